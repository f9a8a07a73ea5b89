"""How do shear and bending reduce the torsion that a joint carries?

Shear: the twisting centre moves away (Fig. 7); slender joints are the bounds, along and across the motion:

    T/T0 = 1 - (V/V0)^2    and    V/V0 = s asinh(1/s),  T/T0 = sqrt(1 + s^2) - s^2 asinh(1/s)

The paper cuts the corner by one plane for all, |T|/c_T + |V| + 1.3 mu N <= 0, Eqs (27)-(29) (Fig. 11).

Bending: the normal force acts at e1 = -M2/N, e2 = M1/N, and uniform pressure fits on a rectangle of half
sides l1 - |e1| and l2 - |e2| only, Eqs (19)-(20); its torsion is that of Eq. (17) (Fig. 8b). The paper puts
one plane through three points of each octant, |T| + mu/2 (|M1| + |M2| + N (l1 + l2)) <= 0, Eq. (30) and
Table 4 (Figs 12, 13).

Source: Orduña & Lourenço (2005), Part I, Sections 3 and 4. Slips of its text: Eqs (19)-(21) need |e|; Eq.
(21) needs |N|^3 for N^2.
"""

from itertools import pairwise
from pathlib import Path

import numpy as np

import limitblocks as lb
from limitblocks.joints.interaction import (
    approximate_torsion_bending,
    approximate_torsion_shear,
    rectangle_torsion_bending,
    slender_across,
    slender_along,
    torsion_shear_curve,
)

L1, L2, FRICTION, N = 0.15, 0.10, 0.7, -240.0  # Figs 8(b), 12 and 13
SQUARE = np.array([(1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)])
TABLE_4 = {  # M1, M2, T
    "A": (-L2 * N, 0.0, -FRICTION * N * L1 / 2),
    "B": (-L2 * N, -L1 * N, 0.0),
    "C": (0.0, -L1 * N, -FRICTION * N * L2 / 2),
}


def main(folder="output"):
    joint = lb.joints.interface(SQUARE * [L1, L2], lb.OrdunaLourenco(FRICTION, slip="paper"))
    T0 = joint.joint.strength(joint, (0, 0, 0, 0, 0, 1), given=(0, 0, N, 0, 0, 0))
    print(f"T0 = {T0:.2f} N m (Fig. 12: 16.3)")
    assert abs(T0 - 16.26) < 0.005
    points = {}
    for point, (M1, M2, T) in TABLE_4.items():
        on_plane = abs(T) + FRICTION / 2 * (abs(M1) + abs(M2) + N * (L1 + L2))
        exact = rectangle_torsion_bending(L1, L2, FRICTION, N, M1, M2)
        print(f"point {point}: M1 = {M1:5.1f}, M2 = {M2:5.1f}, T = {T:5.2f} N m, effective area {exact:.2f}")
        assert abs(on_plane) < 1e-12
        assert abs(exact - T) < 1e-12
        points[point] = exact
        assert "moment-twist" in joint.joint.active_modes(joint, (0, 0, N, M1, M2, T))
    picture(Path(folder))
    return {"T0": T0} | points


def picture(folder):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure = plt.figure(figsize=(7, 6.7))
    figure.get_layout_engine().set(wspace=0.12)
    torsion_shear(figure.add_subplot(2, 2, 1))
    torsion_bending(figure.add_subplot(2, 2, 2))
    shear_surface(figure.add_subplot(2, 2, 3, projection="3d"))
    bending_surface(figure.add_subplot(2, 2, 4, projection="3d"))
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "03_interaction_curves.png")
    plt.close(figure)


def torsion_shear(ax):
    s = np.r_[0, np.geomspace(1e-4, 1e4, 400)]
    ax.plot(*slender_along(s), "k", label="slender, lower bound")
    ax.plot(*slender_across(s), "k", linestyle="dashed", label="slender, upper bound")
    for ratio in (0.2, 1.0, 5.0):
        ax.plot(*torsion_shear_curve(SQUARE * [1, ratio], (1, 0), s), label=f"$l_2/l_1$ = {ratio:g}")
    V = np.linspace(0, 1, 201)
    ax.plot(
        [*V, 1],
        [*approximate_torsion_shear(V), 0],
        color="#E69F00",
        linewidth=2,
        label="planes, Eqs (23)-(29)",
    )
    ax.set(xlabel="$V/V_0$", ylabel="$T/T_0$", xlim=(0, 1.05), ylim=(0, 1.05), aspect="equal")
    ax.set_title("Torsion and shear (Figs 7 and 11a)")
    ax.legend(loc="lower left")


