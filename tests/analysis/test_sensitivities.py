"""Derivatives of the load factor: closed forms, and differences of bounds solved again."""

import json
from dataclasses import replace

import numpy as np
import pytest
from stones import model_of

import limitblocks as lb
from limitblocks import structures
from limitblocks.errors import LimitBlocksError, ModelError
from limitblocks.studies import shape_sensitivity

WIDTH, HEIGHT, MU = 1.0, 2.0, 0.7
JOINTS = {"points": lb.PointContact, "circle": lb.OrdunaLourenco}


def block(joint, **sizes):
    return structures.block(joint, **({"width": WIDTH, "height": HEIGHT} | sizes))


def of(model):
    return lb.sensitivities(model, lb.bounds(model))


def differences(build, value, step):
    """Central difference of the load factor of models solved again."""
    ahead, back = (lb.bounds(build(value + t * step)).lower for t in (1.0, -1.0))
    return (ahead - back) / (2.0 * step)


@pytest.mark.parametrize("joint", JOINTS.values(), ids=JOINTS)
def test_a_block_that_slides_follows_its_friction_alone(joint):
    """a = mu: da/dmu = 1; of the weight and of the shape it is independent."""
    model = block(joint(0.3))
    found = of(model)
    assert found.friction == pytest.approx([1.0], rel=1e-6)
    assert np.abs(found.of_blocks).max() < 1e-6
    wider = shape_sensitivity(model, lb.bounds(model), lambda r: r * [1.0, 0.0, 0.0])
    assert wider == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("joint", JOINTS.values(), ids=JOINTS)
def test_a_block_that_rocks_follows_its_shape_alone(joint):
    """a = b / h (Housner 1963): da/db = 1 / h, da/dh = -b / h^2; friction and weight do not matter."""
    model = block(joint(MU))
    bounds = lb.bounds(model)
    found = lb.sensitivities(model, bounds)
    assert np.abs(found.of_interfaces).max() < 1e-6
    assert np.abs(found.of_blocks).max() < 1e-6
    assert found.unique
    # all x scaled by 1 + t: db/dt = b
    wider = shape_sensitivity(model, bounds, lambda r: r * [1.0, 0.0, 0.0])
    assert wider == pytest.approx(WIDTH / HEIGHT, rel=1e-6)
    base = 0.0  # the block stands on z = 0
    higher = shape_sensitivity(model, bounds, lambda r: (r - [0, 0, base]) * [0.0, 0.0, 1.0])
    assert higher == pytest.approx(-WIDTH / HEIGHT, rel=1e-6)


def test_a_push_at_a_point_of_a_rocking_block():
    """a P z = W b / 2: da/dz = -W b / (2 P z^2), da/dW = b / (2 P z)."""
    z, push = 1.5, 1000.0
    model = block(lb.PointContact(2.0))
    name = model.free_blocks[0].name
    model = replace(model, live=lb.loads.force(name, (push, 0.0, 0.0), (0.0, 0.0, z)))
    found, weight = of(model), model.free_blocks[0].weight
    alpha = weight * WIDTH / (2.0 * push * z)
    assert found.load_factor == pytest.approx(alpha, rel=1e-6)
    (position,) = found.positions
    assert (position.load, position.block) == ("live", name)
    assert position.gradient == pytest.approx([0.0, 0.0, -alpha / z], rel=1e-6, abs=1e-6 * alpha)
    assert found.of_blocks.sum() == pytest.approx(alpha, rel=1e-6)


