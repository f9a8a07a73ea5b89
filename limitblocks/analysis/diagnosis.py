"""What is worth a look in a model: numbers hardly meant, and what its interfaces lack."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

from limitblocks.analysis.magnitudes import questions
from limitblocks.analysis.uncarried import uncarried, uncarried_words
from limitblocks.errors import few
from limitblocks.geometry import Contacts, Interface, NearMiss, Overlap, Sliver, Through, find_contacts
from limitblocks.geometry.accuracy import Accuracy, chosen
from limitblocks.geometry.off_faces import off_faces
from limitblocks.model import Model, checked_model
from limitblocks.shown import many

_Pair = TypeVar("_Pair", Interface, NearMiss, Overlap, Sliver, Through)


@dataclass(frozen=True, repr=False)
class Diagnosis(Contacts):
    """What is worth a look in a model: its numbers, and what its blocks show; see :class:`Contacts`.

    Attributes
    ----------
    interfaces : tuple of Interface
        Contacts of blocks between which the model has no interface; their joint is None.
    near_misses, slivers, strips, through
        Of blocks between which the model has no interface.
    overlaps : tuple of Overlap
    isolated : tuple of str
        Blocks that touch no other and have no interface.
    off_faces : tuple of str
        Interfaces that lie on no face of a block of theirs beyond the tolerances, with distance and angle.
    uncarried : tuple of str
        Free blocks that no interface pushes or pulls against their dead load: friction alone holds them, if
        anything.
    questions : tuple of str
        What is asked about numbers and loads of the model that are hardly meant, with what probably was.
    """

    off_faces: tuple[str, ...] = ()
    uncarried: tuple[str, ...] = ()
    questions: tuple[str, ...] = ()

    @property
    def warnings(self) -> list[str]:
        """A line for each question, for each kind of thing found, and for each overlap."""
        return [*self.questions, *self._found]

    @property
    def _found(self) -> list[str]:
        pairs = dict.fromkeys(one.name for one in self.interfaces)
        missing = self._line("no interface between blocks that touch", tuple(pairs))
        return missing + off_words(self.off_faces) + uncarried_words(self.uncarried) + super()._found

    def __str__(self) -> str:
        asked = f"{many(len(self.questions), 'question')}; " if self.questions else ""
        return f"{asked}beside the interfaces of the model: {super().__str__()}"


def diagnose(
    model: Model, *, gap: float | None = None, angle: float | None = None, width: float | None = None
) -> Diagnosis:
    """Return what is worth a look in `model` before it is analysed: numbers hardly meant, contacts missing.

    Its numbers are those that reports and the command line ask about. Of its blocks it is what they show that
    the interfaces do not; nothing between two supports. `warnings` says all of it, a line each.

    Parameters
    ----------
    model : Model
    gap, angle, width : float, optional
        Tolerances of :func:`limitblocks.find_interfaces`; left out, those that the model was made with
        (`Model.tolerances`), and where it says none, chosen by the accuracy of its faces.

    Raises
    ------
    ModelError
        A tolerance is out of range, or an interface has something else for a joint.
    """
    own = checked_model(model).tolerances
    if own is not None:
        gap, angle, width = (
            mine if asked is None else asked
            for mine, asked in ((own.gap, gap), (own.angle, angle), (own.width, width))
        )
    contacts = find_contacts(model.blocks, None, gap=gap, angle=angle, width=width)
    supports = set(model.supports)
    tied = {frozenset((one.block_i, one.block_j)) for one in model.interfaces}
    ends = {name for pair in tied for name in pair}

    def loose(items: tuple[_Pair, ...]) -> tuple[_Pair, ...]:
        return tuple(one for one in items if frozenset((one.block_i, one.block_j)) not in tied)

    def free(items: tuple[_Pair, ...]) -> tuple[_Pair, ...]:
        return tuple(one for one in items if not {one.block_i, one.block_j} <= supports)

    return Diagnosis(
        interfaces=free(loose(contacts.interfaces)),
        near_misses=free(loose(contacts.near_misses)),
        overlaps=free(contacts.overlaps),
        isolated=tuple(name for name in contacts.isolated if name not in ends),
        slivers=free(loose(contacts.slivers)),
        strips=free(loose(contacts.strips)),
        through=free(contacts.through),
        tolerances=contacts.tolerances,
        length=contacts.length,
        chosen=contacts.chosen,
        off_faces=off_faces(model.blocks, model.interfaces, contacts.tolerances),
        uncarried=uncarried(model, contacts.tolerances),
        questions=tuple(questions(model)),
    )


def astray(model: Model) -> list[str]:
    """Return the line that names interfaces of `model` off the faces of its blocks; none where none are."""
    found = off_faces(model.blocks, model.interfaces, model.tolerances or chosen(None, None, None))
    if found and model.tolerances is None:  # of inaccurate blocks they may be as near as can be told
        used = chosen(None, None, None, Accuracy.shown(model.blocks))
        found = off_faces(model.blocks, model.interfaces, used)
    return off_words(found)


def off_words(found: tuple[str, ...]) -> list[str]:
    """Return the line that says which interfaces are off the faces; none where none are."""
    return [f"interfaces off the faces of their blocks: {few(found)}"] if found else []
