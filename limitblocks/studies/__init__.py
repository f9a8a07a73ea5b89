"""Many analyses at once: directions, moving loads, parameters, and the least that stands."""

from limitblocks.analysis.sensitivities import shape_sensitivity
from limitblocks.studies.results import Directions, MovingLoad, Study, Sweep
from limitblocks.studies.sample_result import SampledStudy
from limitblocks.studies.sampled import study
from limitblocks.studies.series import directions, moving_load, sweep
from limitblocks.studies.threshold import Threshold, maximum, minimum

__all__ = [
    "Directions",
    "MovingLoad",
    "SampledStudy",
    "Study",
    "Sweep",
    "Threshold",
    "directions",
    "maximum",
    "minimum",
    "moving_load",
    "shape_sensitivity",
    "study",
    "sweep",
]


def __dir__() -> list[str]:
    return __all__
