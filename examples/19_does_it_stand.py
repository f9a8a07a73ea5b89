"""Does it stand by itself, or only if somebody wedges it?

A stone of weight W touches two walls, nothing is below it. Each wall makes the angle w with the vertical,
w > 0 where the stone narrows downwards (a V), w = 0 between parallel walls (an H), w < 0 where it narrows
upwards (an A). By symmetry both walls press with N and carry the shear V, up along the wall:

    2 (N sin w + V cos w) = W,    V <= mu N

V: N = W / (2 sin w) with V = 0 carries it, whatever mu is.
H: 2 V = W with any N >= W / (2 mu): such stresses exist for every mu > 0.
A: 2 (V cos w - N sin |w|) = W: they exist where tan |w| < mu.

Existence is all that statics and associated flow ask for. But where do the normal forces of the H and the A
come from? On slightly compliant joints the walls' normal forces are in proportion to how deep the stone is
pressed into them. Symmetry leaves the stone one way to move, down by d, and joints that slide without
lifting close by d sin w. In the H and the A nothing closes, so N = 0 and the stone falls through, unless
somebody wedges it: it stands only by self-stress.

A flat stone on a slope of angle a is pressed on by its own weight and stands where tan a < mu; near that,
with the margin mu cos a - sin a in weights.

Source: Kao et al. (2022), Coupled rigid-block analysis, Computer-Aided Design 146; Drucker (1954) on
friction and the limit theorems.
"""

from pathlib import Path

import numpy as np

import limitblocks as lb

FRICTION = 0.6
DEGREES = (-40, -20, 0, 20, 40)
SLOPES = (0.5, 0.55, 0.7)
UNIT_WEIGHT = 20e3
COLOURS = {"STANDS": "#009E73", "SELF_STRESS": "#E69F00", "FALLS": "#D55E00"}


def main(folder="output"):
    wedges = {w: between_walls(w) for w in DEGREES}
    found = {w: lb.stability(model) for w, model in wedges.items()}
    for w, answer in found.items():
        print(f"walls at {w} deg: {answer}")
        exists = -np.tan(np.radians(w)) < FRICTION
        assert (answer.kind is not lb.results.Standing.FALLS) == exists
        assert answer.stands == (w > 0)
    slopes = [lb.stability(on_a_slope(tangent)) for tangent in SLOPES]
    for tangent, answer in zip(SLOPES, slopes, strict=True):
        print(f"slope of {tangent}: {answer}")
    picture(Path(folder), wedges, found)
    return {
        "answers": [list(lb.results.Standing).index(answer.kind) for answer in found.values()],
        "vertical force over weight": [lift(wedges[w], found[w]) for w in DEGREES if w > 0],
        "margin on the slope": [answer.margin for answer in slopes],
    }


def prism(name, section, unit_weight=None):
    """A body of depth 1 m above the four corners of a section in X and Z."""
    return lb.Block.prism(name, section, (-0.5, 0.5), unit_weight)


def structure(blocks, supports):
    return lb.Model(
        blocks=blocks,
        supports=supports,
        interfaces=lb.find_interfaces(blocks, lb.OrdunaLourenco(FRICTION)),
        dead=lb.self_weight(),
        live=lb.mass_proportional((0.0, 1.0, 0.0)),
    )


def between_walls(degrees):
    low, high, out = 1.5, 1.5 + np.tan(np.radians(degrees)), 3.0
    blocks = [
        prism("left", [(-out, 0), (-low, 0), (-high, 1), (-out, 1)]),
        prism("right", [(low, 0), (out, 0), (out, 1), (high, 1)]),
        prism("stone", [(-low, 0), (low, 0), (high, 1), (-high, 1)], UNIT_WEIGHT),
    ]
    return structure(blocks, ["left", "right"])


def on_a_slope(tangent):
    along, normal = np.array([(1, tangent), (-tangent, 1)]) / np.hypot(1, tangent)

    def box(name, length, low, high, unit_weight=None):
        corners = (-length, low), (length, low), (length, high), (-length, high)
        return prism(name, [x * along + z * normal for x, z in corners], unit_weight)

    return structure([box("plane", 3, -1, 0), box("stone", 1, 0, 0.3, UNIT_WEIGHT)], ["plane"])


def lift(model, answer):
    """Vertical force of both walls on the stone over its weight, from the stresses that arise."""
    force = 0.0
    for interface, Q in zip(model.interfaces, answer.arising, strict=True):
        on_block_i = Q[:3] @ interface.axes
        force += (1.0 if interface.block_i == "stone" else -1.0) * on_block_i[2]
    return force / (UNIT_WEIGHT * model.blocks[2].volume)


def picture(folder, wedges, found):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, axes = plt.subplots(1, len(wedges), figsize=(7, 1.6), sharey=True)
    for axis, (w, model) in zip(axes, wedges.items(), strict=True):
        for block in model.blocks:
            section = block.vertices[:4, [0, 2]]
            stone = block.name == "stone"
            axis.fill(*section.T, color=COLOURS[found[w].kind.name] if stone else "lightgrey", ec="black")
        said = found[w].kind.value.split(":")[0].replace("only by ", "only\nby ")
        axis.set(title=f"{w}°\n{said}", aspect="equal", xticks=[], yticks=[])
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "19_does_it_stand.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
