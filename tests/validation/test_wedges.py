"""Wedges between two planes: closed forms that only round friction gives.

A wedge in an upright, level V groove, each plane at the half angle w from the vertical, is pushed along the
groove by alpha times its weight W. Each plane carries N across and the shear force V.

Without dilatancy the wedge moves along the groove, friction points against that, and nothing but N has a
vertical component: 2 N sin w = W, alpha W = 2 mu N, so that alpha = mu / sin w.

Associated: it moves (1, v) along the groove and up. On either plane that is v sin w across and
sqrt(1 + v^2 cos^2 w) along; normality to Coulomb's cone, v sin w = mu sqrt(1 + v^2 cos^2 w), dissipates
nothing, so that alpha W = W v and alpha = mu / sqrt(sin^2 w - mu^2 cos^2 w). Where tan w <= mu it is stuck.

In between, with dilatancy psi, it moves (1, v) with v sin w = psi sqrt(1 + v^2 cos^2 w) =: psi s, and mu N
points against that along either plane: 2 N (sin w - mu v cos^2 w / s) = W and alpha W = 2 mu N / s.

With an octagon whose side faces the slip, V may also have up to mu N tan(pi/8) across the slip, up or down
the plane: 2 N (sin w +- mu tan(pi/8) cos w) = W gives the ends of an interval of load factors.

Pressure and friction may act halfway up the planes, h/2, and the weight at 2 h/3: the wedge slides before it
turns where alpha h/6 < length/2.
"""

from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb

CLOSE = 1e-4
KINDS = [lb.OrdunaLourenco, lb.PointContact]


def groove(joint, half_angle, load_factor):
    length = max(0.5, load_factor)  # three times what sliding before turning needs
    return lb.structures.wedge(joint, half_angle=half_angle, length=length)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("degrees", "friction"), [(20, 0.4), (20, 0.8), (35, 0.8)])
def test_wedge_with_dilatancy_is_stuck_in_a_steep_groove(kind, degrees, friction):
    with pytest.raises(lb.errors.UnlimitedLoad):
        lb.bounds(groove(kind(friction), np.radians(degrees), 10.0))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("share", [0.0, 0.3, 0.7])
@pytest.mark.parametrize(("degrees", "friction"), [(30, 0.3), (30, 0.6), (50, 0.6), (70, 0.4)])
def test_wedge_in_a_groove_with_some_dilatancy(kind, share, degrees, friction):
    sin, cos = np.sin(np.radians(degrees)), np.cos(np.radians(degrees))
    psi = share * friction
    v = psi / np.sqrt(sin**2 - (psi * cos) ** 2)
    s = np.sqrt(1 + (v * cos) ** 2)
    expected = friction / (s * sin - friction * v * cos**2)
    model = groove(kind(friction), np.radians(degrees), expected)
    assert lb.nonassociated(model, dilatancy=psi).load_factor == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize(("degrees", "friction"), [(45, 0.4), (30, 0.6), (60, 0.2)])
def test_the_octagon_leaves_an_interval(degrees, friction):
    w = np.radians(degrees)
    shares = np.tan(np.pi / 8) * np.linspace(-1, 1, 5)  # the ends of a side, and three points between
    model = groove(lb.OrdunaLourenco(friction, slip="paper"), w, 2.0)
    solutions = friction / (np.sin(w) + friction * shares * np.cos(w))
    for load_factor, share in zip(solutions, shares, strict=True):
        assert lb.check_mcp(model, claim(model, load_factor, share)).worst.value < 1e-9
    result = lb.nonassociated(model).load_factor
    assert solutions[-1] * (1 - CLOSE) <= result <= solutions[0] * (1 + CLOSE)


def test_the_circle_leaves_one_number():
    """The claims that hold on the octagon are outside the circle, or do not flow on it."""
    w, mu, share = np.pi / 4, 0.4, 0.1
    model = groove(lb.OrdunaLourenco(mu), w, 2.0)
    assert lb.check_mcp(model, claim(model, mu / np.sin(w), 0.0)).worst.value < 1e-9
    for shift in (share, -share):
        load_factor = mu / (np.sin(w) + mu * shift * np.cos(w))
        assert not lb.check_mcp(model, claim(model, load_factor, shift)).passed


def test_a_polygon_within_the_circle_is_not_safe():
    """A hexagon's corners are on the circle, its sides at cos(pi/6) of it: V = mu N (cos, -+sin)(pi/6)."""
    w, mu = np.pi / 4, 0.4
    # shorter along the groove than up the planes: V1, to which a corner points, is up the planes
    model = lb.structures.wedge(lb.OrdunaLourenco(mu, slip="inner", sides=6), half_angle=w, length=0.5)
    along, across = np.cos(np.pi / 6), -np.sin(np.pi / 6)
    load_factor = mu * along / (np.sin(w) + mu * across * np.cos(w))
    assert load_factor > 1.08 * mu / np.sin(w)
    assert lb.check_mcp(model, claim(model, load_factor, across, along)).worst.value < 1e-9


