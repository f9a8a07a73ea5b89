"""How thick must a semicircular arch be to stand, and how does friction change the answer?

An arch of radius R and thickness t has its weight along the centreline; phi is the angle from the crown. In
units of the weight per radian, the part above phi weighs phi, and the thrust at the crown is H. The least
thrust of a thickness e = t/R is that of a line through the extrados at the crown which touches the
intrados:

    H(e) = max over phi of (phi (1 - e/2) sin phi - (1 - cos phi)) / (1 + e/2 - (1 - e/2) cos phi)

Without sliding the arch is too thin when that line leaves the extrados of the springing, too: t/R =
0.107426 with H = 0.621772. The horizontal joint of the springing carries H by friction, under the weight
pi/2:

    H <= mu pi/2

Friction above 0.621772/(pi/2) = 0.395832 is enough, and more does not matter. With less, the arch must be
so thick that its thrust is as small: H(t/R) = mu pi/2. Below mu = 0.309215, at t/R = 0.200637, the
voussoirs slide inwards at the haunches, where the thrust must be at least phi / tan(phi + arctan mu) for
every phi, and no thickness stands.

Source: Cocchetti & Rizzi (2020), Analytical and numerical analysis on the collapse modes of least-thickness
circular masonry arches at decreasing friction, for the printed values; the curve follows from the
equations.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

import limitblocks as lb

PRINTED = {0.395832: 0.107426, 0.309215: 0.200637}  # friction: t/R
FRICTIONS = (0.31, 0.33, 0.35, 0.37, 0.39, 0.45, 0.6)
VOUSSOIRS = 45


def main(folder="output"):
    found = [least_thickness(friction) for friction in FRICTIONS]
    for friction, thickness in zip(FRICTIONS, found, strict=True):
        print(f"friction {friction:.2f}: t/R = {thickness:.4f}, continuous arch {continuous(friction):.4f}")
    for friction, thickness in PRINTED.items():
        print(f"friction {friction}: continuous arch {continuous(friction):.6f}, printed {thickness}")
    picture(Path(folder), found)
    return {
        "enough friction": found[-1],
        "blocks over equations": np.divide(found, [continuous(friction) for friction in FRICTIONS]),
        "equations where printed": [continuous(friction) for friction in PRINTED],
    }


def least_thickness(friction):
    """t/R of an arch of VOUSSOIRS that just stands."""

    def model(thickness):
        return arch(friction, thickness)

    return lb.studies.minimum(model, 0.08, 0.3, parameter="t/R", tolerance=1e-5).value


def arch(friction, thickness):
    """An arch of radius 1 m; each weight acts in the middle of its voussoir on the centreline."""
    joint = lb.PointContact(friction)
    model = lb.structures.arch(joint, radius=1.0, thickness=thickness, voussoirs=VOUSSOIRS)
    angles = (np.arange(VOUSSOIRS) + 0.5) * np.pi / VOUSSOIRS - np.pi / 2
    dead = lb.loads.Load()
    for block, angle in zip(model.free_blocks, angles, strict=True):
        dead += lb.loads.force(block.name, (0, 0, -block.weight), at=(np.sin(angle), 0, np.cos(angle)))
    return replace(model, dead=dead)


def least_thrust(e):
    """H(e), with phi on a fine grid."""
    phi = np.linspace(0.01, np.pi / 2, 20001)
    drop = phi * (1 - e / 2) * np.sin(phi) - (1 - np.cos(phi))
    return np.max(drop / (1 + e / 2 - (1 - e / 2) * np.cos(phi)))


def continuous(friction):
    """t/R of the continuous arch: the springing holds the least thrust, by its thickness and by friction."""

    def springing(e):  # moments about the extrados of the springing
        return least_thrust(e) * (1 + e / 2) - (np.pi / 2 * (1 + e / 2) - 1)

    enough = brentq(springing, 0.08, 0.3, xtol=1e-10)
    if least_thrust(enough) <= friction * np.pi / 2:
        return enough
    return brentq(lambda e: least_thrust(e) - friction * np.pi / 2, enough, 0.5, xtol=1e-10)


def picture(folder, found):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, axes = plt.subplots(1, 3, figsize=(7, 2.5), width_ratios=(1.2, 1, 1))
    friction = np.r_[np.linspace(0.309215, 0.3958, 40), 0.395832, 0.62]
    axes[0].plot(friction, [continuous(mu) for mu in friction], color="0.6", label="equations")
    axes[0].plot(FRICTIONS, found, "o", color="#D55E00", label=f"{VOUSSOIRS} voussoirs")
    axes[0].plot(PRINTED.keys(), PRINTED.values(), "k*", markersize=12, label="Cocchetti & Rizzi (2020)")
    axes[0].axvspan(0.24, 0.309215, color="0.92")
    axes[0].annotate("none\nstands", (0.25, 0.125), color="0.35", fontsize="small")
    axes[0].set(xlabel="friction", ylabel="least t/R", xlim=(0.24, 0.62), ylim=(0.09, 0.22))
    axes[0].legend()
    for ax, mu in zip(axes[1:], (0.6, 0.33), strict=True):
        thickness = found[FRICTIONS.index(mu)] * 1.001  # just standing
        model = arch(mu, thickness)
        lb.plots.thrust_line(model, lb.bounds(model, tolerance=1e-5), ax=ax)
        ax.set_title(f"friction {mu}: t/R = {thickness:.4f}")
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "10_minimum_thickness_of_an_arch.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
