"""A corner is pushed outwards and its stones twist: how much does the torsion of their beds matter?

Two walls of four courses interlock at a corner, their quoins alternating. Pushed along the diagonal, the
stones of the corner slide, lift and turn on their beds, and a bed that turns resists by its torsion
strength:

    T0 = c_T mu |N|    under uniform pressure, Eqs (16)-(17);    T0 = mu |N| d/2    with points at its corners

d is the diagonal of the bed. On a square the points are 1.85 times as strong, and a corner of point
contacts seems stronger than it is. `ExactTorsion` brackets the strength under uniform pressure; the surface
of the paper lies a little above. All of these have the same friction coefficient and the same geometry.

The bounds assume that beds which slide also open. They do not, and the load factor without lift is less,
with any of the joints; the order of the joints stays.

A single quoin twisted by itself shows the ratio alone: a cube on its bed under its weight and a couple.

Source: Orduña & Lourenço (2005), Part I, Eqs (16)-(30); Livesley (1978) for the points; the mechanism is
that of Giuffrè (1991) and D'Ayala & Speranza (2003) for corners.
"""

from pathlib import Path

import limitblocks as lb

FRICTION = 0.6
JOINTS = {
    "uniform pressure, inner": lb.joints.ExactTorsion(FRICTION, side="inner"),
    "uniform pressure, outer": lb.joints.ExactTorsion(FRICTION, side="outer"),
    "Orduña & Lourenço": lb.OrdunaLourenco(FRICTION),
    "point contacts": lb.PointContact(FRICTION),
}
COMPARED = ("Orduña & Lourenço", "point contacts")  # without lift, too


def main(folder="output"):
    corners = {name: lb.bounds(corner(joint)) for name, joint in JOINTS.items()}
    quoins = {name: lb.bounds(twisted_quoin(joint)).lower for name, joint in JOINTS.items()}
    flat = {name: lb.nonassociated(corner(JOINTS[name])) for name in COMPARED}
    for name, found in corners.items():
        real = f"{flat[name].load_factor:.4f}" if name in flat else "not run"
        print(
            f"{name:24s}: corner {real}, if sliding lifted {found.lower:.4f}; "
            f"a quoin twisted by itself {quoins[name]:.4f}"
        )
    ratio = quoins["point contacts"] / quoins["Orduña & Lourenço"]
    print(f"point contacts overestimate the torsion of the quoin {ratio:.3f} times")
    inner, outer, _, points = (found.lower for found in corners.values())
    assert inner <= outer <= points
    assert all(found.load_factor <= corners[name].lower + 1e-6 for name, found in flat.items())
    picture(Path(folder), corners, flat)
    return {"ratio": ratio} | quoins


def corner(joint):
    """Two walls along X and Y, pushed outwards along the diagonal."""
    return lb.structures.corner(joint, length=2.0, return_length=2.0, courses=4, direction=(-1, -1, 0))


def twisted_quoin(joint):
    """A cube of 0.4 m under its weight W and alpha times the couple W x 1 m about the vertical."""
    cube = lb.structures.block(joint, width=0.4, height=0.4, depth=0.4)
    couple = lb.loads.moment(cube.free_blocks[0].name, (0, 0, cube.free_blocks[0].weight))
    return lb.Model(cube.blocks, cube.supports, cube.interfaces, cube.dead, couple)


def picture(folder, corners, flat):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure = plt.figure(figsize=(7, 5))
    grid = figure.add_gridspec(2, 2, height_ratios=(1, 1.8))
    left = figure.add_subplot(grid[0, :])
    names = list(corners)
    left.barh(names, [found.lower for found in corners.values()], color="#E69F00", label="if sliding lifted")
    values = [found.load_factor for found in flat.values()]
    left.barh(list(flat), values, height=0.4, color="#0072B2", label="without lift")
    for k, found in enumerate(corners.values()):
        left.annotate(f"{found.lower:.4f}", (found.lower, k), (4, -4), textcoords="offset points")
    left.set(xlabel="load factor", xlim=(0, 1.45 * max(found.lower for found in corners.values())))
    left.set_title("The corner by its joints")
    left.legend(loc="lower right")
    model, found = corner(JOINTS["Orduña & Lourenço"]), flat["Orduña & Lourenço"]
    for k, draw in enumerate((lb.plots.mechanism, lb.plots.interface_states)):
        ax = figure.add_subplot(grid[1, k], projection="3d", proj_type="ortho", elev=25, azim=-110)
        draw(model, found, ax=ax)
        ax.set_title(("Mechanism", "What the joints do")[k], y=1.08)
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "13_corner_failure_with_twist.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
