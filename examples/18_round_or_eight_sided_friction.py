"""Does it matter whether friction is round or eight-sided?

A wedge lies in a V groove, each plane at the half angle w from the vertical, and is pushed along the groove
by alpha times its weight W. Both planes press it with N. Without dilatancy it slides along the groove,
friction mu N points against that, and only N has a vertical component:

    2 N sin w = W,    alpha W = 2 mu N,    alpha = mu / sin w

The paper's octagon has a side that faces this slip. Flow is across that side wherever on it the shear force
is, so that a part t mu N of it, |t| <= tan(22.5 deg), may point up or down the plane though nothing moves
that way: it is locked there, and nothing in the problem says how large it is. It carries the wedge or
presses it down:

    2 N (sin w + t mu cos w) = W,    alpha = mu / (sin w + t mu cos w)

One block then has an interval of load factors. All its values solve the equations; which one an analysis
finds depends on its way there. Round friction has one direction of shear for each direction of slip, and
one load factor. Polygons within the circle are no safer: their sides lock shear as well, and upper ends of
their intervals lie above mu / sin w.

With associated flow the wedge lifts out as it slides, and limits are unique with either:
alpha = mu / sqrt(sin^2 w - mu^2 cos^2 w) for the circle, more for the octagon around it.

Source: Orduña & Lourenço (2005), Part I, Eqs (24)-(26) and Table 3; the wedge factor 1 / sin w: Hoek & Bray
(1981), Rock Slope Engineering, chapter 8.
"""

from pathlib import Path

import numpy as np

import limitblocks as lb

FRICTION = 0.6
DEGREES = (20, 45, 70)
JOINTS = {
    "circle": lb.OrdunaLourenco(FRICTION),
    "octagon": lb.OrdunaLourenco(FRICTION, slip="paper"),
    "circles at the corners": lb.PointContact(FRICTION),
}
LOCKED = np.tan(np.pi / 8)  # of mu N: half a side of the octagon


def main(folder="output"):
    found = {name: [lb.nonassociated(groove(joint, w)) for w in DEGREES] for name, joint in JOINTS.items()}
    alpha = {name: np.array([result.load_factor for result in results]) for name, results in found.items()}
    for k, w in enumerate(DEGREES):
        values = ", ".join(f"{name} {values[k]:.4f}" for name, values in alpha.items())
        least, most = expected(w, LOCKED), expected(w, -LOCKED)
        print(f"w = {w} deg: {values}; mu / sin w = {expected(w):.4f}, octagon {least:.4f} to {most:.4f}")
        assert least - 1e-4 <= alpha["octagon"][k] <= most + 1e-4
    lifted = lb.bounds(groove(JOINTS["circle"], 45)).lower
    print(f"w = 45 deg, associated: {lifted:.4f}")
    picture(Path(folder), alpha, {name: shear(groove(JOINTS[name], 45), found[name][1]) for name in JOINTS})
    ratio = np.array([expected(w) for w in DEGREES])
    return {
        "circle over mu / sin w": alpha["circle"] / ratio,
        "points over mu / sin w": alpha["circles at the corners"] / ratio,
        "associated": lifted,
        "octagon": alpha["octagon"],
    }


def groove(joint, degrees):
    return lb.structures.wedge(joint, half_angle=np.radians(degrees))


def expected(degrees, t=0.0):
    """Load factor where t mu N of shear is locked across the slip, upwards on the wedge."""
    w = np.radians(degrees)
    return FRICTION / (np.sin(w) + t * FRICTION * np.cos(w))


def shear(model, found):
    """Shear force on the wedge over mu N, along the groove and up the first plane."""
    interface, Q = model.interfaces[0], found.stress_resultants[0]
    sign = 1.0 if interface.block_i == "wedge" else -1.0  # +Q acts on block i
    along, *rest = sign * Q[:2] @ interface.axes[:2]
    return np.array([along, np.copysign(np.hypot(*rest), rest[1])]) / (FRICTION * -Q[2])


def picture(folder, alpha, shears):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, axes = plt.subplots(1, 2, figsize=(7, 3.4), width_ratios=(1.2, 1))
    degrees = np.linspace(15, 90, 100)
    axes[0].fill_between(
        degrees,
        expected(degrees, LOCKED),
        np.minimum(expected(degrees, -LOCKED), 5),
        color="#D55E00",
        alpha=0.2,
        label="octagon: all of these",
    )
    axes[0].plot(degrees, expected(degrees), color="#0072B2", label="circle: mu / sin w")
    angle = np.linspace(0, 2 * np.pi, 200)
    axes[1].plot(np.cos(angle), np.sin(angle), color="#0072B2")
    corner = np.pi / 8 + np.pi / 4 * np.arange(9)
    axes[1].plot(*np.array([np.cos(corner), np.sin(corner)]) / np.cos(np.pi / 8), color="#D55E00")
    for (name, values), mark, colour in zip(
        alpha.items(), ("o", "s", "x"), ("#0072B2", "#D55E00", "black"), strict=True
    ):
        axes[0].plot(DEGREES, values, mark, color=colour, label=f"found, {name}")
        axes[1].plot(*shears[name], mark, color=colour, label=name)
    axes[0].set(xlabel="half angle of the groove (deg)", ylabel="load factor", ylim=(0, 3))
    axes[0].set_title("Wedge pushed along a groove, friction 0.6")
    axes[0].legend()
    axes[1].set(
        xlabel="shear along the groove over mu N",
        ylabel="up the plane",
        aspect="equal",
        xticks=(-1, -0.5, 0, 0.5, 1),
    )
    axes[1].set_title("Shear force found at 45 degrees")
    axes[1].legend(loc="center")
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "18_round_or_eight_sided_friction.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
