"""The notebook in examples/python, run cell after cell."""

import json

import pytest

from conftest import ROOT

pytest.importorskip("pyarrow")


def test_every_cell_runs(capsys, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "agg")
    notebook = json.loads((ROOT / "examples/python/crane.ipynb").read_text())
    names = {}
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            exec("".join(cell["source"]), names)  # noqa: S102
    said = capsys.readouterr().out
    assert "converged to a stable equilibrium" in said and "1 part computed, then 0" in said
