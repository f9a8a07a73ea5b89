"""Analyses keep BLAS to one thread and give back what the user had, also where they fail."""

import pytest
import threadpoolctl

import limitblocks as lb
from limitblocks.analysis.one_thread import one_thread


def threads():
    return max(one["num_threads"] for one in threadpoolctl.threadpool_info() if one["user_api"] == "blas")


@pytest.fixture(autouse=True)
def _of_the_user():
    with threadpoolctl.threadpool_limits(2, user_api="blas"):
        if threads() != 2:
            pytest.skip("a BLAS without threads")
        yield


@pytest.mark.parametrize("analysis", [lb.bounds, lb.nonassociated, lb.load_path])
def test_an_analysis_keeps_to_one_thread(analysis):
    met = []
    analysis(
        lb.structures.wall(lb.PointContact(0.5), length=1.2, courses=3),
        progress=lambda _: met.append(threads()),
    )
    assert set(met) == {1}
    assert threads() == 2


def test_threads_come_back_where_an_analysis_fails():
    @one_thread
    def fails(_model):
        raise lb.ModelError(str(threads()))

    with pytest.raises(lb.ModelError, match="1"):
        fails(lb.structures.wall(lb.PointContact(0.5), length=1.2, courses=3))
    assert threads() == 2