def torsion_bending(ax):
    M1 = np.linspace(0, -L2 * N, 200)
    for share, colour in ((0.0, "#0072B2"), (0.5, "#009E73"), (1.0, "#CC79A7")):
        M2 = -share * L1 * N
        ax.plot(
            M1,
            rectangle_torsion_bending(L1, L2, FRICTION, N, M1, M2),
            color=colour,
            label=f"$M_2$ = {M2:g} N m",
        )
        ax.plot(M1, approximate_torsion_bending(L1, L2, FRICTION, N, M1, M2), "--", color=colour)
    for point, (M1, _, T) in TABLE_4.items():
        ax.plot(M1, T, "ko", clip_on=False)
        ax.annotate(point, (M1, T), xytext=(6, 6), textcoords="offset points", fontweight="bold")
    ax.set(xlabel="$M_1$ (N m)", ylabel="$T$ (N m)", xlim=(0, 25.5), ylim=(0, 18))
    ax.set_title("Torsion and bending (Figs 8b, 12);\ndashed: Eqs (23), (30)")
    ax.legend(loc="lower left")


def shear_surface(ax):
    """Twist, slip and slip-twist planes, Eqs (23)-(29), over the slip octagon (Fig. 11c)."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    angles = np.pi / 8 + np.pi / 4 * np.arange(9)
    corner = np.column_stack([np.cos(angles), np.sin(angles)]) / np.cos(np.pi / 8)

    def ring(share, T):
        return np.column_stack([share * corner, np.full(9, T)])

    levels = [ring(0.3, 1), ring(1, 0.3), ring(1, -0.3), ring(0.3, -1)]
    faces, colours = [levels[0][:8], levels[3][:8]], ["gold", "gold"]
    for (upper, lower), colour in zip(
        pairwise(levels), ("lightskyblue", "lightgreen", "lightskyblue"), strict=True
    ):
        faces += [np.array([upper[k], upper[k + 1], lower[k + 1], lower[k]]) for k in range(8)]
        colours += [colour] * 8
    ax.add_collection3d(Poly3DCollection(faces, facecolors=colours, edgecolors="black", shade=True))
    ax.set(xlim=(-1, 1), ylim=(-1, 1), zlim=(-1, 1), xticks=(-1, 0, 1), yticks=(-1, 0, 1), zticks=(-1, 0, 1))
    ax.set(xlabel="$V_1/V_0$", ylabel="$V_2/V_0$", zlabel="$T/T_0$")
    ax.set_title("Planes of twist, slip with twist, slip (Fig. 11c)")


def bending_surface(ax):
    """The effective rectangle's surface under the planes (23) and (30), drawn as wires (Fig. 13)."""
    M1, M2 = np.meshgrid(np.linspace(-L2 * N, L2 * N, 81), np.linspace(-L1 * N, L1 * N, 81))
    exact = rectangle_torsion_bending(L1, L2, FRICTION, N, M1, M2)
    planes = approximate_torsion_bending(L1, L2, FRICTION, N, M1, M2)
    ax.plot_surface(M1, M2, exact, cmap="viridis", rstride=4, cstride=4)
    ax.plot_wireframe(M1, M2, planes, color="#D55E00", linewidth=0.7, rstride=8, cstride=8)
    for point, (m1, m2, T) in TABLE_4.items():
        ax.text(m1 * 1.06, m2 * 1.06, T + 1, point, fontweight="bold", zorder=20)
    ax.set(xlabel="$M_1$ (N m)", ylabel="$M_2$ (N m)", zlabel="$T$ (N m)")
    ax.set(xticks=(-24, 0, 24), yticks=(-36, 0, 36), zticks=(0, 5, 10, 15))
    ax.view_init(elev=28, azim=32)
    ax.set_title("Effective rectangle; planes as wires (Fig. 13)")


if __name__ == "__main__":
    main()
