"""What is wrong with an argument is said in words that show what to write, and what would change nothing is refused."""

import copy
import pickle
import re
import warnings

import crane
import numpy as np
import pytest
from crane.experiments import Run

PAIRED = [0, 3, 1, 2]
STEERED = """
format: 1
name: steered
inputs: {turn: {unit: rad}}
links:
  - {name: arm, joint: {revolute: {axis: y}}, mass: 10, com: [1, 0, 0], inertia: {gyration: [0.1, 0.5, 0.5]}}
drives: [{coordinate: arm_theta, stiffness: 1e5, damping: 1e3, motion: {input: turn}}]
"""


@pytest.fixture(scope="module")
def oil():
    return crane.load("eight_link_hydraulic")


def test_states_of_forces_must_be_finite(oil):
    state = oil.simulation().step(0.1)
    wrong = np.array([state.x, state.x])
    wrong[1, 3] = np.nan
    for of in (oil.state_derivatives, oil.columns_at, lambda q, v, x, **how: oil.state_space(q, v, x=x, **how)):
        with pytest.raises(ValueError, match=r"row \[1\]: x\[3\] \(.*\) is NaN, not a finite number"):
            of(state.q, state.v, wrong)
    with pytest.warns(crane.InvalidRowWarning, match=r"row \[1\]: x\[3\]"):
        accelerations, rates = oil.state_derivatives(state.q, state.v, wrong, invalid="nan")
    assert np.isfinite(accelerations[0]).all() and np.isnan(accelerations[1]).all() and np.isnan(rates[1]).all()
    np.testing.assert_array_equal(rates[0], oil.state_derivatives(state.q, state.v, state.x)[1])


def test_accelerations_that_overflow_are_refused(knuckle):
    q, v = knuckle.guess, np.full((2, 4), 0.1)
    v[1] = 1e200
    for of in (knuckle.forward_dynamics, lambda *state, **how: knuckle.state_derivatives(*state, **how)[0]):
        with pytest.raises(ValueError, match="accelerations are not finite: rates are too large"):
            of(q, v[1])
        with pytest.raises(ValueError, match=r"row \[1\]: accelerations are not finite"):
            of(q, v)
        with pytest.warns(crane.InvalidRowWarning, match=r"1 rows are NaN: row \[1\]"):
            found = of(q, v, invalid="nan")
        np.testing.assert_array_equal(found[0], knuckle.forward_dynamics(q, v[0]))
        assert np.isnan(found[1]).all()
    for of in (lambda: knuckle.joint_states(q * np.nan), lambda: knuckle.coordinates_of({"hook_theta": np.nan})):
        with pytest.raises(ValueError, match="write finite numbers"):
            of()
    with pytest.raises(ValueError, match=r"frequencies=\[ 1. nan\]"):
        knuckle.state_space(q).frequency_response([1.0, np.nan])


def test_no_states_of_forces_are_an_empty_array(knuckle, oil):
    state = knuckle.simulation().step(0.1)
    assert state.x.shape == (0,)
    plain = knuckle.state_derivatives(state.q, state.v, t=state.t)
    for one, other in zip(plain, knuckle.state_derivatives(state.q, state.v, state.x, state.t), strict=True):
        np.testing.assert_array_equal(one, other)
    assert knuckle.columns_at(state.q, state.v, [], state.t)["main_boom_theta"] == state.q[0]
    with pytest.raises(ValueError, match="x needs 0 numbers in its last axis: knuckle_boom has no states of forces"):
        knuckle.columns_at(state.q, state.v, [1.0])
    # Before the first step they are those that hold the pose: with them it goes on to the last bit, and nothing accelerates.
    simulation = oil.simulation()
    saved = simulation.save()
    assert saved.x.shape == state_count(oil)
    assert np.abs(oil.state_derivatives(saved.q, saved.v, saved.x)[0]).max() < 1e-4
    first = simulation.step(0.05)
    other = oil.simulation()
    other.restore(saved)
    np.testing.assert_array_equal(other.step(0.05).x, first.x)


def state_count(c):
    rest = c.guess
    return c.state_derivatives(rest, 0 * rest)[1].shape


