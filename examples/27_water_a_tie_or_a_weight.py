"""A wall stands in water: what does the water take from it, and what would a tie or a weight give back?

A quay wall of width b and height h, weight W a metre, pushed by alpha W. Water up to the height z in its base
joint lifts it by U = gamma_w z b, through the middle of the base, so that it

- slides at alpha = mu (1 - U / W) and
- turns about its toe at alpha = (b / h) (1 - U / W).

A tie with the force F at the height z_t adds F z_t / (W h / 2) to the second. A weight P at the distance x
from the toe and the height z_p adds P (x - alpha z_p). The least of each that reaches a required load factor
is a convex program for associated flow; then the repaired wall is solved without lift.

The design is factored: gamma_G on the dead loads (its favourable value, for the weight holds the wall; where
some dead loads help and others harm, multiply them one by one), gamma_Q on the push, gamma_phi on friction,
gamma_S on the tie.

Source: EN 1990, Eqs (6.1), (6.3), (6.8); the rest is equilibrium of one block.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

import limitblocks as lb
from limitblocks.practice import PartialFactors, adequacy, least_masses, least_ties, tie, uplift

B, H, MU, UNIT_WEIGHT = 1.2, 4.0, 0.6, 22e3  # m, N/m3; one metre of the wall
W = UNIT_WEIGHT * B * H
WATER, LEVELS = 9810.0, np.linspace(0.0, 4.0, 5)
REQUIRED, LEVEL = 0.25, 2.5  # load factor, m of water
REACH, PLACE = 3.5, (-0.5, 1.0)  # height of the tie; x and z of the weight
FACTORS = PartialFactors(gamma_G=0.9, gamma_Q=1.2, gamma_M=1.0, gamma_phi=1.25, gamma_S=1.15)


def main(folder="output"):
    carried = [lb.nonassociated(wet(level)).load_factor for level in LEVELS]
    for level, alpha in zip(LEVELS, carried, strict=True):
        print(f"water {level:.1f} m over the base: load factor {alpha:.6f}")
    model = wet(LEVEL)
    rod = tie("wall", (-B / 2, 0, REACH), "ground", (-8, 0, REACH), area=5e-4, strength=235e6)
    tied = least_ties(model, [rod], REQUIRED)
    laden = least_masses(model, [("wall", (PLACE[0], 0, PLACE[1]))], REQUIRED)
    print(f"least tie {tied.total / 1e3:.3f} kN, least weight {laden.total / 1e3:.3f} kN")
    design = adequacy(tied.model, FACTORS)
    print(design)
    picture(Path(folder), carried)
    return {
        "load factors": carried,
        "least tie": tied.total,
        "tied wall": tied.result.load_factor,
        "least weight": laden.total,
        "adequacy factor": design.factor,
    }


def wet(level):
    """The wall with water up to `level` over its base."""
    stones = [
        lb.Block.box("ground", (4.0, 1.0, 0.5), (0, 0, -0.25)),
        lb.Block.box("wall", (B, 1.0, H), (0, 0, H / 2), UNIT_WEIGHT),
    ]
    found = lb.find_interfaces(stones, lb.PointContact(friction=MU))
    model = lb.Model(stones, ["ground"], found, lb.self_weight(), lb.mass_proportional((1, 0, 0)))
    return replace(model, dead=model.dead + uplift(model, level)) if level else model


def picture(folder, carried):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, axis = plt.subplots(figsize=(3.5, 2.6))
    axis.plot(LEVELS, carried, "o", label="computed")
    z = np.linspace(0, 4, 50)
    axis.plot(z, min(MU, B / H) * (1 - WATER * z * B / W), "k--", linewidth=1, label="(b / h) (1 - U / W)")
    axis.axhline(REQUIRED, color="tab:red", linewidth=1, label="required")
    axis.set(xlabel="water over the base (m)", ylabel="load factor", ylim=(0, None))
    axis.legend()
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "27_water_a_tie_or_a_weight.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