def test_a_block_without_weight_has_a_derivative_by_it():
    """A stone of volume V under a dead force D: a P z = (D + w V) b / 2, so that da/dw = V b / (2 P z)."""
    z, push, laid = 1.5, 1000.0, 40e3
    model = block(lb.PointContact(2.0))
    (name,) = (own.name for own in model.free_blocks)
    light = tuple(own.labelled(unit_weight=0.0) if own.name == name else own for own in model.blocks)
    volume, at = model.free_blocks[0].volume, model.free_blocks[0].centroid
    dead = lb.self_weight() + lb.loads.force(name, (0.0, 0.0, -laid), at)
    model = replace(
        model, blocks=light, dead=dead, live=lb.loads.force(name, (push, 0.0, 0.0), (0.0, 0.0, z))
    )
    found = of(model)
    assert found.load_factor == pytest.approx(laid * WIDTH / (2.0 * push * z), rel=1e-6)
    assert found.unit_weight.sum() == pytest.approx(volume * WIDTH / (2.0 * push * z), rel=1e-6)


def test_a_block_that_slides_on_mortar():
    """a W = mu W + A c: da/dc = A / W, da/dmu = 1, da/d(unit weight) = -A c / (W unit weight)."""
    c = 3e3
    model = block(lb.OrdunaLourenco(0.2, cohesion=c, tensile_strength=1e6), height=0.5)
    found, stone = of(model), model.free_blocks[0]
    area = stone.volume / 0.5
    assert found.cohesion == pytest.approx([area / stone.weight], rel=1e-5)
    assert found.friction == pytest.approx([1.0], rel=1e-5)
    assert found.of_blocks.sum() == pytest.approx(-area * c / stone.weight, rel=1e-4)


def test_a_block_that_crushes_at_its_toe():
    """a W h / 2 = W (b - W / (t f)) / 2, the stress block at the toe (t the depth): da/df = W / (h t f^2)."""
    f, depth = 3e5, 1.0
    model = block(lb.OrdunaLourenco(MU, compressive_strength=f), depth=depth)
    weight = model.free_blocks[0].weight
    found = of(model)
    assert found.load_factor == pytest.approx((WIDTH - weight / (depth * f)) / HEIGHT, rel=1e-6)
    assert found.compressive_strength == pytest.approx([weight / (HEIGHT * depth * f**2)], rel=1e-4)


@pytest.mark.parametrize(
    "joint", [lb.OrdunaLourenco(0.65), lb.OrdunaLourenco(0.65, slip="paper"), lb.PointContact(0.65)]
)
def test_differences_of_bounds_solved_again(joint):
    """A wall that slides and rocks: derivatives against two more solutions, 1e-4 relative."""
    model = structures.ferris_tin_loi_wall(1, joint)
    found = of(model)
    assert found.unique

    def rougher(mu):
        return structures.ferris_tin_loi_wall(1, replace(joint, friction=mu))

    # the load factor as a function of one friction for all joints
    assert found.friction.sum() == pytest.approx(differences(rougher, 0.65, 1e-3), rel=1e-4)
    b = int(np.abs(found.of_blocks).argmax())

    def heavier(weight):
        blocks = [replace(one, unit_weight=weight) if k == b else one for k, one in enumerate(model.blocks)]
        return replace(model, blocks=blocks)

    weight = model.blocks[b].unit_weight
    assert found.unit_weight[b] == pytest.approx(differences(heavier, weight, 1e-2 * weight), rel=1e-4)


def with_friction(model, k, friction):
    changed = list(model.interfaces)
    changed[k] = replace(changed[k], joint=replace(changed[k].joint, friction=friction))
    return replace(model, interfaces=changed)


def sides(model, k, friction, step=1e-3):
    """Derivatives to both sides by the friction of one joint, of bounds solved again."""
    below, at, above = (
        lb.bounds(with_friction(model, k, friction + t * step)).lower for t in (-1.0, 0.0, 1.0)
    )
    return (at - below) / step, (above - at) / step


