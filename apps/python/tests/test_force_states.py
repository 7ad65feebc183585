"""Functions of states that include those of forces, against runs that SciPy integrates and columns of runs."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import crane


@pytest.fixture(scope="module")
def oil():
    return crane.load("eight_link_hydraulic")


def test_scipy_integrates_what_the_crane_does(oil):
    """An implicit method of SciPy, on the right-hand side, ends where the crane's own method does."""
    simulation = oil.simulation(tolerance=1e-8)
    start = simulation.step(0.3)
    n, count = oil.n, start.x.size

    def slope(t, y):
        accelerations, rates = oil.state_derivatives(y[:n], y[n : 2 * n], y[2 * n :], t)
        return np.concatenate([y[n : 2 * n], accelerations, rates])

    # Pressures of 1e5 to 1e7 Pa, spools of order 1.
    scales = np.where(np.abs(start.x) > 1e3, 1e2, 1e-6)
    begin = np.concatenate([start.q, start.v, start.x])
    tolerances = np.concatenate([np.full(2 * n, 1e-8), scales])
    found = solve_ivp(slope, (start.t, start.t + 0.05), begin, method="Radau", rtol=1e-7, atol=tolerances).y[:, -1]
    end = simulation.step(0.05)
    assert np.abs(found[:n] - end.q).max() < 2e-6
    assert count == oil.state_derivatives(start.q, start.v, start.x)[1].shape[-1]
    assert np.abs(found[2 * n :] - end.x).max() < 1e-4 * np.abs(end.x).max()


def test_columns_are_those_of_a_run(oil):
    run = oil.simulate(duration=0.2, output=0.1, verify=False)
    simulation = oil.simulation()
    state = simulation.step(0.2)
    names = ["boom_cylinder_piston_pressure", "boom_psi_drive_torque", "log_middle_z"]
    found = oil.columns_at(state.q, state.v, state.x, state.t, names=names)
    for name in names:
        # The same run with steps that end elsewhere, both with the default tolerance.
        assert found[name] == pytest.approx(run[name][-1], rel=1e-3)


def test_batches_and_cranes_without_states(oil):
    knuckle = crane.load("knuckle_boom")
    rng = np.random.default_rng(3)
    q, v = rng.uniform(-0.5, 0.5, (2, 5, knuckle.n))
    accelerations, rates = knuckle.state_derivatives(q, v)
    assert rates.shape == (5, 0)
    np.testing.assert_array_equal(accelerations, knuckle.forward_dynamics(q, v))
    rest = oil.statics().q
    held = oil.state_derivatives(rest, np.zeros(oil.n))[0]
    # Shut valves hold the pose: what is left is the residual of the equilibrium over the smallest inertia.
    assert np.abs(held).max() < 1e-4
    with pytest.raises(ValueError, match="x needs 28 numbers in its last axis: .*pressure"):
        oil.state_derivatives(rest, rest, np.zeros(3))
    with pytest.raises(ValueError, match="knuckle_boom has no states of forces: leave x out"):
        knuckle.columns_at(q, v, np.zeros(2))
    with pytest.raises(ValueError, match="there is no column 'tipz'"):
        knuckle.columns_at(q, v, names=["tipz"])
