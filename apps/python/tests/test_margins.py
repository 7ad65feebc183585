"""Margins of control loops, against closed forms, the command's numbers in a spec by hand, and runs of the nonlinear crane."""

import crane
import numpy as np
import pytest

ARM = """
format: 1
name: arm
parameters: {load: {value: 40, unit: kg}}
inputs: {torque: {unit: N m}}
links:
  - {name: arm, joint: {revolute: {axis: z}}, mass: 100, com: [1, 0, 0], inertia: {gyration: [0.1, 0.5, 0.5]}}
  - {name: bob, on: {link: arm, at: [2, 0, 0]}, joint: {revolute: {axis: y}}, mass: load, com: [0, 0, -1], inertia: {gyration: [0.1, 0.1, 0.1]}}
drives:
  - {coordinate: arm_psi, effort: {input: torque}, damping: 30}
damping: {bob_theta: 4}
"""


# Nothing but the loop holds the arm: statics finds no stable pose.
REST = [0.0, 0.0]


def test_a_double_integrator_has_the_margins_of_its_formula():
    """With the bob fixed to it the arm is 1/(J s² + d s)."""
    bare = crane.load("arm", text=ARM.replace("joint: {revolute: {axis: y}}, mass", "joint: fixed, mass").replace("damping: {bob_theta: 4}", ""))
    inertia = bare.mass_matrix([0.0])[0, 0]
    p, d, delay = 900.0, 700.0, 0.05
    margins = bare.margins("arm_psi_drive_torque", p, d=d, delay=delay, q=[0.0])
    s = 1j * margins.crossover
    response = (p + d * s) * np.exp(-delay * s) / (inertia * s**2 + 30 * s)
    assert abs(abs(response) - 1) < 1e-9
    np.testing.assert_allclose(margins.phase, np.angle(-response), atol=1e-9)
    assert margins.stable and margins.damping > 0


def test_margins_run_over_parameters_and_poses():
    arm = crane.load("arm", text=ARM)
    batch = arm.replace(load=np.linspace(5.0, 80.0, 3))
    margins = batch.margins("arm_psi_drive_torque", 900.0, d=700.0, delay=0.05, q=REST)
    assert margins.stable.shape == margins.phase.shape == margins.damping.shape == (3,)
    one = arm.replace(load=80.0).margins("arm_psi_drive_torque", 900.0, d=700.0, delay=0.05, q=REST)
    assert one.phase == margins.phase[-1] and one.gain == margins.gain[-1]
    with pytest.raises(ArithmeticError, match="open"):
        arm.margins("arm_psi_drive_torque", 0.0, q=REST)
    with pytest.raises(ValueError, match="on which a loop could act"):
        arm.margins("arm_psy", 1.0)
    with pytest.raises(ValueError, match="does not say what the loop measures"):
        arm.margins("torque", 1.0)


@pytest.mark.parametrize("part", [0.9, 1.1])
def test_a_run_decays_within_the_gain_margin_and_grows_beyond(part):
    """The nonlinear crane with the controller as a program, at 5 ms: half a sample more of dead time."""
    arm = crane.load("arm", text=ARM)
    p, d, delay, sample = 900.0, 500.0, 0.1, 0.005
    margins = arm.margins("arm_psi_drive_torque", p, d=d, delay=delay + 0.5 * sample, q=REST)
    assert margins.stable and np.isfinite(margins.gain)
    # With this gain the loop is close to its limit: it has to grow or to decay at the rate of its eigenvalue.
    gain = part * float(margins.gain)
    expected = arm.margins("arm_psi_drive_torque", gain * p, d=gain * d, delay=delay + 0.5 * sample, q=REST)
    assert expected.stable == (part < 1)
    simulation = arm.simulation(q=[0.002, 0.0], v=[0.0, 0.0], tolerance=1e-9)
    waiting = [0.0] * round(delay / sample)
    rates = []
    for _ in range(1400):
        waiting.append(-gain * (p * simulation.q[0] + d * simulation.v[0]))
        rates.append(simulation.step(sample, inputs={"torque": waiting.pop(0)}).v[0])
    # Once the slow motions have decayed.
    early, late = (np.abs(rates[first : first + 300]).max() for first in (600, 1100))
    growth = np.log(late / early) / (500 * sample)
    # The hold is a half sample of dead time to second order, and peaks fall between samples.
    assert abs(growth - expected.closed.real) < 0.03 * abs(expected.closed.real), (growth, expected.closed)
    assert (growth < 0) == (part < 1)


def test_long_dead_times_are_unstable_and_told():
    """1.3 rad/s and 13 rad/s times 1e6 s: no list of motions, and why; the verdict is Nyquist's."""
    boom = crane.load("knuckle_boom")
    with pytest.warns(crane.InvalidRowWarning, match="is it in s"):
        margins = boom.margins("main_boom_theta", 1.0, delay=1e6)
    assert not margins.stable and np.isnan(margins.damping) and np.isfinite(margins.phase)
    with pytest.raises(ValueError, match="delay=1e\\+?300.*time in s"):
        boom.margins("main_boom_theta", 1.0, delay=1e300)


def test_a_motion_that_grows_far_from_the_axis_is_found():
    """All roots of 1 + L by another program: -0.1247 at 7.15 rad/s."""
    margins = crane.load("eight_link_flexible").margins("boom_psi_rate", 5.0, delay=0.06, lag=0.05)
    assert not margins.stable
    np.testing.assert_allclose([margins.damping, abs(margins.closed)], [-0.1247, 7.15], rtol=1e-3)


def test_a_leak_is_a_drift():
    """Shut valves drift; slightly open ones hold the leak; a crane without valves rests."""
    oil = crane.load("eight_link_hydraulic")
    q = oil.statics().q
    shut = oil.state_space(q)
    fastest = int(np.abs(shut.drift).argmax())
    assert shut.stable and 1e-8 < abs(shut.drift[fastest]) < 1e-3 and shut.decay > 0
    assert np.linalg.eigvals(shut.A).real.max() > 1e-3, "what grows with the drift"
    held = oil.state_space(q, valves="slightly open", steady=True)
    assert held.stable and not held.drift.any() and np.isnan(held.decay)
    rest = crane.load("knuckle_boom")
    model = rest.state_space(rest.statics().q)
    assert model.stable and model.drift.shape == (4,) and not model.drift.any()
