"""The scripts in examples/python: each runs in a process of its own, and ends with an error if it does not reach what it is for."""

import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[3] / "examples/python"


@pytest.mark.parametrize("script", ["lqr_observer", "zv_shaping", "optimal_slew"])
def test_it_reaches_its_goal(script, tmp_path):
    subprocess.run([sys.executable, FOLDER / f"{script}.py"], cwd=tmp_path, check=True, timeout=120)


@pytest.mark.parametrize("script", ["gradient_cost", "steps_per_second"])
def test_it_measures_once(script, tmp_path):
    subprocess.run([sys.executable, FOLDER / f"{script}.py", "1"], cwd=tmp_path, check=True, timeout=120)
