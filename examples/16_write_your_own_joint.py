"""How do I put my own yield criterion into the analysis?

A joint is a frozen dataclass with a friction coefficient and a function `yield_rows`, which says for
polygons of shape (m, n, 2) what stresses x = (V1, V2, N, M1, M2, T) they carry: F x + g >= 0, row by row,
and how the joint flows: dx = -G^T y. Bounds, the non-associated analysis, the check and the pictures all
read the same rows. Here is a mortar joint with friction mu, cohesion c and tensile strength ft on the area
A:

    |V1| + |V2| + |T|/c_T <= mu |N| + c A                          eight rows, one for each choice of signs
    d_k (A ft - N) + (n1 M2 - n2 M1) >= 0 for each side k          the joint does not open about the side k

n1, n2 is the outward normal of a side and d_k its distance from the centroid; the point (e1, e2) = (-M2,
M1)/N must lie within it. The octahedron of the first line is convex and has its six corners on Coulomb's
circle and at the torsion strength, so it lies within the surface of uniform pressure: a safe joint, up to
sqrt(2) too weak along the diagonal. Zero dilatancy takes the column of N out of the first eight rows of G.

What comes out is known. A block b x h of weight W on mortar, pushed at half its height, stands up to

    alpha = min(mu + c A/W, b/h (1 + ft A/W)),    and, pushed at its base `lever` off the middle,
    alpha = (mu + c A/W) / (1 + lever/c_T)

Source: the first line is the inner approximation of the limit surface of Goyal, Ruina & Papadopoulos
(1991), Wear 143; the second is Eq. (36) of Orduña & Lourenço (2005), Part I, with a tensile strength; c_T
is their Eq. (17).
"""

from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np

import limitblocks as lb


@dataclass(frozen=True)
class Mortar(lb.joints.Queries):
    """Friction and cohesion (Pa) within the exact surface; rocking with a tensile strength (Pa).

    The analyses need `friction` and `yield_rows`. Queries adds questions to one joint, such as strength(...).
    """

    friction: float
    cohesion: float = 0.0
    tensile_strength: float = 0.0

    def yield_rows(self, polygons, stress_unit=1.0):
        m, n, _ = polygons.shape
        area = lb.joints.areas(polygons)[:, None] / stress_unit
        edge = np.roll(polygons, -1, axis=1) - polygons
        normal = np.stack([edge[..., 1], -edge[..., 0]], axis=2) / np.linalg.norm(edge, axis=2)[..., None]
        distance = (normal * polygons).sum(axis=2)
        signs = np.array(list(product((1.0, -1.0), repeat=3)))
        F = np.zeros((m, 8 + n, 6))
        F[:, :8, [0, 1, 5]] = -signs
        F[:, :8, 5] /= lb.joints.torsion_constants(polygons)[:, None]
        F[:, :8, 2] = -self.friction
        F[:, 8:, 2] = -1.0
        F[:, 8:, 3], F[:, 8:, 4] = -normal[..., 1] / distance, normal[..., 0] / distance
        G = F.copy()
        G[:, :8, 2] = 0.0
        g = np.repeat(area * [[self.cohesion, self.tensile_strength]], [8, n], axis=1)
        return lb.joints.YieldRows(
            F=F,
            g=g,
            G=G,
            pivot=np.zeros((m, 8 + n)),
            half_sides=np.abs(polygons).max(axis=1),
            resultants=np.broadcast_to(np.eye(6), (m, 6, 6)),
            linear=8 + n,
            cones=(),
            modes=("slip-twist",) * 8 + ("hinge",) * n,
            friction=self.friction,
        )


MORTAR = Mortar(friction=0.6, cohesion=2e3, tensile_strength=1e3)
WIDTH, HEIGHT, LEVER = 0.5, 1.0, 0.2  # m
UNIT_WEIGHT = 20e3


def main(folder="output"):
    found = {}
    for name, joint in (("dry", Mortar(0.6)), ("mortar", MORTAR)):
        for word, model in (("pushed", pushed(joint)), ("pushed off its middle", twisted(joint))):
            bounds, result = lb.bounds(model), lb.nonassociated(model)
            lb.check_mcp(model, result).require()
            print(f"{name}, {word}: {bounds.lower:.4f}, zero dilatancy {result.load_factor:.4f}")
            found[f"{name}, {word}"] = (bounds.lower, result.load_factor)
    picture(Path(folder))
    return found


def pushed(joint):
    """A block on a base under a horizontal force at half its height."""
    return lb.structures.block(joint, width=WIDTH, height=HEIGHT, unit_weight=UNIT_WEIGHT)


def twisted(joint):
    """The same block under a horizontal force along X at its base, LEVER off the middle."""
    model = pushed(joint)
    stone = model.free_blocks[0]
    at = np.add(stone.centroid, (0, LEVER, -HEIGHT / 2))
    return lb.Model(
        model.blocks,
        model.supports,
        model.interfaces,
        model.dead,
        lb.loads.force(stone.name, (stone.weight, 0, 0), at=at),
    )


def picture(folder):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, axes = plt.subplots(1, 3, figsize=(7, 2.8), width_ratios=(1, 1.2, 0.7))
    square = lb.joints.interface([(0.25, -0.25), (0.25, 0.25), (-0.25, 0.25), (-0.25, -0.25)], None)
    for ax, (x, y) in zip(axes, (("V1", "V2"), ("V1", "T")), strict=False):
        lb.plots.interaction(Mortar(0.6), square, x, y, exact=True, label="your joint, dry", ax=ax)
        lb.plots.interaction(lb.OrdunaLourenco(0.6), square, x, y, label="Orduña & Lourenço", ax=ax)
    axes[0].set_title("Shear: a square within the circle")
    axes[1].set_title("Shear and torsion")
    model = pushed(MORTAR)
    found = lb.nonassociated(model)
    lb.plots.mechanism(model, found, ax=axes[2])
    axes[2].set(title=f"On mortar: {found.load_factor:.3f}", ylim=(-0.3, None))
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "16_write_your_own_joint.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
