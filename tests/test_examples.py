"""Every example runs, passes its own assertions, and leaves pictures or reports that are not blank."""

import runpy
from pathlib import Path

import numpy as np
import pytest

EXAMPLES = sorted((Path(__file__).parents[1] / "examples").glob("*.py"))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_example(example, tmp_path, monkeypatch, capsys):
    image = pytest.importorskip("matplotlib.image")
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(example))["main"]()
    assert capsys.readouterr().out.strip()
    made = [path for path in tmp_path.rglob("*") if path.suffix in {".png", ".html"}]
    assert made
    for path in made:
        if path.suffix == ".html":
            assert path.stat().st_size > 10_000
        else:
            pixels = image.imread(path)[..., :3]
            assert min(pixels.shape[:2]) > 300
            assert np.ptp(pixels) > 0.5
            assert (pixels.min(axis=2) < 0.9).mean() > 0.01  # enough that is not white
