"""Does the program find what others have found for walls in running bond?

The four walls of Ferris & Tin-Loi (2001) are the field's common benchmark: blocks of 0.4 m x 0.175 m in the
plane, two plain walls of six and ten courses and two with openings, on a rigid base, friction 0.65, no
cohesion, no tension, no crushing. Their weight presses down, and alpha times their weight pushes to the
right.

Associated flow: a linear program for each bound, whose values agree to every digit. Zero dilatancy: a
complementarity problem,

    alpha Fv + Fc = C^T Q,    F Q + g >= 0,    C u = -G^T y,    y >= 0,    y . (F Q + g) = 0,    Fv . u = 1

whose solutions are not unique; published values differ by a few thousandths.

Source: M. C. Ferris, F. Tin-Loi (2001), Limit analysis of frictional block assemblies as a mathematical
program with complementarity constraints, Int. J. Mech. Sci. 43, 209-224; equations: Orduña & Lourenço
(2005), Part I, Eqs (54)-(59).
"""

from pathlib import Path

import limitblocks as lb
from limitblocks.structures.cases import FERRIS_TIN_LOI, FERRIS_TIN_LOI_NONASSOCIATED

ASSOCIATED = {number: one.value for number, one in FERRIS_TIN_LOI.items()}
NONASSOCIATED = {number: one.value for number, one in FERRIS_TIN_LOI_NONASSOCIATED.items()}


def main(folder="output"):
    joint = lb.OrdunaLourenco(friction=0.65)
    walls = {number: lb.structures.ferris_tin_loi_wall(number, joint) for number in ASSOCIATED}
    bounds = {number: lb.bounds(wall) for number, wall in walls.items()}
    found = {number: lb.nonassociated(wall) for number, wall in walls.items()}
    print("wall  blocks   associated  published   zero dilatancy  published  difference")
    for number, wall in walls.items():
        load_factor, published = found[number].load_factor, NONASSOCIATED[number]
        print(
            f"{number:4}{len(wall.free_blocks):8}{bounds[number].lower:13.5f}{ASSOCIATED[number]:11.5f}"
            f"{load_factor:17.4f}{published:11.3f}{load_factor / published - 1:+12.2%}"
        )
    picture(Path(folder), walls, found)
    return {
        "associated": [bounds[number].lower for number in walls],
        "zero dilatancy over published": [
            found[number].load_factor / NONASSOCIATED[number] for number in walls
        ],
    }


def picture(folder, walls, found):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, axes = plt.subplots(1, 4, figsize=(7, 2.9), width_ratios=(2, 2, 1.6, 2))
    for ax, number in zip(axes, walls, strict=True):
        lb.plots.mechanism(walls[number], found[number], ax=ax)
        ax.set_title(
            f"wall {number}: {found[number].load_factor:.4f}\n(published {NONASSOCIATED[number]:.3f};\n"
            f"associated {ASSOCIATED[number]:.5f})"
        )
    figure.suptitle("Mechanisms for zero dilatancy")
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "09_ferris_and_tin_loi_walls.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
