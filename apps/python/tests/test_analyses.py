"""Statics, modes, stability, runs, ensembles and simulations."""

import copy
import dataclasses
import pickle
import time
import warnings

import crane
import numpy as np
import pytest
from conftest import PENDULUM


def test_statics_balances_the_weight(flexible):
    rest = flexible.statics()
    assert rest.stable and rest.status == "stable" and rest.residual < 1e-10
    np.testing.assert_allclose(flexible.static_residual(rest.q), 0, atol=1e-4)
    # At rest the supports carry the weight, which is minus the bias of a translation of the base.
    weight = flexible.bias(rest.q, np.zeros(25))[2]
    np.testing.assert_allclose(rest.support_reactions.sum(axis=0), [0, 0, -weight], rtol=1e-9, atol=1e-4)


def test_statics_over_parameters_are_those_of_each(flexible):
    masses = np.array([[0.0, 100.0], [400.0, 900.0]])
    rest = flexible.replace(load_mass=masses).statics()
    assert rest.q.shape == (2, 2, 25) and rest.stable.all()
    alone = flexible.replace(load_mass=400.0).statics()
    np.testing.assert_array_equal(rest.q[1, 0], alone.q)
    np.testing.assert_array_equal(rest.drive_efforts[1, 0], alone.drive_efforts)


def test_statics_along_the_manoeuvre(flexible):
    times = np.linspace(0, 5, 4)
    rest = flexible.statics(t=times)
    np.testing.assert_allclose(rest.q[0], flexible.statics().q, atol=1e-9)
    # At the end, the crane rests as far from the positions of the drives as their springs yield.
    psi = flexible.coordinates.index("column_psi")
    assert abs(rest.q[-1, psi] - flexible.drive_motions(5.0)[0, 0]) < 1e-3


def test_statics_with_drives_that_are_held(knuckle):
    """As if the spec held them: `motion: {hold: …}`, to the tolerance of statics."""
    extensions = np.array([0.2, 0.6])
    rest = knuckle.statics(hold={"main_boom": "-30 deg", "extension_x": extensions})
    assert rest.q.shape == (2, knuckle.n) and rest.stable.all()
    for row, extension in enumerate(extensions):
        drives = [{"coordinate": name, "motion": {"hold": value}} for name, value in (("main_boom_theta", "-30 deg"), ("extension_x", extension))]
        written = crane.load("held.yaml", text=knuckle._changed({"drives": drives})).statics()
        np.testing.assert_allclose(rest.q[row], written.q, atol=1e-9)
        # N m and N; forces balance to 1e-10 of some 1e5.
        np.testing.assert_allclose(rest.drive_efforts[row], written.drive_efforts, atol=1e-3)
    for hold, told in (
        ({"boom": 1}, "has no drive `boom`; drives: main_boom_theta, knuckle_theta, extension_x"),
        ({"main_boom": 30}, "angles are in rad"),
        ({"extension": "3 deg"}, r"hold\['extension'\]"),
        ({"extension": 0.1, "extension_x": 0.1}, "given twice"),
    ):
        with pytest.raises(ValueError, match=told):
            knuckle.statics(hold=hold)
    with pytest.raises(ValueError, match="give `t` or `hold`"):
        knuckle.statics(t=1, hold={"extension": 0.1})


def test_no_equilibrium_is_raised_or_reported(pendulum):
    with pytest.raises(crane.NoEquilibrium, match="change `guess:`"):
        pendulum.statics(guess=[np.pi])
    with pytest.warns(crane.InvalidRowWarning):
        rest = pendulum.statics(guess=[[np.pi], [0.1]], invalid="nan")
    assert list(rest.status) == ["unstable", "stable"]
    np.testing.assert_allclose(rest.q[:, 0], [np.pi, 0], atol=1e-9)


def test_modes_of_a_pendulum(pendulum):
    modes = pendulum.modes()
    # ω² = m g l/(J + m l²)
    assert abs(modes.omega_squared[0] - 2 * 9.81 * 1.5 / (0.05 + 2 * 1.5**2)) < 1e-12
    assert modes.dominating == [["rod_theta"]] or len(modes.dominating[0]) == 1
    batch = pendulum.replace(bob=[1.0, 2.0]).modes()
    np.testing.assert_allclose(batch.omega_squared[1], modes.omega_squared, rtol=1e-13)
    np.testing.assert_allclose(np.abs(modes.eigenvalues.imag[0]), np.sqrt(modes.omega_squared[0]), rtol=1e-12)


