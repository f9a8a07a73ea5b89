"""The parts of a lesson in `examples/`, and a notebook of them: numbers to change, functions, steps, picture.

A lesson is a script: question and equations in its docstring, constants, `main`, the functions that it uses,
`picture`. In the notebook `main` is taken apart: a step ends where something is printed, and what is asserted
of the numbers as given comes last, so that a changed number does not stop the way there.
"""

import ast
import textwrap

import nbformat

TRY = "\nTry: "


def parts(file):
    """The question of a lesson, the rest of its docstring, and its code without the last lines."""
    source = file.read_text(encoding="utf-8")
    question, _, lesson = ast.get_docstring(ast.parse(source)).partition("\n\n")
    code = source.split('"""\n', 1)[1].partition('\n\n\nif __name__ == "__main__":')[0]
    return question.replace("\n", " "), lesson, code.strip()


def notebook(file):
    """The lesson as a notebook."""
    question, lesson, _ = parts(file)
    lesson, _, change = lesson.partition(TRY)
    source = file.read_text(encoding="utf-8").splitlines()
    body = ast.parse("\n".join(source)).body[1:-1]  # neither docstring nor the call of main
    main = next(one for one in body if getattr(one, "name", "") == "main")
    drawn = next(one for one in body if getattr(one, "name", "") == "picture")
    cells = [text(f"# {question}\n\n{lesson}"), text(f"## Numbers to change\n\n{change_them(change)}")]
    cells += [code(given(main))]
    cells += [code(piece) for piece in blocks(source, body, (main, drawn))]
    for k, (words, piece) in enumerate(steps(source, main), 1):
        cells += [text(f"## Step {k}: {words}"), code(piece)]
    cells += [text("## The picture"), code(lines(source, [drawn]))]
    cells += [code(piece) for piece in shown(source, main, file.stem)]
    if claims := [one for one in main.body if is_claim(one)]:
        cells += [text("## What holds of the numbers as given"), code(dedented(source, claims))]
    made = nbformat.v4.new_notebook(cells=cells)
    made.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3", "language": "python"}
    for k, cell in enumerate(made.cells):
        cell.id = f"cell-{k}"  # a random one would make every build differ
    return made


def change_them(change):
    said = " ".join(change.split())
    return "Change one and run the cells below again." + (f" Try: {said}" if said else "")


def given(main):
    """The parameters of `main` with their defaults; of files, the folder of the notebook."""
    pairs = zip(main.args.args, main.args.defaults, strict=True)
    rest = [f"{one.arg} = {ast.unparse(default)}" for one, default in pairs if one.arg != "folder"]
    return "\n".join(['folder = "."', *rest])


def text(words):
    return nbformat.v4.new_markdown_cell(words)


def code(words):
    return nbformat.v4.new_code_cell(words)


def lines(source, nodes):
    """The lines of statements, with the comments above them."""
    first = min([nodes[0].lineno, *(one.lineno for one in getattr(nodes[0], "decorator_list", []))])
    while source[first - 2].lstrip().startswith("#"):
        first -= 1
    return "\n".join(source[first - 1 : nodes[-1].end_lineno])


def dedented(source, nodes):
    return "\n".join(textwrap.dedent(lines(source, [one])) for one in nodes)


def blocks(source, body, left_out):
    """Imports and constants together, each function and class by itself."""
    together = []
    for one in (*body, None):
        plain = one is not None and not isinstance(one, ast.FunctionDef | ast.ClassDef)
        if plain:
            together.append(one)
            continue
        if together:
            yield lines(source, together)
            together = []
        if one is not None and one not in left_out:
            yield lines(source, [one])


def steps(source, main):
    """What `main` does before the picture: headed by what is first assigned, ended by what is printed."""
    met = []
    for one in main.body:
        if not is_claim(one) and not is_end(one):
            met.append(one)
            if calls(one, "print"):
                yield heading(met), dedented(source, met)
                met = []
    if met:
        yield heading(met), dedented(source, met)


def heading(nodes):
    names = [
        name.id
        for one in nodes
        if isinstance(one, ast.Assign)
        for target in one.targets
        for name in ast.walk(target)
        if isinstance(name, ast.Name)
    ]
    return ", ".join(f"`{name}`" for name in dict.fromkeys(names)) or "what is found"


def shown(source, main, stem):
    """The picture drawn and shown, then the numbers that the tests compare."""
    for one in main.body:
        if isinstance(one, ast.Expr) and calls(one, "picture"):
            yield f'from IPython.display import Image\n\n{dedented(source, [one])}\nImage("{stem}.png")'
        elif isinstance(one, ast.Return):
            yield dedented(source, [one]).removeprefix("return ")


def calls(node, name):
    """Whether `name` is called anywhere in a statement."""
    called = (one.func for one in ast.walk(node) if isinstance(one, ast.Call))
    return any(isinstance(one, ast.Name) and one.id == name for one in called)


def is_end(node):
    return isinstance(node, ast.Return) or (isinstance(node, ast.Expr) and calls(node, "picture"))


def is_claim(node):
    """An assertion, or a loop of nothing else."""
    if isinstance(node, ast.For):
        return all(isinstance(one, ast.Assert) for one in node.body)
    return isinstance(node, ast.Assert)
