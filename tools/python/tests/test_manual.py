"""Examples of the README and of the manual for Python."""

import math
import re

import numpy as np
import pytest
from conftest import ROOT


def blocks(page, language):
    """The examples of a page."""
    return re.findall(rf"^```{language}\n(.*?)^```", (ROOT / page).read_text(), re.MULTILINE | re.DOTALL)


def test_readme(tmp_path, monkeypatch):
    """The first minute in Python: as it stands, with the crane of the README."""
    [spec], [example] = blocks("README.md", "yaml"), blocks("README.md", "python")
    (tmp_path / "my_crane.yaml").write_text(spec)
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(example, names)
    # The load is a point of 500 kg, 1.5 m below its hinge, whose coordinate is the last; one product, rounded.
    assert abs(names["A"][-1, -1] - 500 * 1.5**2) < 1e-9
    assert not names["run"].cautions


def test_a_link_that_bends(tmp_path, monkeypatch):
    """The robot of the page on exchange, with its link as a beam; its tip, a frame of the robot, moves with the beam."""
    robot, *_ = blocks("docs/manual/exchange.md", "xml")
    (tmp_path / "arm.urdf").write_text(robot)
    monkeypatch.chdir(tmp_path)
    names = {}
    exec("\n".join(blocks("docs/manual/exchange.md", "python")), names)
    bending = names["bending"]
    assert bending.coordinates == ["upper_theta", *(f"upper_beam_{k}_{angle}" for k in range(1, 5) for angle in ("psi", "theta", "phi"))]
    tip = bending.points(0.1 * (bending.coordinates.index("upper_beam_4_theta") == np.arange(bending.n)))[0]
    # The last spring is 0.1 m before the tip.
    assert abs(abs(tip[2] - 1) - 0.1 * math.sin(0.1)) < 1e-12


def test_fitting(capsys):
    """The fit finds the numbers of the measurement, within three deviations, and prints what the manual shows."""
    pytest.importorskip("scipy")
    first, others = blocks("docs/manual/fitting.md", "python")
    names = {}
    exec(first, names)
    found = names["found"]
    for name, value in {"k_boom": 3e6, "d_boom": 4e4, "d_hook": 55, "payload": 620, "dead_time": 0.06}.items():
        assert abs(found[name] - value) < 3 * found.deviations[found.names.index(name)]
    shown = blocks("docs/manual/fitting.md", "text")[0].split("\n")
    said = capsys.readouterr().out.split("\n")
    # The words, and numbers to two digits of their errors: another processor may end the search elsewhere.
    assert [re.sub(r"[\d.e+-]+", "#", line).split() for line in said if line] == [re.sub(r"[\d.e+-]+", "#", line).split() for line in shown if line]
    exec(others.replace("draws=100", "draws=5"), names)
