"""What the documentation takes from the package at every build: commands, public names, list of pages; maths.

A page asks for it with a comment on a line of its own, such as `<!-- commands -->`.
"""

import inspect
import re
from enum import Enum
from pathlib import Path

import click
import typer.main
from docutils.nodes import SkipNode
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.util.logging import getLogger

import limitblocks as lb
from limitblocks.cli import app as command_line

HERE = Path(__file__).parent
MARK = re.compile(r"^<!-- (\w+)(?: (\S+))? -->$", re.MULTILINE)
BARS = re.compile(r"\|+\w+\|+(?![^`]*`(?:[^`]*`[^`]*`)*[^`]*$)")  # outside `code`
FIXED = re.compile(r"^([\w/-]+)$", re.MULTILINE)  # pages that the index names


def pages():
    """Every page that the index does not name itself, so that a new one needs no line anywhere.

    Of a folder with an index, only that: it lists the others.
    """
    named = {"index", *FIXED.findall((HERE / "index.md").read_text(encoding="utf-8"))}
    found = (file.relative_to(HERE).with_suffix("").as_posix() for file in sorted(HERE.rglob("*.md")))
    return "\n".join(page for page in found if page not in named and not _listed_in_its_folder(page))


def _listed_in_its_folder(page):
    folder = (HERE / page).parent
    return folder != HERE and not page.endswith("/index") and (folder / "index.md").exists()


def commands():
    """Every command with its help as the user sees it."""
    return "\n".join(_command(typer.main.get_command(command_line), "limitblocks", None))


def _command(command, name, parent):
    settings = {**command.context_settings, "max_content_width": 96, "terminal_width": 96}
    context = click.Context(command, info_name=name, parent=parent, **settings)
    level = "#" * min(2 + context.command_path.count(" "), 4)
    yield f"{level} {context.command_path}\n\n```text\n{command.get_help(context)}\n```\n"
    for part in getattr(command, "commands", {}).items():
        yield from _command(part[1], part[0], context)


def api(module_name):
    """Every public name of a module: a table, and all that its docstring says."""
    module = lb if module_name == "limitblocks" else getattr(lb, module_name.split(".")[1], None)
    if module is None:
        return "Not part of this version."
    public = getattr(module, "__all__", [])
    if not public:
        return _constants(module)
    kinds = {"Functions": [], "Classes": [], "Errors": []}
    above = [] if module is lb else [n for n in public if getattr(lb, n, None) is getattr(module, n)]
    for name in sorted(set(public) - set(above), key=str.lower):
        thing = getattr(module, name)
        if inspect.isclass(thing):
            kinds["Errors" if issubclass(thing, Exception) else "Classes"].append((name, _class(thing)))
        elif callable(thing):
            kinds["Functions"].append((name, ["autofunction"]))
        elif not inspect.ismodule(thing):
            kinds["Classes"].append((name, ["autodata", "   :no-value:"]))
    groups = [_group(module_name, kind, names) for kind, names in kinds.items() if names]
    target = f"```{{eval-rst}}\n.. py:module:: {module_name}\n```\n"
    also = f"Also here: {', '.join(f'`{name}`' for name in above)}, see above.\n" if above else ""
    return "\n".join([target, also, *groups])


def _group(module, title, entries):
    listed = "\n".join(f"   {name}" for name, _ in entries)
    table = f".. currentmodule:: {module}\n\n.. autosummary::\n   :nosignatures:\n\n{listed}\n"
    body = "\n\n".join(
        "\n".join([f".. {directive} :: {module}.{name}".replace(" ::", "::"), *options])
        for name, (directive, *options) in entries
    )
    return f"### {title}\n\n```{{eval-rst}}\n{table}\n{body}\n```\n"


def _class(thing):
    """Directive and options: the public members that the package itself defines, inherited ones included."""
    if issubclass(thing, Exception):
        return ["autoexception"]
    own = (part for part in thing.__mro__ if part.__module__.startswith("limitblocks"))
    names = [name for part in own for name, value in vars(part).items() if _documented(name, value)]
    if issubclass(thing, Enum):
        names = [member.name for member in thing]
    members = [f"   :members: {', '.join(dict.fromkeys(names))}", "   :inherited-members:"] if names else []
    return ["autoclass", *members]


def _documented(name, value):
    value = getattr(value, "__func__", value)
    return (
        not name.startswith("_") and (callable(value) or isinstance(value, property)) and bool(value.__doc__)
    )


def _constants(module):
    """Table of the numbers of a module."""
    numbers = {name: value for name, value in vars(module).items() if isinstance(value, float)}
    rows = "\n".join(f"| `{name}` | {value!r} |" for name, value in numbers.items())
    return f"{inspect.getdoc(module)}\n\n| name | value |\n|---|---|\n{rows}\n"


def _fill(_app, _page, source):
    makers = {"pages": pages, "commands": commands, "api": api}

    def made(match):
        name, argument = match.groups()
        return makers[name](*filter(None, [argument])) if name in makers else match[0]

    source[0] = MARK.sub(made, source[0])


def _bars(_app, _what, _name, _thing, _options, lines):
    """Keep |N| in a docstring from being read as a substitution."""
    lines[:] = [BARS.sub(lambda bars: bars[0].replace("|", r"\|"), line) for line in lines]


def _inline_maths(writer, node):
    writer.body.append(_mathml(node, block=False))
    raise SkipNode


def _block_maths(writer, node):
    writer.body.append(f'<div class="math">{_mathml(node, block=True)}</div>')
    raise SkipNode


def _mathml(node, block):
    try:
        return tex2mathml(node.astext(), as_block=block)
    except MathError as error:
        getLogger(__name__).warning("maths: %s: %s", error, node.astext(), location=node)
        return ""


def setup(app):
    """Register the pages' comments and the maths with Sphinx."""
    app.connect("source-read", _fill)
    app.connect("autodoc-process-docstring", _bars)
    app.add_html_math_renderer("mathml", (_inline_maths, None), (_block_maths, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
