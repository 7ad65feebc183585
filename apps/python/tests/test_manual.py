"""Examples of the README and of the manual for Python.

The blocks of a page run one after the other in one namespace, in a folder with the files that the page shows.
"""

import math
import re

import numpy as np
import pytest
from conftest import ROOT

# What a page leaves to its reader: files to write, and lines that run first.
SMALL = """
format: 1
name: small
parameters: {payload: {value: 200, unit: kg}}
inputs: {lever: {unit: rad}}
links:
  - {name: boom, joint: {revolute: {axis: y}}, mass: 100, com: [1, 0, 0], inertia: {gyration: [0.1, 0.6, 0.6]}}
  - {name: hook, placement: {transform: {translation: [2, 0, 0]}}, joint: {revolute: {axis: y}}, mass: payload, com: [0, 0, -1]}
drives: [{coordinate: boom_theta, stiffness: 1e6, damping: 1e4, motion: {input: lever}}]
damping: {hook_theta: 40}
run: {duration: 2, output: 0.02}
"""
SLEWING = re.search(r'^SPEC = """\n(.*?)^"""', (ROOT / "examples/python/slewing.py").read_text(), re.MULTILINE | re.DOTALL)[1]
FILES = {
    "docs/manual/learning.md": {"my.yaml": SMALL, "slewing.yaml": SLEWING},
    "docs/manual/python.md": {"my.yaml": SMALL},
}
BEGINNINGS = {
    "docs/manual/controllers.md": "import numpy as np; q, v, t, Q, R = [0.3, -0.5], [0.1, 0.2], 0.0, np.eye(4), np.eye(1)",
    "docs/manual/learning.md": "import numpy as np; goal, levers = np.linspace(-0.2, 0.2, 64), np.zeros((100, 64))",
    "docs/manual/oil-crane.md": """
import crane, os
run = crane.load("eight_link_hydraulic").simulate(duration=0.1, verify=False)
os.mkdir("oil")
table = run.to_pandas()
table.rename(columns={name: f"{name} [{unit}]" for name, unit in run.units.items()}).to_csv("oil/eight_link_hydraulic.csv", index_label="t [s]")
""",
    "docs/manual/python.md": """
import crane
q = crane.load("eight_link_flexible").statics().q
v, a, dq, t = 0.1 + 0 * q, 0 * q, 1e-3 + 0 * q, 1.0
poses, rates = [q, q], [0 * q, 1e-3 + 0 * q]
""",
}
# Long runs, shorter.
SHORTER = {
    "docs/manual/fitting.md": {"draws=100": "draws=5"},
    "docs/manual/python.md": {
        "duration=10": "duration=0.2",
        "simulate_ensemble(": "simulate_ensemble(duration=0.05, ",
        "np.linspace(0, 800, 81)": "np.linspace(0, 800, 3)",
        "np.linspace(200, 2600, 81)": "np.linspace(200, 2600, 3)",
        "np.arange(0, 360, 15)": "[0, 90]",
        "np.arange(0, 75, 5)": "[30]",
        "range(500)": "range(10)",
        "k < 250": "k < 5",
        "q[::50]": "q[::5]",
        "100_000": "8",
    },
}
# Packages without which a page is skipped.
PACKAGES = {
    "docs/manual/controllers.md": ["scipy"],
    "docs/manual/fitting.md": ["scipy"],
    "docs/manual/learning.md": ["gymnasium"],
    "docs/manual/oil-crane.md": ["pandas", "matplotlib"],
    "docs/manual/python.md": ["pandas", "pyarrow", "scipy"],
}
# Blocks that do not run here, by how they begin, and why.
LEFT_OUT = {
    "docs/manual/fmu.md": {"from fmpy import": "tests of apps/fmu simulate the units of all shipped cranes"},
}


def blocks(page, language):
    """The examples of a page, without those that are files."""
    return re.findall(rf"(?<! -->\n)^```{language}\n(.*?)^```", (ROOT / page).read_text(), re.MULTILINE | re.DOTALL)


def run_page(page, folder, monkeypatch):
    """Runs the examples of a page and returns its names."""
    for package in PACKAGES.get(page, []):
        pytest.importorskip(package)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    monkeypatch.chdir(folder)
    shown = re.findall(r"^<!-- file: (\S+) -->\n```\w+\n(.*?)^```", (ROOT / page).read_text(), re.MULTILINE | re.DOTALL)
    for name, text in [*shown, *FILES.get(page, {}).items()]:
        (folder / name).write_text(text)
    names = {"__name__": "__main__"}
    exec(BEGINNINGS.get(page, ""), names)
    found = blocks(page, "python")
    for start in LEFT_OUT.get(page, {}):
        assert [block for block in found if block.startswith(start)], f"{page} has no block {start}"
        found = [block for block in found if not block.startswith(start)]
    for text, other in SHORTER.get(page, {}).items():
        assert any(text in block for block in found), f"{page} has no {text}"
        found = [block.replace(text, other) for block in found]
    for number, block in enumerate(found):
        exec(compile(block, f"{page}, example {number + 1}", "exec"), names)
    return names


OWN_TESTS = ["docs/manual/exchange.md", "docs/manual/fitting.md"]
PAGES = sorted(
    page
    for folder in ("docs", "docs/manual")
    for page in (path.relative_to(ROOT).as_posix() for path in (ROOT / folder).glob("*.md"))
    if page not in OWN_TESTS and blocks(page, "python")
)


@pytest.mark.parametrize("page", PAGES)
def test_page(page, tmp_path, monkeypatch):
    """The examples of a page run as they stand."""
    run_page(page, tmp_path, monkeypatch)


def test_readme(tmp_path, monkeypatch):
    """The first minute in Python: as it stands, with the crane of the README."""
    names = run_page("README.md", tmp_path, monkeypatch)
    # The load is a point of 500 kg, 1.5 m below its hinge, whose coordinate is the last; one product, rounded.
    assert abs(names["A"][-1, -1] - 500 * 1.5**2) < 1e-9
    assert not names["run"].cautions


def test_a_link_that_bends(tmp_path, monkeypatch):
    """The robot of the page on exchange, with its link as a beam; its tip, a frame of the robot, moves with the beam."""
    bending = run_page("docs/manual/exchange.md", tmp_path, monkeypatch)["bending"]
    assert bending.coordinates == ["upper_theta", *(f"upper_beam_{k}_{angle}" for k in range(1, 5) for angle in ("psi", "theta", "phi"))]
    tip = bending.points(0.1 * (bending.coordinates.index("upper_beam_4_theta") == np.arange(bending.n)))[0]
    # The last spring is 0.1 m before the tip.
    assert abs(abs(tip[2] - 1) - 0.1 * math.sin(0.1)) < 1e-12


def test_fitting(capsys, tmp_path, monkeypatch):
    """The fit finds the numbers of the measurement, within three deviations, and prints what the manual shows."""
    found = run_page("docs/manual/fitting.md", tmp_path, monkeypatch)["found"]
    for name, value in {"k_boom": 3e6, "d_boom": 4e4, "d_hook": 55, "payload": 620, "dead_time": 0.06}.items():
        assert abs(found[name] - value) < 3 * found.deviations[found.names.index(name)]
    shown = blocks("docs/manual/fitting.md", "text")[0].split("\n")
    said = capsys.readouterr().out.split("\n")
    # The words, and numbers to two digits of their errors: another processor may end the search elsewhere.
    assert [re.sub(r"[\d.e+-]+", "#", line).split() for line in said if line] == [re.sub(r"[\d.e+-]+", "#", line).split() for line in shown if line]
