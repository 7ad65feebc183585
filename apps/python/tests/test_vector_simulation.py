"""Many cranes that are stepped together."""

import copy
import pickle

import crane
import numpy as np
import pytest
from test_stepping import STEERED

MASSES = np.array([100.0, 800.0, 300.0])
LEVERS = np.random.default_rng(3).uniform(-5e3, 5e3, (6, 3))


@pytest.fixture
def cranes():
    return crane.load("steered.yaml", text=STEERED, payload=MASSES).vector_simulation(inputs={"push": 500.0})


def alone(row, hold, steps=6):
    """The same row as a simulation of its own."""
    c = crane.load("steered.yaml", text=STEERED, payload=MASSES[row], inputs={"push": 500.0})
    simulation = c.simulation()
    return [simulation.step(0.02, inputs={"boom": LEVERS[step, row]}, hold=hold) for step in range(steps)]


@pytest.mark.parametrize("hold", ["constant", "linear"])
def test_rows_are_single_simulations_to_the_last_bit(cranes, hold):
    together = copy.deepcopy(cranes)
    path = [cranes.step(0.02, {"boom": LEVERS[step]}, hold=hold) for step in range(6)]
    run = together.run(0.02, 6, {"boom": LEVERS}, hold=hold)
    assert run.q.shape == (6, 3, 4) and run.t.shape == (6, 3)
    for row in range(3):
        for step, expected in enumerate(alone(row, hold)):
            for q, v in ((path[step].q[row], path[step].v[row]), (run.q[step, row], run.v[step, row])):
                np.testing.assert_array_equal([q, v], [expected.q, expected.v])
    np.testing.assert_array_equal(cranes.inputs["boom"], LEVERS[-1])
    assert not path[0].q.flags.writeable and len(cranes) == 3
    assert cranes.statistics["evaluations"].shape == (3,)


def test_threads_do_not_matter(cranes):
    expected = copy.deepcopy(cranes).run(0.02, 6, {"boom": LEVERS})
    before = crane.threads()
    try:
        crane.set_threads(1)
        np.testing.assert_array_equal(cranes.run(0.02, 6, {"boom": LEVERS}).q, expected.q)
    finally:
        crane.set_threads(before)


def test_single_rows_are_reset(cranes):
    begin = cranes.state
    cranes.run(0.02, 6, {"boom": LEVERS})
    kept = cranes.q
    state = cranes.reset([1], payload=300.0, inputs={"boom": 0.0})
    np.testing.assert_array_equal(state.q[[0, 2]], kept[[0, 2]])
    # Row 1 now has the mass of row 2, and begins where that began.
    np.testing.assert_array_equal(state.q[1], begin.q[2])
    np.testing.assert_allclose(state.t, [0.12, 0.0, 0.12], atol=1e-12)
    np.testing.assert_array_equal(cranes.parameters["payload"], [100.0, 300.0, 300.0])
    after = cranes.step(0.02, {"boom": LEVERS[0, 2]})
    np.testing.assert_array_equal(after.q[1], alone(2, "constant", 1)[0].q)
    cranes.reset(np.array([True, False, True]), q=kept[0], v=np.zeros(4), t=1.0)
    np.testing.assert_array_equal(cranes.q[[0, 2]], kept[[0, 0]])
    np.testing.assert_array_equal(cranes.t[[0, 2]], 1.0)


def test_copies_go_on_to_the_last_bit(cranes):
    cranes.run(0.02, 3, {"boom": LEVERS[:3]}, hold="linear")
    for other in (copy.deepcopy(cranes), pickle.loads(pickle.dumps(cranes)), copy.copy(cranes)):
        expected = copy.deepcopy(cranes).run(0.02, 3, {"boom": LEVERS[3:]})
        np.testing.assert_array_equal(other.run(0.02, 3, {"boom": LEVERS[3:]}).q, expected.q)
        np.testing.assert_array_equal(other.inputs["boom"], LEVERS[-1])
    np.testing.assert_array_equal(cranes.inputs["boom"], LEVERS[2])


def test_a_row_that_fails_stays_and_says_why(pendulum):
    """A rate beyond all bounds in one row."""
    cranes = pendulum.vector_simulation(q=[[0.1], [0.1]], v=[[0.0], [1e9]])
    state = cranes.step(0.1, invalid="nan")
    first, second = cranes.failures
    assert first is None and second
    assert state.t[0] == 0.1 and state.t[1] == 0.0
    with pytest.raises(RuntimeError):
        cranes.step(0.1)
    with pytest.raises(ValueError, match="reset them first"):
        copy.deepcopy(cranes)
    cranes.reset([1], q=[0.1], v=[0.0])
    assert cranes.failures == [None, None]
    cranes.step(0.1)


def test_what_is_refused(cranes, knuckle):
    for call, words in [
        (lambda: cranes.step(0.02, {"bom": 1.0}), "no input 'bom': write one of boom, knuckle, push"),
        (lambda: cranes.step(0.02, {"boom": [1.0, 2.0]}), r"shape \[2\]: give one number, 3 of them"),
        (lambda: cranes.step(0.02, {"boom": np.nan}), "nan, not a finite number|NaN, not a finite number"),
        (lambda: cranes.step(-1.0), "dt=-1"),
        (lambda: cranes.step(0.1, hold="x"), "hold='x'"),
        (lambda: cranes.step(0.1, invalid="x"), "invalid='x'"),
        (lambda: cranes.run(0.1, 0), "steps=0"),
        (lambda: cranes.reset([0, 0]), "different ones from 0 to 2"),
        (lambda: cranes.reset([3]), "different ones from 0 to 2"),
        (lambda: cranes.reset([0], paylod=1.0), "no live parameter 'paylod': write one of payload"),
        (lambda: knuckle.vector_simulation(), "give `count`"),
        (lambda: knuckle.replace(payload=[1.0, 2.0]).vector_simulation(3), "broadcast"),
    ]:
        with pytest.raises(ValueError, match=words):
            call()
    # A reset that fails changes nothing.
    with pytest.raises(crane.ParameterError):
        cranes.reset([0], payload=-1.0)
    np.testing.assert_array_equal(cranes.parameters["payload"], MASSES)
    cranes.step(0.02)
