"""What a pinnacle does for a buttress under the thrust of a flyer: it keeps the top course from sliding."""

import pytest

import limitblocks as lb

BREADTH, DEPTH, COURSE, COURSES, GAMMA, MU = 1.5, 0.8, 1.0, 4, 22e3, 0.5
STEEP, HEIGHT = 0.4, 3.4  # fall of the flyer's thrust, and where it meets the inner face
WEIGHT = BREADTH * DEPTH * COURSE * GAMMA  # of a course, N


def by_statics(pinnacle, at):
    """Least horizontal thrust, N, over all beds: it slides off a bed, or turns about its outer edge."""
    found = {}
    for bed in range(COURSES):
        above, lever = (COURSES - bed) * WEIGHT, HEIGHT - bed * COURSE - STEEP * BREADTH
        found["slide", bed] = MU * (above + pinnacle) / (1 - MU * STEEP)
        if lever > 0:
            found["hinge", bed] = (above * BREADTH / 2 + pinnacle * (BREADTH / 2 - at)) / lever
    return min((thrust, mode, bed) for (mode, bed), thrust in found.items())


@pytest.mark.parametrize(
    "joint", [lb.OrdunaLourenco(MU), lb.PointContact(MU)], ids=lambda j: type(j).__name__
)
@pytest.mark.parametrize(
    ("height", "at", "mode", "bed"), [(0.0, 0.0, "slide", 3), (1.0, 0.0, "slide", 3), (3.0, 0.35, "hinge", 0)]
)
def test_a_pinnacle_stops_the_top_from_sliding_until_the_buttress_turns(joint, height, at, mode, bed):
    size, side = (BREADTH, DEPTH, COURSE), 0.8
    blocks = [lb.Block.box("ground", (6, 2, 0.5), (0, 0, -0.25))]
    blocks += [lb.Block.box(f"course {k}", size, (0, 0, (k + 0.5) * COURSE), GAMMA) for k in range(COURSES)]
    if height:
        top = COURSES * COURSE
        blocks.append(lb.Block.box("pinnacle", (side, side, height), (at, 0, top + height / 2), GAMMA))
    flyer = lb.loads.force(f"course {COURSES - 1}", (1, 0, -STEEP), at=(-BREADTH / 2, 0, HEIGHT))
    model = lb.Model(blocks, ["ground"], lb.find_interfaces(blocks, joint), lb.self_weight(), flyer)
    expected, *how = by_statics(side**2 * height * GAMMA, at)
    assert how == [mode, bed]
    found = lb.nonassociated(model)
    assert found.load_factor == pytest.approx(expected, rel=1e-6)
    assert lb.bounds(model).lower == pytest.approx(expected, rel=1e-6)
    states = dict(
        zip((one.name for one in model.interfaces), lb.interface_states(model, found).state, strict=True)
    )
    below = "ground" if bed == 0 else f"course {bed - 1}"
    assert states.pop(f"{below}|course {bed}") == mode
    assert set(states.values()) == {"stick"}
