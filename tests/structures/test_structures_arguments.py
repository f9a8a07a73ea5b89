"""Every number of every structure: what is none is refused by name, and its type makes no difference."""

import inspect
from decimal import Decimal
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from stones import volume

import limitblocks as lb
from limitblocks import structures

JOINT = lb.PointContact(0.6)
#: Measures with which each structure is small.
SMALL = {
    "arch": {"radius": 2.0, "thickness": 0.5, "voussoirs": 4},
    "segmental_arch": {"span": 3.0, "rise": 1.0, "thickness": 0.5, "voussoirs": 4},
    "pointed_arch": {"span": 3.0, "rise": 2.0, "thickness": 0.5, "voussoirs": 4},
    "elliptical_arch": {"span": 3.0, "rise": 1.0, "thickness": 0.5, "voussoirs": 4},
    "arch_bridge": {
        "span": 3.0,
        "rise": 1.0,
        "thickness": 0.5,
        "voussoirs": 4,
        "spans": 2,
        "pier_width": 1.5,
    },
    "barrel_vault": {"radius": 2.0, "thickness": 0.5, "length": 2.0, "courses": 4, "stones": 2},
    "groin_vault": {"radius": 2.0, "thickness": 0.5, "length": 5.0, "courses": 3, "stone_length": 1.0},
    "pavilion_vault": {"radius": 2.0, "thickness": 0.5, "courses": 3, "stone_length": 1.0},
    "dome": {"radius": 2.0, "thickness": 0.5, "courses": 2, "stones": 6},
    "dome_lunes": {"radius": 2.0, "thickness": 0.5, "voussoirs": 4},
    "wedge": {"half_angle": 0.5, "height": 1.0, "length": 4.0},
    "block": {"width": 1.0, "height": 1.0},
    "column": {"count": 2, "width": 1.0, "height": 1.0},
    "overhang": {"count": 2, "length": 1.0, "height": 0.5},
    "wall": {"length": 1.2, "courses": 2},
    "two_leaf_wall": {"length": 1.2, "courses": 2},
    "ferris_tin_loi_wall": {"number": 1},
    "corner": {"length": 1.6, "return_length": 1.6, "courses": 2},
    "facade": {"length": 3.2, "courses": 2, "return_length": 1.6, "openings": ()},
    "tower": {"length": 1.6, "width": 1.6, "courses": 2},
    "buttressed_wall": {"length": 1.6, "courses": 2, "buttress_length": 0.8},
    "portal": {"span": 2.0, "pier_width": 0.5, "pier_blocks": 1},
    "eccentric_lintel": {},
    "stair": {"treads": 2},
    "cantilever_stair": {"treads": 2, "courses_above": 1},
}
MAKERS = [name for name in structures.__all__ if inspect.isfunction(getattr(structures, name))]
NUMBERS = [
    (maker, name, one.annotation.removesuffix(" | None"))
    for maker in MAKERS
    for name, one in inspect.signature(getattr(structures, maker)).parameters.items()
    if one.annotation.removesuffix(" | None") in ("float", "int", "bool")
]
NONE = ["1", "thick", True, [1.0], np.ones(1), {}, 1j, b"1", 10**400]


def made(maker, **given):
    return getattr(structures, maker)(joint=JOINT, **(SMALL[maker] | given))


def test_every_structure_is_here():
    assert set(SMALL) == set(MAKERS)


@pytest.mark.parametrize(("maker", "name", "kind"), NUMBERS)
def test_what_is_no_number_is_refused_by_name_and_value(maker, name, kind):
    own = [1.0, "yes"] if kind == "bool" else [*NONE, 1e300 if kind == "float" else 2.5]
    for value in own:
        with pytest.raises(lb.ModelError) as caught:
            made(maker, **{name: value})
        said = str(caught.value)
        assert said.startswith(f"{name.replace('_', ' ')} is "), said
        assert "expected" in said
        assert "\n" not in said