def test_modes_solve_the_eigenproblem(flexible):
    rest = flexible.statics()
    modes, small = flexible.modes(rest.q), flexible.linearise(rest.q)
    left = modes.shapes @ small.stiffness @ modes.shapes.T
    # Shapes are orthonormal in A and diagonalise K, to rounding of the largest eigenvalue.
    np.testing.assert_allclose(left, np.diag(modes.omega_squared), atol=1e-8 * modes.omega_squared[-1])
    np.testing.assert_allclose(modes.shapes @ small.mass @ modes.shapes.T, np.eye(25), atol=1e-9)
    stable = flexible.stability(rest.q)
    # The classical Runge-Kutta method reaches 2.785 on the real axis and 2.83 on the imaginary one.
    fastest = np.abs(modes.eigenvalues).max()
    assert 2.5 / fastest < stable.steps["rk4"] < 2.9 / fastest
    assert stable.steps["bdf"] == np.inf and "rad/s" in stable.limited_by["rk4"]


def test_a_run_is_recorded_with_its_errors(knuckle):
    run = knuckle.simulate(duration=1.0, output=0.01)
    assert run.t[0] == 0 and run.t[-1] == 1.0 and len(run.t) == 101
    assert run.units["main_boom_theta_drive_torque"] == "N m" and run.errors["main_boom_theta"] < 1e-4
    assert run.statistics["steps"] > 0 and run.method == "bdf"
    np.testing.assert_allclose(run["energy_balance"], 0, atol=1e-3 * np.ptp(run["drive_work"]))
    finer = knuckle.simulate(duration=1.0, output=0.01, tolerance=1e-9, verify=False)
    assert finer.errors is None
    # The difference from a much finer run is the estimated one, except for a small part of it.
    difference = np.abs(run["main_boom_theta"] - finer["main_boom_theta"]).max()
    assert difference < 1.5 * run.errors["main_boom_theta"] + 1e-9
    with pytest.raises(KeyError, match="did you mean"):
        run["main_boom_tetha"]


def test_a_run_goes_on_from_any_state(pendulum):
    run = pendulum.simulate(duration=2.0, output=0.01, q=[0.5], v=[0.0], method="dopri5", tolerance=1e-10, verify=False)
    energy = run["kinetic_energy"] + run["gravity_energy"]
    np.testing.assert_allclose(energy, energy[0], atol=1e-7 * abs(energy[0]))
    assert run.start == "as given"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"method": "rk5"}, "there is no method `rk5`"),
        ({"duration": -1.0}, "duration=-1"),
        ({"output": np.nan}, "output=NaN"),
        ({"tolerance": 1e-20}, "tolerance=0.00000000000000000001|tolerance=1e-20"),
        ({"step": "small"}, "step='small'"),
        ({"step": 1e-3, "method": "bdf"}, "`step` has no effect with bdf"),
        ({"step": 0.5}, "unstable; rk4 takes at most"),
        ({"q": [np.nan] * 25}, r"q\[0\] \(truck_x\) is NaN"),
    ],
)
def test_wrong_settings_say_what_to_write(flexible, arguments, words):
    with pytest.raises(ValueError, match=words):
        flexible.simulate(**{"duration": 1.0, "output": 0.5, **arguments})


def test_an_ensemble_is_its_single_runs(knuckle):
    loads = np.array([0.0, 200.0, 500.0])
    told = []
    ensemble = knuckle.replace(payload=loads).simulate_ensemble(duration=1.0, progress=lambda done, all: told.append((done, all)))
    assert list(ensemble.status) == ["done"] * 3 and told[-1] == (3, 3)
    name = "main_boom_theta_drive_torque"
    for row, load in enumerate(loads):
        run = knuckle.replace(payload=load).simulate(duration=1.0, verify=False)
        extremes = run.extremes(name)
        # The same steps of the same crane.
        assert ensemble[f"{name}_min"][row] == extremes["minimum"]
        assert ensemble[f"{name}_max_time"][row] == extremes["time_of_maximum"]
        np.testing.assert_array_equal(ensemble.q[row], [run[coordinate][-1] for coordinate in knuckle.coordinates])


