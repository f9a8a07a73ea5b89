"""What practice asks: closed forms of ties, settlement, rocking, code checks, bridges, water and repair.

Independent values are those of the programs in tests/practice, run here.
"""

import math
import sys
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

import limitblocks as lb
from cases.case import Case, of_print
from limitblocks.practice import (
    Deck,
    PartialFactors,
    Vehicle,
    adequacy,
    capacity_curve,
    dowel,
    least_masses,
    least_ties,
    passive_fill,
    reinforced,
    settlement,
    settlement_to_collapse,
    strip,
    tie,
    uplift,
    vehicle_load,
    verification,
    worst_position,
)
from limitblocks.structures import Fill, arch_bridge
from limitblocks.structures.cases import COCCHETTI_RIZZI, PRESTWOOD, STOCKDALE

sys.path.extend(str(Path(__file__).parents[2] / folder) for folder in ("tests", "tests/practice"))

import facades
import planar_bridge
import spreading_arch
from facades import ARM, FLOOR, OWN, SITE, G, H, T
from stones import model_of

GROUP = "Practice"
ANOTHER = "another program, tests/practice/"
SPREAD = 1e-6  # of the radius: the interval in which a spreading arch falls
JOINT = lb.PointContact(0.7)


def nonassociated(model):
    result = lb.nonassociated(model)
    lb.check_mcp(model, result).require()
    return result.load_factor


facade, lintel = partial(facades.facade, JOINT), partial(facades.beam, JOINT)


def wall():
    """The facade without its floor."""
    return model_of(facades.wall_stones(), ["ground"], JOINT)


def rod(z, force, prestress=0.0):
    ends = (-T / 2, 0, z), (-6, 0, z)
    return tie("wall", ends[0], "ground", ends[1], area=1e-3, strength=force / 1e-3, prestress=prestress)


def rocking(force=0.0, z=0.0):
    """Moments about the outer edge."""
    return (OWN * T / 2 + FLOOR * ARM + force * z) / (OWN * H / 2 + FLOOR * H)


@cache
def verified():
    model = facade()
    curve = capacity_curve(model, control=("wall", (T / 2, 0.5, H)), steps=3)
    return verification(model, lb.nonassociated(model), SITE, q=2.0, confidence=1.35, curve=curve)


def arch_thrust():
    """Semicircle a trifle above its least thickness, its springing spreads: reaction over gamma t d R."""
    t = 1.0002 * 0.107478
    arch = lb.structures.arch(lb.PointContact(2.0), radius=1.0, thickness=t, voussoirs=60, unit_weight=20e3)
    found = settlement(arch, "right support", (1, 0, 0), without_dilatancy=False)
    return found.upper / (20e3 * t)


def spread(voussoirs, ratio):
    """Middle of the interval in which a semicircle of radius 1 falls when a springing spreads."""
    ring = lb.structures.arch(lb.PointContact(0.8), radius=1.0, thickness=ratio, voussoirs=voussoirs)
    way = settlement_to_collapse(ring, "right support", (1, 0, 0), step=0.1, accuracy=SPREAD,
                                 without_dilatancy=False)  # fmt: skip
    return (way.stands_to + way.falls) / 2


def slides_away():
    """Settlement at which a beam has lost its bearing of .2 m; less than 1e-3 block lengths is no contact."""
    stones = [
        lb.Block.box("left", (0.1, 1, 1), (-1.95, 0, -0.5)),
        lb.Block.box("right", (0.2, 1, 1), (1.5, 0, -0.5)),
        lb.Block.box("beam", (4.0, 1, 0.5), (-0.4, 0, 0.25), 20e3),
    ]
    beam = model_of(stones, ["left", "right"], lb.PointContact(0.5))
    way = settlement_to_collapse(beam, "right", (1, 0, 0), step=0.1, accuracy=1e-3)
    return way.falls


def point_load():
    """Intrados radius 1.806 m, thickness .1661 of it, depth .25 m, 1530 kg/m3; kN at joint 8 of 27."""
    inner, t = 1.806, 0.1661 * 1.806
    ring = lb.structures.arch(lb.PointContact(0.9), radius=inner + t / 2, thickness=t, voussoirs=27,
                              depth=0.25, unit_weight=1530 * G)  # fmt: skip
    angle = math.pi * 8 / 27
    joint = (-(inner + t) * math.cos(angle), 0.0, (inner + t) * math.sin(angle))
    left = min(ring.free_blocks, key=lambda block: block.centroid[0])
    eighth = sorted(ring.free_blocks, key=lambda block: block.centroid[0])[7]
    assert left.name == "voussoir 1"
    return lb.bounds(replace(ring, live=lb.loads.force(eighth.name, (0, 0, -1e3), at=joint))).upper


