"""Scripts have no suffix: one as a module, without a file of its byte code beside it."""

import sys
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

SCRIPTS = Path(__file__).parents[1] / "scripts"


def script(name):
    loader = SourceFileLoader(f"{name}_script", str(SCRIPTS / name))
    module = module_from_spec(spec_from_loader(loader.name, loader))
    writes, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    sys.modules[loader.name] = module  # its dataclasses look themselves up there
    try:
        loader.exec_module(module)
    finally:
        sys.dont_write_bytecode = writes
        del sys.modules[loader.name]
    return module
