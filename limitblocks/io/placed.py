"""What a reader finds in a file, and where it is: unit of length, axis up, both as stated or guessed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.io import guesses
from limitblocks.io.guesses import Boxes
from limitblocks.io.solid import Solid, corners
from limitblocks.io.units import METRES

#: Metres per unit of length.
UNITS = {name: float(metres) for name, metres in METRES.items()}
SAME = 1e-5  # of a unit: a foot of the survey is a foot
#: From axes with Y up to axes with Z up.
Z_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


class Contents(NamedTuple):
    """What a reader finds in a file: solids, metres per unit and the axis up where it says so, notes.

    `wrong` says of parts of the file, by name, why they are no solids; `left_out` names others that may be
    meant as blocks, such as what is hidden. `drawn` is what the unit is guessed by where the solids have
    dimensions that are not in it.
    """

    solids: Sequence[Solid]
    metres: float | None = None
    notes: Sequence[str] = ()
    up: str | None = None
    wrong: Mapping[str, Sequence[str]] = MappingProxyType({})
    left_out: Sequence[str] = ()
    drawn: Sequence[Solid] = ()


class Frame(NamedTuple):
    """Metres per unit of a file, its axis up, and what of these was guessed."""

    metres: float
    up: str
    warnings: tuple[str, ...]


def metres(units: str | None, stated: float | None = None) -> float:
    """Return metres per unit: those of `units`, else what the file states, else 1.

    Raises
    ------
    ModelError
        `units` is unknown.
    """
    if units is None:
        return 1.0 if stated is None else stated
    if units not in tuple(UNITS):  # a list has no hash
        raise ModelError(f"units are {units!r}; expected one of {', '.join(UNITS)}")
    return UNITS[units]


def frame(contents: Contents, units: str | None, up: str | None) -> Frame:
    """Return unit and axis up of a file: as given, else as the file says, else m and Z or what is likelier.

    Raises
    ------
    ModelError
        An unknown unit or axis.
    """
    per_unit, axis = metres(units, contents.metres), up or contents.up or "z"
    warnings = []
    upright(axis)
    solids = contents.drawn or contents.solids
    points = [corners(solid) for solid in solids]
    sound = [k for k, one in enumerate(points) if len(one) and np.abs(one).max() < 1e30]
    words = [(solids[k].name, solids[k].layer) for k in sound]
    boxes = Boxes.of([points[k] for k in sound], words) if sound else None
    unit = guesses.unit(boxes) if boxes and units is None and contents.metres is None else None
    if unit:
        per_unit = UNITS[unit[0]]
        warnings.append(unit[1])
    said = guesses.of_stated(boxes, contents.metres) if boxes and units is None and contents.metres else ""
    warnings += [said] * bool(said)
    if boxes and units and contents.metres and abs(per_unit / contents.metres - 1.0) > SAME:
        near = (name for name, value in UNITS.items() if abs(value / contents.metres - 1.0) <= SAME)
        stated = next(near, f"{contents.metres:g} m")
        size = f"{per_unit * boxes.size:.4g} m large, not {contents.metres * boxes.size:.4g} m"
        warnings.append(
            f"says that its unit is {stated}: taken in {units}, as asked, the structure is {size}"
        )
    coarse = guesses.of_single_precision([points[k] for k in sound], boxes.length, per_unit) if boxes else ""
    warnings += [coarse] * bool(coarse)
    why = guesses.tilted(boxes, axis) if boxes and up is None else ""
    if why and contents.up is None:
        axis = "y"
        warnings.append(f"does not say which axis points up; taken as Y: {why}; say up='y' or 'z' (--up)")
    elif why:
        other = "z" if axis == "y" else "y"
        warnings.append(f"seems to lie on its side: {why}; if so, say up={other!r} (--up {other})")
    return Frame(per_unit, axis, tuple(warnings))


def upright(up: str) -> Array:
    """Return the matrix (3, 3) that turns rows of coordinates to Z up."""
    if up not in ("y", "z"):
        raise ModelError(f"up is {up!r}; expected 'y' or 'z'")
    return Z_UP.T if up == "y" else np.eye(3)
