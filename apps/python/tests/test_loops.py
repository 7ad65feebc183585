"""Cranes with closed loops and rigid drives: numbers of the whole crane, not of the open chain."""

import json
import re
import shutil
import subprocess

import crane
import numpy as np
import pytest
from conftest import ROOT


def shown(page):
    """The first spec that a page of the manual shows."""
    return re.search(r"^```yaml\n(.*?)^```", (ROOT / page).read_text(), re.MULTILINE | re.DOTALL)[1]


FOUR_BAR = shown("docs/manual/loops.md")
RIGID = FOUR_BAR.replace("stiffness: 4e3, damping: 40", "rigid: true")
# The pads of the page on telescopes, without compliance.
EXACT = re.sub(r"rear: {stiff.*", "rear: {exact: [y, z]}", re.sub(r"front: {stiff.*", "front: {exact: [y, z, twist]}", shown("docs/manual/telescopes.md")))
SPECS = [*crane.shipped(), *map(str, sorted((ROOT / "specs/examples").glob("*.yaml")))]


@pytest.fixture
def four_bar():
    return crane.load("four_bar.yaml", text=FOUR_BAR)


@pytest.mark.parametrize("spec", [*SPECS, FOUR_BAR, EXACT], ids=lambda spec: spec.split("/")[-1][:25].split("\n")[0])
def test_joints_carry_what_the_command_prints(spec, tmp_path):
    """All joints and the ground, to the tolerance of statics relative to the largest number: both find the pose by themselves."""
    program = shutil.which("crane") or ROOT / "target/release/crane"
    if spec.startswith("format"):
        (tmp_path / "own.yaml").write_text(spec)
        spec = str(tmp_path / "own.yaml")
    said = json.loads(subprocess.run([program, "strength", spec, "--format", "json"], capture_output=True, check=True).stdout)
    c = crane.load(spec)
    held, forces = c.strength().internal_forces, c.internal_forces(c.statics().q)
    np.testing.assert_array_equal(held, forces)
    joints = {cut["link"] or "ground": held[place] for place, cut in enumerate(c.info["cuts"]) if cut["kind"] in ("ground", "joint")}
    printed = {row["joint"]: [row[of] for of in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")] for row in said["loads"]}
    assert list(printed) == [name for name in joints if name in printed] and len(printed) == len(joints)
    np.testing.assert_allclose([joints[name] for name in printed], list(printed.values()), rtol=0, atol=1e-8 * np.abs(held).max())


def test_a_joint_carries_the_effort_of_its_drive(four_bar):
    """Along the axis of the crank the moment is minus the effort, at rest and in motion: nothing else turns it. Rounding."""
    rest = four_bar.statics()
    crank = [cut["link"] for cut in four_bar.info["cuts"]].index("crank")
    assert four_bar.internal_forces(rest.q)[crank, 5] == pytest.approx(-rest.drive_efforts[0], rel=1e-9)
    state = four_bar.simulation().step(0.8)
    a = four_bar.forward_dynamics(state.q, state.v, state.t)
    effort = four_bar.columns_at(state.q, state.v, t=state.t)["crank_psi_drive_torque"]
    moving = four_bar.internal_forces([state.q, state.q], state.v, a, state.t)[..., crank, 5]
    np.testing.assert_allclose(moving, -effort, rtol=1e-9)


def test_forces_of_the_open_chain_are_refused():
    rigid = crane.load("four_bar.yaml", text=RIGID)
    q = rigid.statics().q
    for call in (rigid.forces, rigid.drive_forces, rigid.drive_power):
        with pytest.raises(ValueError, match=rf"{call.__name__} of four_bar depends on the loop that ground_pin closes: use .*columns_at\(q, v, x, t\)"):
            call(q, 0 * q)
    with pytest.raises(ValueError, match="forces of four_bar depends on the loop"):
        rigid.vjp("forces", np.ones(3), q, 0 * q)
    # What is named instead has the effort: the power of the drive is that of all parts together, m q̈ q̇ and weight, to the error of a run.
    state = rigid.simulation(tolerance=1e-9).step(0.8)
    effort = rigid.columns_at(state.q, state.v, [], state.t)["crank_psi_drive_torque"]
    acceleration = rigid.state_derivatives(state.q, state.v, [], state.t)[0]
    required = rigid.inverse_dynamics(state.q, state.v, acceleration)
    assert effort * state.v[0] == pytest.approx(required @ state.v, rel=1e-6)


def test_the_slopes_of_forces_are_without_rigid_drives():
    """`force_derivatives` is that of the f of `dynamic_residual`; `forces` also has the effort, with which A q̈ = e + f. Differences over 1e-6."""
    pair = """
format: 1
name: pair
links:
  - {name: arm, joint: {revolute: {axis: y}}, mass: 10, com: [1, 0, 0], inertia: {gyration: [0.1, 0.5, 0.5]}}
  - {name: load, placement: {transform: {translation: [2, 0, 0]}}, joint: {revolute: {axis: y}}, mass: 5, com: [0, 0, -1]}
drives: [{coordinate: arm_theta, rigid: true, motion: {quintic: {from: 0, to: 1, duration: 2}}}]
damping: {load_theta: 3}
"""
    c = crane.load("pair.yaml", text=pair)
    q, v, t = np.array([0.2, -0.3]), np.array([0.4, 0.1]), 0.7
    a = c.forward_dynamics(q, v, t)
    np.testing.assert_allclose(c.mass_matrix(q) @ a, c.bias(q, v) + c.forces(q, v, t), rtol=1e-12)
    f = lambda v: c.mass_matrix(q) @ a - c.bias(q, v) - c.dynamic_residual(q, v, a, t)
    slopes = np.stack([(f(v + dv) - f(v - dv)) / 2e-6 for dv in 1e-6 * np.eye(2)], axis=-1)
    np.testing.assert_allclose(c.force_derivatives(q, v, t)[1], slopes, atol=1e-7)
    assert c.force_derivatives(q, v, t)[1].tolist() == [[0.0, 0.0], [0.0, -3.0]]
    small = c.linearise(q)
    assert small.mass[0].tolist() == [1.0, 0.0] and small.mass[1, 1] == c.mass_matrix(q)[1, 1]
    for words, of in (("without the efforts of", "force_derivatives"), ("Those of rigid drives are", "forces"), ("except for 1 on the", "linearise")):
        assert words in re.sub(r"\s+", " ", getattr(crane.Crane, of).__doc__)


def test_an_open_start_names_a_function(four_bar):
    with pytest.raises(RuntimeError, match="single coordinates by `coordinates_of`"):
        four_bar.simulate(q=[0.0, 0.0, 0.0], duration=0.1)
