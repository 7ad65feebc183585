"""Products of vectors with the derivatives of functions."""

import crane
import numpy as np
import pytest

from conftest import ROOT

#: Functions of all kinds of results: vectors, points, pairs, rows, tensions, numbers.
FUNCTIONS = [
    "dynamic_residual",
    "forward_dynamics",
    "inverse_dynamics",
    "forces",
    "bias",
    "points",
    "point_accelerations",
    "point_jacobians",
    "connector_tensions",
    "loop_states",
    "drive_motions",
    "support_reactions",
    "gravity_energy",
    "dissipation",
]
CRANES = ["knuckle_boom", "eight_link_flexible", "loader_tipping", "two_arms", "eight_link_hydraulic"]


def given(c, function, rows, rng):
    """Random states with the arguments that a function has."""
    takes = next(takes for name, takes, _ in crane._native.functions() if name == function)
    every = {
        "q": c.guess + 0.01 * rng.normal(size=(rows, c.n)),
        "v": 0.1 * rng.normal(size=(rows, c.n)),
        "a": rng.normal(size=(rows, c.n)),
        "t": rng.uniform(0, 5, rows),
    }
    return {name: every[name] for name in takes}


def offered(c, function):
    """Whether a crane has products of a function, which then has results."""
    try:
        return 0 not in c._product_shape(function)
    except ValueError as refused:
        # What follows from pressures or bristles.
        assert "follows from" in str(refused)
        return False


@pytest.mark.parametrize("name", CRANES)
@pytest.mark.parametrize("function", FUNCTIONS)
def test_both_products_are_of_one_matrix_which_is_that_of_differences(name, function):
    c, rng = crane.load(name), np.random.default_rng(3)
    if not offered(c, function):
        return
    state = given(c, function, 3, rng)
    weights = rng.normal(size=(3, *c._product_shape(function)))
    changes = {key: rng.normal(size=c.n if key in "qva" else ()) for key, _ in c._product_numbers()}
    by_all = c.vjp(function, weights, **state)
    along = c.jvp(function, changes, **state)
    assert set(by_all) == set(changes)
    of_weights = sum(by_all[key] @ change if key in "qva" else by_all[key] * change for key, change in changes.items())
    of_changes = (weights * along).reshape(3, -1).sum(axis=1)
    # Sums of the same numbers in another order; accelerations of a base on stiff feet are differences of much larger ones.
    size = np.abs(weights * along).reshape(3, -1).sum(axis=1)
    np.testing.assert_allclose(of_weights, of_changes, rtol=0, atol=1e-11 * size.max())

    def moved(step):
        other = c.replace(**{key: value + step * changes[key] for key, value in c.parameters.items()})
        return getattr(other, function)(**{key: value + step * changes[key] for key, value in state.items()})

    step = 1e-6
    differences = (moved(step) - moved(-step)) / (2 * step)
    # Rounding over the step, and the square of the step.
    np.testing.assert_allclose(along, differences, rtol=0, atol=1e-7 * np.abs(along).max() + 1e-12)


def test_parameters_may_be_arrays():
    c, rng = crane.load("knuckle_boom"), np.random.default_rng(4)
    payloads = np.array([100.0, 900.0])
    state = given(c, "dynamic_residual", 2, rng)
    weights = rng.normal(size=c.n)
    both = c.replace(payload=payloads).vjp("dynamic_residual", weights, **state)
    changes = {"payload": 1.0, "q": rng.normal(size=c.n)}
    along = c.replace(payload=payloads).jvp("dynamic_residual", changes, **state)
    for row, payload in enumerate(payloads):
        alone, own = c.replace(payload=float(payload)), {key: value[row] for key, value in state.items()}
        for key, found in alone.vjp("dynamic_residual", weights, **own).items():
            np.testing.assert_array_equal(both[key][row], found)
        np.testing.assert_array_equal(along[row], alone.jvp("dynamic_residual", changes, **own))


