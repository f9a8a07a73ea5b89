"""Does a block on a plane slide or rock, and at what angle does it go when the plane tilts?

A block, b wide, h high and of weight W, stands on a plane with friction coefficient mu. A horizontal force
alpha W pushes it in its middle. The joint carries the normal force W, the shear force alpha W and the
moment alpha W h/2. It slides when the shear force reaches mu W, and rocks about its lower edge when the
normal force arrives there, alpha W h/2 = W b/2:

    alpha = min(mu, b/h)

A column of k such blocks is as slender as a block k times as high: min(mu, b/(k h)). On a plane tilted by
the angle t the weight has the components W cos t and W sin t, in the ratio tan t: it goes at tan t = alpha.

Source: Coulomb (1773), Essai sur une application des règles de maximis et minimis, for the two conditions;
yield functions: Orduña & Lourenço (2005), Part I, Eqs (24) and (36).
"""

from pathlib import Path

import numpy as np

import limitblocks as lb

FRICTION = 0.6
JOINT = lb.PointContact(FRICTION)
RATIOS = np.linspace(0.1, 1.2, 12)  # b/h


def main(folder="output"):
    swept = lb.studies.sweep(stone, RATIOS, parameter="b/h")
    for ratio, found in zip(RATIOS, swept.load_factors, strict=True):
        print(f"b/h = {ratio:.1f}: load factor {found:.4f}, min(mu, b/h) = {min(FRICTION, ratio):.4f}")
    column = lb.bounds(lb.structures.column(JOINT, count=5, width=0.5, height=0.4)).lower
    angle = np.degrees(lb.loads.Tilting.angle(lb.bounds(on_tilting_plane(0.4)).lower))
    print(f"five blocks of b/h = 1.25: {column:.4f}; b/h = 0.4 rocks on a plane of {angle:.2f} deg")
    picture(Path(folder), swept.load_factors)
    return {"load factors": swept.load_factors, "column of five": column, "angle": angle}


def stone(ratio):
    """A block of height 1 m on a base, pushed along X."""
    return lb.structures.block(JOINT, width=float(ratio), height=1.0)


def on_tilting_plane(ratio):
    """The same block under the loads of a plane that tilts towards X."""
    model, loads = stone(ratio), lb.loads.tilting((1, 0, 0))
    return lb.Model(model.blocks, model.supports, model.interfaces, loads.dead, loads.live)


def picture(folder, load_factors):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, axes = plt.subplots(1, 3, figsize=(7, 2.7), width_ratios=(1.4, 1, 1))
    ratio = np.linspace(0, 1.2, 200)
    axes[0].plot(ratio, np.minimum(FRICTION, ratio), color="0.6", label="min(mu, b/h)")
    axes[0].plot(RATIOS, load_factors, "o", color="#D55E00", label="found")
    axes[0].set(xlabel="b/h", ylabel="load factor", ylim=(0, 0.7), title="A block with friction 0.6")
    axes[0].annotate("rocks", (0.32, 0.2), color="#0072B2")
    axes[0].annotate("slides", (0.85, 0.63), color="#0072B2")
    axes[0].legend(loc="lower right")
    for ax, ratio, word in zip(axes[1:], (0.3, 1.0), ("rocks", "slides"), strict=True):
        lb.plots.mechanism(stone(ratio), lb.nonassociated(stone(ratio)), ax=ax)
        ax.set(title=f"b/h = {ratio:g}: {word}", xlim=(-0.3, 1.4), ylim=(-0.2, 1.3))
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "06_sliding_and_rocking_block.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