def test_a_bad_row_of_an_ensemble_is_named_or_nan(knuckle):
    batch = knuckle.replace(payload=[100.0, 1e12])
    with pytest.raises(RuntimeError, match=r"row \[1\]: knuckle_boom: statics did not find"):
        batch.simulate_ensemble(duration=0.2)
    with pytest.warns(crane.InvalidRowWarning, match=r"row \[1\]"):
        ensemble = batch.simulate_ensemble(duration=0.2, invalid="nan")
    assert ensemble.status[0] == "done" and "statics did not find" in ensemble.status[1]
    assert np.isfinite(ensemble.table[0]).all() and np.isnan(ensemble.table[1]).all()


def test_a_simulation_comes_back_to_the_last_bit(knuckle):
    """Each time it is restored, and in another simulation; it agrees within the tolerance with the one that kept its history."""
    simulation = knuckle.simulation()
    for _ in range(5):
        simulation.step(0.05)
    saved = simulation.save()
    straight_on = [simulation.step(0.05) for _ in range(5)]
    simulation.restore(saved)
    first = [simulation.step(0.05) for _ in range(5)]
    other = knuckle.simulation()
    other.restore(saved)
    second = [other.step(0.05) for _ in range(5)]
    for a, b, c in zip(first, second, straight_on, strict=True):
        np.testing.assert_array_equal(a.q, b.q)
        np.testing.assert_array_equal(a.v, b.v)
        np.testing.assert_allclose(a.q, c.q, atol=1e-4)
    assert abs(simulation.t - 0.5) < 1e-12


@pytest.mark.parametrize("method", ["bdf", "rosw4"])
def test_short_calls_cost_no_more_than_a_run(flexible, method):
    """Two seconds in 200 calls take the evaluations of one call. Setting a parameter to its present value does not end the history."""
    one = flexible.simulation(method=method)
    one.step(2.0)
    many = flexible.simulation(method=method)
    for _ in range(200):
        many.step(0.01)
    again = flexible.simulation(method=method)
    for _ in range(200):
        again.step(0.01, load_mass=500.0)
    assert flexible.parameters["load_mass"] == 500.0
    changing = flexible.simulation(method=method)
    for call in range(200):
        changing.step(0.01, load_mass=500.0 + call % 2)
    counts = [of.statistics["evaluations"] for of in (one, many, again, changing)]
    assert counts[1] <= 1.02 * counts[0] and counts[2] == counts[1], counts
    assert counts[3] > 3 * counts[1], counts
    # Both follow the motion to the tolerance of a step, 2e-5, over some hundred steps.
    np.testing.assert_allclose(many.q, one.q, atol=1e-3)
    assert many.t == pytest.approx(2.0, abs=1e-12)


def test_a_simulation_is_the_run(knuckle):
    simulation = knuckle.simulation(tolerance=1e-8)
    path = [simulation.q[0]] + [simulation.step(0.1).q[0] for _ in range(10)]
    run = knuckle.simulate(duration=1.0, output=0.1, tolerance=1e-9, verify=False)
    # Errors of ten runs at 1e-8 each, some ten times that over a run.
    np.testing.assert_allclose(path, run[knuckle.coordinates[0]], atol=1e-6)
    energy = run["drive_work"][-1]
    assert abs(simulation.work - energy) < 1e-4 * max(abs(energy), 1.0)


def test_parameters_change_between_steps(knuckle):
    simulation = knuckle.simulation()
    before = simulation.save()
    simulation.step(0.2, payload=900.0)
    heavier = simulation.q
    assert simulation.crane.parameters["payload"] == 900.0
    simulation.restore(before)
    assert simulation.crane.parameters == before.parameters
    simulation.step(0.2)
    assert np.abs(simulation.q - heavier).max() > 1e-6
    with pytest.raises(crane.ParameterError):
        simulation.step(0.1, payload=-1.0)
    with pytest.raises(ValueError, match="has 4 coordinates"):
        simulation.restore(crane.State(0.0, np.zeros(2), np.zeros(2)))


