import json
import sys
from types import SimpleNamespace

import pytest
from portal_by_hand import PORTAL, solved, walked

import limitblocks as lb
import limitblocks.studies.pool  # keeps the analyses that are there when it is loaded: no fakes


@pytest.fixture
def solver(monkeypatch):
    """Puts analyses of known outcome in place of the real ones."""

    def put(nonassociated=solved, load_path=walked):
        fakes = {"loop": {"nonassociated": nonassociated}, "load_path": {"load_path": load_path}}
        for name, fake in fakes.items():
            module = f"limitblocks.analysis.nonassociated.{name}"
            monkeypatch.setitem(sys.modules, module, SimpleNamespace(**fake))

    put()
    return put


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "portal.json"
    path.write_text(json.dumps(PORTAL))
    return path


@pytest.fixture
def result(file, tmp_path):
    return lb.files.write_result(solved(lb.read(file)), tmp_path / "result.json")
