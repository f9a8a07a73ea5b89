"""Why does the analysis give two numbers when there is one load factor?

An arch of nine voussoirs, 140 deg of a circle, is pushed sideways by a share alpha of its weight. Neither
number needs the answer to be known:

- Static theorem. Whoever finds forces in equilibrium that no joint refuses has proven that the arch stands:
  alpha is a lower bound. Here the line of thrust is kept within the middle share s of the thickness. At s =
  1/3 that is the rule of the middle third; the smaller s, the safer, and the farther from the truth.
- Kinematic theorem. Whoever finds a way for the arch to move that takes no more work than the loads give
  has proven that it falls: alpha is an upper bound. Here three bars turn about four hinges, at any four
  joints and on alternate sides.

The load factor of a mechanism is the one at which the work of all loads is zero:

    sum of W (alpha u - w) = 0,    u, w the horizontal and upward rates of the centroids

Both theorems hold for associated flow. The largest lower and the smallest upper bound meet: they are the
same convex program seen from two sides, and their difference, the gap, is the proof that both were solved.

Source: Kooharian (1952), Limit analysis of voussoir and concrete arches; Heyman (1966), The stone skeleton;
Drucker, Prager & Greenberg (1952) for the theorems.
"""

from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np

import limitblocks as lb

SHARES = (1 / 3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
RADIUS, THICKNESS, VOUSSOIRS, EMBRACE = 2.0, 0.5, 9, np.radians(140)


def main(folder="output"):
    arch = lb.structures.arch(
        lb.PointContact(friction=0.8),
        radius=RADIUS,
        thickness=THICKNESS,
        voussoirs=VOUSSOIRS,
        embrace=EMBRACE,
    )
    lower = [lb.bounds(within(arch, share)).lower for share in SHARES]
    for share, found in zip(SHARES, lower, strict=True):
        print(f"thrust within the middle {share:.2f} of the joints: stands at {found:.4f}")
    upper = np.sort(upper_bounds(arch))
    print(f"{len(upper)} mechanisms of four hinges: falls at {upper[0]:.6f}, {upper[1]:.6f}, ...")
    bounds = lb.bounds(arch)
    print(bounds)
    assert max(lower) < bounds.upper + 1e-6
    picture(Path(folder), arch, lower, upper, bounds)
    return {
        "load factor": bounds.lower,
        "gap": bounds.gap,
        "static less the mechanisms": bounds.lower - upper[0],
        "kinematic less the mechanisms": bounds.upper - upper[0],
    }


def within(model, share):
    """The model with joints of a share of their length in the plane X, Z."""
    narrow = []
    for interface in model.interfaces:
        scale = np.where(np.abs(interface.axes[:2, 1]) > 0.5, 1.0, share)  # not across the plane
        narrow.append(replace(interface, polygon=interface.polygon * scale))
    return replace(model, interfaces=narrow)


def upper_bounds(arch):
    """Load factors of all mechanisms of three bars between four hinges that only open their joints."""
    angles = np.linspace(-EMBRACE / 2, EMBRACE / 2, VOUSSOIRS + 1)  # of the joints, from the left springing
    outward = np.column_stack([np.sin(angles), np.cos(angles)])
    inner, outer = (RADIUS - THICKNESS / 2) * outward, (RADIUS + THICKNESS / 2) * outward
    stones = [(block.weight, block.centroid[[0, 2]]) for block in arch.free_blocks]
    found = []
    for joints in combinations(range(VOUSSOIRS + 1), 4):
        for sides in ((inner, outer) * 2, (outer, inner) * 2):
            hinges = np.array([side[joint] for side, joint in zip(sides, joints, strict=True)])
            signs = [1 if side is outer else -1 for side in sides]
            found += load_factor_of(hinges, signs, joints, stones)
    return np.array(found)


def turned(arm):
    """Rate of the end of an arm that turns anticlockwise at the rate one."""
    return np.array([-arm[1], arm[0]])


def load_factor_of(hinges, signs, joints, stones):
    """The load factor of one mechanism, in a list, which is empty if a joint would have to overlap."""
    A, B, C, D = hinges
    w = np.zeros(5)  # rates of rotation: left part and right part stand still
    w[1] = 1.0
    columns = np.column_stack([turned(C - B), -turned(C - D)])  # v_B + w2 x BC = w3 x DC
    w[2], w[3] = np.linalg.solve(columns, -w[1] * turned(B - A))
    opening = np.diff(w) * signs  # at the extrados a joint opens where the next part turns anticlockwise
    if not (np.all(opening <= 1e-12) or np.all(opening >= -1e-12)):
        return []
    w *= np.sign(opening.sum())
    dead = live = 0.0
    for k, (weight, centroid) in enumerate(stones):
        part = np.searchsorted(joints, k, side="right")
        pivot = (A, A, B, D, D)[part]
        v = w[part] * turned(centroid - pivot) + (w[1] * turned(B - A) if part == 2 else 0)
        dead, live = dead - weight * v[1], live + weight * v[0]
    return [-dead / live] if live > 1e-9 else []


def picture(folder, arch, lower, upper, bounds):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, axes = plt.subplots(1, 3, figsize=(7, 2.5), width_ratios=(1.1, 1, 1))
    axes[0].plot(SHARES, lower, "o-", color="#0072B2", label="it stands: thrust within\nthe middle share")
    shown = upper[upper < 3 * bounds.upper]
    axes[0].plot(
        np.linspace(1, 1 / 3, len(shown)), shown, ".", color="#D55E00", label="it falls: four hinges"
    )
    axes[0].axhline(bounds.upper, color="0.6", linestyle=":")
    axes[0].set(xlabel="share of the joints used", ylabel="load factor", ylim=(0, None))
    axes[0].legend(loc="upper right")
    axes[0].set_title("The bounds close in")
    middle = within(arch, 1 / 3)
    lb.plots.thrust_line(middle, lb.bounds(middle), ax=axes[1])
    axes[1].set_title(f"Middle third: stands, {lower[0]:.3f}")
    lb.plots.mechanism(arch, bounds, ax=axes[2])
    axes[2].set_title(f"Best mechanism: falls, {bounds.upper:.4f}")
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "07_why_two_bounds.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
