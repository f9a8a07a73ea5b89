import facades
import pytest

import limitblocks as lb


@pytest.fixture(scope="session")
def facade():
    return facades.facade()


@pytest.fixture(scope="session")
def answer(facade):
    return lb.nonassociated(facade)