def test_a_row_of_an_ensemble_that_is_not_finite_is_nan(knuckle):
    q = np.array([knuckle.guess, knuckle.guess, knuckle.guess])
    q[1, 2] = np.nan
    with pytest.raises(ValueError, match=r"row \[1\]: q\[2\] \(.*\) is NaN"):
        knuckle.simulate_ensemble(q=q, duration=0.1)
    with pytest.warns(crane.InvalidRowWarning, match=r"1 rows are NaN: row \[1\]: q\[2\]"):
        found = knuckle.simulate_ensemble(q=q, duration=0.1, invalid="nan")
    assert found.status.tolist()[::2] == ["done", "done"] and "q[2]" in found.status[1]
    assert np.isnan(found.table[1]).all() and np.isnan(found.q[1]).all() and np.isnan(found.steps[1])
    # Rows do not depend on those beside them but for the steps of their fleet.
    alone = knuckle.simulate_ensemble(q=q[::2], duration=0.1)
    np.testing.assert_array_equal(found.table[::2], alone.table)


def test_parameters_and_guess_cannot_be_set(knuckle):
    for of in (knuckle.parameters, knuckle.inputs):
        with pytest.raises(TypeError, match=r"never changes: `c\.replace\(NAME=\.\.\.\)`"):
            of["payload"] = 3.0
        with pytest.raises(TypeError, match="never changes"):
            of.update(payload=3.0)
    with pytest.raises(ValueError, match="read-only"):
        knuckle.guess[0] = 9.0
    batch = knuckle.replace(payload=[1.0, 2.0])
    with pytest.raises(ValueError, match="read-only"):
        batch.parameters["payload"][0] = 9.0
    copies = [copy.deepcopy(knuckle.parameters), pickle.loads(pickle.dumps(knuckle.parameters)), {**knuckle.parameters}]
    for own in copies:
        own["payload"] = 3.0
        assert knuckle.replace(**own).parameters["payload"] == 3.0 and knuckle.parameters["payload"] == 800.0
    assert pickle.loads(pickle.dumps(batch)).parameters["payload"].tolist() == [1.0, 2.0]


def test_columns_of_data_frames_are_taken_by_name(knuckle):
    pandas = pytest.importorskip("pandas")
    rng = np.random.default_rng(5)
    q, v = rng.uniform(-0.4, 0.4, (2, 3, 4))
    names = np.array(knuckle.coordinates)
    frame = pandas.DataFrame(q[:, PAIRED], columns=names[PAIRED])
    rates = pandas.DataFrame(v[:, PAIRED], columns=[f"{name}_rate" for name in names[PAIRED]])
    right = knuckle.forward_dynamics(q, v)
    np.testing.assert_array_equal(knuckle.forward_dynamics(frame, rates), right)
    np.testing.assert_array_equal(knuckle.forward_dynamics(frame.iloc[1], v[1]), right[1])
    np.testing.assert_array_equal(knuckle.joint_states(frame).position, q)
    np.testing.assert_array_equal(knuckle.modes(frame).frequencies, knuckle.modes(q).frequencies)
    np.testing.assert_array_equal(knuckle.simulation(q=frame.iloc[0]).q, q[0])
    np.testing.assert_array_equal(knuckle.vector_simulation(q=frame).q, q)
    # Without names, by place.
    np.testing.assert_array_equal(knuckle.points(pandas.DataFrame(q)), knuckle.points(q))
    for wrong in (frame.rename(columns={"hook_theta": "hook"}), frame.assign(t=0.0), frame[names[:3]], rates):
        with pytest.raises(ValueError, match=r"not called after the coordinates of knuckle_boom: write frame\[c.coordinates\]"):
            knuckle.points(wrong)


def test_one_name_is_a_list_of_it(knuckle):
    q, v = knuckle.guess, np.zeros(4)
    model = knuckle.state_space(q, inputs="main_boom_theta_prescribed", outputs="hook_theta")
    assert model.inputs == ("main_boom_theta_prescribed",) and model.outputs == ("hook_theta",)
    assert list(knuckle.columns_at(q, v, names="hook_theta")) == ["hook_theta"]
    chart = knuckle.envelope({"main_boom": [-0.5]}, without="stops")
    assert chart.considered == knuckle.envelope({"main_boom": [-0.5]}, without=["stops"]).considered


