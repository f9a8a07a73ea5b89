import matplotlib.pyplot as plt
import pytest


@pytest.fixture(autouse=True)
def no_open_figures():
    """No function leaves a figure open in pyplot; the style of what ran before does not count."""
    before = plt.get_fignums()
    with plt.rc_context():
        plt.style.use("default")
        yield
    assert plt.get_fignums() == before