@pytest.mark.parametrize("joint", JOINTS.values(), ids=JOINTS)
def test_a_friction_that_stresses_do_not_agree_on_has_a_kink(joint):
    """A beam that slides on three supports: the one in the middle carries anything from nothing to all."""
    stones = [lb.Block.box(f"support {x}", (0.5, 1.0, 1.0), (x, 0.0, -0.5)) for x in (-2.0, 0.0, 2.0)]
    stones.append(lb.Block.box("beam", (4.5, 1.0, 0.4), (0.0, 0.0, 0.2), unit_weight=2e4))
    model = model_of(stones, [one.name for one in stones[:3]], joint(0.3))
    slides = of(model)
    assert slides.unique
    assert not slides.agreed.any()
    assert "by the friction of 3 joints it may be one-sided" in str(slides)
    assert slides.friction.sum() == pytest.approx(1.0, rel=1e-6)
    assert sides(model, 1, 0.3) == pytest.approx((0.0, 1.0), abs=1e-5)
    assert 0.0 <= slides.friction[1] <= 1.0


def test_a_friction_that_stresses_agree_on_has_one_derivative():
    """Corners that lift carry nothing in any stress state; what is left of a wall's is determined."""
    model = structures.ferris_tin_loi_wall(1, lb.PointContact(0.65))
    found = of(model)
    assert found.unique
    for k in np.argsort(-np.abs(found.friction))[:3].tolist():
        assert found.agreed[k]
        assert sides(model, k, 0.65) == pytest.approx((found.friction[k],) * 2, rel=5e-3)


def test_weights_of_all_blocks_together_do_not_matter_without_strengths():
    """A load factor of mass-proportional loads is without unit: the elasticities add up to zero."""
    model = structures.ferris_tin_loi_wall(1, lb.OrdunaLourenco(0.65))
    found = of(model)
    assert abs(found.of_blocks.sum()) < 1e-5 * found.load_factor
    assert np.abs(found.of_blocks).max() > 1e-2 * found.load_factor


def test_a_shape_moves_as_the_model_built_anew():
    """An arch grown by a field from its mid-surface outwards is the arch of another thickness."""
    radius, thickness = 1.0, 0.2

    def arch(t):
        return structures.arch(lb.PointContact(0.9), voussoirs=9, radius=radius, thickness=t, depth=0.5)

    def outwards(points):
        flat = points * [1.0, 0.0, 1.0]
        r = np.linalg.norm(flat, axis=1, keepdims=True)
        return np.where(r > 0.0, flat / np.maximum(r, 1e-12), 0.0) * np.sign(r - radius) / 2.0

    model = arch(thickness)
    found = shape_sensitivity(model, lb.bounds(model), outwards)
    assert found == pytest.approx(differences(arch, thickness, 1e-4), rel=1e-4)


def test_a_mechanism_that_is_not_the_only_one_is_told():
    """Two equal blocks on one base, pushed alike: either may rock alone."""
    stones = [lb.Block.box("base", (4.0, 1.0, 1.0), (0.0, 0.0, -0.5))]
    stones += [
        lb.Block.box(n, (0.5, 1.0, 1.0), (x, 0.0, 0.5), unit_weight=2e4) for n, x in (("a", -1.0), ("b", 1.0))
    ]
    joint = lb.PointContact(2.0)
    for chosen, unique in ((stones, False), (stones[:2], True)):
        model = model_of(chosen, ["base"], joint)
        found = of(model)
        assert found.unique is unique
        assert ("not unique" in str(found)) is not unique


@pytest.mark.parametrize("joint", [lb.PointContact, lb.OrdunaLourenco])
@pytest.mark.parametrize(("friction", "by_friction"), [(0.198, 1.0), (0.2, None), (0.202, 0.0)])
def test_sliding_and_rocking_at_one_load_are_no_single_mechanism(joint, friction, by_friction):
    """min(mu, b/h) has its kink at mu = b/h: one derivative on either side, any between where both move.

    The corners that lift may be dragged along at any rate while they do: that is what is not unique.
    """
    model = structures.block(joint(friction), width=0.2, height=1.0)
    found = of(model)
    assert found.unique is (by_friction is not None)
    said = [
        value
        for one in lb.report(model, found).sections
        for name, value, _ in one.values
        if "by fric" in name
    ]
    if found.unique:
        assert found.friction == pytest.approx([by_friction], abs=1e-5)
        assert said == ["two-sided"]
    else:
        assert 0.01 < found.friction[0] < 0.99
        assert said == ["in part one-sided"]


