"""Linear models with inputs and outputs, against a pendulum by hand, differences of the equations of motion, and a run."""

import crane
import numpy as np
import pytest

PENDULUM = """
format: 1
name: pendulum
inputs: {torque: {value: 3, unit: N m}, gust: {unit: N}}
links:
  - {name: rod, joint: {revolute: {axis: y}}, mass: 2, com: [0, 0, -1.5], inertia: {Ixx: 0.001, Iyy: 0.05, Izz: 0.05}}
drives:
  - {coordinate: rod_theta, effort: {input: torque}, damping: 0.4}
loads:
  - {name: wind, link: rod, at: [0, 0, -1.5], force: [1, 0, 0], scale: {input: gust}}
points:
  - {name: bob, link: rod, at: [0, 0, -1.5]}
"""


def test_a_pendulum_has_the_matrices_of_its_textbook():
    """`J q̈ = −m g l sin q − d q̇ + τ − F l cos q`; exact derivatives, and differences of what is linear."""
    pendulum = crane.load("pendulum", text=PENDULUM)
    angle, rate = 0.3, 0.7
    model = pendulum.state_space([angle], [rate])
    inertia, weight, arm = 0.05 + 2 * 1.5**2, 2 * 9.81 * 1.5, 1.5
    np.testing.assert_allclose(model.A, [[0, 1], [-weight * np.cos(angle) / inertia, -0.4 / inertia]], rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(np.abs(model.B), [[0, 0], [1 / inertia, arm * np.cos(angle) / inertia]], rtol=1e-8)
    assert model.inputs == ("torque", "gust") and model.input_units == ("N m", "N")
    assert model.states == ("rod_theta", "rod_theta_rate") and model.state_units == ("rad", "rad/s")
    x = model.C[model.outputs.index("bob_x")]
    np.testing.assert_allclose(np.abs(x), [arm * np.cos(angle), 0], atol=1e-12)
    assert model.D.shape == (5, 2) and not model.D.any()


def test_the_frequency_response_is_that_of_an_oscillator():
    """Driven at its frequency, a pendulum at rest answers with `1/(d ω)`."""
    pendulum = crane.load("pendulum", text=PENDULUM, inputs={"torque": 0.0})
    model = pendulum.state_space([0.0], outputs=["rod_theta"], inputs=["torque"])
    omega = np.sqrt(2 * 9.81 * 1.5 / (0.05 + 2 * 1.5**2))
    response = model.frequency_response([0.0, omega / (2 * np.pi)])
    assert response.shape == (2, 1, 1)
    np.testing.assert_allclose(response[:, 0, 0], [1 / (2 * 9.81 * 1.5), -1j / (0.4 * omega)], rtol=1e-7)


def test_a_flexible_crane_answers_a_small_step_as_its_model():
    """A run of 0.05 s with a small change of its input, against the exponential of the linear model: off by the square of the change."""
    text = """
extends: knuckle_boom
name: steered_boom
inputs: {trim: {unit: rad}}
drives: [{coordinate: main_boom_theta, offset: trim}]
"""
    steered = crane.load("steered_boom", text=text)
    rest = steered.statics().q
    model = steered.state_space(rest, outputs=["main_boom_theta", "main_boom_theta_rate"])
    change, time = 1e-4, 0.05
    moved = model.C @ model.sampled(time).B[:, 0] * change
    simulation = steered.simulation(q=rest, v=np.zeros(steered.n), tolerance=1e-10)
    state = simulation.step(time, inputs={"trim": change})
    still = steered.simulation(q=rest, v=np.zeros(steered.n), tolerance=1e-10).step(time)
    place = steered.coordinates.index("main_boom_theta")
    found = np.array([(state.q - still.q)[place], (state.v - still.v)[place]])
    np.testing.assert_allclose(found, moved, rtol=1e-3)


def test_sampled_models_are_those_of_scipy():
    """Exponentials by another program, also of pressures in Pa beside angles in rad."""
    signal = pytest.importorskip("scipy.signal")
    hydraulic = crane.load("eight_link_hydraulic")
    about_oil = hydraulic.state_space(hydraulic.statics().q, valves="slightly open", inputs=["boom_psi_prescribed"], outputs=["boom_psi"])
    pendulum = crane.load("pendulum", text=PENDULUM).state_space([0.3])
    for model, interval in ((pendulum, 0.1), (about_oil, 0.01)):
        sampled = model.sampled(interval)
        A, B, *_ = signal.cont2discrete(tuple(model), interval)
        # SciPy does not balance: rounding of its largest entries.
        np.testing.assert_allclose(sampled.A, A, atol=1e-9 * np.abs(A).max())
        np.testing.assert_allclose(sampled.B, B, atol=1e-9 * np.abs(B).max())
        # Slow oscillations of an angle pass a hold with half an interval of delay.
        slow = 0.001 / interval
        delayed = model.frequency_response([slow])[0, 0] * np.exp(-1j * np.pi * slow * interval)
        np.testing.assert_allclose(sampled.frequency_response([slow])[0, 0], delayed, rtol=1e-3)
    with pytest.raises(ValueError, match="sampled already"):
        sampled.sampled(0.1)
    with pytest.raises(ValueError, match="above 0"):
        pendulum.sampled(-1.0)


def test_forces_are_outputs_and_states_of_oil_are_states():
    """All columns of a run; the weight of the bob on the pin's effort; a crane on oil has its pressures in x."""
    pendulum = crane.load("pendulum", text=PENDULUM, inputs={"torque": 0.0})
    model = pendulum.state_space([0.0], outputs=["rod_theta_drive_torque", "kinetic_energy"], inputs=["torque", "rod_theta_drive_torque"])
    np.testing.assert_allclose(model.C, [[0, -0.4], [0, 0]], atol=1e-9)
    np.testing.assert_allclose(model.D, [[1, 1], [0, 0]], atol=1e-9)
    hydraulic = crane.load("eight_link_hydraulic")
    model = hydraulic.state_space(hydraulic.statics().q, outputs=["boom_cylinder_piston_pressure", "s1_reaction_z"])
    assert model.states[-3:] == ("pump_pressure", "upper_hinge_psi_bristle", "rotator_psi_bristle") and model.state_units[-3] == "Pa"
    assert len(model.states) == 2 * hydraulic.n + 12
    pressure = model.states.index("boom_cylinder_piston_pressure")
    np.testing.assert_allclose(model.C[0], np.eye(len(model.states))[pressure], atol=1e-9)
    assert np.abs(model.C[1, : hydraulic.n]).max() > 1e5
    state = hydraulic.simulation().step(0.05)
    moving = hydraulic.state_space(state.q, state.v, state.t, state.x)
    assert moving.A.shape == model.A.shape and np.isfinite(moving.A).all()
    with pytest.raises(ValueError, match="x needs 28 numbers"):
        hydraulic.state_space(state.q, state.v, state.t, state.x[:5])


def test_batches_and_names():
    """Leading axes broadcast; unknown names are refused with those that exist."""
    pendulum = crane.load("pendulum", text=PENDULUM)
    model = pendulum.state_space(np.linspace(-0.5, 0.5, 6).reshape(2, 3, 1))
    assert model.A.shape == (2, 3, 2, 2) and model.B.shape == (2, 3, 2, 2) and model.C.shape == (2, 3, 5, 2)
    assert model.frequency_response([0.5, 1.0]).shape == (2, 3, 2, 5, 2)
    with pytest.raises(ValueError, match="no input 'torqe': write one of torque, gust"):
        pendulum.state_space([0.0], inputs=["torqe"])
    with pytest.raises(ValueError, match="no output 'bob_u'"):
        pendulum.state_space([0.0], outputs=["bob_u"])