def test_inputs_are_set_between_steps():
    """A mass on a spring whose far end jumps: it oscillates about the position where the spring is relaxed."""
    text = (
        "format: 1\nname: slide\ngravity: [0, 0, 0]\ninputs: {lever: {unit: m}}\n"
        "links: [{name: slide, joint: {prismatic: {axis: x}}, mass: 4, com: [0, 0, 0]}]\n"
        "drives: [{coordinate: slide_x, stiffness: 100, motion: {input: lever}}]\n"
    )
    simulation = crane.load("slide.yaml", text=text).simulation(tolerance=1e-9)
    assert simulation.crane.info["inputs"] == [{"name": "lever", "unit": "m", "about": "", "default": 0.0, "moves": False}]
    x = v = 0.0
    sine, cosine = np.sin(1.5), np.cos(1.5)
    for lever in [0.5, -0.2, 0.0]:
        state = simulation.step(0.3, inputs={"lever": lever})
        x, v = lever + (x - lever) * cosine + v / 5 * sine, v * cosine - (x - lever) * 5 * sine
        np.testing.assert_allclose([simulation.q[0], simulation.v[0]], [x, v], atol=2e-6)
    assert state.inputs == {"lever": 0.0}
    assert simulation.step(0.3, inputs={"lever": None}).inputs == {}
    with pytest.raises(ValueError, match="no input `levr`; inputs: lever"):
        simulation.step(0.1, inputs={"levr": 1.0})
    with pytest.raises(ValueError, match="not a finite number"):
        simulation.step(0.1, inputs={"lever": np.nan})


def test_inputs_hold_for_all_functions():
    """A spring whose far end is an input: where the mass rests, what moves it, and how a run goes."""
    text = (
        "format: 1\nname: slide\ngravity: [0, 0, 0]\ninputs: {lever: {unit: m}}\n"
        "links: [{name: slide, joint: {prismatic: {axis: x}}, mass: 4, com: [0, 0, 0]}]\n"
        "drives: [{coordinate: slide_x, stiffness: 100, motion: {input: lever}}]\n"
    )
    slide = crane.load("slide.yaml", text=text)
    pulled = slide.replace(inputs={"lever": 0.3})
    assert slide.inputs == {} and pulled.inputs == {"lever": 0.3}
    np.testing.assert_allclose(pulled.forces([[0.0], [0.1]], [0.0]), [[30.0], [20.0]], rtol=1e-12)
    np.testing.assert_allclose(pulled.forces([0.0], [0.0]), [30.0], rtol=1e-12)
    assert slide.forces([0.0], [0.0]) == 0.0
    # From 0: x = 0.3 (1 − cos 5t).
    run = slide.simulate(duration=1.0, q=[0.0], tolerance=1e-9, inputs={"lever": 0.3}, verify=False)
    np.testing.assert_allclose(run["slide_x"], 0.3 * (1.0 - np.cos(5.0 * run.t)), atol=2e-6)
    assert pickle.loads(pickle.dumps(pulled)).inputs == {"lever": 0.3}
    assert pulled.replace(inputs={"lever": None}).inputs == {}
    assert crane.load("slide.yaml", text=text, inputs={"lever": 0.1}).inputs == {"lever": 0.1}
    with pytest.raises(ValueError, match="no input `levr`; inputs: lever"):
        slide.replace(inputs={"levr": 1.0})


def test_a_pendulum_swings_in_time(pendulum):
    """A step for a controller costs no more than the motion needs: a second of a pendulum in far less than a second."""
    simulation = pendulum.simulation(q=[0.1])
    begin = time.process_time()
    for _ in range(100):
        simulation.step(0.01)
    assert time.process_time() - begin < 1.0


def test_oil_moves_a_crane_and_its_states_are_saved():
    """Pressures and valves continue from their saved states; functions that would lack the cylinders' forces raise an error."""
    boom = crane.load("eight_link_hydraulic")
    with pytest.raises(ValueError, match="pressures"):
        boom.forward_dynamics(boom.statics().q, np.zeros(boom.n))
    simulation = boom.simulation()
    simulation.step(0.2)
    saved = simulation.save()
    assert saved.x.shape == (28,) and (saved.x[[0, 1, 3, 4, 6, 7, 9]] > 1e5).all()
    first = simulation.step(0.1)
    simulation.restore(saved)
    second = simulation.step(0.1)
    np.testing.assert_allclose(second.x, first.x, rtol=1e-3, atol=1e-3)
    # At first, the cylinder holds the boom with the torque that statics reports.
    run = boom.simulate(duration=0.1)
    np.testing.assert_allclose(run["boom_psi_drive_torque"][0], boom.statics().drive_efforts[1], rtol=1e-9)


