"""What an interface can carry: one yield model a file, each as conic rows (F, g, G, K)."""

from limitblocks.joints.base import Joint, YieldRows
from limitblocks.joints.exact_torsion import ExactTorsion
from limitblocks.joints.interaction import effective_strength
from limitblocks.joints.materials import Material, Materials, weaker
from limitblocks.joints.orduna_lourenco import OrdunaLourenco
from limitblocks.joints.point_contact import PointContact
from limitblocks.joints.queries import interface

__all__ = [
    "ExactTorsion",
    "Joint",
    "Material",
    "Materials",
    "OrdunaLourenco",
    "PointContact",
    "YieldRows",
    "effective_strength",
    "interface",
    "weaker",
]
