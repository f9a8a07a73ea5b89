"""Every example runs, finds the number that a formula or the literature gives, and leaves a picture."""

import ast
import runpy
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[1]
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))


def mean_distance(a, b):
    """Of the points of a rectangle a x b from its centre: the torsion constant c_T, by midpoints."""
    share = (np.arange(400) + 0.5) / 800
    return np.hypot(a * share[:, None], b * share).mean()


TORSION = mean_distance(1, 1)

# name of the number: (expected, tolerance), with its source
EXPECTED = {
    "01_torsion_of_a_rectangle": {"T0": (16.26, 0.005)},  # Orduña & Lourenço (2005), Fig. 12
    "02_stress_lines": {  # integrals of the unit square by quadrature, theory of the paper, Section 3.1
        "V/V0": ([0, 0.34855, 0.79023, 0.95344, 1], 1e-5),
        "T/T0": ([1, 0.90943, 0.51783, 0.23519, 0], 1e-5),
    },
    "03_interaction_curves": {  # Fig. 12 and Table 4 of the paper
        "T0": (16.26, 0.005),
        "A": (0.7 * 240 * 0.15 / 2, 1e-9),
        "B": (0, 1e-9),
        "C": (0.7 * 240 * 0.10 / 2, 1e-9),
    },
    "04_plane_surface_against_exact": {
        "octagon": (1 / np.cos(np.pi / 8), 1e-6),  # drawn around the circle
        "circle": (1, 1e-9),
    },
    "05_orduna_lourenco_against_point_contact": {
        "excess": ([1.85, 1.89, 1.94], 0.01),  # mu |N| d/2 over Eq. (17), l1/l2 = 1, 2, 4
        "not twisted": (0.7, 1e-6),  # slides at mu
    },
    "06_sliding_and_rocking_block": {
        "load factors": (np.minimum(0.6, np.linspace(0.1, 1.2, 12)), 1e-6),  # min(mu, b/h)
        "column of five": (0.5 / (5 * 0.4), 1e-6),
        "angle": (np.degrees(np.arctan(0.4)), 1e-4),
    },
    "07_why_two_bounds": {
        "gap": (0, 1e-6),
        # virtual work of 4-hinge mechanisms, by hand in the example without the library's analysis
        "kinematic less the mechanisms": (0, 1e-6),
        "static less the mechanisms": (0, 1e-6),
    },
    "08_friction_is_not_associated": {  # Ferris & Tin-Loi (2001), wall 4
        "associated": (0.33195, 1e-5),
        "zero dilatancy, loaded": (0.264, 0.01 * 0.264),
    },
    "09_ferris_and_tin_loi_walls": {  # Ferris & Tin-Loi (2001), walls 1 to 4
        "associated": ([0.64286, 0.58000, 0.40369, 0.33195], 1e-5),
        "zero dilatancy over published": (1, 0.01),
    },
    "10_minimum_thickness_of_an_arch": {  # Cocchetti & Rizzi (2020)
        "enough friction": (0.107426, 0.107426 * 4 / 45**2 + 1e-5),  # the error of 45 voussoirs
        "equations where printed": ([0.107426, 0.200637], 2e-6),
        "blocks over equations": (1, 0.01),
    },
    "11_oppenheims_arch": {"load factor": (0.37, 0.005), "hinges": (4, 0)},  # Oppenheim (1992)
    "12_facade_and_its_returns": {
        "free-standing": (0.4 / 2.0, 1e-6),  # t/H
        "friction 0.3": (0.3, 1e-5),  # less 3e-6: stones part as they slide
        "one body": (0.5, 1e-9),  # moments of 400 x 40 cm and 2 x 120 x 40 cm in plan, 2 m high
    },
    "13_corner_failure_with_twist": {
        "ratio": (np.sqrt(2) / 2 / TORSION, 1e-3),  # d/2 over c_T of a square
        "point contacts": (0.6 * 0.4 * np.sqrt(2) / 2, 1e-6),  # mu d/2
        "Orduña & Lourenço": (0.6 * 0.4 * TORSION, 1e-5),  # mu c_T, Eqs (16)-(17)
    },
    "14_dome_of_lunes": {"many voussoirs": (0.0428, 5e-5)},  # lunes by thrust lines; Heyman (1967): 0.042
    "15_two_right_answers": {  # mu (1 + 2 P/W)
        "claimed": ([0.3, 0.9], 1e-12),
        "worst residual": (0, 1e-6),
        "found less the rule": (0, 1e-5),
        "started from P = W": (0.9, 1e-5),
        "frictionless": (0, 1e-9),
        "associated": (np.inf, 0),
    },
    "16_write_your_own_joint": {  # W = 10 kN, A = 0.5 m2, c_T of 0.5 m x 1 m
        "dry, pushed": (0.5, 1e-6),
        "mortar, pushed": (0.5 * (1 + 1e3 * 0.5 / 10e3), 1e-6),
        "dry, pushed off its middle": (0.6 / (1 + 0.2 / mean_distance(0.5, 1)), 1e-5),
        "mortar, pushed off its middle": ((0.6 + 0.1) / (1 + 0.2 / mean_distance(0.5, 1)), 1e-5),
    },
    "17_check_somebody_elses_answer": {
        "right": (0, 1e-12),
        # 1 % of mu W over all loads, (1 + 1.01 mu) W
        "1 % more load and forces: yield": (0.01 * 0.3 / (1 + 1.01 * 0.3), 1e-9),
        "1 % more load and forces: equilibrium": (0, 1e-9),
        "1 % more load, same forces: equilibrium": (0.01 * 0.3 / (1 + 1.01 * 0.3), 1e-9),
        "1 % more load, same forces: yield": (0, 1e-9),
        "rises as it slides: flow": (1 + 0.3, 1e-6),  # (1 + mu) W rising by mu, over mu W sliding by 1
        "half the load: equilibrium": (0, 1e-9),
        "half the load: yield": (0, 1e-9),
    },
    "18_round_or_eight_sided_friction": {
        "circle over mu / sin w": (1, 1e-3),
        "points over mu / sin w": (1, 1e-3),
        # mu / sqrt(sin^2 w - mu^2 cos^2 w) at 45 degrees
        "associated": (0.6 / np.sqrt(0.5 - 0.5 * 0.6**2), 1e-6),
    },
    "20_a_load_path_that_snaps": {  # closed form in the example
        "collapse over weight": (1, 1e-9),
        "after the snap over weight": (1, 1e-8),
        "before the snap over greatest": (1, 2e-5),
        "jack moved across the snap": (0, 1e-12),
        "same end along": (1, 1e-9),
    },
    "19_does_it_stand": {  # by hand in the example: tan 40 deg > 0.6 > tan 20 deg
        "answers": ([2, 1, 1, 0, 0], 0),  # falls, only by self-stress twice, stands twice
        "vertical force over weight": (1, 1e-6),
        "margin on the slope": ((0.6 - np.array([0.5, 0.55, 0.7])) / np.hypot(1, [0.5, 0.55, 0.7]), 1e-6),
    },
    "23_what_the_flow_rule_costs": {
        "block": (np.minimum([0.3, 0.5, 0.7], 1 / 1.6), 1e-6),  # min(mu, b/h)
        "arch, share": (1, 1e-6),  # hinges alone
        "wedge, associated": (  # mu / sqrt(sin^2 w - mu^2 cos^2 w) and mu / sin w at 45 degrees
            [mu / np.sqrt(0.5 - 0.5 * mu**2) for mu in (0.3, 0.5, 0.7)],
            1e-6,
        ),
        "wedge, without lift": ([mu * np.sqrt(2) for mu in (0.3, 0.5, 0.7)], 1e-3),
    },
    "24_a_facade_a_tie_an_earthquake": {  # closed forms in the lesson
        "load factors": ([14.75 / 162.5, 50.75 / 162.5], 1e-6),
        "displacement without resistance": (5 * np.sin(np.arctan(14.75 / 162.5)), 1e-6),
        "a0*": (0.7298419, 1e-6),
        "e*": (162.5**2 / 531.25 / 55, 1e-6),
        "d0*": (0.2955306, 1e-6),
        "T_SLV": (2.742208, 1e-6),
        "linear check": (0.495985, 1e-5),
    },
    "25_a_support_gives_way": {
        "thrusts at the least thickness": ([0.620881, 0.620881], 2e-3),
        "spread at the fall": (0.37763, 1e-3),  # by statics alone, tests/practice/test_collapse.py
        "thrust at the fall over that at rest": (2.20039, 2e-3),
        "spread first": ([True] * 4, 0),
    },
    "26_a_bridge_of_two_spans": {  # tests/practice/planar_bridge.py, a program of its own in the plane
        "one span": (37.8540124, 1e-5),
        "heavy pier": (37.8540124, 1e-4),
        "bonded rings": (37.8540124, 1e-4),
        "usual pier": (33.8672990, 1e-4),
        "rings with friction .6": (15.2298211, 1e-4),
        "rings without friction": (11.5441222, 1e-4),
        "order": ([0, 1, 2], 0),  # the more slender the pier, the less
        "fill brings": (True, 0),
    },
    "27_water_a_tie_or_a_weight": {  # moments about the toe
        "load factors": (0.3 * (1 - 9810 * np.linspace(0, 4, 5) / (22e3 * 4.0)), 1e-6),
        "least tie": ((0.25 * 2.0 - (1 - 9810 * 2.5 / 88e3) * 0.6) * 105600 / 3.5, 0.05),
        "tied wall": (0.25, 1e-6),
        "least weight": ((0.25 * 2.0 - (1 - 9810 * 2.5 / 88e3) * 0.6) * 105600 / (1.1 - 0.25 * 1.0), 0.05),
        "adequacy factor": (
            (0.9 * (1 - 9810 * 2.5 / 88e3) * 0.6 + (0.5 - (1 - 9810 * 2.5 / 88e3) * 0.6) / 1.15)
            / (1.2 * 2.0),
            1e-5,
        ),
    },
    "22_three_ranges": {  # by hand in the example
        "certified less by hand": ([0, 0], 1e-7),
        "reached within": (1, 0),
        "worst residual": (0, 1e-8),
        "wedged": (0, 0),
    },
    "21_three_answers_all_checked": {  # Ferris & Tin-Loi (2001); wall 4 has other solutions than theirs
        "associated": ([0.64286, 0.33195], 1e-5),
        "path over published": (1, 0.01),
        "fixed point over published, wall 1": (1, 0.01),
        "fixed point over associated, at most 1": (1, 1e-6),
        "worst residual": (0, 1e-8),
        "what a round changes": (0, 1e-6),
    },
}