@pytest.mark.parametrize(("maker", "name", "kind"), NUMBERS)
@pytest.mark.filterwarnings("error")
def test_numbers_out_of_all_proportion_are_refused_or_make_sound_blocks(maker, name, kind):
    values = (np.nan, np.inf, -np.inf, -1.0, 0.0, 1e-12, 1e12) if kind == "float" else (-1, 0, 100_001)
    for value in values if kind != "bool" else ():
        try:
            model = made(maker, **{name: value})
        except lb.ModelError:
            continue
        assert np.isfinite(value)
        assert all(block.volume > 0.0 for block in model.blocks)


def test_single_precision_fits_as_double_does():
    """Calculated in single precision, ring and springer overlapped by 1e-7 m, and were refused."""
    given = {
        "span": np.float32(3.0),
        "rise": np.float32(1.5),
        "thickness": Decimal("0.5"),
        "rings": np.int64(2),
    }
    model = made("arch_bridge", **given)
    same = made("arch_bridge", rise=1.5, rings=2)
    assert model.digest == same.digest
    assert made("wall", thickness=Fraction(1, 5)).digest == made("wall", thickness=0.2).digest


@pytest.mark.parametrize(
    ("maker", "given", "said"),
    [
        ("arch", {"piers": 1.0}, r"piers is 1.0, expected Piers\(width, blocks, block_height\)"),
        ("arch", {"thickness": 20.0}, "less than twice the radius"),
        ("arch", {"embrace": 4.0}, "embrace is 4.0"),
        ("arch", {"voussoirs": 1}, "voussoirs is 1"),
        ("arch", {"piers": (0.3, 2)}, "at least that of the springing"),
        ("arch", {"stereotomy": "oblique"}, "stereotomy is 'oblique', expected 'radial' or 'vertical'"),
        ("arch", {"facets": 0}, "facets is 0, expected a whole number of at least 1"),
        ("arch", {"piers": (1.2, 0)}, "pier blocks is 0"),
        ("arch", {"fill": (-1.0,)}, "fill height is -1.0"),
        ("arch", {"fill": structures.Fill(0.1, inertia=2.0)}, "fill inertia is 2.0"),
        ("arch", {"direction": (0.0, 0.0, 0.0)}, "direction"),
        ("segmental_arch", {"rise": 1e-12}, "rise is 1e-12, expected at least 1e-06 of the span 3.0"),
        ("segmental_arch", {"rise": 2.1}, "rise is 2.1, expected at most half the span"),
        ("segmental_arch", {"thickness": -0.1}, "thickness is -0.1"),
        ("pointed_arch", {"rise": 1.4}, "rise is 1.4, expected more than half the span"),
        ("pointed_arch", {"voussoirs": 9}, "voussoirs is 9, expected an even number"),
        ("pointed_arch", {"thickness": 5.0}, "thickness is 5.0, expected less than the span"),
        ("elliptical_arch", {"thickness": 1.4}, "thickness is 1.4, expected less than 1.33333 m"),
        ("elliptical_arch", {"voussoirs": 1}, "voussoirs is 1"),
        ("arch_bridge", {"pier_width": None}, "pier width is missing, expected at least"),
        ("arch_bridge", {"pier_width": 0.3}, "pier width is 0.3, expected at least"),
        ("arch_bridge", {"rise": 2.0}, "rise is 2.0, expected at most half the clear span"),
        ("arch_bridge", {"rings": 0}, "rings is 0, expected a whole number of at least 1"),
        ("arch_bridge", {"thickness": -0.2}, "thickness is -0.2"),
        ("arch_bridge", {"fill": 1.0}, r"fill is 1.0, expected Fill\(height, unit_weight, "),
        ("arch_bridge", {"rise": 1e-12}, "rise is 1e-12, expected at least 1e-06 of the clear span 3.0"),
        ("barrel_vault", {"stones": 0}, "stones is 0"),
        ("barrel_vault", {"embrace": 4.0}, "embrace is 4.0"),
        ("groin_vault", {"stone_length": 1e-9}, "length is 5.0, expected at most 100000 stones of 1e-09 m"),
        ("groin_vault", {"length": 4.4}, "length is 4.4, expected more than 4.5 m"),
        ("groin_vault", {"stone_length": 0.0}, "stone length is 0.0"),
        ("groin_vault", {"courses": 1}, "courses is 1, expected a whole number of at least 2"),
        ("pavilion_vault", {"stone_length": -1.0}, "stone length is -1.0"),
        ("dome", {"stones": 3}, "stones is 3, expected a whole number of at least 4"),
        ("dome", {"courses": 0}, "courses is 0"),
        ("dome", {"embrace": 2.0, "courses": 8, "stones": 4}, "stones is 4, expected more for 8 courses"),
        ("dome", {"oculus": 3.2}, "oculus is 3.2"),
        ("dome", {"embrace": 3.2}, "embrace is 3.2"),
        ("dome", {"thickness": 4.0}, "less than twice the radius"),
        ("dome_lunes", {"voussoirs": 10}, "voussoirs is 10, expected an odd number"),
        ("dome_lunes", {"angle": 3.2}, "angle is 3.2"),
        ("wedge", {"height": 1e-12}, "block 'left plane': it has no volume beside its size"),
        ("block", {"width": -1.0}, "width is -1.0, expected a number > 0"),
        ("column", {"count": 0}, "count is 0, expected"),
        ("column", {"width": 0.0}, "width is 0.0, expected"),
        ("column", {"height": -1.0}, "height is -1.0, expected"),
        ("wall", {"length": 1e9}, r"length is 1000000000.0, expected at most 100000 stones of 0.4 m"),
        ("wall", {"openings": "door"}, r"openings are 'door', expected \(left, sill, width, height\)"),
        ("wall", {"openings": (0.4, 0.0, 0.4, 0.2)}, "openings are .*expected"),
        ("two_leaf_wall", {"header_spacing": 0.3}, "header spacing is 0.3, expected a multiple of 0.2"),
        ("two_leaf_wall", {"header_spacing": 0.2}, "at least one block"),
        ("two_leaf_wall", {"header_courses": 0}, "header courses is 0"),
        ("two_leaf_wall", {"thickness": -1.0}, "thickness is -1.0"),
        ("corner", {"length": 2.5}, "length 2.5 m is not a positive multiple of 0.4"),
        ("corner", {"return_length": 0.4}, "no room for the corner"),
        ("facade", {"length": 6.5}, "length 6.5 m is not a positive multiple of 0.4"),
        ("facade", {"length": 1.6}, "no room for corners"),
        ("facade", {"courses": 0}, "courses is 0"),
        ("facade", {"block_height": -0.4}, "block height is -0.4"),
        ("tower", {"openings": 1.0}, "openings are 1.0, expected those of each side by its name"),
        ("tower", {"width": 1.2}, "no room for corners"),
        ("tower", {"length": 2.5}, "length 2.5 m is not a positive multiple of 0.4"),
        ("tower", {"openings": {"top": []}}, "openings are given for 'top', expected one of front, back"),
        ("buttressed_wall", {"buttress_length": 1e-9}, "buttress length 1e-09 m is not a positive multiple"),
        ("buttressed_wall", {"buttress_courses": 5}, "buttress courses is 5, expected 1 to 2"),
        ("buttressed_wall", {"position": 2.4}, "position is 2.4"),
        ("buttressed_wall", {"buttress_length": 0.5}, "buttress length 0.5 m is not a positive multiple"),
        ("portal", {"span": -1.0}, "span is -1.0"),
        ("portal", {"pier_blocks": 0}, "pier blocks is 0"),
        ("eccentric_lintel", {"bearing": 1e-9}, "bearing 1e-09 m is not a positive multiple"),
        ("eccentric_lintel", {"bearing": 2.4}, "less than the length"),
        ("eccentric_lintel", {"length": 2.5}, "length 2.5 m is not a positive multiple of 0.4"),
        ("eccentric_lintel", {"load_length": 1.0}, "at most the overhang"),
        ("eccentric_lintel", {"eccentricity": 0.8}, "less than the thickness"),
        ("eccentric_lintel", {"courses": 0}, "courses is 0"),
        ("stair", {"newel": 1.3}, "less than the length"),
        ("stair", {"treads": 0}, "treads is 0"),
        ("cantilever_stair", {"overlap": 0.3}, "overlap is 0.3"),
        ("cantilever_stair", {"treads": 0}, "treads is 0"),
        ("cantilever_stair", {"going": -0.3}, "going is -0.3"),
    ],
)
def test_measures_without_a_structure_are_refused(maker, given, said):
    with pytest.raises(lb.ModelError, match=said):
        made(maker, **given)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"thicknes": 0.4}, "arch has no argument 'thicknes'; did you mean 'thickness'?"),
        ({"colour": "red", "name": 1.0}, "arch has no argument 'colour'; arch has no argument 'name'"),
        ({"thickness": 0.4}, "arch needs 'voussoirs'"),
        ({}, "arch needs 'thickness'; arch needs 'voussoirs'"),
    ],
)
def test_arguments_of_no_structure_and_missing_ones_are_refused_by_name(given, said):
    with pytest.raises(lb.ModelError) as caught:
        structures.arch(JOINT, radius=2.0, **given)
    assert str(caught.value) == said
    with pytest.raises(lb.ModelError, match="arch: too many positional arguments"):
        structures.arch(JOINT, 2.0, thickness=0.4, voussoirs=9)


