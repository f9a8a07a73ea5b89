"""What does an arch do when a springing gives way?

As long as its support stands still, a masonry arch has many states of equilibrium, and none can say which it
is in. Let the springing move outwards by a little: the arch cracks into a mechanism and follows it, and its
thrust is then the least of all. Pushed together, its thrust is the greatest. The two meet where the arch is
so thin that it has one state of equilibrium left, at the least thickness .107478 R of a semicircle, with the
thrust .621772 gamma t d R.

The support is made a block that a guide lets slide along the motion. Its reaction is the unknown load: the
static theorem finds the least that balances the arch, the kinematic theorem the mechanism that follows.

Source: Heyman (1966), The stone skeleton; Milankovitch (1907); Cocchetti, Colasante & Rizzi (2011).
"""

from pathlib import Path

import numpy as np

import limitblocks as lb
from limitblocks.practice import settlement

LEAST, THRUST = 0.107478, 0.621772
RADIUS, DEPTH, UNIT_WEIGHT = 1.0, 1.0, 20e3
THICKNESS = (1.0002 * LEAST, 0.115, 0.13, 0.16)  # over R


def main(folder="output"):
    thrusts = []
    for t in THICKNESS:
        arch = lb.structures.arch(
            lb.PointContact(friction=2.0),  # no sliding
            radius=RADIUS,
            thickness=t * RADIUS,
            voussoirs=40,
            depth=DEPTH,
            unit_weight=UNIT_WEIGHT,
        )
        spread, pushed = (
            settlement(arch, "right support", (way, 0, 0), without_dilatancy=False) for way in (1, -1)
        )
        unit = UNIT_WEIGHT * t * RADIUS**2 * DEPTH
        thrusts.append((spread.upper / unit, -pushed.upper / unit))
        print(f"t/R {t:.4f}: thrust {thrusts[-1][0]:.5f} to {thrusts[-1][1]:.5f} gamma t d R")
    picture(Path(folder), np.array(thrusts))
    return {
        "thrusts at the least thickness": list(thrusts[0]),
        "spread first": [least <= greatest for least, greatest in thrusts],
    }


def picture(folder, thrusts):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, axis = plt.subplots(figsize=(3.5, 2.6))
    axis.fill_between(THICKNESS, *thrusts.T, alpha=0.3, label="states of equilibrium")
    axis.plot(THICKNESS, thrusts[:, 0], "o-", label="springing gives way")
    axis.plot(THICKNESS, thrusts[:, 1], "s-", label="springings pushed together")
    axis.plot(LEAST, THRUST, "k*", markersize=12, label="least thickness")
    axis.set(xlabel="thickness over radius", ylabel="thrust over gamma t d R")
    axis.legend()
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "25_a_support_gives_way.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
