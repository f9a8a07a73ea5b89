"""The models that the non-associated analysis is measured on: structures, joints, frictions and pushes."""

from dataclasses import dataclass, replace
from functools import partial

import limitblocks as lb
from limitblocks import structures

DIRECTIONS = {"along": (1.0, 0.0, 0.0), "out": (0.0, 1.0, 0.0), "diagonal": (1.0, 1.0, 0.0)}
FRICTIONS = (0.3, 0.6, 0.8)
STRENGTH = 0.3e6  # Pa: low, so that crushing takes part under the weight of a few metres of stone
HELD_OUT = (
    "wall", "two_leaf_wall", "tower", "buttressed_wall", "overhang", "arch, fill", "segmental_arch",
    "pointed_arch", "elliptical_arch", "groin_vault", "pavilion_vault", "dome", "dome_lunes",
    "cantilever_stair",
)  # fmt: skip
DOORS = {"front": [(1.6, 0.0, 0.8, 2.0)], "back": [(1.6, 0.8, 0.8, 0.8)]}
LARGE = {
    "facade 160": structures.facade,
    "facade 223": lambda joint: structures.facade(joint, length=8.0, courses=12, return_length=4.0),
    "facade 508": lambda joint: structures.facade(joint, length=12.0, courses=17, return_length=6.4),
    "house 215": lambda joint: structures.tower(joint, length=4.8, width=4.0, courses=11, openings=DOORS),
    "house 505": lambda joint: structures.tower(joint, length=6.4, width=6.4, courses=17, openings=DOORS),
    "tower 180": lambda joint: structures.tower(joint, length=2.4, width=2.4, courses=18),
    "tower 504": lambda joint: structures.tower(joint, length=3.2, width=3.2, courses=36),
    "dome 289": lambda joint: structures.dome(joint, radius=3.0, thickness=0.4, courses=12, stones=24),
    "groin vault 300": lambda joint: structures.groin_vault(
        joint, radius=3.0, thickness=0.4, length=7.0, courses=25, stone_length=0.5
    ),
    "wall 1008": lambda joint: structures.wall(joint, length=12.8, courses=31),
    "wall 2000": lambda joint: structures.wall(joint, length=18.4, courses=43),
}

ODD = (0.9553, 0.2955, 0.0)  # .3 rad off X: across no plane of symmetry, nor along one
ASKEW = {
    "corner 49": lambda joint: structures.corner(joint, length=3.2, return_length=2.4, courses=7),
    "tower 100": lambda joint: structures.tower(joint, length=2.4, width=2.4, courses=10),
    "groin vault 92": lambda joint: structures.groin_vault(
        joint, radius=3.0, thickness=0.4, length=7.0, courses=13, stone_length=1.1
    ),
    "pavilion vault 77": lambda joint: structures.pavilion_vault(
        joint, radius=3.0, thickness=0.4, courses=11, stone_length=0.9
    ),
    **{
        f"dome {courses * stones + 1}": partial(
            structures.dome, radius=3.0, thickness=0.4, courses=courses, stones=stones
        )
        for courses, stones in ((5, 9), (5, 11), (6, 9), (6, 11), (7, 13), (7, 14))
    },
}


@dataclass
class Case:
    """One analysis of the matrix."""

    structure: str
    joint: lb.OrdunaLourenco | lb.PointContact
    push: str
    model: lb.Model

    @property
    def joint_name(self):
        if isinstance(self.joint, lb.PointContact):
            return "point contact"
        return "crushing" if self.joint.compressive_strength else "no crushing"


def corner(joint, direction):
    return structures.corner(joint, length=2.4, return_length=2.4, courses=4, direction=direction)


def small_facade(joint, direction=DIRECTIONS["out"]):
    door = [(1.2, 0.0, 0.8, 1.2)]
    return structures.facade(
        joint, length=3.2, courses=5, return_length=1.6, openings=door, direction=direction
    )


def facade(joint, direction):
    return structures.facade(joint, direction=direction)


def lintel(joint, direction):
    return structures.eccentric_lintel(joint, eccentricity=0.1, direction=direction)


def stair(joint, direction):
    return structures.stair(joint, direction=direction)


def vault(joint, direction):
    return structures.barrel_vault(
        joint, radius=1.5, thickness=0.4, length=1.8, courses=7, stones=3, direction=direction
    )


def portal(joint, direction):
    return structures.portal(joint, span=1.6, pier_width=0.8, pier_blocks=3, depth=0.8, direction=direction)


def arch_on_piers(joint, direction):
    return structures.arch(
        joint, radius=1.5, thickness=0.5, voussoirs=9, piers=structures.Piers(1.2, 2), direction=direction
    )


def walls(joint, _direction):
    for number in (1, 2, 3, 4):
        yield f"wall {number}", structures.ferris_tin_loi_wall(number, joint)


SOLID = (small_facade, corner, lintel, stair, vault, portal, arch_on_piers)


def joints(*frictions):
    return [lb.OrdunaLourenco(mu, compressive_strength=fc) for fc in (None, STRENGTH) for mu in frictions]


def cases(quick):
    """Everything the issue asks for; `quick` keeps one friction and no crushing."""
    for joint in (lb.OrdunaLourenco(0.65), lb.PointContact(0.65)):
        for name, model in walls(joint, None):
            yield Case(name, joint, "along", model)
    choice = [*joints(*FRICTIONS), lb.PointContact(0.6)]
    builders = [
        (build, [lb.OrdunaLourenco(0.6), lb.PointContact(0.6)] if quick else choice) for build in SOLID
    ]
    builders += [] if quick else [(facade, [lb.OrdunaLourenco(0.6)])]
    for build, chosen in builders:
        for joint in chosen:
            for push, direction in DIRECTIONS.items():
                yield Case(build.__name__.replace("_", " "), joint, push, build(joint, direction))


def held_out(quick):
    """Structures on which no setting of the analysis was chosen."""
    plain, crushing = joints(0.7)
    for joint in [plain] if quick else [plain, lb.PointContact(0.7), crushing]:  # what takes long comes last
        for name in HELD_OUT:
            model = structures.EXAMPLES[name](joint)
            for push, direction in DIRECTIONS.items():
                yield Case(name, joint, push, replace(model, live=lb.mass_proportional(direction)))


def askew(quick):
    """Vaults, a tower and a corner of 46 to 100 blocks, pushed where they have no plane of symmetry."""
    for friction in (0.6,) if quick else (0.6, 0.8):
        for joint in (lb.OrdunaLourenco(friction), lb.PointContact(friction)):
            for name, build in ASKEW.items():
                yield Case(name, joint, "askew", replace(build(joint), live=lb.mass_proportional(ODD)))


def large(_quick, only=""):
    """Structures of 160 to 2,000 blocks whose name begins with `only`, three pushes each, both joints."""
    for name, build in ((k, v) for k, v in LARGE.items() if k.startswith(only)):
        for joint in (lb.OrdunaLourenco(0.6), lb.PointContact(0.6)):
            for push, direction in DIRECTIONS.items():
                yield Case(name, joint, push, replace(build(joint), live=lb.mass_proportional(direction)))
