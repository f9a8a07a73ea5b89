"""How thin may a dome be that has cracked along its meridians?

A hemispherical dome that cracks along its meridians stands as pairs of opposite lunes, slices like those of
an orange, each pair an arch that narrows to its crown. Hoop forces are gone. In a lune of the angle one the
part from the crown down to phi has the weight W and the first moment M about the axis, with s = t/R:

    W = gamma s R^3 (1 + s^2/12) (1 - cos phi),    M = gamma s R^4 (1 + s^2/4) (phi/2 - sin(2 phi)/4)

The lune stands if a line of thrust from the crown to the springing fits in its thickness, with no tension
and no sliding; W and M give its height at every phi for a thrust H. The least thickness is t/R = 0.0428,
much less than the 0.1075 of an arch, because the weight near the crown is small.

Source: Heyman (1967), On shell solutions for masonry domes, Int. J. Solids Struct. 3, 227-241: 0.042;
Heyman (1995), The stone skeleton.
"""

from pathlib import Path

import numpy as np

import limitblocks as lb

COUNTS = (13, 25, 51)


def main(folder="output"):
    found = [least_thickness(voussoirs) for voussoirs in COUNTS]
    for voussoirs, thickness in zip(COUNTS, found, strict=True):
        print(f"{voussoirs} voussoirs: t/R = {thickness:.5f}")
    (m, n), (a, b) = COUNTS[-2:], found[-2:]
    limit = b + (b - a) / ((n / m) ** 2 - 1)  # the error goes about with the square of a size
    print(f"many voussoirs: t/R = {limit:.5f}; Heyman 0.042")
    picture(Path(folder), found, limit)
    return {"least thickness": found, "many voussoirs": limit}


def lunes(thickness, voussoirs, angle=0.1):
    joint = lb.PointContact(friction=0.8)
    return lb.structures.dome_lunes(joint, radius=1.0, thickness=thickness, voussoirs=voussoirs, angle=angle)


def least_thickness(voussoirs):
    found = lb.studies.minimum(
        lambda thickness: lunes(thickness, voussoirs), 0.03, 0.06, parameter="t/R", tolerance=1e-6
    )
    return found.value


def picture(folder, found, limit):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure = plt.figure(figsize=(7, 2.6))
    first = figure.add_subplot(1, 3, 1, projection="3d", proj_type="ortho", elev=25, azim=-60)
    second, third = figure.add_subplot(1, 3, 2), figure.add_subplot(1, 3, 3)
    figure.get_layout_engine().set(wspace=0.1)
    lb.plots.structure(lunes(0.15, 13, angle=0.6), ax=first, live=False)
    first.set_yticks([0.0])
    first.set_zlabel("")
    first.set_title("Two lunes (thicker, wider)")
    model = lunes(found[-1] * 1.001, COUNTS[-1])  # just standing
    lb.plots.thrust_line(model, lb.bounds(model, tolerance=1e-5), ax=second)
    second.set_title(f"Line of thrust, t/R = {found[-1]:.4f}")
    third.plot(1 / np.square(COUNTS), found, "o-", color="#D55E00", label="found")
    third.axhline(0.0428, color="0.6", linestyle=":", label="0.0428, as thrust lines")
    third.axhline(0.042, color="0.6", label="Heyman (1967), 0.042")
    third.plot(0, limit, "k*", markersize=12, label="many voussoirs")
    third.set_xticks([1 / n**2 for n in COUNTS], [f"1/{n}²" for n in COUNTS])
    third.set(xlabel="1/voussoirs²", ylabel="least t/R", title="Convergence", ylim=(None, 0.0438))
    third.legend(loc="upper right")
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "14_dome_of_lunes.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