def rocked():
    block = lb.structures.block(lb.PointContact(0.6), width=0.2, height=1.0)
    return capacity_curve(block, control=("block 1", (0.2, 0.5, 1.0)), steps=3).zero


def tipped():
    """An axle of 10 kN at the end of an overhang of 1 m tips the lintel."""
    found = worst_position(lintel(), Vehicle((10e3,), contact=1e-6), Deck(0.5), (3.5, 3.999), positions=3)
    return found.bounds.upper * (found.position - 3.0)


def wedge_in_fill():
    """A prism of 45 degrees that slides into fill."""
    section = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]
    wedge = lb.Block.prism("wedge", section, (-0.5, 0.5), 20e3)
    stones = [lb.Block.box("ground", (3, 1, 0.4), (0.5, 0, -0.2)), wedge]
    model = model_of(stones, ["ground"], lb.PointContact(0.2))
    return nonassociated(reinforced(model, *passive_fill(model, 1.5, unit_weight=1e3, coefficient=2.0)))


def rocks_with_prestress(strength=2e3, z=4.5, away=9.0):
    """Zero of a wall held by a tie of which half is prestress, m of its top."""
    held = tie("wall", (-T / 2, 0, z), "ground", (-T / 2 - away, 0, z), area=1e-4, strength=strength / 1e-4,
               prestress=strength / 2)  # fmt: skip
    model = reinforced(wall(), held)
    return capacity_curve(model, control=("wall", (T / 2, 0.5, H)), steps=3).zero


def zero_with_tie(strength=2e3, z=4.5, away=9.0):
    """The same by moments about the toe, where the anchor and the tie are at a turn of the wall."""

    def moment(turn):
        c, s = math.cos(turn), math.sin(turn)
        x, height = z * s - T * c, z * c + T * s
        run, rise = -T - away - x, z - height
        return OWN * (T * c - H * s) / 2 - strength * (height * run - x * rise) / math.hypot(run, rise)

    return H * math.sin(brentq(moment, 0.0, 1.0, xtol=1e-14))


def sinks_with_prestress():
    """The rod from the lintel into the support that sinks carries 6 kN, 5 kN of them prestress."""
    rod_ = tie("beam", (2.75, 0, 0.5), "right", (2.75, 0, -0.9), area=1e-4, strength=6e7, prestress=5e3)
    return settlement(reinforced(lintel(), rod_), "right", (0, 0, -1)).nonassociated


def bridge(**settings):
    """Quarter span of the first arch, clear span 3 m, no fill, one metre of width."""
    model = arch_bridge(lb.PointContact(0.6), span=3.0, rise=0.75, thickness=0.22, voussoirs=15, **settings)
    return lb.bounds(replace(model, live=lb.loads.top_force((0, 0, -1e3), (-0.75, 0)))).upper


def prestwood(voussoirs=40, filled=True):
    """Masonry 18 kN/m3, friction .6; fill 20 kN/m3, .165 m over the crown, 2:1 from .3 m, K_p = 3."""
    joint, top = lb.PointContact(0.6), Fill(0.165, 20e3)
    model = arch_bridge(joint, span=6.55, rise=1.428, thickness=0.22, voussoirs=voussoirs, depth=3.8,
                        unit_weight=18e3, fill=top if filled else None)  # fmt: skip
    if not filled:
        return lb.bounds(replace(model, live=lb.loads.top_force((0, 0, -1e3), (-6.55 / 4, 0)))).upper
    level = max(block.vertices[:, 2].max() for block in model.free_blocks) + top.height
    loaded = replace(model, live=vehicle_load(model, Vehicle((1e3,)), Deck(level), -6.55 / 4))
    fill = passive_fill(loaded, level, unit_weight=20e3, coefficient=3.0)
    return lb.bounds(reinforced(loaded, *fill)).upper


def slides(friction=0.3, width=2.0, height=1.0):
    return lb.structures.block(lb.PointContact(friction), width=width, height=height)


def lifted():
    model = slides()
    return nonassociated(replace(model, dead=model.dead + uplift(model, 0.6, unit_weight=9810.0)))


def pinned():
    model = slides()
    (joint,), weight = model.interfaces, model.free_blocks[0].weight
    pin = dowel(joint, joint.centroid, diameter=0.02, capacity=0.05 * weight)
    return nonassociated(reinforced(model, pin))


def stripped():
    model = facade()
    own = strip(model.interfaces[0], (-T / 2, 0, 0), width=0.1, capacity=6e3)
    return nonassociated(reinforced(model, own))


