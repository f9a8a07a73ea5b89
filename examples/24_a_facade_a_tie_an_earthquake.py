"""How far can a facade rock before it falls, and what does a tie rod bring?

A facade of thickness t and height H carries a floor: P at its top, the distance a from the outer edge. Pushed
outwards it turns about that edge. With the tie force F at the height z the load factor is

    alpha0 = (W t / 2 + P a + F z) / (W H / 2 + P H).

Without the tie, turned by theta, both sides turn alike: alpha = tan(theta0 - theta), tan theta0 = alpha0, so
that nothing is left at theta0, where the corner above the toe has moved by H sin theta0. A tie that yields
pulls on.

The Italian code makes an oscillator of the mechanism: with the displacements delta_i of the weights P_i

    M* = (sum P delta)^2 / (g sum P delta^2),   e* = g M* / sum P,   a0* = alpha0 g / (e* FC),

set off where a0* is less than a_g S / q, and its displacement capacity is 40 % of the displacement at which
nothing is left.

Source: NTC 2018 and Circolare 7/2019, Section C8.7.1.2.
"""

from pathlib import Path

import numpy as np

import limitblocks as lb
from limitblocks.practice import Spectrum, capacity_curve, reinforced, tie, verification

T, H, UNIT_WEIGHT = 0.5, 5.0, 18e3  # m, N/m3; one metre of the facade
FLOOR, ARM = 10e3, 0.35  # N, m from the outer edge
FORCE, HEIGHT = 8e3, 4.5  # N, m: what the anchor of the tie holds, and where
SITE = Spectrum(a_g=0.25 * 9.81, S=1.2, F0=2.5, T_C=0.5)


def main(folder="output"):
    facade = structure()
    rod = tie(
        "facade", (-T / 2, 0, HEIGHT), "ground", (-6, 0, HEIGHT), area=2e-4, strength=235e6, pull_out=FORCE
    )
    tied = reinforced(facade, rod)
    wall = facade.free_blocks[0].vertices
    corner = wall[(wall[:, 0] > 0) & (wall[:, 2] > 0)][0]  # above the toe
    curves = [capacity_curve(model, control=("facade", corner), steps=6) for model in (facade, tied)]
    results = [lb.nonassociated(model) for model in (facade, tied)]
    for name, curve, result in zip(("facade", "with a tie"), curves, results, strict=True):
        print(f"{name}: load factor {result.load_factor:.7f}; {curve}")
    found = verification(facade, results[0], SITE, q=2.0, confidence=1.35, curve=curves[0])
    for quantity in found.quantities:
        print(f"{quantity.symbol:8} {quantity.value:11.6g} {quantity.unit:5} {quantity.formula}")
    for check in found.checks:
        print(f"{check.name}: capacity over demand {check.ratio:.6f}")
    picture(Path(folder), curves)
    return {
        "load factors": [result.load_factor for result in results],
        "displacement without resistance": curves[0].zero,
        "a0*": found["a0*"],
        "e*": found["e*"],
        "d0*": found["d0*"],
        "T_SLV": found["T_SLV"],
        "linear check": found.checks[0].ratio,
    }


def structure():
    stones = [
        lb.Block.box("ground", (2.0, 1.0, 0.4), (0, 0, -0.2)),
        lb.Block.box("facade", (T, 1.0, H), (0, 0, H / 2), UNIT_WEIGHT),
    ]
    floor = lb.loads.added_mass("facade", (T / 2 - ARM, 0, H), weight=FLOOR)
    return lb.Model(
        blocks=stones,
        supports=["ground"],
        interfaces=lb.find_interfaces(stones, lb.PointContact(friction=0.6)),
        dead=lb.self_weight([floor]),
        live=lb.mass_proportional((1, 0, 0), [floor]),
    )


def picture(folder, curves):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, axis = plt.subplots(figsize=(3.5, 2.6))
    for curve, label, marker in zip(curves, ("facade", "with a tie"), "os", strict=True):
        axis.plot(curve.displacements, curve.load_factors, marker=marker, label=label)
    turn = np.linspace(0.0, np.arctan(curves[0].load_factors[0]))
    law = np.tan(turn[-1] - turn)
    axis.plot(H * np.sin(turn), law, "k--", linewidth=1, label="tan(theta0 - theta)")
    axis.set(xlabel="displacement of the top (m)", ylabel="load factor", ylim=(0, None), xlim=(0, None))
    axis.legend()
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "24_a_facade_a_tie_an_earthquake.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
