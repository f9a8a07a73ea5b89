"""A group of commands that is imported when one of them is asked for, so that --help is quick."""

from __future__ import annotations

from importlib import import_module
from typing import Any, ClassVar

from typer.core import TyperGroup
from typer.main import get_group


class Later(TyperGroup):
    """The commands of the typer app `attribute` in `module`."""

    module: ClassVar[str]
    attribute: ClassVar[str]

    @classmethod
    def of(cls, module: str, attribute: str) -> type[Later]:
        """Return the class for one group, of which typer makes the only instance."""
        return type("Later", (cls,), {"module": module, "attribute": attribute})

    @property
    def commands(self) -> Any:
        """The commands by name."""
        return get_group(getattr(import_module(self.module), self.attribute)).commands

    @commands.setter
    def commands(self, given: Any) -> None:
        """What typer knows of the group: no command yet."""