def claim(model, load_factor, share, along=1.0):
    """Slip along the groove under V = mu N (along, share), the second part against the wedge's sinking."""
    (wedge,) = model.free_blocks
    mu = model.interfaces[0].joint.friction
    N = load_factor * wedge.weight / (2 * mu * along)
    forces, up = [], []  # on the wedge, and the unit vectors up the planes
    for interface in model.interfaces:
        into = interface.axes[2] * (1.0 if interface.block_j == "wedge" else -1.0)
        up.append(np.cross(into, (1.0, 0.0, 0.0)) * np.sign(np.cross(into, (1.0, 0.0, 0.0))[2]))
        forces.append(N * (into - mu * np.array((along, 0.0, 0.0)) + mu * share * up[-1]))
    arms = [interface.centroid - wedge.centroid for interface in model.interfaces]
    turning = np.cross(arms, forces).sum(axis=0)[1]  # balanced by N farther on: bending about `up`
    Q = []
    for interface, force, u in zip(model.interfaces, forces, up, strict=True):
        sign = 1.0 if interface.block_i == "wedge" else -1.0  # +Q acts on block i
        moment = -turning / 2 * u / u[1]
        Q.append(sign * np.concatenate([interface.axes @ force, interface.axes @ moment]))
    rates = np.zeros((len(model.blocks), 6))
    rates[[block.name for block in model.blocks].index("wedge"), 0] = 1.0 / wedge.weight
    return lb.results.Claim(load_factor, np.array(Q), displacement_rates=rates)


# --------------------------------- two planes and a plunging line: Hoek & Bray (1981), Rock Slope Engineering

PLANES = [  # dip and dip direction of both planes, degrees
    ((40, 130), (60, 220)),  # Itasca, verification problem "Sliding wedge" of 3DEC
    ((45, 105), (70, 235)),
    ((50, 100), (60, 220)),
    ((60, 60), (60, 300)),
    ((55, 140), (65, 290)),
]


def upward_normal(plane):
    """East, north, up."""
    dip, towards = np.radians(plane)
    return np.array([np.sin(dip) * np.sin(towards), np.sin(dip) * np.cos(towards), np.cos(dip)])


def intersection(normals):
    """Unit vector down the line of intersection of two planes."""
    line = np.cross(*normals)
    return -line * np.sign(line[2]) / np.linalg.norm(line)


def wedge_between(planes, joints, horizontal):
    """Wedge on two planes, pushed down the line of intersection or towards where it points, in plan."""
    normals = [upward_normal(plane) for plane in planes]
    line = intersection(normals)
    sideways = np.cross(line, (0, 0, 1)) / np.linalg.norm(line[:2])  # to the right of the line
    bisector = sum(normals) / np.linalg.norm(sum(normals))
    plunge = -np.arcsin(line[2])
    model = lb.structures.wedge(
        joints[0],
        half_angle=np.arccos(-normals[0] @ normals[1]) / 2,
        length=4.0,
        plunge=plunge,
        tilt=np.arcsin(bisector @ sideways),
        direction=(1, 0, 0) if horizontal else (np.cos(plunge), 0, -np.sin(plunge)),
    )
    # the left plane dips to the right
    on = dict(zip(("right plane", "left plane"), joints, strict=True))
    if normals[0] @ sideways > 0:
        on = dict(zip(("left plane", "right plane"), joints, strict=True))
    interfaces = [replace(i, joint=on[({i.block_i, i.block_j} - {"wedge"}).pop()]) for i in model.interfaces]
    return replace(model, interfaces=interfaces)


def vector_statics(planes, frictions, horizontal):
    """Load factor of sliding along the line: N_A, N_B and alpha from the balance of forces over W."""
    normals = [upward_normal(plane) for plane in planes]
    line = intersection(normals)
    push = np.array([*line[:2] / np.linalg.norm(line[:2]), 0.0]) if horizontal else line
    columns = [n - mu * line for n, mu in zip(normals, frictions, strict=True)]
    *forces, load_factor = np.linalg.solve(np.column_stack([*columns, push]), (0, 0, 1))
    assert min(forces) > 0.0  # both planes in contact
    return load_factor


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("horizontal", [False, True])
@pytest.mark.parametrize("planes", PLANES)
def test_wedge_on_two_planes(kind, planes, horizontal):
    """Of friction high enough for it to stand, equal on both planes and not."""
    for frictions in ((0.8, 0.8), (0.7, 0.9)):
        expected = vector_statics(planes, frictions, horizontal)
        model = wedge_between(planes, [kind(mu) for mu in frictions], horizontal)
        assert lb.nonassociated(model).load_factor == pytest.approx(expected, abs=CLOSE)


@pytest.mark.parametrize("planes", PLANES)
def test_wedge_factor_is_vector_statics(planes):
    """tan(atan(mu K) - plunge), as the docstring of `wedge` has it, K = cos(tilt) / sin(half angle)."""
    normals = [upward_normal(plane) for plane in planes]
    line, half_angle = intersection(normals), np.arccos(-normals[0] @ normals[1]) / 2
    bisector = sum(normals) / np.linalg.norm(sum(normals))
    cos_tilt = np.linalg.norm(np.cross(bisector, np.cross(line, (0, 0, 1)))) / np.linalg.norm(line[:2])
    K = cos_tilt / np.sin(half_angle)
    expected = np.tan(np.arctan(0.5 * K) + np.arcsin(line[2]))
    assert vector_statics(planes, (0.5, 0.5), True) == pytest.approx(expected, abs=1e-12)