def test_a_pendulum_on_a_turning_shaft():
    """On a shaft that turns freely at a rate Ω, a pendulum keeps `cos θ = g/(l Ω²)`, and swings with `ω² = Ω² (1 + 3 cos² θ)`."""
    text = """
format: 1
name: pendulum
links:
  - {name: shaft, joint: {revolute: {axis: z}}, mass: 1, com: [0, 0, 0], inertia: {Ixx: 1e-12, Iyy: 1e-12, Izz: 1e-12}}
  - {name: rod, joint: {revolute: {axis: y}}, mass: 3, com: [0, 0, -0.8]}
"""
    c = crane.load("pendulum.yaml", text=text)
    rates = np.array([4.0, 5.0, 6.0])
    found = c.steady_motion(rates={"shaft_psi": rates}, start=[0.0, 1.0])
    cosine = 9.81 / (0.8 * rates**2)
    np.testing.assert_allclose(np.cos(found.q[:, 1]), cosine, rtol=1e-12)
    np.testing.assert_allclose(found.efforts, 0.0, atol=1e-9)
    small = c.linearise(found.q, found.v)
    np.testing.assert_allclose(small.gyroscopic[:, 0, 1], -small.gyroscopic[:, 1, 0])
    fastest = np.abs(np.linalg.eigvals(small.state_matrix).imag).max(axis=-1)
    np.testing.assert_allclose(fastest**2, rates**2 * (1.0 + 3.0 * cosine**2), rtol=1e-9)
    # At rest nothing holds the shaft's angle.
    with pytest.raises(crane.NoEquilibrium, match="no steady motion"):
        c.steady_motion()
    with pytest.raises(ValueError, match="no coordinate 'shaft'"):
        c.steady_motion(rates={"shaft": 1.0})


def test_linearising_at_rest_is_linearising_without_rates():
    c = crane.load("eight_link_flexible")
    q = c.statics().q
    rest, motion = c.linearise(q), c.linearise(q, np.zeros(c.n))
    for one, other in zip(rest, motion, strict=True):
        np.testing.assert_allclose(other, one, rtol=0, atol=1e-13 * np.abs(one).max())


def test_arguments_that_mean_nothing_are_refused(knuckle):
    """Each is refused with a message that names it: none has a result."""
    here = {"main_boom_theta": [0.0]}
    for call, words in [
        (lambda: knuckle.statics(tolerance=np.nan), "tolerance=NaN"),
        (lambda: knuckle.statics(tolerance=0), "tolerance=0"),
        (lambda: knuckle.statics(tolerance=-1), "tolerance=-1"),
        (lambda: knuckle.statics(tolerance=np.inf), "tolerance=inf"),
        (lambda: knuckle.statics(iterations=0), "iterations=0"),
        (lambda: knuckle.statics(t=np.nan), "t is NaN"),
        (lambda: knuckle.statics(t=[0.0, np.inf]), r"row \[1\]: t is inf"),
        (lambda: knuckle.statics(guess=[0.0, np.nan, 0.0, 0.0]), r"guess\[1\]"),
        (lambda: knuckle.modes(q=[0.0, np.nan, 0.0, 0.0]), r"q\[1\]"),
        (lambda: knuckle.stability(q=[0.0, np.inf, 0.0, 0.0]), r"q\[1\]"),
        (lambda: knuckle.envelope(here, greatest_load=np.nan), "greatest_load=NaN"),
        (lambda: knuckle.envelope(here, greatest_load=np.inf), "greatest_load=inf"),
        (lambda: knuckle.envelope({"main_boom_theta": [1e300]}), "1e300 is beyond"),
        (lambda: knuckle.envelope({"main_boom_theta": [-1e5]}), "-1e5 is beyond"),
        (lambda: knuckle.simulate(duration=0.1, bend_limit=np.nan), "bend_limit=NaN"),
        (lambda: knuckle.simulate(duration=0.1, bend_limit=-1), "bend_limit=-1"),
        (lambda: knuckle.simulation(t=np.nan), "t is NaN"),
        (lambda: knuckle.simulation(q=knuckle.guess, v=np.full(4, np.nan)).step(0.1), r"v\[0\]"),
        (lambda: knuckle.simulate_ensemble(duration=0.1, q=np.full((2, 4), np.nan)), r"row \[0\]: q\[0\]"),
    ]:
        with pytest.raises(ValueError, match=words):
            call()


