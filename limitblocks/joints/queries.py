"""Questions to one interface: how strong, how much used, which modes are active, how does it flow.

Works on the same conic rows as the analyses, so that answers and analyses cannot disagree.
"""

from __future__ import annotations

from dataclasses import MISSING, fields
from typing import Any

import numpy as np
import shapely

from limitblocks.arrays import Array, read_only, reals_if_any
from limitblocks.errors import GeometryError, ModelError, refuse_kind
from limitblocks.geometry import Interface
from limitblocks.geometry.polygon import areas
from limitblocks.joints.base import YieldRows, friction_words
from limitblocks.joints.question import OUTSIDE, Question
from limitblocks.joints.torsion import as_region
from limitblocks.problem import Flow, Turning, checked_dilatancy, turning_of


def interface(polygon: Any, joint: object) -> Interface:
    """Return an interface by itself, between blocks "i" and "j", to put questions to its joint.

    Parameters
    ----------
    polygon : array_like, shape (n, 2)
        Convex polygon, m, in either sense; it is moved to its centroid. Its axes are x1 and x2.
    joint : object
        What the interface can carry; a joint of :mod:`limitblocks.joints`.

    Raises
    ------
    GeometryError
        If the polygon is no finite (n >= 3, 2) array, crosses itself, has no area or is not convex.
    """
    shape = as_region(polygon)
    if not shape.convex_hull.area <= shape.area * (1 + 1e-9):
        raise GeometryError("the interface polygon must be convex; divide it into convex ones")
    ring = shapely.get_coordinates(shapely.geometry.polygon.orient(shape).exterior)[:-1]
    about = read_only(ring - shapely.get_coordinates(shape.centroid)[0])
    return Interface("i", "j", read_only(np.zeros(3)), read_only(np.eye(3)), about, joint)


