"""Runs the notebooks of examples/notebooks, and writes them as pages of the manual, with what their cells print and draw, into docs/manual/notebooks.

    python tools/book/notebooks.py                    # all of them
    python tools/book/notebooks.py statics robot      # some

The pages are committed: the list of chapters names them, forges show them, and the site is built where the package is not installed.

Solutions of exercises, which are code in cells of text, run after the cells before them. It needs the package `crane` and what the notebooks import.
"""

import ast
import contextlib
import io
import itertools
import json
import math
import os
import re
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
from matplotlib.figure import Figure

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = ROOT / "examples/notebooks"
PAGES = ROOT / "docs/manual/notebooks"
# Text as text: figures are small, and equal wherever they are made.
STYLE: dict[str, Any] = {"svg.fonttype": "none", "font.size": 9, "figure.max_open_warning": 0}
# Code in cells of text.
CODE = re.compile(r"(^```python\n(.*?)^```\n)", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\((\.\.?/[^)#]*)")
NUMBER = re.compile(r"(?<![\w.])[-+−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
# Digits in which printed numbers agree on all machines, except for one unit of the last of them.
DIGITS = 4


@dataclass
class Page:
    """A notebook that ran: its text in Markdown, and its figures in SVG by the names of their files."""

    name: str
    text: str = ""
    figures: dict[str, str] = field(default_factory=dict)

    def write(self) -> None:
        """Writes it in place of the previous one."""
        PAGES.mkdir(exist_ok=True)
        for old in PAGES.glob(f"{self.name}-*.svg"):
            old.unlink()
        (PAGES / f"{self.name}.md").write_text(self.text, encoding="utf-8")
        for file, figure in self.figures.items():
            (PAGES / file).write_text(figure, encoding="utf-8")

    def differences(self) -> list[str]:
        """What the page that was written says otherwise. Figures count by their existence, shape, and size in bytes to a quarter."""
        page = PAGES / f"{self.name}.md"
        if not page.exists():
            return [f"there is no {page.relative_to(ROOT)}"]
        found = list(compare(page.read_text(encoding="utf-8"), self.text))
        written = {path.name: path.read_text(encoding="utf-8") for path in PAGES.glob(f"{self.name}-*.svg")}
        found += [f"{file}: in one of both only" for file in sorted(written.keys() ^ self.figures.keys())]
        for file in written.keys() & self.figures.keys():
            old, new = written[file], self.figures[file]
            if _shape(old) != _shape(new) or abs(len(old) - len(new)) > len(new) / 4:
                found.append(f"{file}: {_shape(old)} and {len(old)} bytes, now {_shape(new)} and {len(new)} bytes")
        return found


def find() -> list[Path]:
    """All notebooks."""
    return sorted(NOTEBOOKS.glob("*.ipynb"))


def run(path: Path) -> Page:
    """Runs a notebook in a namespace and in an empty folder of its own, with its solutions."""
    where = path.relative_to(ROOT)
    page = Page(path.stem, "<!-- Written by tools/book/notebooks.py: edit the notebook. -->\n")
    first, *cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    title, _, begin = "".join(first["source"]).partition("\n")
    page.text += f"{title}\n\nThis page is the notebook `{where}` with what its cells print and draw.\n{LINK.sub(_moved, begin)}\n"
    names: dict[str, Any] = {"__name__": "__main__"}
    style = {**STYLE, "svg.hashsalt": path.stem}
    # What others drew is none of its figures.
    plt.close("all")
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder), matplotlib.rc_context(style):
        for number, cell in enumerate(cells, 1):
            source, place = "".join(cell["source"]), f"{path.name}, cell {number}"
            if cell["cell_type"] == "code":
                page.text += f"\n```python\n{source.removesuffix(';')}\n```\n{_execute(source, names, place, page)}"
            else:
                text = LINK.sub(_moved, f"\n{source}\n")
                page.text += CODE.sub(lambda code: code[1] + _execute(code[2], names, f"the solution of {path.name}", page), text)
    return page


def _execute(source: str, names: dict[str, Any], place: str, page: Page) -> str:
    """Runs a cell; returns what it prints, the value of its last line unless a semicolon follows, and its figures, as Markdown."""
    body = ast.parse(source, place).body
    last = body.pop() if body and isinstance(body[-1], ast.Expr) else None
    printed = io.StringIO()
    try:
        with contextlib.redirect_stdout(printed):
            exec(compile(ast.Module(body, []), place, "exec"), names)  # noqa: S102
            value = eval(compile(ast.Expression(last.value), place, "eval"), names) if isinstance(last, ast.Expr) else None
            if value is not None and not source.rstrip().endswith(";"):
                print(repr(value))
    except Exception as error:
        error.add_note(f"in {place}:\n{source}")
        plt.close("all")
        raise
    out = f"\n```text\n{printed.getvalue().rstrip()}\n```\n" if printed.getvalue().strip() else ""
    for number in plt.get_fignums():
        file = f"{page.name}-{len(page.figures) + 1}.svg"
        figure = plt.figure(number)
        drawn = io.StringIO()
        figure.savefig(drawn, format="svg", metadata={"Date": None})
        page.figures[file] = re.sub(r" +$", "", drawn.getvalue(), flags=re.MULTILINE)
        out += f"\n![{_described(figure)}]({file})\n"
    plt.close("all")
    return out


def _described(figure: Figure) -> str:
    """What a figure shows: its name, or its labels."""
    if figure.get_label():
        return str(figure.get_label())
    drawn = [tuple(re.sub(r" \[.*?\]", "", label) for label in (axes.get_xlabel(), axes.get_ylabel())) for axes in figure.axes]
    across = next((x for x, _ in reversed(drawn) if x), "")
    shown = ", ".join(y if x in ("", across) else f"{y} over {x}" for x, y in drawn if y)
    return f"{shown} over {across}" if shown and across else shown or across


def _moved(link: re.Match[str]) -> str:
    """A link from the folder of notebooks, as one from the folder of pages."""
    return f"]({os.path.relpath(NOTEBOOKS / link[1], PAGES)}"


def _shape(figure: str) -> str:
    """Width and height of a figure."""
    found = re.search(r'width="\S+" height="\S+"', figure)
    return found[0] if found else "no shape"


def compare(old: str, new: str) -> Iterator[str]:
    """Lines that differ between two pages; numbers that cells print may differ a little."""
    is_output = False
    for number, (before, after) in enumerate(itertools.zip_longest(old.splitlines(), new.splitlines()), 1):
        if before is None or after is None or not (_alike(before, after) if is_output else before == after):
            yield f"line {number}: {before!r}, now {after!r}"
        if after is not None and after.startswith("```"):
            is_output = after == "```text"


def _alike(old: str, new: str) -> bool:
    """Whether two lines have the same words, and nearly the same numbers."""
    if NUMBER.sub("#", old).split() != NUMBER.sub("#", new).split():
        return False
    pairs = zip(NUMBER.findall(old), NUMBER.findall(new), strict=True)
    return all(_close(*pair) for pair in pairs)


def _close(old: str, new: str) -> bool:
    """Whether two printed numbers agree, except for one unit of the last common digit that counts."""
    one, other = (float(number.replace("−", "-")) for number in (old, new))
    counts = math.floor(math.log10(abs(one))) - DIGITS + 1 if one != 0.0 else -math.inf
    return old == new or abs(one - other) <= 1.000001 * 10.0 ** max(counts, _last(old), _last(new))


def _last(number: str) -> float:
    """The exponent of ten of the last digit of a printed number. A whole number may be a count."""
    mantissa, _, exponent = number.partition("e")
    _, point, decimals = mantissa.partition(".")
    return int(exponent or 0) - len(decimals) if point or exponent else -math.inf


def main(names: list[str]) -> None:
    """Writes the pages of all notebooks, or of those with these names."""
    for path in find():
        if not names or path.stem in names:
            page = run(path)
            page.write()
            print(f"{PAGES.relative_to(ROOT)}/{page.name}.md, {len(page.figures)} figures")


if __name__ == "__main__":
    main(sys.argv[1:])
