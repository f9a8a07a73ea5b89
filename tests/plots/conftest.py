import matplotlib.pyplot as plt
import pytest


@pytest.fixture(autouse=True)
def no_open_figures():
    """No function leaves a figure open in pyplot."""
    before = plt.get_fignums()
    yield
    assert plt.get_fignums() == before
