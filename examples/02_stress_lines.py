"""What happens to the friction stress when a joint twists about a point that is not its centre?

The stress follows circles about the twisting centre. As the centre moves away from the middle of the joint,
the stresses begin to point the same way: the shear force V grows to V0 = mu |N|, Eq. (18), and the torsion
T about the middle falls from T0 to zero. Both are sums of Eqs (11)-(15) over the right triangles between
the twisting centre and the sides, wherever the centre is.

Source: Orduña & Lourenço (2005), Part I, Section 3.1, Fig. 6. Two slips of its text: Eq. (12) has the sign
of -V1 in Eq. (7); Eq. (14) must read b - c ln((b + c)/a), or T1 + T2 = T fails.
"""

from pathlib import Path

import numpy as np

from limitblocks.joints.interaction import torsion_shear_curve

L1, L2 = 0.75, 0.5
RECTANGLE = np.array([(L1, -L2), (L1, L2), (-L1, L2), (-L1, -L2)])
SQUARE = np.array([(0.5, -0.5), (0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5)])
CENTRES = (0.0, 0.25, 0.5, 0.75, 1.25, np.inf)  # distances to the left of the middle, m


def main(folder="output"):
    V, T = torsion_shear_curve(SQUARE, (0, 1), [0, 0.2, 0.5, 1, np.inf])
    for distance, shear, torsion in zip((0, 0.2, 0.5, 1, np.inf), V, T, strict=True):
        print(f"unit square, centre {distance:3} from the middle: V/V0 = {shear:.5f}, T/T0 = {torsion:.5f}")
    assert np.allclose(V, [0, 0.34855, 0.79023, 0.95344, 1], atol=1e-5)
    assert np.allclose(T, [1, 0.90943, 0.51783, 0.23519, 0], atol=1e-5)
    picture(Path(folder))
    return {"V/V0": V, "T/T0": T}


def picture(folder):
    import matplotlib.pyplot as plt
    from matplotlib.patches import Polygon

    plt.style.use("limitblocks.plots.paper")
    figure, axes = plt.subplots(2, 3, figsize=(7, 3.2))
    V, T = torsion_shear_curve(RECTANGLE, (-1, 0), CENTRES)
    angle = np.linspace(-np.pi, np.pi, 721)
    for ax, distance, shear, torsion in zip(axes.flat, CENTRES, V, T, strict=True):
        joint = ax.add_patch(Polygon(RECTANGLE, facecolor="0.94", edgecolor="black"))
        if np.isinf(distance):
            lines = [(np.full(2, x), np.array([-1.0, 1.0])) for x in np.arange(-L1 + 0.05, L1, 0.1)]
        else:
            radii = np.arange(0.05, distance + L1 + L2, 0.1)
            lines = [(-distance + r * np.cos(angle), r * np.sin(angle)) for r in radii]
            ax.plot(-distance, 0, "+", color="#D55E00", markersize=10, markeredgewidth=2)
        for x, y in lines:
            ax.plot(x, y, color="#0072B2", linewidth=1, clip_path=joint)
        where = (
            "infinitely far"
            if np.isinf(distance)
            else f"at $x_1$ = {-distance:g} m"
            if distance
            else "in the middle"
        )
        ax.set(xlim=(-1.4, 0.85), ylim=(-0.55, 0.55), aspect="equal")
        ax.set_title(f"centre {where}\n$V/V_0$ = {shear:.3f}   $T/T_0$ = {torsion:.3f}")
        ax.axis("off")
    figure.suptitle("Lines of friction stress (Fig. 6); the cross is the twisting centre")
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "02_stress_lines.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