@pytest.fixture(scope="module")
def gallery():
    pytest.importorskip("nbformat")
    return runpy.run_path(str(ROOT / "scripts" / "gallery"))


COLUMN, PAGE = 3.5, 7.0  # inches, of a journal of two columns


def watched(monkeypatch):
    """Return a list to which each figure that is saved adds what is not fit to print.

    Texts that overlap, leave the page, lie on a curve or are below 7 pt, and more than the width of a page.
    """
    figure = pytest.importorskip("matplotlib.figure")
    from overlap import collisions, covered, too_small

    found, save = [], figure.Figure.savefig

    def saved(self, *arguments, **options):
        save(self, *arguments, **options)
        wide = float(self.get_size_inches()[0])
        found.extend((*collisions(self), *covered(self), *too_small(self)))
        found.extend([("inches wide", wide)] if wide not in (COLUMN, PAGE) else [])

    monkeypatch.setattr(figure.Figure, "savefig", saved)
    return found


def test_overlap_is_seen():
    plt = pytest.importorskip("matplotlib.pyplot")
    from overlap import collisions, covered, too_small

    plt.style.use("default")  # not the style of what ran before
    figure, axis = plt.subplots()
    axis.set(xticks=[0, 1], xlabel="far from each other")
    assert collisions(figure) == []
    axis.set_xticks([0.5, 0.501], ["twelve thousand", "thirteen thousand"])
    axis.annotate("off the page", (1.1, 0.5), xycoords="figure fraction", annotation_clip=False)
    assert collisions(figure) == [
        ("twelve thousand", "thirteen thousand"),
        ("off the page", "outside the figure"),
    ]
    assert (covered(figure), too_small(figure)) == ([], [])
    axis.plot([0, 1], [0, 1], label="diagonal")
    axis.text(0.45, 0.5, "crossed", fontsize=6)
    assert covered(figure) == [("crossed", "covers diagonal")]
    assert too_small(figure) == [("crossed", 6)]
    plt.close(figure)


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_example(example, tmp_path, monkeypatch, capsys):
    mpl, image = pytest.importorskip("matplotlib"), pytest.importorskip("matplotlib.image")
    monkeypatch.chdir(tmp_path)
    crowded = watched(monkeypatch)
    with mpl.rc_context():
        values = runpy.run_path(str(example))["main"]()
    assert crowded == []
    assert capsys.readouterr().out.strip()
    made = [path for path in tmp_path.rglob("*") if path.suffix in {".png", ".html"}]
    assert made
    # by this `limitblocks examples run` knows what would be replaced
    assert {path.stem for path in tmp_path.rglob("*.*")} == {example.stem}
    for path in made:
        if path.suffix == ".html":
            assert path.stat().st_size > 10_000
        else:
            pixels = image.imread(path)[..., :3]
            assert min(pixels.shape[:2]) > 300
            assert np.ptp(pixels) > 0.5
            assert (pixels.min(axis=2) < 0.9).mean() > 0.01  # enough that is not white
    for name, (value, tolerance) in EXPECTED.get(example.stem, {}).items():
        np.testing.assert_allclose(values[name], value, rtol=0, atol=tolerance, err_msg=name)


