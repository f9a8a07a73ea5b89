"""Three methods give three load factors of one wall: which of them is right?

Walls 1 and 4 of Ferris & Tin-Loi (2001), lesson 09, with point contacts, by three methods:

- bounds: associated flow, two convex programs, one load factor;
- the tracked path: zero dilatancy, the solution that loading leads to from the permanent loads;
- the fixed point of Gilbert, Casapulla & Ahmed (2006): friction is frozen at the normal forces of the last
  analysis, which makes an associated problem of it; that is solved, friction is frozen again, and so on until
  the load factor stands still.

All are right. The first answers another question: it is the largest load factor that any flow rule could
give. The other two solve the same equations, Eqs (54)-(59), and pass the same check. On wall 1 they agree
within a few thousandths, as on walls 2 and 3. On wall 4 the fixed point ends a sixth above the path, which
ends at the published value: without dilatancy there are many solutions, and a method chooses one.

A load factor that stands still proves nothing. When the rounds change it by less than one part in ten
thousand, the residuals of the equations are still above 1e-3: what makes an answer of it is the closing, two
more convex programs, and the check afterwards. In return every answer, also that of the path, is a fixed
point: with friction frozen at it, limit analysis gives its load factor again.

Source: M. Gilbert, C. Casapulla, H. M. Ahmed (2006), Limit analysis of masonry block structures with
non-associative frictional joints using linear programming, Computers & Structures 84, 873-887; published
values: M. C. Ferris, F. Tin-Loi (2001), Int. J. Mech. Sci. 43, 209-224.
"""

from pathlib import Path

import limitblocks as lb
from limitblocks.structures.cases import FERRIS_TIN_LOI, FERRIS_TIN_LOI_NONASSOCIATED

WALLS = (1, 4)
ASSOCIATED = {number: FERRIS_TIN_LOI[number].value for number in WALLS}
NONASSOCIATED = {number: FERRIS_TIN_LOI_NONASSOCIATED[number].value for number in WALLS}


def main(folder="output"):
    joint = lb.PointContact(friction=0.65)
    walls = {number: lb.structures.ferris_tin_loi_wall(number, joint) for number in ASSOCIATED}
    bounds = {number: lb.bounds(wall) for number, wall in walls.items()}
    paths = {number: lb.nonassociated(wall) for number, wall in walls.items()}
    loops = {number: lb.nonassociated(wall, method="fixed point") for number, wall in walls.items()}
    answers = {"bounds": bounds, "path": paths, "fixed point": loops}
    checks = {
        name: {number: lb.check_mcp(walls[number], one, tolerance=1e-6) for number, one in found.items()}
        for name, found in answers.items()
    }
    print("wall  method       load factor  published  stages  worst residual  check   a round changes")
    for number in walls:
        for name, found in answers.items():
            one, check = found[number], checks[name][number]
            published = (ASSOCIATED if name == "bounds" else NONASSOCIATED)[number]
            change = getattr(one, "fixed_point_change", None)
            print(
                f"{number:4}  {name:11}{one.load_factor:13.4f}{published:11.3f}"
                f"{len(getattr(one, 'history', ())) or '':8}{check.worst.value:16.0e}  "
                f"{'passed' if check.passed else 'FAILED'}{'' if change is None else f'{change:18.0e}'}"
            )
    still = [max(rounds(loops[number])[-1].residuals.values()) for number in walls]
    print("worst residual where the load factor stood still:", ", ".join(f"{one:.0e}" for one in still))
    picture(Path(folder), answers)
    return {
        "associated": [one.load_factor for one in bounds.values()],
        "path over published": [one.load_factor / NONASSOCIATED[k] for k, one in paths.items()],
        "fixed point over published, wall 1": loops[1].load_factor / NONASSOCIATED[1],
        "fixed point over associated, at most 1": max(
            1.0, *(loops[number].load_factor / bounds[number].upper for number in walls)
        ),
        "worst residual": [
            check.worst.value for name in ("path", "fixed point") for check in checks[name].values()
        ],
        "what a round changes": [one.fixed_point_change for one in (*paths.values(), *loops.values())],
    }


def rounds(result):
    return [stage for stage in result.history if stage.kind == "fixed point"]


def picture(folder, answers):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, axes = plt.subplots(1, 3, figsize=(7, 2.5))
    marks = {"bounds": "^", "path": "o", "fixed point": "x"}
    for (name, found), shift in zip(answers.items(), (-0.15, 0.0, 0.15), strict=True):
        places = [number + shift for number in found]
        axes[0].plot(places, [one.load_factor for one in found.values()], marks[name], label=name)
    axes[0].plot(*zip(*NONASSOCIATED.items(), strict=True), "k_", markersize=16, label="published", alpha=0.4)
    axes[0].set(xlabel="wall", ylabel="load factor", xticks=list(NONASSOCIATED), ylim=(0.0, 0.7))
    axes[0].legend()
    for number, one in answers["fixed point"].items():
        stages = rounds(one)
        numbers = [stage.inner for stage in stages]
        loads = [stage.load_factor / one.associated for stage in stages]
        worst = [max(stage.residuals.values()) for stage in stages]
        axes[1].plot(numbers, loads, ".-", label=f"wall {number}")
        axes[2].semilogy([*numbers, numbers[-1] + 1], [*worst, one.residuals.worst.value], ".-")
    axes[1].set(xlabel="round", ylabel="load factor over\nthe associated one")
    axes[2].set(xlabel="round, and the closing", ylabel="worst residual")
    axes[2].axhline(1e-8, color="0.6", linestyle=":")
    axes[1].legend()
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "21_three_answers_all_checked.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
