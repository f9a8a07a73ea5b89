"""Partial factors on loads and strengths, in the notation of the Eurocodes."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any

from limitblocks.errors import ModelError
from limitblocks.joints import Dowel, Joint, Tie
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads.load import number
from limitblocks.model import Model

MOST = 10.0  # several times what codes have: more is a slip, such as per cent


@dataclass(frozen=True)
class PartialFactors:
    """Partial factors in the notation of the Eurocodes; none has a default that a code would have to back.

    Parameters
    ----------
    gamma_G : float
        Multiplies the dead loads, prestress included; 1 or less where they are favourable.
    gamma_Q : float
        Multiplies the live loads.
    gamma_M : float
        Divides cohesion, tensile and compressive strength of joints.
    gamma_phi : float, optional
        Divides the friction coefficient, the tangent of the friction angle; `gamma_M` unless given.
    gamma_S : float, optional
        Divides the strength of ties, strips and dowels, and the resistance of passive fill; needed where the
        model has any.

    Raises
    ------
    ModelError
        If a factor is not a number > 0 and <= 10.
    """

    gamma_G: float
    gamma_Q: float
    gamma_M: float
    gamma_phi: float | None = None
    gamma_S: float | None = None

    def __post_init__(self) -> None:
        for name in ("gamma_G", "gamma_Q", "gamma_M", "gamma_phi", "gamma_S"):
            value = getattr(self, name)
            if value is not None or name not in ("gamma_phi", "gamma_S"):
                object.__setattr__(self, name, number(value, name, "", above=0.0, most=MOST))

    def value(self, name: str) -> float:
        """Value of a factor by its name."""
        return float(getattr(self, name))

    @property
    def of_friction(self) -> tuple[str, float]:
        """Name and value of the factor that divides friction."""
        return ("gamma_M", self.gamma_M) if self.gamma_phi is None else ("gamma_phi", self.gamma_phi)

    def of_strength(self, joint: Joint) -> tuple[str, float]:
        """Name and value of the factor that divides the strengths of a joint.

        Raises
        ------
        ModelError
            A tie, dowel or passive fill without gamma_S.
        """
        if not isinstance(joint, Tie | Dowel):
            return "gamma_M", self.gamma_M
        if self.gamma_S is None:
            raise ModelError(
                "the model has ties, dowels or passive fill: give gamma_S (--gamma-s), which divides their "
                "strength"
            )
        return "gamma_S", self.gamma_S


@dataclass(frozen=True, eq=False, repr=False)
class DesignModel(Model):
    """A model with design loads and strengths; a live load that takes the place of its own has gamma_Q, too.

    Parameters
    ----------
    gamma_Q : float
        What its live load was multiplied by.
    """

    gamma_Q: float = 1.0

    def to_dict(self) -> dict[str, Any]:
        """Return the document of a model, which says what its live load was multiplied by."""
        return super().to_dict() | {"gamma_Q": self.gamma_Q}


def with_design_values(model: Model, gamma_Q: float) -> DesignModel:
    """Return a model, whose loads and strengths have their design values, as one that says so.

    Raises
    ------
    ModelError
        If gamma_Q is not a number > 0 and <= 10.
    """
    gamma_Q = number(gamma_Q, "gamma_Q", "", above=0.0, most=MOST)
    return DesignModel(**{one.name: getattr(model, one.name) for one in fields(Model)}, gamma_Q=gamma_Q)


def live_factor(model: Model) -> float:
    """Return what multiplies a characteristic live load in a model: gamma_Q of a design model, else 1."""
    return model.gamma_Q if isinstance(model, DesignModel) else 1.0


def with_live(model: Model, live: Load) -> Model:
    """Return a model with another characteristic live load; a design model multiplies it by gamma_Q."""
    return replace(model, live=model.gamma_Q * live if isinstance(model, DesignModel) else live)
