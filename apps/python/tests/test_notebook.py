"""The notebooks in examples/notebooks: all cells and all solutions run, and the pages of the manual show what they print and draw."""

import json

import pytest

for package in ("matplotlib", "pyarrow", "scipy"):
    pytest.importorskip(package)

import notebooks


def test_there_are_some():
    assert len(notebooks.find()) >= 5
    assert {path.stem for path in notebooks.PAGES.glob("*.md")} == {path.stem for path in notebooks.find()}


@pytest.mark.parametrize("path", notebooks.find(), ids=lambda path: path.stem)
def test_every_cell_runs_and_the_page_is_current(path):
    """Where pages differ on purpose: `python tools/book/notebooks.py` writes them again."""
    assert notebooks.run(path).differences() == []


@pytest.mark.parametrize("path", notebooks.find(), ids=lambda path: path.stem)
def test_it_has_no_outputs_short_cells_checks_and_an_exercise(path):
    cells = json.loads(path.read_text())["cells"]
    code = [cell for cell in cells if cell["cell_type"] == "code"]
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in code)
    assert max(len(cell["source"]) for cell in code) <= 13
    assert "assert" in "".join(code[-1]["source"])
    assert cells[0]["source"][0].startswith("# ") and "<details>" in "".join(cells[-1]["source"])


@pytest.mark.parametrize(
    ("before", "after", "is_alike"),
    [
        ("f 1.23456 Hz", "f 1.23461 Hz", True),
        ("f 1.2345 Hz", "f 1.2365 Hz", False),
        ("f  0.12", "f 0.13", True),
        ("f 0.12", "f 0.14", False),
        ("21 of 22", "21 of 23", False),
        ("40106 kg", "40111 kg", True),
        ("3.0011e+06", "2.9999e+06", False),
        ("-1.5 N", "1.5 N", False),
        ("1.5 N", "1.5 m", False),
    ],
)
def test_numbers_that_cells_print_may_differ_beyond_four_digits(before, after, is_alike):
    as_output, as_code = (f"```{language}\n{{}}\n```\n".format for language in ("text", "python"))
    assert (list(notebooks.compare(as_output(before), as_output(after))) == []) is is_alike
    assert list(notebooks.compare(as_code(before), as_code(after)))
    assert list(notebooks.compare(as_output(before), as_output(before) + "\n"))
