"""Why do codes with contact points at the corners find walls stronger against twisting?

Livesley's model lets a joint touch at points, each with Coulomb's law. The pressure is then free to gather
in the corners, farthest from the centre, and a rectangle of diagonal d carries the torsion mu |N| d/2.
Under the uniform pressure of Eqs (16)-(17) it carries mu |N| c_T: on a square 1.85 times less, at l1/l2 = 4
1.94 times less. More points change nothing, because any force within the polygon can be shared among its
corners.

Here a stone on a joint of 0.3 m x 0.2 m is pushed sideways, `lever` off the middle of the joint. Pushed at
its middle it slides, and all models agree; far off it twists, and they part.

Source: Livesley (1978), Int. J. Numer. Meth. Engng 12; Orduña & Lourenço (2005), Part I, Eqs (16)-(29).
"""

from pathlib import Path

import numpy as np

import limitblocks as lb
from limitblocks.joints.torsion import rectangle_torsion_constant

FRICTION = 0.7
SQUARE = np.array([(1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)])
JOINTS = {
    "point contacts": lb.PointContact(FRICTION),
    "Orduña & Lourenço": lb.OrdunaLourenco(FRICTION),
    "uniform pressure, outer": lb.joints.ExactTorsion(FRICTION, side="outer"),
    "uniform pressure, inner": lb.joints.ExactTorsion(FRICTION, side="inner"),
}


def main(folder="output"):
    excesses = []
    for ratio, expected in ((1, 1.85), (2, 1.89), (4, 1.94)):
        excess = torsion(lb.PointContact(1.0), ratio) / torsion(lb.OrdunaLourenco(1.0), ratio)
        refined = torsion(lb.PointContact(1.0, points=4), ratio) / torsion(lb.OrdunaLourenco(1.0), ratio)
        print(
            f"l1/l2 = {ratio}: points carry {excess:.3f} times the torsion; four points a side {refined:.3f}"
        )
        assert abs(excess - expected) < 0.01
        assert abs(refined - excess) < 1e-8
        excesses.append(excess)
    levers = np.array([0.0, 0.02, 0.05, 0.1, 0.2, 0.4])
    found = {name: [load_factor(joint, lever) for lever in levers] for name, joint in JOINTS.items()}
    for name, values in found.items():
        print(f"{name:24s}" + "".join(f"{value:8.4f}" for value in values))
    assert np.allclose([values[0] for values in found.values()], FRICTION, rtol=1e-6)
    assert found["point contacts"][-1] > 1.5 * found["Orduña & Lourenço"][-1]
    picture(Path(folder), levers, found)
    return {"excess": excesses, "not twisted": [values[0] for values in found.values()]}


def torsion(joint, ratio):
    """Torsion strength of a joint with half sides `ratio` and 1 under N = -1."""
    interface = lb.joints.interface(SQUARE * [ratio, 1], joint)
    return joint.strength(interface, (0, 0, 0, 0, 0, 1), given=(0, 0, -1, 0, 0, 0))


def load_factor(joint, lever):
    """A stone on a base, pushed by its weight along Y in the plane of the joint, `lever` off its middle."""
    blocks = [
        lb.Block.box("base", size=(1, 1, 0.1), at=(0, 0, -0.05)),
        lb.Block.box("stone", size=(0.3, 0.2, 0.1), at=(0, 0, 0.05), unit_weight=20e3),
    ]
    live = lb.loads.force("stone", (0, blocks[1].weight, 0), at=(lever, 0, 0))
    return lb.bounds(
        lb.Model(blocks, ["base"], lb.find_interfaces(blocks, joint), lb.self_weight(), live)
    ).lower


def picture(folder, levers, found):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, (left, right) = plt.subplots(1, 2, figsize=(7, 3.2))
    for (name, values), style in zip(found.items(), ("s-", "o-", "^--", "v--"), strict=True):
        left.plot(levers, values, style, label=name)
    left.set(xlabel="lever of the push (m)", ylabel="load factor", ylim=(0, 0.75))
    left.set_title("A stone pushed off its middle (associated flow)")
    left.legend()
    ratio = np.geomspace(1, 50, 200)
    right.semilogx(ratio, np.hypot(ratio, 1) / rectangle_torsion_constant(ratio, 1))
    for known in (1, 4):
        excess = torsion(JOINTS["point contacts"], known) / torsion(JOINTS["Orduña & Lourenço"], known)
        right.plot(known, excess, "o", color="#D55E00")
        right.annotate(f"{excess:.2f}", (known, excess), xytext=(8, -10), textcoords="offset points")
    right.set(xlabel="aspect ratio $l_1/l_2$", ylabel="torsion strength, points / uniform pressure")
    right.set(ylim=(1.8, 2.02), title="Point contacts overestimate torsion")
    right.set_xticks([1, 2, 4, 10, 20, 50], ["1", "2", "4", "10", "20", "50"])
    right.minorticks_off()
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "05_orduna_lourenco_against_point_contact.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
