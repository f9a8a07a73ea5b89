"""Somebody gives me a load factor and forces: how do I find out whether they are right?

A stone of weight W, 1 m x 1 m x 2 m, on the ground with friction 0.3, is pushed along X by alpha W at half
its height. Others claim alpha with the stress resultants (V1, V2, N, M1, M2, T) of the joint, in a file
which any program, or a hand, can write (docs/result-file.md). The check trusts nothing. It puts the numbers
into the conditions and reports what is left over in each:

    equilibrium       Fc + alpha Fv - C^T Q          (56)    over what acts on the block
    yield             what F Q + g lacks to 0        (57)    the same, of the lesser block
    flow              C u + G^T y                    (54)    power of that force over that of the live load
    normalisation     Fv . u - 1                     (55)
    multipliers       what y lacks to 0              (58)    power, as for the flow
    complementarity   (F Q + g) o y, row by row      (59)    power, as for the flow
    dissipation       power that a joint gives               power, as for the flow
    standing          what the dead loads lack               equilibrium and yield, as above

What acts on the stone counts up to all loads, W + alpha W. The power of this force at the rate v is
(1 + alpha) W v, that of the live load at the rate of sliding 1 is alpha W.

Equilibrium and yield alone prove that the load factor is safe for associated flow. The others need a
mechanism; if none is given the check looks for one. Five claims: the right one, alpha = mu; one with 1 %
too much load and forces to match, which break the yield surface by 1 % of mu W; the 1 % without the forces,
which are then out of balance by as much; a mechanism that rises by mu as it slides by 1, which is right for
associated flow but not without dilatancy; and half the load, which is safe, but nothing moves.

Source: Orduña & Lourenço (2005), Part I, Eqs (54)-(59).
"""

import json
from pathlib import Path

import numpy as np

import limitblocks as lb

FRICTION, WEIGHT = 0.3, 40e3
TOLERANCE = 1e-8  # of the check


def main(folder="output"):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    model = stone()
    checks = {}
    for word, claim in claims().items():
        file = folder / "17_check_somebody_elses_answer.json"
        file.write_text(json.dumps(claim), encoding="utf-8")
        checks[word] = lb.check_mcp(model, lb.read_result(file, model))
        file.unlink()
        print(f"{word}: {checks[word]}")
        for entry in checks[word].residuals.above(TOLERANCE):
            print(f"    {entry.name} {entry.value:.2e}: {entry.meaning}")
    picture(folder, model, checks)
    return {"right": checks["right"].worst.value} | {
        f"{word}: {name}": value
        for word, check in checks.items()
        for name, value in check.residuals.to_dict().items()
    }


def stone():
    stones = [
        lb.Block.box("ground", size=(4.0, 1.0, 0.2), at=(0.0, 0.0, -0.1)),
        lb.Block.box("stone", size=(1.0, 1.0, 2.0), at=(0.0, 0.0, 1.0), unit_weight=20e3),
    ]
    interfaces = lb.find_interfaces(stones, lb.OrdunaLourenco(FRICTION))
    return lb.Model(stones, ["ground"], interfaces, lb.self_weight(), lb.mass_proportional((1, 0, 0)))


def claims():
    """What others say, as the contents of result files. Forces in N, moments in N m, rates in m."""

    def claim(load_factor, forces_of, **mechanism):
        V = forces_of * WEIGHT  # and the push at 1 m above the joint makes the moment V x 1 m
        forces = {"ground|stone": [V, 0.0, -WEIGHT, 0.0, V * 1.0, 0.0]}
        return {"load_factor": load_factor, "stress_resultants": forces} | mechanism

    rising = {"displacement_rates": {"stone": [1 / WEIGHT, 0, FRICTION / WEIGHT, 0, 0, 0]}}
    return {
        "right": claim(FRICTION, FRICTION),
        "1 % more load and forces": claim(1.01 * FRICTION, 1.01 * FRICTION),
        "1 % more load, same forces": claim(1.01 * FRICTION, FRICTION),
        "rises as it slides": claim(FRICTION, FRICTION, **rising),
        "half the load": claim(FRICTION / 2, FRICTION / 2),
    }


def picture(folder, model, checks):
    import matplotlib.pyplot as plt
    from matplotlib.colors import LogNorm

    plt.style.use("limitblocks.plots.paper")
    figure, (left, right) = plt.subplots(1, 2, figsize=(7, 2.8), width_ratios=(0.5, 2))
    lb.plots.structure(model, ax=left)
    left.set_title("A stone, friction 0.3")
    names = list(next(iter(checks.values())).residuals.to_dict())
    values = np.array([list(check.residuals.to_dict().values()) for check in checks.values()])
    drawn = np.clip(values, 1e-9, 1)
    right.imshow(drawn, norm=LogNorm(1e-9, 1), cmap="YlOrBr", aspect="auto", alpha=0.75)
    for (row, column), value in np.ndenumerate(values):
        text = "0" if value < 1e-12 else f"{value:.0e}"
        right.text(
            column, row, text, ha="center", va="center", fontweight="bold" if value > TOLERANCE else None
        )
    verdicts = [f"{word}: {'passed' if check.passed else 'FAILED'}" for word, check in checks.items()]
    right.set_xticks(range(len(names)), names, rotation=90)
    right.set_yticks(range(len(checks)), verdicts)
    right.set_title("Residuals of five claims; bold: above 1e-8")
    figure.savefig(folder / "17_check_somebody_elses_answer.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