def polygon(corners):
    """Area and abscissa of the centroid of a polygon (n, 2)."""
    x, z = np.transpose(corners)
    swept = x * np.roll(z, -1) - z * np.roll(x, -1)
    return abs(swept.sum()) / 2.0, float(((x + np.roll(x, -1)) * swept).sum() / (3.0 * swept.sum()))


@pytest.mark.parametrize("rise", [3e-6, 1e-3, 0.4, 1.5])
def test_volume_of_a_segmental_arch(rise):
    """n/2 (ro^2 - ri^2) sin(embrace / n), as corners are joined by straight edges."""
    radius, embrace = (9 / 4 + rise**2) / (2 * rise), 4 * np.arctan2(2 * rise, 3.0)
    expected = 4 / 2 * (2 * radius * 0.5) * np.sin(embrace / 4)  # ro^2 - ri^2 = 2 R t
    assert volume(made("segmental_arch", rise=rise)) == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize(
    ("rise", "rings", "spans", "height"), [(0.3, 1, 1, 2.0), (1.0, 2, 3, 2.0), (1.5, 3, 2, 0.05)]
)
def test_volume_and_count_of_a_bridge(rise, rings, spans, height):
    """Rings, piers, and springers: trapezia of width w below and w - 2 t sin(phi) above, t cos(phi) high."""
    model = made("arch_bridge", rise=rise, rings=rings, spans=spans, pier_height=height, pier_blocks=4)
    radius, phi = (9 / 4 + rise**2) / (2 * rise), 2 * np.arctan2(2 * rise, 3.0)
    arch = 4 / 2 * ((radius + 0.5) ** 2 - radius**2) * np.sin(2 * phi / 4)
    pier = 1.5 * height + (1.5 - 0.5 * np.sin(phi)) * 0.5 * np.cos(phi)
    assert volume(model) == pytest.approx(spans * arch + (spans - 1) * pier, rel=1e-12)
    springers = int(rise < 1.5)
    assert len(model.free_blocks) == spans * rings * 4 + (spans - 1) * (4 + springers)
    assert len(model.interfaces) == spans * (4 * (rings - 1) + 3 * rings + 2 * rings) + (spans - 1) * (
        4 + springers
    )


