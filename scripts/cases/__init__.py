"""Published values and closed forms, each with its source and the analysis that has to reproduce it."""

from cases import arches, by_hand, closed_forms, practice, statics, torsion, walls


def cases():
    """Every case, in the order of the page."""
    makers = (walls.ferris_tin_loi, closed_forms.closed_forms, statics.statics, by_hand.by_hand,
              torsion.torsions, arches.arches, walls.running_bond_walls, practice.practice)  # fmt: skip
    return [case for make in makers for case in make()]
