"""Bounds against bare solvers on the same matrices, in one run: CPU time, memory, fitted exponents, JSON."""

import json
import resource
import time

import cvxpy as cp
import numpy as np
from rich.table import Table

import limitblocks as lb
from limitblocks.analysis import conic, direct, forms, programs
from limitblocks.analysis.scales import scaled
from limitblocks.problem import Cones

ALONE = {"form": "", "solver": "", "iterations": "", "raw": float("nan"), "status": "bounds alone"}
PEERS = ("HIGHS", "PIQP", "QOCO")  # called through cvxpy, where they are installed
METHODS = ("qdldl", "faer")
FORMS = ("static", "kinematic", "rates")
COLUMNS = (
    "structure",
    "joint",
    "blocks",
    "assembly",
    "bounds",
    "form",
    "solver",
    "iterations",
    "raw",
    "status",
)


def wall(joint, size):
    """Pushed along and across: no plane to reduce it to."""
    courses = max(4, round((size / 1.5) ** 0.5))
    length = max(2, round(size / courses)) * 0.4
    return lb.structures.wall(joint, length=length, courses=courses, direction=(1.0, 1.0, 0.0))


def facade(joint, size):
    courses = max(5, round((size / 2.2) ** 0.5))
    stones = max(4, round(size / courses / 2))
    lengths = {"length": stones * 0.8, "return_length": max(1, stones // 2) * 0.8}
    return lb.structures.facade(joint, courses=courses, openings=(), **lengths)


def dome(joint, size):
    courses = max(4, round((size / 2) ** 0.5))
    stones = max(8, round(size / courses))
    return lb.structures.dome(
        joint, radius=5.0, thickness=0.6, courses=courses, stones=stones, running_bond=False
    )


STRUCTURES = {"wall": wall, "facade": facade, "dome": dome}


def candidates(problem, chosen):
    """Programs of the load factor: static, kinematic, and in rates alone where the joints allow it."""
    p = scaled(problem)
    for form, build in (("static", programs.static_program), ("kinematic", programs.kinematic_program)):
        if form in chosen:
            program = build(p)
            yield form, program, handed_over(program.problem)
    rates = forms.without_multipliers(p) if "rates" in chosen else None
    if rates is not None:
        yield "rates", None, conic.compiled(rates.limit().problem)


def handed_over(problem):
    """The matrices of any program as cvxpy hands them over to Clarabel."""
    data, _, _ = problem.get_problem_data(cp.CLARABEL)
    cones = Cones.of_sizes(data["dims"].nonneg, data["dims"].soc)
    return conic.Conic(data["c"], data["A"], data["b"], cones)


def bare(program, settings):
    """Clarabel by itself: CPU s, iterations, status."""
    start = time.process_time()
    found = direct.solution(program, settings | {"verbose": False})
    return time.process_time() - start, found.iterations, str(found.status)


def peer(program, solver):
    """Another solver through cvxpy: CPU s, iterations, status."""
    start = time.process_time()
    try:
        program.problem.solve(solver=solver)
        status = program.problem.status
    except (cp.SolverError, ValueError, ArithmeticError) as error:
        status = type(error).__name__
    stats = program.problem.solver_stats
    return time.process_time() - start, stats.num_iters if stats else None, status


def medians(rows):
    """One row of those of the same runs: the median of each time."""
    times = {key: float(np.median([row[key] for row in rows])) for key in ("assembly", "bounds", "raw")}
    return rows[0] | times


def measured(name, joint, size, methods, chosen):
    """Rows of one model: `bounds` once, and every chosen form by every solver that takes it."""
    model = STRUCTURES[name](joint, size)
    start = time.process_time()
    problem = model.problem
    assembly = time.process_time() - start
    start = time.process_time()
    found = lb.bounds(model)
    total = assembly + time.process_time() - start
    whole = {"structure": name, "joint": repr(joint), "blocks": len(model.free_blocks), "assembly": assembly,
             "bounds": total, "proven": found.proven, "width": found.proof.width,
             "memory": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024}  # fmt: skip
    rows = []
    for form, program, matrices in candidates(problem, chosen):
        settings = {method: programs.TIGHT | {"direct_solve_method": method} for method in methods}
        runs = {f"CLARABEL {method}": bare(matrices, settings[method]) for method in methods}
        if program is not None and not problem.cones.second_order:
            runs |= {solver: peer(program, solver) for solver in PEERS if solver in cp.installed_solvers()}
        for solver, (raw, iterations, status) in runs.items():
            row = {"form": form, "solver": solver, "iterations": iterations, "raw": raw, "status": status}
            rows.append(whole | row)
    return rows or [whole | ALONE]


def best(rows):
    """Least raw time of each model among those that were solved."""
    least = {}
    for row in rows:
        if row["status"].lower() in ("solved", "almostsolved", "optimal"):
            key = row["structure"], row["joint"], row["blocks"]
            least[key] = min(least.get(key, np.inf), row["raw"])
    return least


def exponent(sizes, times):
    """Slope of log time over log size; NaN for one size."""
    return float(np.polyfit(np.log(sizes), np.log(times), 1)[0]) if len(set(sizes)) > 1 else float("nan")


def tables(rows):
    """All runs, and of each class of models the ratio to the best raw call and the exponents."""
    runs = Table(*COLUMNS, title="CPU s")
    for row in rows:
        runs.add_row(*(f"{row[k]:.2f}" if isinstance(row[k], float) else str(row[k]) for k in COLUMNS))
    least, total = best(rows), {}
    for row in rows:
        total[row["structure"], row["joint"], row["blocks"]] = row
    summary = Table("structure", "joint", "blocks", "bounds", "best raw", "ratio", "width", "memory, MB",
                    title="bounds over the best raw call")  # fmt: skip
    classes = {}
    for key, row in total.items():
        raw = least.get(key, float("nan"))
        classes.setdefault(key[:2], []).append((key[2], row["bounds"]))
        ratio, memory = row["bounds"] / raw, row["memory"] / 1e6
        summary.add_row(*key[:2], str(key[2]), f"{row['bounds']:.2f}", f"{raw:.2f}", f"{ratio:.2f}",
                        f"{row['width']:.0e}", f"{memory:.0f}")  # fmt: skip
    growth = Table("structure", "joint", "exponent of bounds", title="growth with the number of blocks")
    for key, points in classes.items():
        growth.add_row(*key, f"{exponent(*zip(*points, strict=True)):.2f}")
    return runs, summary, growth


def compared(before, after):
    """Table of the CPU time of bounds in two files."""
    table = Table("structure", "joint", "blocks", "before", "after", "ratio", title="bounds, CPU s")
    both = [{}, {}]
    for file, known in zip((before, after), both, strict=True):
        with open(file, encoding="utf-8") as stream:
            for row in json.load(stream):
                known[row["structure"], row["joint"], row["blocks"]] = row["bounds"]
    for key in both[0].keys() & both[1].keys():
        old, new = (known[key] for known in both)
        table.add_row(*map(str, key), f"{old:.2f}", f"{new:.2f}", f"{new / old:.2f}")
    return table


def run(sizes, joints, structures, methods, chosen, repeat, file, console):
    """Measure, print, and write the rows to `file` as JSON."""
    rows = []
    lb.bounds(wall(joints[0], 30))  # what is imported when first needed
    for solver in PEERS:
        if solver not in cp.installed_solvers():
            console.print(f"{solver} is not installed: left out")
    for name in structures:
        for joint in joints:
            for size in sizes:
                tried = [measured(name, joint, size, methods, chosen) for _ in range(repeat)]
                rows += map(medians, zip(*tried, strict=True))
    console.print(*tables(rows))
    if file:
        with open(file, "w", encoding="utf-8") as stream:
            json.dump(rows, stream, indent=1)