def factored():
    return adequacy(slides(), PartialFactors(gamma_G=1.35, gamma_Q=1.5, gamma_M=2.2, gamma_phi=1.25)).factor


def arch_with_rods(case, source):
    """Ties, prestress, least ties and water of one arch, in both programs."""
    own = planar_bridge.Bridge(depth=1.0)
    model = partial(arch_bridge, lb.PointContact(0.6), span=3.0, rise=0.75, thickness=0.22, voussoirs=15)
    live = lb.loads.top_force((0, 0, -1e3), (-0.75, 0))

    def rods(k, force, prestress=0.0):
        x, z = (own.point(0, 0, k) + own.point(0, 1, k + 1)) / 2
        ours = tie(f"span 1 voussoir {k + 1}", (x, 0, z), f"span 1 voussoir {15 - k}", (-x, 0, z),
                   area=1e-4, strength=force / 1e-4, prestress=prestress)  # fmt: skip
        return ours, ((x, z), (1.0, 0.0), (prestress, force), (0, 0, k), (0, 0, 14 - k))

    def bounded(*elements, water=None):
        loaded = replace(model(), live=live)
        if water:
            loaded = replace(loaded, dead=loaded.dead + uplift(loaded, water))
        return lb.bounds(reinforced(loaded, *elements) if elements else loaded).upper

    for name, rod_ in (("tie of 20 kN at the haunches", rods(2, 2e4)),
                       ("rod of 50 kN prestress at the fifth voussoirs", rods(4, 5e4 + 1, 5e4))):  # fmt: skip
        yield case(f"arch, {name}", "associated, kN", source,
                   planar_bridge.load_factor(own, -0.75, pulls=[rod_[1]]),
                   lambda rod_=rod_: bounded(rod_[0]))  # fmt: skip
    level = own.rise + own.thickness + 0.3
    yield case("arch, water 0.3 m over the crown in its joints", "associated, kN", source,
               planar_bridge.load_factor(own, -0.75, water=level), lambda: bounded(water=level))  # fmt: skip
    required = 1.5 * planar_bridge.load_factor(own, -0.75)
    ours, pulls = zip(*(rods(k, 5e4) for k in (1, 2, 4)), strict=True)
    yield case("arch, least ties for 1.5 times its load", "sum of forces, N", source,
               planar_bridge.least_pulls(own, -0.75, required, pulls),
               lambda: least_ties(replace(model(), live=live), ours, required).total)  # fmt: skip