def test_a_batch_may_be_empty_and_a_row_may_be_bad():
    c = crane.load("knuckle_boom")
    by_all = c.vjp("dynamic_residual", np.zeros((0, c.n)), c.guess, c.guess, c.guess)
    assert by_all["q"].shape == (0, c.n) and by_all["payload"].shape == (0,)
    assert c.jvp("points", {}, c.guess).shape == tuple(c._product_shape("points"))
    assert not c.jvp("points", {}, c.guess).any()
    weights = np.ones((2, c.n))
    weights[1, 0] = np.nan
    with pytest.raises(ValueError, match=r"weights\[.*not a finite number"):
        c.vjp("bias", weights, c.guess, c.guess)
    with pytest.warns(crane.InvalidRowWarning):
        by_all = c.vjp("bias", weights, c.guess, c.guess, invalid="nan")
    assert np.isfinite(by_all["q"][0]).all() and np.isnan(by_all["q"][1]).all()


def test_a_parameter_may_be_called_as_a_state():
    text = (
        "format: 1\nname: p\nparameters: {a: {value: 0.4}, m: {value: 3}}\n"
        "links: [{name: rod, joint: {revolute: {axis: y}}, mass: m, com: [a, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}]\n"
    )
    c = crane.load("p.yaml", text=text)
    by_all = c.vjp("inverse_dynamics", [1.0], [0.3], [0.0], [2.0])
    # r = (I + m a²) q̈ − m g a cos q with q̈ = 2.
    assert by_all["a"] == pytest.approx([1 + 3 * 0.16])
    assert by_all["parameters.a"] == pytest.approx(2 * 3 * 0.4 * 2 - 3 * 9.81 * np.cos(0.3))
    along = c.jvp("inverse_dynamics", {"parameters.a": 1.0}, [0.3], [0.0], [2.0])
    assert along == pytest.approx(float(by_all["parameters.a"]))


def test_what_has_no_products_is_refused():
    c = crane.load("knuckle_boom")
    with pytest.raises(ValueError, match="write one of points"):
        c.vjp("mass_matrix", 1.0, c.guess)
    with pytest.raises(ValueError, match="last axes"):
        c.vjp("dynamic_residual", np.ones(c.n + 1), c.guess, c.guess, c.guess)
    with pytest.raises(KeyError, match="payload"):
        c.jvp("points", {"mass": 1.0}, c.guess)
    with pytest.raises(ValueError, match="4 coordinates"):
        c.jvp("points", {"q": 1.0}, c.guess)
    harvester = crane.load(str(ROOT / "specs/examples/parallel_harvester.yaml"))
    with pytest.raises(ValueError, match="depends on the loop that parallel_pin closes"):
        harvester.vjp("forward_dynamics", np.ones(harvester.n), harvester.guess, harvester.guess)
    assert harvester.vjp("loop_states", np.ones(harvester._product_shape("loop_states")), harvester.guess, harvester.guess)["q"].any()
    with pytest.raises(ValueError, match="no a: it depends on q, v, t; times are t="):
        c.vjp("forward_dynamics", np.ones(c.n), c.guess, c.guess, c.guess)
    with pytest.raises(ValueError, match="bias needs v"):
        c.vjp("bias", np.ones(c.n), c.guess)
    with pytest.raises(ValueError, match="did you mean dynamic_residual"):
        c.vjp("dynamic_residuals", np.ones(c.n), c.guess, c.guess, c.guess)
    with pytest.raises(TypeError, match="by name"):
        c.jvp("bias", "q", c.guess, c.guess)
    with pytest.raises(KeyError, match="did you mean payload"):
        c.jvp("bias", {"paylod": 1.0}, c.guess, c.guess)
    with pytest.raises(ValueError, match="do not broadcast: payload"):
        c.jvp("bias", {"payload": [1.0, 2.0, 3.0], "q": np.ones((2, c.n))}, c.guess, c.guess)