def test_every_numbered_example_has_a_number(gallery):
    assert set(EXPECTED) == {path.stem for path in gallery["EXAMPLES"]}


def test_every_numbered_example_opens_with_its_question_and_names_its_source(gallery):
    for example in gallery["EXAMPLES"]:
        question, lesson, _ = gallery["parts"](example)
        assert question.endswith("?"), example.name
        assert "\nSource: " in lesson, example.name


def test_readme_of_the_examples_lists_them(gallery):
    text = (ROOT / "examples" / "README.md").read_text(encoding="utf-8")
    assert gallery["table"](gallery["EXAMPLES"], ".py") in text


def test_gallery(gallery, tmp_path, monkeypatch, capsys):
    """Page, pictures, notebook and script of one example, a thumbnail in the index; nothing overwritten."""
    nbformat = pytest.importorskip("nbformat")
    monkeypatch.setattr(sys, "argv", ["gallery", str(tmp_path), "01"])
    gallery["main"]()
    stem = "01_torsion_of_a_rectangle"
    assert {path.name for path in tmp_path.iterdir()} == {
        "index.md",
        *(stem + suffix for suffix in (".md", ".png", "_small.png", ".svg", ".py", ".ipynb")),
    }
    page = (tmp_path / f"{stem}.md").read_text(encoding="utf-8")
    assert page.startswith("# How much torsion does a dry rectangular joint carry?")
    assert "16.26 N m" in page
    assert f"]({stem}.svg)" in page
    question = "How much torsion does a dry rectangular joint carry?"
    link = (
        f"[![]({stem}_small.png)<br>{question}]({stem}.md)"  # its text names it where the picture is not seen
    )
    assert link in (tmp_path / "index.md").read_text(encoding="utf-8")
    nbformat.validate(nbformat.read(tmp_path / f"{stem}.ipynb", as_version=4))
    with pytest.raises(SystemExit, match="not empty"):
        gallery["main"]()


