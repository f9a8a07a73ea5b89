"""How much torsion does a dry rectangular joint carry?

A joint of half sides l1, l2 carries the normal force N, spread evenly, and is twisted. When it gives way,
every point slides along a circle about the centre; the friction stress has the same size everywhere and
follows these circles:

    T0 = c_T mu |N|                                                                          Eq. (16)
    c_T = 1/3 (c + l1^2/(2 l2) ln((l2 + c)/l1) + l2^2/(2 l1) ln((l1 + c)/l2)),  c^2 = l1^2 + l2^2     Eq. (17)

The torsion constant c_T is the mean distance of the points of the joint from its centre, a length. A line
of half length l has c_T = l/2, Eq. (22). A point contact has none.

Source: Orduña & Lourenço (2005), Part I, Sections 2 and 3, Figs 3, 5 and 12.
"""

from pathlib import Path

import numpy as np

import limitblocks as lb
from limitblocks.joints.torsion import rectangle_torsion_constant

L1, L2, FRICTION, N = 0.15, 0.10, 0.7, -240.0  # m, m, -, N: the joint of Fig. 12


def main(folder="output"):
    corners = [(L1, -L2), (L1, L2), (-L1, L2), (-L1, -L2)]
    joint = lb.joints.interface(corners, lb.OrdunaLourenco(FRICTION))
    T0 = joint.joint.strength(joint, direction=(0, 0, 0, 0, 0, 1), given=(0, 0, N, 0, 0, 0))
    print(f"T0 = {T0:.2f} N m; the paper draws 16.3 N m in Fig. 12")
    assert abs(T0 - 16.26) < 0.005
    assert abs(T0 - FRICTION * -N * float(rectangle_torsion_constant(L1, L2))) < 1e-12
    picture(Path(folder))
    return {"T0": T0}


def picture(folder):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, (left, right) = plt.subplots(1, 2, figsize=(7, 3.1))
    x, y = np.meshgrid(np.linspace(-0.135, 0.135, 13), np.linspace(-0.085, 0.085, 8))
    r = np.hypot(x, y)
    left.quiver(x, y, -y / r, x / r, scale=24, width=0.004, pivot="mid", color="#0072B2")
    left.fill([L1, L1, -L1, -L1], [-L2, L2, L2, -L2], facecolor="0.94", edgecolor="black", zorder=0)
    left.plot(0, 0, "k+")
    left.set(
        aspect="equal", xlabel="$x_1$ (m)", ylabel="$x_2$ (m)", title="Friction stress when the joint twists"
    )

    ratio = np.geomspace(0.01, 1, 200)
    right.plot(ratio, rectangle_torsion_constant(1, ratio), label="rectangle, Eq. (17)")
    right.plot(ratio, np.full_like(ratio, 0.5), ":", color="black", label="line, Eq. (22)")
    right.plot(
        L2 / L1, rectangle_torsion_constant(1, L2 / L1), "o", color="#D55E00", label="the joint of Fig. 12"
    )
    right.set(xlabel="$l_2/l_1$", ylabel="$c_T/l_1$", title="Torsion constant", ylim=(0.45, 0.8))
    right.legend()
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "01_torsion_of_a_rectangle.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
