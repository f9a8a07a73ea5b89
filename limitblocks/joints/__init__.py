"""What an interface can carry: one yield model a file, each as conic rows (F, g, G, K)."""

from limitblocks.joints.base import Joint, YieldRows
from limitblocks.joints.orduna_lourenco import OrdunaLourenco
from limitblocks.joints.point_contact import PointContact

__all__ = ["Joint", "OrdunaLourenco", "PointContact", "YieldRows"]
