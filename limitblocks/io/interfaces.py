"""Check of interfaces that a file gives in numbers."""

from __future__ import annotations

import numpy as np

from limitblocks.geometry import Interface
from limitblocks.geometry.polygon import centroids, cross, following

AXES_TOLERANCE = 1e-9
#: Distance from the polygon's origin to its centroid, over its size, that still counts as none.
CENTROID_TOLERANCE = 1e-6


def interface_fault(interface: Interface) -> str:
    """Say what is wrong with the numbers of `interface`; empty when sound."""
    axes, polygon = interface.axes, interface.polygon
    skew = float(np.abs(axes @ axes.T - np.eye(3)).max())
    if skew > AXES_TOLERANCE:
        return f"axes are off orthonormal by {skew:.1e}; at most {AXES_TOLERANCE:.0e} is allowed"
    if np.linalg.det(axes) < 0.0:
        return "axes are left-handed; n = s1 x s2 is needed"
    side = following(polygon) - polygon
    swept = cross(polygon, following(polygon))
    size2 = float(np.abs(polygon).max()) ** 2
    if swept.sum() <= 1e-12 * size2:
        return f"polygon is not counter-clockwise: its area is {swept.sum() / 2:.3g} m2"
    if cross(side, following(side)).min() < -1e-9 * size2:
        return "polygon is not convex"
    if swept.min() <= 1e-12 * size2:
        return "the centroid is not strictly inside the polygon"
    # a polygon that winds round the origin twice has only left turns, too
    if np.arctan2(swept, (polygon * following(polygon)).sum(axis=1)).sum() > 3.0 * np.pi:
        return "polygon crosses itself"
    off = float(np.abs(centroids(polygon)).max())
    if off > CENTROID_TOLERANCE * np.sqrt(size2):
        return f"the centroid of the polygon is {off:.3g} m from its origin; give vertices about the centroid"
    return ""
