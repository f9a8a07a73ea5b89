"""Models of stones put together by hand."""

import limitblocks as lb


def model_of(stones, supports, joint, direction=(1, 0, 0), name=""):
    """Stones with one joint wherever they touch, under their weight, pushed along `direction`."""
    found = lb.find_interfaces(stones, joint)
    return lb.Model(stones, supports, found, lb.self_weight(), lb.mass_proportional(direction), name)
