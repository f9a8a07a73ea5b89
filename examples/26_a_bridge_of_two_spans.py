"""Which axle does a bridge carry, and what do its piers, rings and fill bring?

Two arches of clear span 3 m on a pier. Three answers for one force P at the quarter span of the first:

- on a heavy pier the loaded span falls alone, in four hinges; on a slender one the thrust that the load adds
  pushes the pier over, and both spans fall;
- brick arches are built ring on ring. Bonded rings are one arch of the whole thickness; where they have
  parted, each carries its share, and friction between them a little more;
- fill weighs on the haunches, spreads the axle, and resists with K_p times its vertical pressure where the
  arch moves into it, up to K_p gamma z on the projection of a voussoir.

A vehicle is moved along the deck: the least load factor of all places is what counts, and with several spans
it may lie in any of them.

Source: Heyman (1982), The masonry arch; Melbourne & Gilbert (1995), The behaviour of multiring brickwork arch
bridges, The Structural Engineer 73(3), for rings as blocks of their own.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

import limitblocks as lb
from limitblocks.practice import Deck, Vehicle, passive_fill, reinforced, vehicle_load, worst_position
from limitblocks.structures import Fill, arch_bridge

SHAPE = {"span": 3.0, "rise": 0.75, "thickness": 0.22, "voussoirs": 15, "depth": 2.0, "unit_weight": 20e3}
DRY, BONDED = lb.PointContact(0.6), lb.OrdunaLourenco(0.6, cohesion=2e6, tensile_strength=2e6)
PIERS = {"heavy": (4.0, 1.5), "usual": (0.5, 1.5), "slender": (0.4, 3.0)}  # width, height, m
RAIL = 0.3  # m of fill over the crown


def main(folder="output"):
    one = force(arch_bridge(DRY, **SHAPE))
    print(f"one span: {one:.4f} kN")
    piers = {
        name: force(arch_bridge(DRY, spans=2, pier_width=width, pier_height=height, **SHAPE))
        for name, (width, height) in PIERS.items()
    }
    rings = {
        "bonded": force(arch_bridge(DRY, rings=2, ring_joint=BONDED, **SHAPE)),
        "friction .6": force(arch_bridge(DRY, rings=2, **SHAPE)),
        "no friction": force(arch_bridge(DRY, rings=2, ring_joint=lb.PointContact(0.0), **SHAPE)),
    }
    for name, value in (*piers.items(), *rings.items()):
        print(f"{name}: {value:.4f} kN")
    bridge = arch_bridge(DRY, spans=2, pier_width=0.5, pier_height=1.5, fill=Fill(RAIL, 18e3), **SHAPE)
    level = max(block.vertices[:, 2].max() for block in bridge.free_blocks) + RAIL
    deck, axle = Deck(level), Vehicle((1e3,))
    quarter = replace(bridge, live=vehicle_load(bridge, axle, deck, -0.75))
    # over the pier the fill leans on the other span: it holds the two halves beside the abutments only
    ends = [f"span 1 voussoir {k}" for k in range(1, 8)] + [f"span 2 voussoir {k}" for k in range(9, 16)]
    fill = passive_fill(bridge, level, unit_weight=18e3, coefficient=3.0, blocks=ends)
    filled = [lb.bounds(model).upper for model in (quarter, reinforced(quarter, *fill))]
    print(f"with the weight of fill {filled[0]:.3f} kN, with its resistance {filled[1]:.3f} kN")
    tandem = Vehicle((50e3, 50e3), (0.0, 1.2))
    worst = worst_position(reinforced(bridge, *fill), tandem, deck, positions=13)
    print(worst)
    picture(Path(folder), worst)
    return {
        "one span": one,
        "heavy pier": piers["heavy"],
        "bonded rings": rings["bonded"],
        "usual pier": piers["usual"],
        "rings with friction .6": rings["friction .6"],
        "rings without friction": rings["no friction"],
        "order": list(np.argsort([piers["slender"], piers["usual"], piers["heavy"]])),
        "fill brings": bool(one < filled[0] < filled[1]),
    }


def force(model):
    """Collapse load of a force at the quarter span of the first arch, on its extrados, kN."""
    return lb.bounds(replace(model, live=lb.loads.top_force((0, 0, -1e3), (-0.75, 0)))).upper


def picture(folder, worst):
    import matplotlib.pyplot as plt

    order = np.argsort(worst.positions)
    plt.style.use("limitblocks.plots.paper")
    figure, axis = plt.subplots(figsize=(3.5, 2.6))
    axis.plot(worst.positions[order], worst.load_factors[order], "o-")
    axis.plot(worst.position, worst.bounds.lower, "s", color="tab:red", label="worst position")
    axis.set(xlabel="X of the first axle (m)", ylabel="load factor of 50 + 50 kN", ylim=(0, None))
    axis.legend()
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "26_a_bridge_of_two_spans.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