class Queries:
    """Questions that every joint answers, about one interface; `Q` is (V1, V2, N, M1, M2, T), N and N m."""

    def yield_rows(self, polygons: Array, stress_unit: float = 1.0) -> YieldRows:
        """Return the rows of the yield set; see :class:`limitblocks.joints.base.Joint`."""
        raise NotImplementedError

    def in_words(self) -> str:
        """Return the joint as an engineer would say it, with units."""
        return f"{friction_words(float(getattr(self, 'friction', 0.0)))}, {self!r}"

    def assumed(self) -> tuple[str, ...]:
        """Return a sentence for each assumption that the joint makes with these settings."""
        return ()

    def __repr__(self) -> str:
        """Name the settings that differ from their defaults."""
        shown = (
            f"{field.name}={getattr(self, field.name)!r}"
            for field in fields(self)  # type: ignore[arg-type] # every joint is a dataclass
            if field.default is MISSING or getattr(self, field.name) != field.default
        )
        return f"{type(self).__name__}({', '.join(shown)})"

    def strength(self, interface: Interface, direction: Any, given: Any = None) -> float:
        """Return the largest t for which `given` + t `direction` is within the yield set.

        Parameters
        ----------
        interface : Interface
            Its polygon counts, its own joint does not.
        direction : array_like, shape (6,)
            Stress direction of any length, for instance (0, 0, 0, 0, 0, 1) for torsion: t is then in N m.
        given : array_like, shape (6,), optional
            Stress resultants that are there already; none unless given.

        Returns
        -------
        float
            t >= 0; infinite if the interface carries any multiple.

        Raises
        ------
        ModelError
            If `given` is outside the yield set by itself, or the direction is zero or not six numbers.
        """
        d = _six(direction, "direction")
        Q = _six(np.zeros(6) if given is None else given, "given")
        if not d.any():
            raise ModelError("direction is zero; a stress direction (V1, V2, N, M1, M2, T) is needed")
        question = self._question(interface, Q if Q.any() else d)
        step = float(np.abs(d / question.unit).max())
        largest = self._largest(question, Q, d / step)
        if np.isnan(largest):
            raise ModelError(f"the given stress resultants {Q.tolist()} are outside the yield set already")
        return largest / step

    def utilisation(self, interface: Interface, Q: Any) -> float:
        """Return how much of its strength the interface uses at Q: 1 on the surface, > 1 outside.

        It is 1/t, t the largest multiple of (V1, V2, M1, M2, T) that the interface carries under the same
        N, or N over what crushes or tears it by itself, if that is more. Zero without shear, bending and
        torsion, or if they may grow without limit, where N has no limit; infinite if N by itself cannot be
        carried.
        """
        refuse_kind(interface, Interface, "interface")
        Q = _six(Q, "Q")
        held = Q * [0, 0, 1, 0, 0, 0]
        try:
            if not (Q - held).any():
                self.strength(interface, [0, 0, 1, 0, 0, 0], held)
                return normal_share(self, interface, Q[2])
            t = self.strength(interface, Q - held, held)
        except ModelError:
            return np.inf
        return np.inf if t == 0.0 else max(1.0 / t, normal_share(self, interface, Q[2]))

    def active_modes(self, interface: Interface, Q: Any, tolerance: float = 1e-6) -> tuple[str, ...]:
        """Return the names of the failure modes whose yield functions are zero at Q, or above.

        Names: slip, twist, slip-twist, moment-twist, hinge, crush (a hinge of limited compressive
        strength), open. `tolerance` is relative to the largest of the forces, and moments over the square
        root of the area. Nothing is active at Q = 0.
        """
        Q = _six(Q, "Q")
        if not Q.any():
            return ()
        question = self._question(interface, Q)
        return self._active(question, Q, tolerance)

    def flow_directions(
        self, interface: Interface, Q: Any, dilatancy: float = 0.0, turning: Turning | str = Turning.CENTROID
    ) -> Array:
        """Return the flow directions of all yield functions at Q, Tables 3, 5 and 6.

        Parameters
        ----------
        interface : Interface
            Its polygon counts.
        Q : array_like, shape (6,)
            Stress resultants: planes need them for the point of action (e1, e2), cones for the direction.
        dilatancy : float
            Tangent of the dilatancy angle, 0 to friction: zero is the paper's flow, friction the associated
            one, linear in between. Hinging is associated always.
        turning : {"centroid", "centre of pressure"}
            What twisting under bending turns about; the second is the paper's Table 5, with e1 = -M2 / N and
            e2 = M1 / N.

        Returns
        -------
        Array, shape (k, 6)
            (ds1, ds2, dn, dth1, dth2, dthn) per unit multiplier, m/N and 1/(N m) apart; one row for each
            plane and then one for each cone, as in `yield_rows`.

        Raises
        ------
        ModelError
            If the dilatancy is out of range or the turning unknown, or the rows act on forces of points: only
            rigid motions of all points are strain rates.
        """
        Q = _six(Q, "Q")
        question = self._question(interface, Q if Q.any() else np.array([0, 0, -1.0, 0, 0, 0]))
        length = float(np.sqrt(areas(interface.polygon)))
        problem = question.problem
        if problem.resultants.nnz > problem.resultants.shape[1]:
            raise ModelError(
                f"{type(self).__name__} has no flow directions in stress resultants; its rows act on the "
                "forces of points"
            )
        flow = Flow(problem, checked_dilatancy(problem, dilatancy), turning_of(turning))
        x = question.stresses(Q)
        rates = question.flow(flow.matrix(x).toarray() @ problem.resultants.T, x)
        return np.asarray(rates / np.repeat([1.0, length], 3) + 0.0)  # -0.0 becomes 0.0

    def _question(self, interface: Interface, Q: Array) -> Question:
        """Rows of the interface in units of the root of its area and of the size of the stresses Q."""
        refuse_kind(interface, Interface, "interface")
        length = float(np.sqrt(areas(interface.polygon)))
        levers = np.repeat([1.0, length], 3)
        force = float(np.abs(Q / levers).max())
        rows = self.yield_rows(interface.polygon[None] / length, force / length**2)
        return Question(rows, force * levers)

    def _largest(self, question: Question, Q: Array, d: Array) -> float:
        """Largest t with Q + t d within the yield set; NaN if Q is not."""
        x, dx = question.stresses(Q), question.stresses(d)
        if np.isnan(x).any() or question.margins(x).min() < -OUTSIDE:
            return np.nan
        if np.isnan(dx).any():
            return 0.0  # a stress that the interface has no component for
        return question.longest(x, dx)

    def _active(self, question: Question, Q: Array, tolerance: float) -> tuple[str, ...]:
        margins = question.margins(question.stresses(Q))
        named = zip(question.modes, margins, strict=True)
        return tuple(dict.fromkeys(mode for mode, margin in named if not margin > tolerance))


def normal_share(joint: object, interface: Interface, N: float) -> float:
    """Share of its compressive or tensile strength that N, in N, uses by itself; zero without a strength."""
    tension = getattr(joint, "counted_tension", getattr(joint, "tensile_strength", None))
    strength = tension if N > 0.0 else getattr(joint, "compressive_strength", None)
    return abs(N) / float(strength * areas(interface.polygon)) if strength else 0.0


def _six(values: Any, word: str) -> Array:
    array = reals_if_any(values)
    if array.shape != (6,) or not np.isfinite(array).all():
        raise ModelError(f"{word} is {values!r}, expected six finite numbers (V1, V2, N, M1, M2, T)")
    return array