@pytest.mark.parametrize("joint", [lb.PointContact, lb.OrdunaLourenco])
@pytest.mark.parametrize("off", [-1e-6, -1e-7, 1e-7, 1e-6])
def test_a_kink_within_the_digits_of_a_drawing_is_one(joint, off):
    """min(mu, b/h) with mu = b/h but for 7 or 6 digits: one mechanism is the only one, by so little.

    Its derivative holds for a change of the friction by 1e-7; for all others there are two, 0 and 1.
    """
    found = of(structures.block(joint(0.2 * (1.0 + off)), width=0.2, height=1.0))
    assert not found.unique


@pytest.mark.parametrize("joint", [lb.PointContact, lb.OrdunaLourenco])
def test_the_one_mechanism_of_a_large_facade_is_told_as_the_only_one(joint):
    """Where forward and backward differences of the unit weights agree, to the second order of the step."""
    model = structures.facade(joint(0.6))
    found, shares, step = of(model), np.random.default_rng(0).standard_normal(len(model.blocks)), 1e-3

    def changed(by):
        blocks = zip(model.blocks, shares.tolist(), strict=True)
        return [replace(one, unit_weight=(one.unit_weight or 0.0) * (1.0 + by * s)) for one, s in blocks]

    now, ahead, back = (lb.bounds(replace(model, blocks=changed(by))).lower for by in (0.0, step, -step))
    assert ahead - now == pytest.approx(now - back, rel=0.02)
    assert found.unique


def test_governing_joints_and_stones_come_first():
    found = of(structures.ferris_tin_loi_wall(1, lb.OrdunaLourenco(0.65)))
    first = found.governing(5)
    sizes = [abs(one.elasticity) for one in first]
    assert sizes == sorted(sizes, reverse=True)
    everything = np.concatenate([found.of_interfaces, found.of_blocks])
    assert sizes[0] == np.abs(everything).max()
    assert len(found.governing(10**3)) == (np.abs(everything) > 1e-9 * found.load_factor).sum()
    assert {one.kind for one in first} <= {"friction", "unit weight"}
    assert str(first[0]).startswith(f"{first[0].kind} of {first[0].name}")


def test_a_joint_in_pieces_is_one():
    """An L slides at mu: the load factor changes with the friction of its joint one to one."""
    outline = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 3), (0, 3)]
    stones = [
        lb.Block.box("ground", (9.0, 9.0, 1.0), (0.0, 0.0, -0.5)),
        lb.Block.prism("foot", outline, (0.0, 0.1), 20e3, along="z"),
    ]
    model = model_of(stones, ["ground"], lb.PointContact(0.3))
    assert len(model.interfaces) == 2
    (influence,) = of(model).governing()
    assert (influence.kind, influence.name) == ("friction", "ground|foot")
    assert influence.elasticity == pytest.approx(0.3)
    assert sorted(row["name"] for row in of(model).rows()) == ["foot", "ground", "ground|foot"]


def test_bounds_of_another_model_are_refused():
    model, other = block(lb.PointContact(0.3)), block(lb.PointContact(0.4))
    with pytest.raises(ModelError, match="this Bounds belongs to model"):
        lb.sensitivities(model, lb.bounds(other))
    with pytest.raises(LimitBlocksError, match="belongs to model"):
        lb.plots.sensitivity(model, of(other))


def test_the_picture_says_what_the_largest_changes_are():
    model = structures.ferris_tin_loi_wall(1, lb.OrdunaLourenco(0.65))
    found = of(model)
    ax = lb.plots.sensitivity(model, found)
    assert f"{np.abs(found.of_interfaces).max():.3g}" in ax.get_title() or "10^" in ax.get_title()


def test_a_dictionary_of_numbers_and_text():
    found = of(block(lb.OrdunaLourenco(0.3)))
    written = json.loads(json.dumps(found.to_dict()))
    assert written["friction"] == pytest.approx([1.0])
    assert written["cohesion"] == [None]
    assert written["unique"] is found.unique
