"""How far apart can the right answers of one structure lie?

Two equal low blocks of weight W stand one behind the other, and alpha W pushes each along the row. The bed
of the one behind has friction m1, that of the one in front m2 > m1, the joint between them m3. Both slide
together, so that the joint between does not slip: it carries a pressure P, and any vertical force V W up to
its friction, which shifts weight from one bed to the other,

    2 alpha = m1 (1 + V) + m2 (1 - V),    P = m2 (1 - V) W - alpha W,    |V| W <= m3 P.

Every such V is a solution of Eqs (54)-(59), with the same mechanism. With V at its limits

    alpha = (m1 + m2) / 2 -+ m3 (m2 - m1)^2 / (4 +- 2 m3 (m1 + m2)).

Nothing is wedged here, no structure is simpler, and yet the load factor is an interval. What decides is V,
which the push itself does not set: it is what building, settlement and creep have left in the joint. So
three answers are told apart. The load path starts from one state of the permanent loads. Paths from other
such states reach other answers: that spread is the uncertainty to design for. And all solutions together
have a least and a greatest value, found here by two convex programs, since the solutions of one mechanism
are a convex set; a mixed-integer program, with friction in squares, proves that no other mechanism has a
lower one or a higher one.

Source: equilibrium by hand; least load factors and why they may not be reached: Orduña & Lourenço (2005),
Part I, Section 5; Baggio & Trovalusci (2000), Mechanics of Structures and Machines 26, 287-304.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

import limitblocks as lb

BEHIND, FRONT, BETWEEN = 0.2, 0.5, 0.6  # m1, m2, m3
CHECKED = 1e-8  # a path on which the joint between slips to the end ends at a limit of V: a right answer, too


def main(folder="output"):
    model = pair(lb.PointContact)
    found = lb.load_factor_range(model, paths=11, mechanisms=10)
    print(found)
    for answer in found.answers:
        print(f"{answer.load_factor:.4f}  {answer.origin.value}: {answer.solution.how}")
    expected = least, most = by_hand()
    print(f"by hand: {least:.6f} to {most:.6f}")
    picture(Path(folder), found, expected)
    return {
        "certified less by hand": np.subtract(found.certified, expected),
        "reached within": float(least - CHECKED <= found.reached[0] < found.reached[1] <= most + CHECKED),
        "worst residual": max(answer.check.worst.value for answer in found.answers),
        "wedged": float(found.wedging.wedged),
    }


def pair(joint):
    """The two blocks on their floor."""
    stones = [
        lb.Block.box("floor", (6.0, 2.0, 0.2), (0, 0, -0.1)),
        lb.Block.box("behind", (1.0, 1.0, 0.4), (-0.5, 0, 0.2), unit_weight=20e3),
        lb.Block.box("front", (1.0, 1.0, 0.4), (0.5, 0, 0.2), unit_weight=20e3),
    ]
    beds = {"behind": BEHIND, "front": FRONT}
    interfaces = []
    for one in lb.find_interfaces(stones, joint(BETWEEN)):
        on = {one.block_i, one.block_j} - {"floor"}
        interfaces.append(replace(one, joint=joint(beds[on.pop()])) if len(on) == 1 else one)
    return lb.Model(stones, ["floor"], interfaces, lb.self_weight(), lb.mass_proportional((1, 0, 0)))


def by_hand():
    """The least and the greatest load factor."""
    total, less = BEHIND + FRONT, FRONT - BEHIND
    limits = np.array([4 + 2 * BETWEEN * total, -4 + 2 * BETWEEN * total])
    return total / 2 - BETWEEN * less**2 / limits


def picture(folder, found, expected):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, ax = plt.subplots(figsize=(7, 2.6))
    ax.axvspan(*expected, color="0.9", label="every solution, by hand")
    levels = {lb.results.Origin.SEARCHED: 1, lb.results.Origin.REACHED: 2, lb.results.Origin.LOAD_PATH: 3}
    for origin, level in levels.items():
        values = [one.load_factor for one in found.answers if one.origin is origin]
        ax.plot(values, [level] * len(values), "o", markersize=6, label=origin.value)
    ax.set(xlabel="load factor", ylim=(0.5, 5.2), yticks=[])
    ax.legend(loc="upper left", ncols=1)
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "22_three_ranges.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
