"""A result is checked where no solver is installed."""

import subprocess
import sys

import limitblocks as lb

SCRIPT = """
import importlib.abc, sys

class NoSolver(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name.split(".")[0] in {"cvxpy", "clarabel", "osqp", "highspy", "scs"}:
            raise ModuleNotFoundError(name)

sys.meta_path.insert(0, NoSolver())
from limitblocks.cli import main
sys.argv = ["limitblocks", *sys.argv[1:]]
main()
"""


def test_check_and_info_need_no_solver(tmp_path):
    model = lb.structures.block(lb.PointContact(0.6), width=0.5, height=1.0)
    file = model.save(tmp_path / "block.json")
    lb.nonassociated(model).save(tmp_path / "result.json")
    for words, code in (
        (["check", file, tmp_path / "result.json"], 0),
        (["info", file], 0),
        (["bounds", file], 1),
    ):
        command = [sys.executable, "-c", SCRIPT, *map(str, words)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == code, done.stderr
