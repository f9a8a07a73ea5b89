"""What happens beyond the greatest load, and can it happen at once?

A plug sits in a seat that narrows downwards, driven in so hard that both faces press with N0, five times its
weight: friction holds what the press would throw out. A soft jack pushes it up from below, ever so slowly.

Each face has the area A, the half angle w against the vertical, stiffness k_n and k_s per area and friction
mu. The plug is rigid and moves by d. Until a face slides it carries k_s A d cos w more along itself, and it
presses by k_n A d sin w less. From then on its shear is mu times what is left of the press, which goes on
falling:

    sliding at   d = (mu N0 - T0) / (A (k_s cos w + mu k_n sin w)),   T0 = (2 N0 sin w - W) / (2 cos w)
    force there  F = 2 A d (k_s cos^2 w + k_n sin^2 w)
    afterwards   dF/dd = -2 k_n A sin w (mu cos w - sin w) < 0,   until N = 0 and F is the weight W

The jack (of weight J, stiffness K) moves by d + F/K. Where the seat loses force faster than K, d can only
grow if the jack goes *back*: 1 + (dF/dd) / K < 0. A slow experiment moves the jack on, and the plug snaps out
of the seat. The library follows the states between by arclength, reports the two ends of the snap, and goes
on to where the push carries all the weight.

Source: derived above; snaps followed by arclength: Riks (1979), Int. J. Solids Structures 15, 529-551.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import limitblocks as lb
from limitblocks.structures.convex import hull

MU, HALF_ANGLE = 0.6, np.radians(20.0)
WIDTH, HEIGHT, DEPTH = 0.3, 0.4, 0.5  # m
STIFF, SOFT = 1e9, 1e7  # N/m3
AREA = HEIGHT / np.cos(HALF_ANGLE) * DEPTH
SEAT, JACK = lb.OrdunaLourenco(MU), lb.OrdunaLourenco(0.5)  # two joints, for two stiffnesses


def main(folder="output", suffix=".png"):
    model = plug_in_its_seat()
    weight, jack = (block.weight for block in model.free_blocks)
    options = {"start": driven_in(model), "stiffness": {SEAT: (STIFF, STIFF), JACK: (SOFT, SOFT)}}
    path, along = (lb.load_path(model, **options, snaps=how) for how in ("across", "along"))
    lb.check_mcp(model, path.collapse).require()
    (snap,) = path.snaps
    peak = greatest(weight) + jack
    print(path)
    print(f"{snap}; by hand from {peak:.2f} N to {weight + jack:.2f} N")
    picture(Path(folder) / f"20_a_load_path_that_snaps{suffix}", model, along)
    return {
        "collapse over weight": path.load_factor / (weight + jack),
        "after the snap over weight": snap.after.load_factor / (weight + jack),
        "before the snap over greatest": snap.before.load_factor / peak,
        "jack moved across the snap": float(np.ptp([lift(model, at) for at in (snap.before, snap.after)])),
        "same end along": along.load_factor / path.load_factor,
    }


def plug_in_its_seat():
    """The plug between two abutments, on a jack that stands on the floor and pushes it up."""
    low, high = WIDTH / 2, WIDTH / 2 + HEIGHT * np.tan(HALF_ANGLE)

    def prism(name, section, unit_weight=None):
        return hull(name, np.array([(x, y, z) for y in (0, DEPTH) for x, z in section]), unit_weight)

    blocks = [
        prism("floor", [(-0.6, -0.3), (0.6, -0.3), (0.6, -0.1), (-0.6, -0.1)]),
        prism("left", [(-low, 0), (-high, HEIGHT), (-0.6, HEIGHT), (-0.6, 0)]),
        prism("right", [(low, 0), (high, HEIGHT), (0.6, HEIGHT), (0.6, 0)]),
        prism("plug", [(-low, 0), (low, 0), (high, HEIGHT), (-high, HEIGHT)], 20e3),
        prism("jack", [(-low, -0.1), (low, -0.1), (low, 0), (-low, 0)], 20e3),
    ]
    found = lb.find_interfaces(blocks, SEAT)
    interfaces = [replace(i, joint=JACK) if i.name == "plug|jack" else i for i in found]
    push = lb.loads.force("jack", (0, 0, 1), at=(0, DEPTH / 2, -0.05))
    return lb.Model(blocks, ["floor", "left", "right"], interfaces, lb.self_weight(), push)


def driven_in(model):
    """Resultants (V1, V2, N, M1, M2, T) of the seat that press with N0, and of the jack on the floor."""
    weight, jack = (block.weight for block in model.free_blocks)
    N0, T0 = press(weight)
    c, s = np.cos(HALF_ANGLE), np.sin(HALF_ANGLE)
    onto = {  # forces on the second block
        "left|plug": np.array([N0 * c + T0 * s, 0, N0 * s - T0 * c]),
        "right|plug": np.array([-N0 * c - T0 * s, 0, N0 * s - T0 * c]),
        "floor|jack": np.array([0, 0, jack]),
    }
    nothing = np.zeros(3)  # Q acts on the first block
    return np.array([np.r_[-i.axes @ onto.get(i.name, nothing), nothing] for i in model.interfaces])


def press(weight):
    """N0 and T0: press and downward shear of a face before the push."""
    N0 = 5 * weight
    return N0, (2 * N0 * np.sin(HALF_ANGLE) - weight) / (2 * np.cos(HALF_ANGLE))


def greatest(weight):
    """Force of the jack on the plug where its faces begin to slide, by the formula above."""
    N0, T0 = press(weight)
    c, s = np.cos(HALF_ANGLE), np.sin(HALF_ANGLE)
    moved = (MU * N0 - T0) / (AREA * STIFF * (c + MU * s))
    return 2 * AREA * moved * STIFF * (c**2 + s**2)


def lift(model, step):
    """Upward displacement of the jack, m."""
    return step.displacements[[block.name for block in model.blocks].index("jack"), 2]


def picture(file, model, path):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, axes = plt.subplots(1, 3, figsize=(7, 3), width_ratios=(0.8, 1, 1))
    lb.plots.mechanism(model, path.collapse, ax=axes[0])
    axes[0].set_title("the plug leaves its seat")
    lb.plots.load_path(model, path, block="jack", component="Z", ax=axes[1])
    length, _, load_factor = path.trace.T
    axes[2].plot(length, load_factor, ".-", color="#0072B2", linewidth=1)
    for one, mark in ((path.snaps[0].before, "v"), (path.snaps[0].after, "^")):
        near = np.abs(load_factor - one.load_factor).argmin()
        axes[2].plot(length[near], load_factor[near], mark, color="#D55E00", markersize=8)
    axes[2].set(xlabel="arclength (–)", ylabel="load factor (–)", title="every point")
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file)
    plt.close(figure)


if __name__ == "__main__":
    main(*sys.argv[1:])
