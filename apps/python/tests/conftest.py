"""What the tests share."""

import sys
from pathlib import Path

import crane
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[3]
# The second derivation of every quantity, from the YAML alone.
sys.path.append(str(ROOT / "tools/casadi"))
# Notebooks as pages.
sys.path.append(str(ROOT / "tools/book"))

PENDULUM = """
format: 1
name: pendulum
parameters: {bob: {value: 2, unit: kg, about: what hangs}}
links:
  - {name: rod, joint: {revolute: {axis: y}}, mass: bob, com: [0, 0, -1.5], inertia: {Ixx: 0.001, Iyy: 0.05, Izz: 0.05}}
points:
  - {name: bob, link: rod, at: [0, 0, -1.5]}
run: {duration: 2, output: 0.1}
"""


@pytest.fixture(scope="session")
def flexible():
    """The reference crane, 25 coordinates."""
    return crane.load("eight_link_flexible")


@pytest.fixture(scope="session")
def knuckle():
    """A small crane with drives."""
    return crane.load("knuckle_boom")


@pytest.fixture
def pendulum():
    """A rod on a pin, with the load as a live parameter."""
    return crane.load("pendulum.yaml", text=PENDULUM)


@pytest.fixture
def states(flexible):
    """Random states near the guess: t (7), q and v (7, n)."""
    rng = np.random.default_rng(1)
    shape = (7, flexible.n)
    return rng.uniform(0, 5, 7), flexible.guess + rng.uniform(-0.02, 0.02, shape), rng.uniform(-0.5, 0.5, shape)
