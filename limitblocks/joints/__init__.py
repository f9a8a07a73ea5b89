"""What an interface can carry: one yield model a file, each as conic rows (F, g, G, K).

For a joint of your own: `YieldRows` is what it returns, `Queries` asks one joint, `areas` and
`torsion_constants` measure polygons; examples/16_write_your_own_joint.py is one. Its strengths, Pa, are
fields named `cohesion`, `tensile_strength` and `compressive_strength`, where partial factors and displaced
structures look for them.
`Model.save` writes its fields, but no file tells its rows: build such a model again in Python.
"""

from limitblocks.geometry.polygon import areas
from limitblocks.joints.base import Joint, YieldRows
from limitblocks.joints.elements import Backfill, Dowel, Guide, Tie
from limitblocks.joints.exact_torsion import ExactTorsion
from limitblocks.joints.interaction import effective_strength
from limitblocks.joints.materials import Material, Materials, weaker
from limitblocks.joints.orduna_lourenco import OrdunaLourenco
from limitblocks.joints.point_contact import PointContact
from limitblocks.joints.queries import Queries, interface
from limitblocks.joints.torsion import torsion_constants

__all__ = [
    "Backfill",
    "Dowel",
    "ExactTorsion",
    "Guide",
    "Joint",
    "Material",
    "Materials",
    "OrdunaLourenco",
    "PointContact",
    "Queries",
    "Tie",
    "YieldRows",
    "areas",
    "effective_strength",
    "interface",
    "torsion_constants",
    "weaker",
]


def __dir__() -> list[str]:
    return __all__