def test_bad_parameters_are_bad_at_all_times_and_poses(knuckle):
    """A row of parameters that breaks a rule gives NaN wherever it is combined with others, not the numbers of another row."""
    with pytest.warns(crane.InvalidRowWarning):
        batch = knuckle.replace(payload=[100.0, -1.0, 300.0], invalid="nan")
    for found in (
        lambda: batch.statics(t=[[0.0], [1.0]], invalid="nan").q,
        lambda: batch.modes(np.zeros((2, 1, 4)), invalid="nan").omega_squared,
        lambda: batch.stability(np.zeros((2, 1, 4)), invalid="nan").steps["rk4"][..., None],
        lambda: np.broadcast_to(batch.guess, (2, 3, 4)),
    ):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            numbers = found()
        np.testing.assert_array_equal(np.isnan(numbers).all(axis=-1), [[False, True, False]] * 2)
    with pytest.warns(crane.InvalidRowWarning):
        assert list(batch.statics(invalid="nan").status) == ["stable", "invalid", "stable"]


def test_a_simulation_can_be_copied_and_pickled(flexible):
    """A copy, stepped or not, goes on as the original does, to the last bit; test_stepping.py has other methods and cranes."""
    original = flexible.simulation()
    for dt in (0.05, 0.1):
        original.step(dt, load_mass=200.0)
        copies = [copy.deepcopy(original), pickle.loads(pickle.dumps(original)), copy.copy(original)]
        assert all(one.statistics == original.statistics for one in copies)
        expected = original.step(0.1)
        for one in copies:
            state = one.step(0.1)
            np.testing.assert_array_equal([state.q, state.v], [expected.q, expected.v])
            assert (state.t, state.work, state.parameters) == (expected.t, expected.work, expected.parameters)
            assert not one.q.flags.writeable


def test_states_cannot_be_changed_in_place(knuckle):
    own = knuckle.guess.copy()
    simulation = knuckle.simulation(q=own)
    own[:] = 7
    for _ in range(2):
        saved = simulation.save()
        for array in (simulation.q, simulation.v, saved.q, saved.v, saved.x):
            with pytest.raises(ValueError, match="read-only"):
                array[...] = 99.0
        simulation.step(0.01)
    given = crane.State(0.0, knuckle.guess.copy(), np.zeros(4))
    simulation.restore(given)
    given.q[:] = 99.0
    np.testing.assert_array_equal(simulation.q, knuckle.guess)
    # A state with other numbers is restored.
    simulation.restore(dataclasses.replace(saved, q=saved.q + 0.01))
    np.testing.assert_array_equal(simulation.q, saved.q + 0.01)


def test_an_ensemble_over_inputs_and_starts():
    """Masses on springs whose far ends are inputs: x = u + (x₀ − u) cos ωt + v₀/ω sin ωt, over all axes."""
    text = (
        "format: 1\nname: slide\ngravity: [0, 0, 0]\ninputs: {lever: {unit: m}, push: {unit: N}}\n"
        "parameters: {block: {value: 4, unit: kg}}\n"
        "links: [{name: slide, joint: {prismatic: {axis: x}}, mass: block, com: [0, 0, 0]}]\n"
        "drives: [{coordinate: slide_x, stiffness: 100, motion: {input: lever}}]\n"
        "points: [{name: end, link: slide, at: [0, 0, 0]}]\n"
        "loads: [{name: push, link: slide, at: [0, 0, 0], force: [1, 0, 0], scale: {input: push}}]\n"
    )
    masses, levers = np.array([1.0, 4.0]), np.array([[0.3], [-0.1], [0.0]])
    q, v = np.array([[[0.1]], [[0.2]], [[0.0]]]), np.array([0.5])
    slide = crane.load("slide.yaml", text=text, block=masses)
    for settings in ({"tolerance": 1e-9}, {"method": "rk4", "step": 1e-3}):
        found = slide.simulate_ensemble(duration=1.0, output=0.5, q=q, v=v, inputs={"lever": levers, "push": None}, **settings)
        omega = np.sqrt(100 / masses)
        expected = levers + (q[..., 0] - levers) * np.cos(omega) + 0.5 / omega * np.sin(omega)
        assert found.time.shape == found.done.shape == (3, 2) and found.done.all()
        np.testing.assert_allclose(found["end_x_end"], expected, atol=2e-6)
    frame = found.to_pandas()
    assert list(frame.columns[:2]) == ["block", "lever"] and frame.attrs["units"]["end_x_end"] == "m" and len(frame) == 6
    np.testing.assert_array_equal(frame["lever"], np.repeat(levers[:, 0], 2))
    np.testing.assert_array_equal(frame["end_x_end"], found["end_x_end"].ravel())
    with pytest.raises(ValueError, match="no input `levr`"):
        slide.simulate_ensemble(inputs={"levr": [1.0]})
    with pytest.raises(ValueError, match=r"inputs\['lever'\] is NaN"):
        slide.simulate_ensemble(inputs={"lever": [0.0, np.nan]})
    with pytest.raises(ValueError, match="do not match"):
        slide.simulate_ensemble(inputs={"lever": [0.0, 1.0, 2.0]})
    with pytest.raises(TypeError, match="is one number, except in `simulate_ensemble`"):
        slide.replace(inputs={"lever": [0.0, 1.0]})


