"""What is claimed of a model: a load factor with the state that is to prove it, in SI units."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.model import Model, refuse_other
from limitblocks.problem import ASSOCIATED, Turning, turning_of
from limitblocks.shown import Result


@dataclass(frozen=True, eq=False, repr=False)
class Claim(Result):
    """A claimed solution, from any source, in SI units.

    Attributes
    ----------
    load_factor : float
        Load factor.
    stress_resultants : Array, shape (m, 6)
        (V1, V2, N, M1, M2, T) of the model's interfaces, local axes, N and N m; N <= 0 in compression.
    displacement_rates : Array, shape (n, 6), optional
        Of all blocks of the model at their centroids, global axes, m and rad, in the scale in which the live
        load does the work 1 N m, Eq. (55); searched for if missing.
    flow_multipliers : Array, shape (R,), optional
        Of the rows of the limit problem, m, in the same scale; searched for if missing.
    generalised_stresses : Array, shape (s,), optional
        Stresses that the rows act on, N and N m; needed where a joint has inner forces (PointContact).
    dead_load_stresses : Array, shape (s,), optional
        Generalised stresses that carry the dead loads alone; searched for if missing.
    dilatancy : float
        Tangent of the dilatancy angle of the flow; infinite for the associated flow.
    turning : {"centroid", "centre of pressure"}
        What twisting under bending turns about.
    upper : float, optional
        Of bounds: the load factor that the mechanism is to show.
    proven : bool
        Of bounds: whether they are claimed to be theorems, rounding errors included.
    digest : str
        SHA-256 of the model it belongs to; empty if unknown.
    """

    load_factor: float
    stress_resultants: Array
    displacement_rates: Array | None = None
    flow_multipliers: Array | None = None
    generalised_stresses: Array | None = None
    dead_load_stresses: Array | None = None
    dilatancy: float = 0.0
    turning: Turning | str = Turning.CENTROID
    upper: float | None = None
    proven: bool = False
    digest: str = ""

    title: ClassVar[str] = "Claimed solution"

    @property
    def collapse(self) -> Claim:
        """The state at collapse, which is this one."""
        return self

    def __str__(self) -> str:
        upper = "" if self.upper is None else f" to {self.upper:.6g}"
        flow = "associated" if self.dilatancy == ASSOCIATED else "non-associated"
        return f"claimed {flow} load factor {self.load_factor:.6g}{upper}, not checked"

    def to_dict(self) -> dict[str, Any]:
        """Return the claim as plain numbers and lists; as a file it is what was read."""
        said: dict[str, Any] = {"load_factor": self.load_factor, "dilatancy": self.dilatancy}
        said |= {"analysis": "nonassociated", "turning": turning_of(self.turning).value}
        if self.dilatancy == ASSOCIATED:
            said = {"analysis": "bounds", "lower": self.load_factor, "upper": self.upper}
            said |= {"proven": self.proven}
        given = {name: value for name in ARRAYS if (value := getattr(self, name)) is not None}
        arrays = {name: np.asarray(value).tolist() for name, value in given.items()}
        return said | arrays | {"model_digest": self.digest}


ARRAYS = (
    "stress_resultants",
    "displacement_rates",
    "flow_multipliers",
    "generalised_stresses",
    "dead_load_stresses",
)


def claim_of(model: Model, result: Any) -> Claim:
    """Return what `result` claims of `model`; a load path claims its collapse.

    Raises
    ------
    ModelError
        If it is no result, belongs to another model, or a number is missing, of the wrong shape, complex or
        not finite.
    """
    result = getattr(result, "collapse", result)
    missing = [name for name in ("load_factor", "stress_resultants") if not hasattr(result, name)]
    if missing:
        raise ModelError(
            f"{type(result).__name__} has no {' and no '.join(missing)}; expected a Claim, or the result of "
            "bounds, nonassociated or path; of a range, one of its answers (answer.solution.save(file))"
        )
    refuse_other(model, result)
    problem, shapes = model.problem, {}
    stresses, rows = problem.C.shape[0], len(problem.g)
    expected = ((len(model.interfaces), 6), (len(model.blocks), 6), (rows,), (stresses,), (stresses,))
    for name, shape in zip(ARRAYS, expected, strict=True):
        value = getattr(result, name, None)
        shapes[name] = None if value is None else real_array(name, value, shape)
    dilatancy = real_number("dilatancy", getattr(result, "dilatancy", 0.0), infinite=True)
    if dilatancy < 0.0:
        raise ModelError(f"dilatancy is {dilatancy!r}, expected 0 or more; infinite means associated flow")
    if shapes["stress_resultants"] is None:
        raise ModelError("stress_resultants are missing, and a load factor alone cannot be checked")
    upper = getattr(result, "upper", None)
    return Claim(
        load_factor=real_number("load_factor", result.load_factor),
        upper=None if upper is None else real_number("upper", upper),
        proven=bool(getattr(result, "proven", False)),
        dilatancy=dilatancy,
        turning=turning_of(getattr(result, "turning", Turning.CENTROID)),
        digest=str(getattr(result, "digest", "")),
        **shapes,  # type: ignore[arg-type] # the required one is there
    )


def real_array(name: str, value: Any, shape: tuple[int, ...]) -> Array:
    """Return `value` as an array of this shape; raise ModelError unless it is real and finite."""
    array = _real(name, value)
    if array.shape != shape:
        raise ModelError(f"{name} has shape {array.shape}, expected {shape} for this model")
    bad = np.argwhere(~np.isfinite(array))
    if len(bad):
        place = tuple(bad[0].tolist())
        raise ModelError(f"{name}{list(place)} is {array[place]}, expected finite numbers")
    return array


def real_number(name: str, value: Any, infinite: bool = False) -> float:
    """Return `value` as a float; raise ModelError unless it is real and finite, or may be `infinite`."""
    number = _real(name, value)
    if number.shape != () or np.isnan(number):
        raise ModelError(f"{name} is {value!r}, expected a real number")
    if not infinite and not np.isfinite(number):
        raise ModelError(f"{name} is {value!r}, expected a finite number")
    return float(number)


def _real(name: str, value: Any) -> Array:
    """`value` as floats; what numpy would turn into numbers by dropping a part of it is refused."""
    try:
        array = np.asarray(value)
    except (ValueError, TypeError):
        raise ModelError(f"{name} is no array of numbers: its rows differ in length") from None
    if array.dtype.kind not in "fiu" or np.ma.isMaskedArray(value):
        kind = "masked values" if np.ma.isMaskedArray(value) else str(array.dtype)
        raise ModelError(f"{name} holds {kind}, expected real numbers")
    with np.errstate(over="ignore"):  # of longer floats: infinite, and refused as such
        return np.asarray(array, dtype=float)