@pytest.mark.parametrize("rise", [0.3, 0.5, 0.7, 1.0, 1.3])
def test_a_pier_of_a_bridge_may_be_as_wide_as_its_springings_whatever_rounding_says(rise):
    """Its springer is a triangle of width w = 2 t sin(phi), sin(phi) = span / 2 / radius, t cos(phi) high."""
    radius = (9 / 4 + rise**2) / (2 * rise)
    width = 0.5 * 3.0 / radius
    model = made("arch_bridge", rise=rise, pier_width=width)
    springer = next(block for block in model.blocks if block.name == "pier 1 springer")
    assert springer.volume == pytest.approx(width * 0.5 * (radius - rise) / radius / 2, rel=1e-9)
    assert len(springer.vertices) == 6


@pytest.mark.parametrize("rise", [1.6, 2.0, 4.0])
def test_volume_and_apex_of_a_pointed_arch(rise):
    c = (rise**2 - 9 / 4) / 3.0
    inner, outer = 1.5 + c - 0.25, 1.5 + c + 0.25
    angles = np.linspace(0.0, np.arccos(c / inner), 3)
    above = np.array([*angles[:-1], np.arccos(c / outer)])
    place = lambda r, a: (r * np.cos(a), r * np.sin(a))  # noqa: E731
    area = sum(
        polygon([place(inner, a), place(inner, b), place(outer, d), place(outer, e)])[0]
        for a, b, e, d in zip(angles, angles[1:], above, above[1:], strict=False)
    )
    model = made("pointed_arch", rise=rise)
    assert volume(model) == pytest.approx(2.0 * area, rel=1e-12)
    assert max(block.vertices[:, 2].max() for block in model.blocks) == pytest.approx(
        np.sqrt(outer**2 - c**2)
    )