def cells(notebook):
    return [cell.source for cell in notebook.cells if cell.cell_type == "code"]


@pytest.mark.parametrize("example", EXAMPLES[:-1], ids=lambda path: path.stem[:2])
def test_a_notebook_has_all_of_the_lesson_in_steps(gallery, example):
    """Every statement of the script, the numbers before the steps, and steps that do not assert."""
    made = gallery["notebook"](example)
    code = cells(made)
    body = ast.parse(example.read_text(encoding="utf-8")).body[1:-1]
    main = next(one for one in body if getattr(one, "name", "") == "main")
    expected = [one for one in body if one is not main] + main.body
    found = ast.parse("\n".join(code)).body
    said = {ast.unparse(one).removeprefix("return ") for one in expected}
    assert said <= {ast.unparse(one) for one in found}
    heads = [cell.source.split("\n")[0] for cell in made.cells if cell.cell_type == "markdown"]
    assert heads[1] == "## Numbers to change"
    assert sum(head.startswith("## Step") for head in heads) >= 1
    assert "assert" not in {line.split(" ")[0] for piece in code[:-1] for line in piece.splitlines()}


def changed(gallery):
    """The notebook of the block that slides or rocks, with less friction than the script has."""
    made = gallery["notebook"](next(file for file in EXAMPLES if file.stem.startswith("06")))
    (numbers,) = (cell for cell in made.cells if cell.source.count("FRICTION = 0.6"))
    numbers.source = numbers.source.replace("FRICTION = 0.6", "FRICTION = 0.3").replace("1.2, 12)", "1.0, 3)")
    made.cells = [cell for cell in made.cells if not cell.source.startswith("## What holds")]
    return made


def test_a_changed_notebook_runs_in_a_kernel(gallery, tmp_path):
    """min(mu, b/h) with the changed mu, and the picture in the page."""
    client = pytest.importorskip("nbclient", reason="the package nbclient is not installed")
    pytest.importorskip("ipykernel", reason="the package ipykernel is not installed")
    made = changed(gallery)
    client.NotebookClient(made, timeout=120, resources={"metadata": {"path": tmp_path}}).execute()
    outputs = [one for cell in made.cells if cell.cell_type == "code" for one in cell.outputs]
    printed = "".join(one.get("text", "") for one in outputs)
    for ratio in np.linspace(0.1, 1.0, 3):
        assert f"b/h = {ratio:.1f}: load factor {min(0.3, ratio):.4f}" in printed
    assert any("image/png" in one.get("data", {}) for one in outputs)
