import facades
import pytest

import limitblocks as lb
from limitblocks.practice import capacity_curve


@pytest.fixture(scope="session")
def facade():
    return facades.facade()


@pytest.fixture(scope="session")
def answer(facade):
    return lb.nonassociated(facade)


@pytest.fixture(scope="session")
def curve(facade):
    wall = facade.free_blocks[0].vertices
    corner = wall[(wall[:, 0] > 0) & (wall[:, 2] > 1)][0]  # above the toe
    return capacity_curve(facade, control=("wall", corner), steps=3)
