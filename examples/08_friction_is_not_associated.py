"""What is lost when sliding does not lift the blocks?

Associated flow makes a sliding joint open as steeply as the friction angle. Between neighbours that stand
still there is no room to open: the blocks wedge, thrust builds up, and friction lives on thrust. Real
joints slide almost level. The structure is wall 4 of Ferris & Tin-Loi, 55 blocks in running bond with two
rows of openings, friction 0.65, pushed sideways by a share of its weight. The flow has the dilatancy d, the
tangent of its angle:

    strain rates = -G^T y,    G = G0 + d/mu (F - G0),    0 <= d <= mu

with the yield rows F, and G0 which are the same rows without opening in sliding and twisting. At d = mu the
flow is associated, and the two bounds hold; below, the load factor is not unique.

Two ways to d = 0. Continuation: start at the associated solution and lower d in small steps, each from the
state before (`start=`). The thrust of the wedged state is kept and stays admissible, so the load factor
hardly falls. Loading: start from the permanent loads. With d = 0.05 the blocks still wedge while they begin
to slide, and the end is the same; with d = 0 nothing builds that thrust up, and the load factor jumps down.
Both ends at d = 0 are solutions, which the check confirms. What thrust a real wall has nobody knows: count
on the less.

Source: Drucker (1954), Coulomb friction, plasticity, and limit loads; Ferris & Tin-Loi (2001), Int. J.
Mech. Sci. 43: 0.33195 associated, 0.264 for zero dilatancy; flow: Orduña & Lourenço (2005), Part I, Table
3.
"""

from pathlib import Path

import limitblocks as lb

FRICTION = 0.65
DILATANCIES = (0.65, 0.5, 0.35, 0.2, 0.05, 0.0)
LOADED = (0.65, 0.2, 0.05, 0.0)


def main(folder="output"):
    wall = lb.structures.ferris_tin_loi_wall(4, lb.OrdunaLourenco(FRICTION))
    bounds = lb.bounds(wall)
    continued, start = [], bounds
    for dilatancy in DILATANCIES:
        start = lb.nonassociated(wall, dilatancy=dilatancy, start=start)
        continued.append(start)
        print(f"dilatancy {dilatancy:.2f}, from the state before:    {start.load_factor:.5f}")
    loaded = [lb.nonassociated(wall, dilatancy=dilatancy) for dilatancy in LOADED]
    for dilatancy, found in zip(LOADED, loaded, strict=True):
        print(f"dilatancy {dilatancy:.2f}, from the permanent loads: {found.load_factor:.5f}")
    for found in (continued[-1], loaded[-1]):
        print(f"{found.load_factor:.5f}: {lb.check_mcp(wall, found)}")
        lb.check_mcp(wall, found).require()
    assert loaded[-1].load_factor < continued[-1].load_factor < bounds.upper
    picture(Path(folder), wall, continued, loaded)
    return {
        "associated": bounds.lower,
        "zero dilatancy, loaded": loaded[-1].load_factor,
        "zero dilatancy, continued": continued[-1].load_factor,
        "continuation": [found.load_factor for found in continued],
    }


def picture(folder, wall, continued, loaded):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, axes = plt.subplots(1, 3, figsize=(7, 2.9), width_ratios=(1.3, 1, 1))
    axes[0].plot(
        DILATANCIES,
        [found.load_factor for found in continued],
        "o-",
        label="continued from the associated end",
    )
    axes[0].plot(
        LOADED, [found.load_factor for found in loaded], "s", label="loaded from the permanent loads"
    )
    axes[0].plot(FRICTION, 0.33195, "k*", markersize=14, zorder=0, label="Ferris & Tin-Loi (2001)")
    axes[0].plot(0, 0.264, "k*", markersize=14, zorder=0)
    axes[0].set(xlabel="dilatancy", ylabel="load factor", ylim=(0.2, 0.36))
    axes[0].set_title("Load factor against dilatancy")
    axes[0].legend(loc="lower right")
    for ax, found, word in zip(
        axes[1:], (continued[0], loaded[-1]), ("associated", "zero dilatancy"), strict=True
    ):
        lb.plots.mechanism(wall, found, ax=ax)
        ax.set_title(f"{word}: {found.load_factor:.5f}")
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "08_friction_is_not_associated.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