def messages(knuckle):
    """Calls, the exception, and what it says."""
    q, t = knuckle.guess, np.linspace(0.0, 1.0, 5)
    yield lambda: knuckle.statics(hold=["main_boom"]), TypeError, 'hold has values by name, as hold={"boom": "20 deg"}: it is not list'
    yield lambda: knuckle.envelope([1.0]), TypeError, "ranges has values by name"
    yield lambda: knuckle.coordinates_of([1.0]), TypeError, 'positions has values by name, as positions={"main_boom_theta": 0.1}: it is not list'
    yield lambda: knuckle.sensitivity(frequencies=-1), ValueError, "frequencies=-1: write how many of the lowest ones, 0 or more"
    yield lambda: crane.set_threads(-1), ValueError, "set_threads(-1): write a number of 1 or more, or None"
    yield lambda: knuckle.vector_simulation(-1), ValueError, "count=-1: write how many cranes, 1 or more"
    yield lambda: knuckle.simulation().restore(None), TypeError, "restore takes a state that `save` or `step` has returned, not NoneType"
    yield lambda: knuckle.simulate(verify="no"), TypeError, "verify='no': write True or False"
    yield lambda: knuckle.simulate(duration="3 s"), TypeError, "duration='3 s': write one number, in s"
    yield lambda: knuckle.simulate(tolerance=[1e-5, 1e-6]), TypeError, "tolerance=[1e-05, 1e-06]: write one number, in m and rad"
    yield lambda: knuckle.envelope({"main_boom": [-0.5]}, tipping=2), ValueError, "tipping=2: write a number from 0 to below 1"
    yield lambda: knuckle.envelope({"main_boom": [-0.5]}, utilisation=-1), ValueError, "utilisation=-1: write a number above 0"
    yield lambda: knuckle.envelope({"main_boom": [-0.5]}, load_factor=0), ValueError, "load_factor=0: write a number above 0"
    yield lambda: knuckle.frames({"a": ("hook", [0.0, 0.0, np.nan])}), ValueError, "frame 'a': write (link, [x, y, z]), finite numbers of m"
    for column, words in ((np.where(t == 0.0, np.inf, t), "infinite values"), (t * np.nan, "no values")):
        yield lambda column=column: crane.fit(knuckle, {"payload": None}, Run(t, {"hook_theta": column})), ValueError, f"run: hook_theta holds {words}"


def test_messages_say_what_to_write(knuckle):
    for call, kind, words in messages(knuckle):
        with pytest.raises(kind, match=re.escape(words)):
            call()


def test_inputs_of_a_step_may_have_units():
    """As text, 20 mrad = 0.02 rad; a wrong one leaves the simulation where it was."""
    c = crane.load("steered.yaml", text=STEERED)
    simulations = [c.simulation(), c.simulation(), c.vector_simulation(1)]
    found = [of.step(0.1, inputs={"turn": value}) for of, value in zip(simulations, (0.02, "20 mrad", "20 mrad"), strict=True)]
    assert simulations[1].crane.inputs == {"turn": 0.02} and simulations[2].inputs["turn"].tolist() == [0.02]
    for other in found[1:]:
        np.testing.assert_array_equal(np.squeeze(other.q), found[0].q)
    np.testing.assert_array_equal(simulations[0].step(0.1, {"turn": np.array([0.03])}).q, simulations[1].step(0.1, {"turn": 0.03}).q)
    for wrong, kind in (({"turn": "2 m"}, ValueError), ({"turn": [0.0, 1.0]}, ValueError), ([0.0], TypeError)):
        with pytest.raises(kind, match="turn.* is in rad|has shape|inputs has values by name"):
            simulations[1].step(0.1, inputs=wrong)
        assert simulations[1].t == pytest.approx(0.2)


def test_measured_columns_may_be_a_data_frame():
    pandas = pytest.importorskip("pandas")
    assert list(Run([0.0, 1.0], pandas.DataFrame({"hook_theta": [0.1, 0.2]})).columns) == ["hook_theta"]


def test_utilisation_without_an_allowable_stress_is_told(flexible):
    held = flexible.strength()
    assert held.tipping_margin > 0.0
    with pytest.warns(crane.InvalidRowWarning, match="no beam has an allowable stress; write `yield_stress`"):
        assert np.isnan(held.utilisation).all()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert crane.load("loader_tipping").strength().utilisation.max() > 0.0


def test_help_shows_types_by_their_names():
    import inspect

    signature = str(inspect.signature(crane.Crane.simulate))
    assert "q: 'ArrayLike | None' = None" in signature and "Buffer" not in signature and len(signature) < 1000


