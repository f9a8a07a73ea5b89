"""What analyses and the search for contacts may be told beyond their plain options."""

from limitblocks.analysis.nonassociated.means import Means
from limitblocks.analysis.nonassociated.path_equations import Barrier
from limitblocks.analysis.nonassociated.settings import Settings
from limitblocks.choices import Method, Turning
from limitblocks.geometry import Tolerances

__all__ = ["Barrier", "Means", "Method", "Settings", "Tolerances", "Turning"]


def __dir__() -> list[str]:
    return __all__
