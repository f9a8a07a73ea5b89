"""What a report says beside a result that was read from a file."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from limitblocks.kinds import kind_of
from limitblocks.reports.section import Section

AS_READ = "as the file says, not computed here"
CHECKED = (
    "read from a file: load factor, stresses, mechanism and the equilibrium of steps were checked here anew; "
    "limits, ways and what else is named beside them are what the file says"
)
NOT_JUDGED = (
    "read from a file, which does not hold what it takes to check it: all of it is what the file says"
)


def as_read(made: Section, result: Any) -> Section:
    """Return the section of a result; where that was read it says what was checked here, if anything."""
    if not getattr(result, "from_file", False):
        return made
    kind = kind_of(result)
    if kind and kind.judge:
        return replace(made, warnings=(CHECKED, *made.warnings))
    values = (("Answer of the file", made.headline, AS_READ), *made.values)
    title = f"{made.title}, as a file says"
    made = replace(made, title=title, values=values, judged=None, rates=None)
    made = replace(made, designs=(), upper=None, compared=())
    return replace(made, headline="not checked", warnings=(NOT_JUDGED, *made.warnings))
