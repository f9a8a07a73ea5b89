"""What does an arch do when a springing gives way?

As long as its support stands still, a masonry arch has many states of equilibrium, and none can say which it
is in. Let the springing move outwards by a little: the arch cracks into a mechanism and follows it, and its
thrust is then the least of all. Pushed together, its thrust is the greatest. The two meet where the arch is
so thin that it has one state of equilibrium left, at the least thickness .107478 R of a semicircle, with the
thrust .620881 gamma t d R (with the weight on the centre line, at .107426 R, .621772).

How far can it go on? Moved along its mechanism, the arch gets wider and lower and its thrust grows, until the
line of thrust reaches the outer edge of the springing: a fourth hinge, and it falls.

The support is made a block that a guide lets slide along the motion. Its reaction is the unknown load: the
static theorem finds the least that balances the arch, the kinematic theorem the mechanism that follows.

Source: Heyman (1966), The stone skeleton; Milankovitch (1907); Cocchetti, Colasante & Rizzi (2011);
Ochsendorf (2006), The masonry arch on spreading supports.
"""

from pathlib import Path

import numpy as np

import limitblocks as lb
from limitblocks.practice import settlement, settlement_to_collapse

LEAST, THRUST = 0.107478, 0.620881
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
    way = spread_until_it_falls()
    print(f"t/R 0.2: {way}")
    picture(Path(folder), np.array(thrusts), way)
    return {
        "spread at the fall": (way.stands_to + way.falls) / 2,
        "thrust at the fall over that at rest": way.reactions[-1] / way.reactions[0],
        "thrusts at the least thickness": list(thrusts[0]),
        "spread first": [least <= greatest for least, greatest in thrusts],
    }


def spread_until_it_falls():
    arch = lb.structures.arch(lb.PointContact(friction=0.8), radius=RADIUS, thickness=0.2, voussoirs=8)
    return settlement_to_collapse(
        arch, "right support", (1, 0, 0), step=0.1, accuracy=1e-3, without_dilatancy=False
    )


def picture(folder, thrusts, way):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, (axis, beside) = plt.subplots(1, 2, figsize=(7.0, 2.6))
    lb.plots.settlement(way, beside)
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