def practice():
    def case(structure, quantity, formula, value, run, quick=True):
        return Case(GROUP, structure, quantity, formula, value, 1e-6 * abs(value), run, quick=quick)

    yield case("lintel on two supports, one settles", "least reaction, N", "W (L/2 - b) / (L - b)",
               40e3 * 1.5 / 2.5, lambda: settlement(lintel(), "right", (0, 0, -1)).nonassociated)  # fmt: skip
    thrust = COCCHETTI_RIZZI["thrust"]
    yield of_print(GROUP, "semicircle of least thickness, 60 voussoirs, spreads", "reaction / (gamma t d R)",
                   replace(thrust, tolerance=3e-3), arch_thrust, quick=True)  # fmt: skip
    for voussoirs, ratio in ((8, 0.2), (16, 0.15)):
        yield Case(GROUP, f"semicircle of {voussoirs} voussoirs, t/R = {ratio:g}, spreads",
                   "settlement at collapse / R", f"{ANOTHER}spreading_arch.py",
                   spreading_arch.fourth_hinge(voussoirs, ratio), SPREAD,
                   partial(spread, voussoirs, ratio))  # fmt: skip
    yield Case(GROUP, "beam whose support slides away below its end", "settlement at collapse, m",
               "length of its bearing", 0.2, 2e-3, slides_away)  # fmt: skip
    yield case("facade with a floor", "non-associated", "moments about toe", rocking(),
               lambda: nonassociated(facade()))  # fmt: skip
    yield case("facade, tie of 8 kN at 4.5 m", "non-associated", "moments about toe", rocking(8e3, 4.5),
               lambda: nonassociated(reinforced(facade(), rod(4.5, 8e3))))  # fmt: skip
    yield case("facade, two ties in parallel, one with a prestress", "non-associated", "moments about toe",
               rocking(8e3, 4.5),
               lambda: nonassociated(reinforced(facade(), rod(4.5, 5e3), rod(4.5, 3e3, 1e3))))  # fmt: skip
    yield case("facade, strip that debonds at 6 kN", "non-associated", "moments about toe", rocking(6e3, T),
               stripped)  # fmt: skip
    yield case("block that slides, dowel", "non-associated", "mu + F / W", 0.35, pinned)
    yield case("block 0.2 m x 1.0 m rocks", "displacement of no resistance, m", "h sin(atan(b / h))",
               math.sin(math.atan(0.2)), rocked, quick=False)  # fmt: skip
    yield case("facade, tie of 2 kN, half of it prestress", "displacement of no resistance, m",
               "moments about toe", zero_with_tie(), rocks_with_prestress, quick=False)  # fmt: skip
    yield case("lintel, rod into the support that settles", "least reaction, N",
               "(W (L/2 - b) - T (L - x))/(L - b)", (40e3 * 1.5 - 6e3 * 0.25) / 2.5,
               sinks_with_prestress)  # fmt: skip
    weights, ways = np.array([OWN, FLOOR]), np.array([H / 2, H])
    mass = (weights @ ways) ** 2 / (G * weights @ ways**2)
    e = G * mass / weights.sum()
    d0 = H * math.sin(math.atan(rocking())) * (weights @ ways**2) / (H * weights @ ways)
    a0 = rocking() * G / (e * 1.35)
    for symbol, value in {"e*": e, "a0*": a0, "d0*": d0}.items():
        yield case("facade, verification, FC 1.35", symbol, "Circolare 7/2019, C8.7.1.2", value,
                   lambda symbol=symbol: verified()[symbol], quick=False)  # fmt: skip
    yield case("facade, verification, FC 1.35", "linear check, ratio", "a0* q / (a_g S)",
               a0 * 2.0 / (0.25 * G * 1.2), lambda: verified().checks[0].ratio, quick=False)  # fmt: skip
    yield case("block that slides, partial factors", "adequacy factor", "mu gamma_G / (gamma_phi gamma_Q)",
               0.3 * 1.35 / 1.25 / 1.5, factored)  # fmt: skip
    yield case("overhang of a beam, axle at its end", "load factor x lever, m", "W (3 - 2) / P", 4.0, tipped)
    yield case("prism of 45 degrees slides into fill", "non-associated", "mu + K_p gamma z A / W", 0.4,
               wedge_in_fill)  # fmt: skip
    bond = lb.OrdunaLourenco(0.6, cohesion=2e6, tensile_strength=2e6)
    shape, source = {"depth": 1.0}, f"{ANOTHER}planar_bridge.py"
    for name, other, settings in (
        ("arch of two bonded rings", {}, {"rings": 2, "ring_joint": bond}),
        ("arch of two dry rings", {"rings": 2}, {"rings": 2}),
        ("two arches on a pier of 0.5 m x 1.5 m", {"spans": 2},
         {"spans": 2, "pier_width": 0.5, "pier_height": 1.5}),
    ):  # fmt: skip
        value = planar_bridge.load_factor(planar_bridge.Bridge(**shape, **other), -0.75)
        yield case(name, "associated, kN", source, value, lambda settings=settings: bridge(**settings))
    yield from arch_with_rods(case, source)
    bare = planar_bridge.Bridge(6.55, 1.428, 0.22, 40, depth=3.8, gamma=18e3)
    yield case("Prestwood bridge, bare ring, 40 voussoirs", "associated, kN", source,
               planar_bridge.load_factor(bare, -6.55 / 4), lambda: prestwood(filled=False))  # fmt: skip
    yield of_print(GROUP, "Prestwood bridge, fill, 40 voussoirs", "associated, kN", PRESTWOOD, prestwood,
                   quick=True)  # fmt: skip
    yield of_print(GROUP, "ring of 27 voussoirs, load at the eighth joint", "associated, kN", STOCKDALE,
                   point_load, quick=True)  # fmt: skip
    yield case("block that slides, uplift", "non-associated", "mu (1 - p A / W)",
               0.3 * (1 - 9810.0 * 0.6 * 2.0 / 40e3), lifted)  # fmt: skip
    force = OWN * (0.3 * H - T) / 2 / 4.5
    yield case("wall, least ties for load factor .3", "sum of forces, N", "W (a H - t) / (2 z)", force,
               lambda: least_ties(wall(), [rod(2.0, 1e5), rod(4.5, 1e5)], 0.3).total)  # fmt: skip
    mass = OWN * (0.12 * H - T) / 2 / (T - 0.12 * 0.5)
    places = [("wall", (0, 0, 4.0)), ("wall", (-T / 2, 0, 0.5))]
    yield case("wall, least masses for load factor .12", "sum of weights, N", "W (a H - t) / 2 (x - a z)",
               mass, lambda: least_masses(wall(), places, 0.12).total)  # fmt: skip
