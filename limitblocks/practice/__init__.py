"""What practice asks: ties, settlement, capacity curve, verification, vehicles, water, repair."""

from limitblocks.practice.adequacy import adequacy, design_model
from limitblocks.practice.adequacy_result import Adequacy, DesignValue
from limitblocks.practice.backfill import passive_fill
from limitblocks.practice.capacity import capacity_curve
from limitblocks.practice.capacity_result import CapacityCurve, CapacityPoint, Control
from limitblocks.practice.collapse import settlement_to_collapse
from limitblocks.practice.collapse_result import SettlementCurve, SettlementPoint
from limitblocks.practice.elements import Element, dowel, reinforced, strip, tie
from limitblocks.practice.moving_masses import MovingMass
from limitblocks.practice.partial_factors import PartialFactors
from limitblocks.practice.repair import Repair, least_masses, least_ties
from limitblocks.practice.rocking import Rocking, elastic_period, element_acceleration, element_force
from limitblocks.practice.settlement import Settlement, settlement
from limitblocks.practice.settling import Settling, settling
from limitblocks.practice.spectra import Floor, FloorMode, Spectrum
from limitblocks.practice.vehicles import Deck, Vehicle, vehicle_load
from limitblocks.practice.verification import verification
from limitblocks.practice.verification_result import Inequality, Quantity, Verification
from limitblocks.practice.water import uplift
from limitblocks.practice.worst_position import WorstPosition, worst_position

__all__ = [
    "Adequacy",
    "CapacityCurve",
    "CapacityPoint",
    "Control",
    "Deck",
    "DesignValue",
    "Element",
    "Floor",
    "FloorMode",
    "Inequality",
    "MovingMass",
    "PartialFactors",
    "Quantity",
    "Repair",
    "Rocking",
    "Settlement",
    "SettlementCurve",
    "SettlementPoint",
    "Settling",
    "Spectrum",
    "Vehicle",
    "Verification",
    "WorstPosition",
    "adequacy",
    "capacity_curve",
    "design_model",
    "dowel",
    "elastic_period",
    "element_acceleration",
    "element_force",
    "least_masses",
    "least_ties",
    "passive_fill",
    "reinforced",
    "settlement",
    "settlement_to_collapse",
    "settling",
    "strip",
    "tie",
    "uplift",
    "vehicle_load",
    "verification",
    "worst_position",
]


def __dir__() -> list[str]:
    return __all__
