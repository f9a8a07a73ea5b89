"""How good are the paper's planes, and what can be used instead?

The planes of Eqs (23)-(30) are quick, but neither safe nor unsafe: the octagon of Eqs (24)-(26) is drawn
around Coulomb's circle, up to 1/cos(22.5 deg) - 1 = 8.2 % too strong; Eqs (27)-(29) neglect the shape of
the joint; Eq. (30) overestimates torsion under bending except at a hinge. `OrdunaLourenco` therefore has
the circle itself unless asked for `slip="paper"`; what else the octagon does is lesson 18. `ExactTorsion`
draws the limit surface of uniform pressure (Goyal, Ruina & Papadopoulos 1991) from within and from without,
with the error as a number; two analyses then bracket the load factor.

Here a stone on a joint of 0.3 m x 0.2 m is pushed sideways in the plane of the joint, `lever` off its
middle, so that T = lever V. Its load factor is known: the twisting centre is where Eqs (11)-(15) give that
ratio.

Source: Orduña & Lourenço (2005), Part I, Sections 3.1 and 4; the limit surface: Wear 143 (1991) 307-330.
"""

from pathlib import Path

import numpy as np
from scipy.optimize import brentq

import limitblocks as lb
from limitblocks.joints.interaction import torsion_shear_curve
from limitblocks.joints.torsion import rectangle_torsion_constant

L1, L2, FRICTION = 0.15, 0.10, 0.7
RECTANGLE = np.array([(L1, -L2), (L1, L2), (-L1, L2), (-L1, -L2)])
C_T = float(rectangle_torsion_constant(L1, L2))
JOINTS = {
    "uniform pressure, inner": lb.joints.ExactTorsion(FRICTION, fineness=4, side="inner"),
    "uniform pressure, outer": lb.joints.ExactTorsion(FRICTION, fineness=4, side="outer"),
    "planes of the paper": lb.OrdunaLourenco(FRICTION, slip="paper"),
    "the same, round friction": lb.OrdunaLourenco(FRICTION),
}


def main(folder="output"):
    lever = 0.1
    exact = exact_load_factor(lever)
    found = {name: lb.bounds(pushed_aside(joint, lever)).lower for name, joint in JOINTS.items()}
    for name, load_factor in found.items():
        print(f"{name:28s}: load factor {load_factor:.4f}, {load_factor / exact - 1:+.1%}; exact {exact:.4f}")
    inner, outer, *_ = found.values()
    gap = JOINTS["uniform pressure, inner"].discretisation_error(lb.joints.interface(RECTANGLE, None))
    assert inner <= exact <= outer <= (1 + gap) ** 2 * inner
    diagonal = [joint_strength(joint, np.pi / 8) / FRICTION for joint in list(JOINTS.values())[2:]]
    print(f"shear strength at 22.5 deg over mu |N|: octagon {diagonal[0]:.4f}, circle {diagonal[1]:.4f}")
    assert abs(diagonal[0] - 1.082) < 5e-4
    assert abs(diagonal[1] - 1) < 1e-12
    picture(Path(folder))
    return found | {"exact": exact, "octagon": diagonal[0], "circle": diagonal[1]}


def pushed_aside(joint, lever):
    """A stone of 120 N on a base; the live load is its weight, along Y, `lever` off the middle."""
    blocks = [
        lb.Block.box("base", size=(1, 1, 0.1), at=(0, 0, -0.05)),
        lb.Block.box("stone", size=(2 * L1, 2 * L2, 0.1), at=(0, 0, 0.05), unit_weight=20e3),
    ]
    live = lb.loads.force("stone", (0, blocks[1].weight, 0), at=(lever, 0, 0))
    return lb.Model(blocks, ["base"], lb.find_interfaces(blocks, joint), lb.self_weight(), live)


def exact_load_factor(lever):
    """mu V / V0 for the twisting centre on the x1 axis at which T / V is the lever."""

    def excess(distance):
        V, T = torsion_shear_curve(RECTANGLE, (1, 0), distance)
        return float(T) * C_T - lever * float(V)

    distance = brentq(excess, 1e-9, 1e3, xtol=1e-14)
    return FRICTION * float(torsion_shear_curve(RECTANGLE, (1, 0), distance)[0])


def joint_strength(joint, angle):
    """Shear strength in a direction for N = -1."""
    direction = (np.cos(angle), np.sin(angle), 0, 0, 0, 0)
    return joint.strength(lb.joints.interface(RECTANGLE, joint), direction, given=(0, 0, -1, 0, 0, 0))


def cut(joint, first, second):
    """Boundary of the yield set at N = -1 in the plane of two stress directions."""
    angles = np.linspace(0, np.pi / 2, 91)
    interface = lb.joints.interface(RECTANGLE, joint)
    rays = [np.cos(a) * np.array(first) + np.sin(a) * np.array(second) for a in angles]
    t = np.array([joint.strength(interface, ray, given=(0, 0, -1, 0, 0, 0)) for ray in rays])
    return t * np.cos(angles), t * np.sin(angles)


def picture(folder):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, axes = plt.subplots(1, 3, figsize=(7, 3))
    shear1, shear2 = FRICTION * np.eye(6)[0], FRICTION * np.eye(6)[1]
    torsion, bending = FRICTION * C_T * np.eye(6)[5], L2 * np.eye(6)[3]
    styles = ("#009E73", "#E69F00", "#D55E00", "#CC79A7")
    for (name, joint), colour in zip(JOINTS.items(), styles, strict=True):
        dashed = "--" if joint.__class__ is lb.OrdunaLourenco else "-"
        for ax, first, second in zip(
            axes, (shear1, shear2, bending), (shear2, torsion, torsion), strict=True
        ):
            ax.plot(*cut(joint, first, second), dashed, color=colour, label=name)
    angle = np.linspace(0, np.pi / 2, 100)
    axes[0].plot(np.cos(angle), np.sin(angle), "k:", label="exact")
    axes[1].plot(
        *torsion_shear_curve(RECTANGLE, (1, 0), np.r_[0, np.geomspace(1e-4, 1e3, 300)]), "k:", label="exact"
    )
    share = np.linspace(0, 1, 100)
    axes[2].plot(share, rectangle_torsion_constant(L1, L2 * (1 - share)) / C_T, "k:", label="exact")
    labels = (("$V_1/V_0$", "$V_2/V_0$"), ("$V_2/V_0$", "$T/T_0$"), ("$M_1/(l_2|N|)$", "$T/T_0$"))
    for ax, (x, y) in zip(axes, labels, strict=True):
        ax.set(xlabel=x, ylabel=y, xlim=(0, 1.12), ylim=(0, 1.12), aspect="equal")
    figure.legend(*axes[1].get_legend_handles_labels(), loc="outside lower center", ncols=5)
    figure.suptitle("Yield surfaces of a joint with $l_2/l_1$ = 2/3, cut at constant N")
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "04_plane_surface_against_exact.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
