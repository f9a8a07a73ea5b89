"""Analyses keep BLAS to one thread and give back what the user had, also where they fail or overlap."""

from concurrent.futures import ThreadPoolExecutor
from threading import Event, Thread

import pytest
import threadpoolctl

import limitblocks as lb
from limitblocks.analysis.one_thread import one_thread


def threads():
    return max(one["num_threads"] for one in threadpoolctl.threadpool_info() if one["user_api"] == "blas")


def set_threads(number):
    """In a thread that ends: one that lives would be the only one that may change it."""
    thread = Thread(target=threadpoolctl.threadpool_limits, args=(number, "blas"))
    thread.start()
    thread.join()


@pytest.fixture(autouse=True)
def _of_the_user():
    before = threads()
    set_threads(2)
    if threads() != 2:
        pytest.skip("a BLAS without threads")
    yield
    set_threads(before)


@pytest.mark.parametrize("analysis", [lb.bounds, lb.nonassociated, lb.load_path])
def test_an_analysis_keeps_to_one_thread(analysis):
    met = []
    analysis(
        lb.structures.wall(lb.PointContact(0.5), length=1.2, courses=3),
        progress=lambda _: met.append(threads()),
    )
    assert set(met) == {1}
    assert threads() == 2


@one_thread
def met():
    return threads()


def test_threads_come_back_where_an_analysis_fails():
    @one_thread
    def fails():
        raise lb.ModelError(str(threads()))

    with pytest.raises(lb.ModelError, match="1"):
        fails()
    assert threads() == 2
    assert met() == 1  # the next one is in one thread again


def test_an_analysis_within_another_leaves_it_in_one_thread():
    @one_thread
    def outer():
        return met(), threads()

    assert outer() == (1, 1)
    assert threads() == 2


def test_threads_come_back_where_analyses_overlap():
    """The second begins while the first runs and ends after it."""
    second_runs, first_has_ended = Event(), Event()

    @one_thread
    def second():
        second_runs.set()
        first_has_ended.wait(10)

    @one_thread
    def first():
        running = pool.submit(second)
        assert second_runs.wait(10)
        return running

    with ThreadPoolExecutor(1) as pool:
        running = first()
        first_has_ended.set()
        running.result()
    assert threads() == 2
    assert met() == 1
