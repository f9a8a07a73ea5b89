"""Damaged files of every format, as scripts/mutants makes them: read, or refused in one clean error.

Here are 200 with one seed, in this process; the script reads 20,000 in a process with bounds.
"""

import numpy as np
import pytest
import scripts_as_modules

import limitblocks as lb
from limitblocks.io.formats import WRITTEN

COUNT, SEED = 20, 13
KINDS = [*(f"a{suffix}" for suffix in WRITTEN), "a.gltf", "model.json", "result.json"]


@pytest.fixture(scope="module")
def mutants():
    return scripts_as_modules.script("mutants")


@pytest.fixture(scope="module")
def originals(mutants, tmp_path_factory):
    folder = tmp_path_factory.mktemp("good")
    return {path.name: path for path in mutants.originals(folder)}


@pytest.mark.parametrize("kind", KINDS)
def test_mutants_are_read_or_refused_in_one_clean_error(mutants, originals, tmp_path, monkeypatch, kind):
    # rhino3dm may never return from a damaged file: what it does is tried in a process, in test_io_rhino
    monkeypatch.setattr("limitblocks.io.formats.rhino.trial.fault", lambda path: "is not tried here")
    good = originals[kind].read_bytes()
    assert mutants.read(originals[kind]) == (("refused", "") if kind == "a.3dm" else ("read", ""))
    path = tmp_path / kind
    ends = []
    for k in range(COUNT):
        data = mutants.mutant(good, np.random.default_rng((SEED, k)))
        path.write_bytes(data)
        ends.append(mutants.read(path))
    assert [(k, said) for k, (how, said) in enumerate(ends) if how == "fault"] == []
    assert "refused" in {how for how, _ in ends}


def test_a_reader_that_raises_anything_else_is_a_fault(mutants, originals, monkeypatch):
    def broken(path):
        raise KeyError(path)

    monkeypatch.setattr(lb.files, "read_blocks", broken)
    assert mutants.read(originals["a.obj"])[0] == "fault"