@pytest.mark.parametrize("courses", [2, 3, 6])
def test_volumes_of_cross_vaults(courses):
    """A web of the groin vault is swept from the diagonal to its edge, one of the other between diagonals."""
    angles = np.linspace(-np.pi / 2, np.pi / 2, courses + 1)
    place = lambda r, a: (r * np.sin(a), r * np.cos(a))  # noqa: E731
    groin = pavilion = 0.0
    for a, b in pairwise(angles):
        outline = [place(1.75, a), place(1.75, b), place(2.25, b), place(2.25, a)]
        area, x = polygon(outline)
        if a < -1e-9 and b > 1e-9:  # the crown
            half = [(0.0, outline[1][1]), outline[1], outline[2], (0.0, outline[2][1])]
            low, high, tall = outline[1][0], outline[2][0], outline[2][1] - outline[1][1]
            pavilion += tall / 3.0 * 4.0 * (low**2 + low * high + high**2)  # of a frustum
            groin += 4.0 * (area * 2.5 - 2.0 * np.prod(polygon(half)))
        else:
            groin += 4.0 * area * (2.5 - abs(x))
            pavilion += 2.0 * 2.0 * area * abs(x)
    assert volume(made("groin_vault", courses=courses)) == pytest.approx(groin, rel=1e-12)
    assert volume(made("pavilion_vault", courses=courses)) == pytest.approx(pavilion, rel=1e-12)


def test_volume_of_a_wedge():
    assert volume(made("wedge", plunge=0.3, tilt=0.2)) == pytest.approx(np.tan(0.5) * 4.0)


@pytest.mark.parametrize("embrace", [np.pi, 3.0559322033898306, 2.5, 1.2])
@pytest.mark.parametrize("thickness", [0.1, 0.3, 0.4, 0.7])
def test_piers_may_be_as_wide_as_the_springing_whatever_rounding_says(embrace, thickness):
    """t sin(embrace / 2): refused, or with two vertices in one place, in half of the cases."""
    piers = structures.Piers(thickness * np.sin(embrace / 2), 2)
    arch = structures.arch(
        lb.PointContact(0.7), radius=2.0, thickness=thickness, voussoirs=5, embrace=embrace, piers=piers
    )
    assert len(arch.interfaces) == 4 + 2 + 2 + 2 + 2 * (embrace < np.pi)


@pytest.mark.parametrize("count", [10**9, True, 1.5, "2"])
def test_a_count_of_blocks_of_a_pier_is_one_as_others_are(count):
    with pytest.raises(lb.ModelError, match="pier blocks is"):
        structures.arch(
            lb.PointContact(0.7), radius=2.0, thickness=0.4, voussoirs=9, piers=structures.Piers(0.9, count)
        )
