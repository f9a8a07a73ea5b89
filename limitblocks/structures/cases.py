"""Published values, once: for tests, lessons, the validation page and the benchmark.

Each has its source, the class of its comparison and the tolerance that belongs to it, stated before any run.
What a model of this package is compared with is said where it is built, in `scripts/cases`.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

__all__ = [
    "ARGIENTO",
    "COCCHETTI_RIZZI",
    "FERRIS_TIN_LOI",
    "FERRIS_TIN_LOI_NONASSOCIATED",
    "GOODMAN_BRAY",
    "HEYMAN",
    "MILANKOVITCH",
    "OPPENHEIM",
    "ORDUNA_LOURENCO",
    "PRESTWOOD",
    "STOCKDALE",
    "Comparison",
    "Published",
]


class Comparison(Enum):
    """How much of the source's model is in ours; the text says what a difference consists of."""

    SAME = "same model: digits printed, and where a solution is not unique another one of the same equations"
    IDEALISED = "idealised: the source has a continuum or no sliding, ours finitely many blocks with friction"
    INDICATIVE = "indicative: the source leaves something out that had to be inferred"
    MEASURED = "measured: a test to collapse; accepted is by how much published analyses of it differ"

    @property
    def word(self) -> str:
        """The class in a word or two."""
        return self.value.split(":")[0]


@dataclass(frozen=True)
class Published:
    """A value in print.

    Attributes
    ----------
    value : float
        As printed, in the unit of the source.
    source : str
        Where.
    comparison : Comparison
        Its class.
    tolerance : float
        Largest absolute difference that is accepted.
    """

    value: float
    source: str
    comparison: Comparison
    tolerance: float


_WALLS = "Ferris & Tin-Loi (2001)"
_RING = "Cocchetti & Rizzi (2020), Table 3"

#: Walls 1 to 4, friction 0.65, pushed along: associated load factors; five digits are printed.
FERRIS_TIN_LOI = {
    number: Published(value, _WALLS, Comparison.SAME, 1e-5)
    for number, value in {1: 0.64286, 2: 0.58000, 3: 0.40369, 4: 0.33195}.items()
}
#: The same without dilatancy, by complementarity; not unique, so that 1 % is accepted.
FERRIS_TIN_LOI_NONASSOCIATED = {
    number: Published(value, _WALLS, Comparison.SAME, 0.01 * value)
    for number, value in {1: 0.640, 2: 0.563, 3: 0.356, 4: 0.264}.items()
}
#: Continuous semicircular ring, weights on the centreline: least t/R by friction, thrust over gamma t d R,
#: and the hinge of the haunch, degrees from the crown. For 201 voussoirs.
COCCHETTI_RIZZI = {
    "t/R": {
        friction: Published(value, _RING, Comparison.IDEALISED, 2e-4 * value)
        for friction, value in {0.7: 0.107426, 0.309215: 0.200637}.items()
    },
    "thrust": Published(0.621772, _RING, Comparison.IDEALISED, 2e-3 * 0.621772),
    "haunch": Published(54.50, _RING, Comparison.IDEALISED, 180 / 201),
}
#: Semicircular ring, true centroids: least t/R; four digits are printed.
MILANKOVITCH = Published(0.1075, "Milankovitch (1907)", Comparison.IDEALISED, 5e-5)
#: Two opposite lunes of a hemisphere: least t/R by thrust lines; Heyman has 0.042.
HEYMAN = Published(0.0428, "two-lune solution; Heyman (1967) has 0.042", Comparison.IDEALISED, 1e-4)
#: R = 10 m, t/R = 0.15, 157.5 degrees, 7 voussoirs: horizontal acceleration over g; two digits are printed.
OPPENHEIM = Published(0.37, "Oppenheim (1992)", Comparison.SAME, 0.005)
#: 0.30 m x 0.20 m, friction 0.7, 240 N: torsion, N m, as Fig. 12 draws it.
ORDUNA_LOURENCO = Published(16.3, "Orduña & Lourenço (2005), Fig. 12", Comparison.SAME, 0.05)
#: Running-bond walls of 12 courses as long as high, by height over length of a block. The source does not
#: state the friction, here 0.7, nor the blocks at the ends of the courses.
ARGIENTO = {
    ratio: Published(value, "Argiento, Maione & Casapulla (2018)", Comparison.INDICATIVE, 0.03 * value)
    for ratio, value in {"1/3": 0.68, "1": 0.26}.items()
}
#: Ring of 27 curved voussoirs without sliding, point load at the eighth joint, kN: their program has 2.751,
#: their virtual powers 2.756 (.2 %); voussoirs with straight edges are lighter by .23 %. As quoted by others.
STOCKDALE = Published(2.751, "Stockdale et al. (2018), KCLC", Comparison.IDEALISED, 0.0043 * 2.751)
#: Prestwood bridge with its fill, line load at the quarter span, kN. Published analyses of the test, as
#: quoted by others: 220 kN (Zampieri et al. 2020) and 245 kN (Simoncello et al. 2020), which are 25 kN apart.
PRESTWOOD = Published(228.0, "Page (1987), TRRL RR 110, tested", Comparison.MEASURED, 25.0)
#: Slope of 16 blocks that topple and slide: friction at limit equilibrium; four digits are printed.
#: Also in D. C. Wyllie, C. W. Mah, Rock Slope Engineering (2004), Section 9.4.3.
GOODMAN_BRAY = Published(0.7855, "Goodman & Bray (1976)", Comparison.SAME, 5e-5)