def test_forces_with_states_say_what_to_use_instead():
    boom = crane.load("eight_link_hydraulic")
    q = boom.statics().q
    v = np.zeros(boom.n)
    for name, call in [
        ("forward_dynamics", lambda: boom.forward_dynamics(q, v)),
        ("forces", lambda: boom.forces(q, v)),
        ("force_derivatives", lambda: boom.force_derivatives(q, v)),
        ("drive_forces", lambda: boom.drive_forces(q, v)),
        ("drive_power", lambda: boom.drive_power(q, v)),
        ("dissipation", lambda: boom.dissipation(q, v)),
        ("friction_forces", lambda: boom.friction_forces(v)),
    ]:
        with pytest.raises(ValueError, match=f"{name} of eight_link_hydraulic follows from .*bristles, which are states of a run: use (state_|columns_at|simulate)"):
            call()
    with pytest.raises(ValueError, match=r"use state_derivatives\(q, v, x, t\)"):
        boom.strength(q, v)
    with pytest.raises(ValueError, match=r"use state_space\(q\), or modes\(q\)"):
        boom.linearise(q)
    with pytest.raises(ValueError, match=r"use modes\(q\)"):
        boom.linearise(q, v)
    # Friction without bristles follows from the rates.
    rubbing = crane.load("rubbing.yaml", text=PENDULUM + "friction: {rod_theta: {coulomb: 3}}\n")
    np.testing.assert_allclose(rubbing.friction_forces([[5.0], [-5.0]]), [[-3.0], [3.0]], rtol=1e-6)


def test_a_closed_loop_is_pushed_by_a_load_at_its_time():
    """A slide along y on one along x, whose end keeps to a line at 45°: `F(t) = (m + 2 M) ẍ` and ÿ = ẍ."""
    text = """
format: 1
name: corner
links:
  - {name: along, joint: {prismatic: {axis: x}}, mass: 2, com: [0, 0, 0]}
  - {name: aside, joint: {prismatic: {axis: y}}, mass: 3, com: [0, 0, 0]}
loop_joints: [{name: groove, from: {at: [0, 0, 0]}, to: {link: aside, at: [0, 0, 0]}, joint: {slide: {axis: [1, 1, 0]}}}]
loads: [{name: push, link: along, force: [16, 0, 0], scale: {cubic: {from: 0, to: 1, duration: 2}}}]
"""
    c = crane.load("corner.yaml", text=text)
    # Half of the load at half of its time; some roundings.
    found = c.forward_dynamics([0.4, 0.4], [0.0, 0.0], [0.0, 1.0, 2.0])
    np.testing.assert_allclose(found, [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]], atol=1e-12)


def test_what_is_printed_is_short(knuckle):
    run = knuckle.simulate(duration=0.2, verify=False)
    ensemble = knuckle.replace(payload=[1.0, 2.0]).simulate_ensemble(duration=0.2)
    assert repr(run).startswith("<run of knuckle_boom: 0.2 s from the static equilibrium, at rest, bdf, ")
    assert repr(ensemble).startswith("<2 runs of knuckle_boom: 2 done, ")
    assert len(repr(run)) < 200 and len(repr(ensemble)) < 200
    assert run.to_pandas().attrs["units"]["main_boom_theta"] == "rad"
    # Of public names, as help and completion show them, none is internal.
    for name in (name for name in dir(knuckle) if not name.startswith("_")):
        assert not any(word in name for word in ("rows", "record", "equilibria", "describe")) and name != "motion", name
