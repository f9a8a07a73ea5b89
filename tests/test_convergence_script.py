"""The script that counts how often the analysis converges: its limits of time and its counts."""

import contextlib

import pytest
import scripts_as_modules

import limitblocks as lb
from matrix import Case


@pytest.fixture(scope="module")
def script():
    return scripts_as_modules.script("convergence")


@pytest.mark.parametrize(
    ("limit", "times", "limits"),
    [
        (60.0, 40.0, [60.0, 80.0]),
        (60.0, 10.0, [60.0, 60.0]),
        (None, 40.0, [None, 80.0]),
        (None, None, [None, 0.0]),
    ],
)
def test_a_case_is_stopped_after_seconds_or_times_its_bounds(script, limit, times, limits, monkeypatch):
    """Bounds that take 2 s allow 80 s at 40 times; the limit in seconds holds for the bounds alone."""
    clock, given = iter([0.0, 2.0, 2.0]), []

    @contextlib.contextmanager
    def noted(seconds):
        given.append(seconds)
        yield

    def pressed(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(script, "interrupted_after", noted)
    monkeypatch.setattr(script.time, "thread_time", lambda: next(clock))
    monkeypatch.setattr(lb, "bounds", lambda _: None)
    monkeypatch.setattr(lb, "nonassociated", pressed)
    joint = lb.PointContact(0.6)
    case = Case("block", joint, "along", lb.structures.block(joint, width=1.0, height=1.0))
    row, good, ratio = script.limited(case, seconds=limit, times=times)
    assert given == limits
    assert (row[-1], good, ratio) == ("STOPPED", False, None)


def test_a_table_says_how_many_cases_are_within_times_their_bounds(script, tmp_path):
    """Three of five converge, two of them within 40 times; what was written before counts as well."""
    cells = ["0.6", "along", "100", *[""] * 6, "1.00", "0.10"]
    rows = [
        (["a", "no crushing", *cells, "39.9", "converged"], True, 39.9),
        (["b", "no crushing", *cells, "40.0", "exact within 0.0001"], True, 40.0),
        (["c", "no crushing", *cells, "41.0", "converged"], True, 41.0),
        (["d", "no crushing", *cells, "10.0", "STOPPED"], False, 10.0),
        (["e", "no crushing", *cells, "", "STOPPED"], False, None),
    ]
    page = tmp_path / "page.md"
    stops = script.stopping(60.0, 40.0)
    script.markdown(rows, page, " --large", 5, stops=stops, times=40.0)
    text = page.read_text(encoding="utf-8")
    assert "An analysis is stopped after 60 s of CPU time or 40 times its bounds, whichever is more." in text
    assert (
        "Converged 3 of 5 (60.0 %), 2 of them in at most 40 times the time of the bounds; time over" in text
    )
    kept = script.kept(page, {("e", "no crushing", "0.6", "along")}, script.COLUMNS)
    assert script.summary(kept, 40.0).startswith("converged 3 of 4 (75.0 %), 2 of them in at most 40 times")
    assert script.summary(kept).startswith("converged 3 of 4 (75.0 %); time over that of the bounds: median")
    assert script.stopping(None, None) == ""
