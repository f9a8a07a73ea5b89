"""The remark on shear that polyhedral friction locks across the slip: one interface, in closed form."""

import numpy as np
import pytest

import limitblocks as lb


def remarks(degrees, slip):
    push = np.radians(degrees)
    model = lb.structures.block(
        lb.OrdunaLourenco(0.2, slip=slip), width=2.0, height=1.0, depth=2.0,
        direction=(np.cos(push), np.sin(push), 0.0),
    )  # fmt: skip
    return [remark for remark in lb.nonassociated(model).remarks if "polyhedral friction locks" in remark]


@pytest.mark.parametrize(("degrees", "off"), [(10, 10), (30, 15), (45.7, 1), (62, 17)])
def test_a_push_between_the_normals_of_the_octagon_is_off_the_slip(degrees, off):
    """It slips along a normal, at a multiple of 45 degrees; the shear is along the push."""
    (remark,) = remarks(degrees, "paper")
    assert f"up to {off} degrees off" in remark


@pytest.mark.parametrize(  # .03 degrees are accuracy
    ("degrees", "slip"), [(0, "paper"), (45, "paper"), (45.03, "paper"), (135, "paper"), (30, "exact")]
)
def test_a_push_along_a_normal_and_round_friction_lock_nothing(degrees, slip):
    assert not remarks(degrees, slip)
