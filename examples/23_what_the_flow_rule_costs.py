"""What does the flow rule cost: how much less does a structure carry because sliding does not lift it?

The bounds assume that joints which slide also open, by the friction angle (associated flow). Dry stone
slides without lifting. What the assumption is worth depends on what the mechanism does, not on friction
alone:

- where joints only hinge nothing slides, and it costs nothing: an arch, whatever the friction;
- a block that slides on its bed may lift freely, nothing holds it down: nothing again, alpha = min(mu, b/h);
- where sliding parts are held together, lifting has to move weight, which associated flow counts as
  resistance. A wedge in a groove at the half angle w:

    associated    mu / sqrt(sin^2 w - mu^2 cos^2 w)
    without lift  mu / sin w

- walls, corners and facades of interlocking stones are between these.

The table has the quotient of both load factors, for six structures and three frictions. It is no factor of
safety: it is known only after both analyses.

Source: Drucker (1954) on friction and the limit theorems; Ferris & Tin-Loi (2001), whose wall 4 has
0.264 / 0.33195 = 0.80; the wedge as in lesson 18, the arch of Oppenheim (1992).

Try: other frictions; a longer wall, a higher one; `lb.PointContact` in place of `lb.OrdunaLourenco`.
"""

from pathlib import Path

import numpy as np

import limitblocks as lb

FRICTIONS = (0.3, 0.5, 0.7)
HALF_ANGLE = np.radians(45)
STRUCTURES = {
    "block": lambda joint: lb.structures.block(joint, width=1.0, height=1.6),
    "arch": lambda joint: lb.structures.arch(
        joint, radius=10.0, thickness=1.5, voussoirs=7, embrace=np.radians(157.5)
    ),
    "wedge": lambda joint: lb.structures.wedge(joint, half_angle=HALF_ANGLE),
    "wall": lambda joint: lb.structures.wall(
        joint, length=1.2, courses=4, block_length=0.4, block_height=0.2
    ),
    "corner": lambda joint: lb.structures.corner(
        joint, length=1.6, return_length=1.6, courses=3, direction=(-1, -1, 0)
    ),
    "facade": lambda joint: lb.structures.facade(
        joint, length=3.2, courses=3, return_length=1.2, openings=()
    ),
}


def main(folder="output"):
    associated, found = np.zeros((2, len(STRUCTURES), len(FRICTIONS)))
    for i, build in enumerate(STRUCTURES.values()):
        for k, friction in enumerate(FRICTIONS):
            model = build(lb.OrdunaLourenco(friction))
            associated[i, k] = lb.bounds(model).lower
            found[i, k] = lb.nonassociated(model).load_factor
    share = found / associated
    print("load factor without lift over the associated one")
    print(" " * 10, *(f"mu = {friction}" for friction in FRICTIONS))
    for name, row in zip(STRUCTURES, share, strict=True):
        print(f"{name:10s}", *(f"{value:8.3f}" for value in row))
    assert np.all(share <= 1 + 1e-6)
    picture(Path(folder), share)
    names = list(STRUCTURES)
    return {
        "block": found[names.index("block")],
        "arch, share": share[names.index("arch")],
        "wedge, associated": associated[names.index("wedge")],
        "wedge, without lift": found[names.index("wedge")],
    }


def picture(folder, share):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, axis = plt.subplots(figsize=(7, 2.4))
    width, colours = 0.26, ("#0072B2", "#E69F00", "#009E73")
    for k, (friction, colour) in enumerate(zip(FRICTIONS, colours, strict=True)):
        places = np.arange(len(STRUCTURES)) + width * (k - 1)
        axis.bar(places, share[:, k], width, color=colour, label=f"friction {friction}")
    axis.axhline(1.0, color="black", linewidth=0.8)
    axis.set_xticks(range(len(STRUCTURES)), STRUCTURES)
    axis.set(ylabel="without lift / associated", ylim=(0.5, 1.15))
    axis.legend(ncols=3, loc="upper center")
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "23_what_the_flow_rule_costs.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
