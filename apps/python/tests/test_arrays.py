"""Arrays of any order, stride and type: every function gives the same numbers, to the last bit."""

import inspect

import numpy as np
import pytest
from every_function import ARRAYS, NO_STATE, ONE_STATE, OTHERS, Duck, arguments_of, arrays_of, batched, call, functions, given  # noqa: F401


def test_every_function_is_known():
    """A function with an argument of a new name must say here what it is; otherwise no other test would try its arrays."""
    for name in functions():
        if name in ONE_STATE | NO_STATE:
            continue
        assert arrays_of(name), f"{name} takes no array that ARRAYS knows"
        for parameter in arguments_of(name):
            known = parameter.name in ARRAYS or parameter.name in OTHERS or parameter.default is not inspect.Parameter.empty
            assert known, f"{name}({parameter.name})"


def unaligned(array):
    """The same numbers, one byte beside an address of a number."""
    buffer = np.zeros(array.nbytes + 1, np.uint8)
    own = buffer[1:].view(array.dtype).reshape(array.shape)
    own[...] = array
    return own


def embedded(array):
    """Every second number of a larger array, along every axis."""
    larger = np.full([2 * size for size in array.shape], 7.5)
    larger[tuple(slice(None, None, 2) for _ in array.shape)] = array
    return larger[tuple(slice(None, None, 2) for _ in array.shape)]


def read_only(array):
    own = array.copy()
    own.flags.writeable = False
    return own


def read_only_fortran(array):
    own = array.copy(order="F")
    own.flags.writeable = False
    return own


def backward(array):
    everything = tuple(slice(None, None, -1) for _ in array.shape)
    return np.ascontiguousarray(array[everything])[everything]


ORDERS = {
    "Fortran": np.asfortranarray,
    "transposed": lambda array: np.ascontiguousarray(array.T).T,
    "an axis moved": lambda array: np.moveaxis(np.ascontiguousarray(np.moveaxis(array, 0, -1)), -1, 0),
    "slices": embedded,
    "reversed": backward,
    "read-only": read_only,
    "read-only Fortran": read_only_fortran,
    "unaligned": unaligned,
    "other byte order": lambda array: array.astype(array.dtype.newbyteorder()),
    "float32": lambda array: np.asfortranarray(array, dtype=np.float32),
    "float16": lambda array: array.astype(np.float16),
    "long double": lambda array: np.asfortranarray(array, dtype=np.longdouble),
    "masked, nothing hidden": np.ma.masked_array,
    "duck": lambda array: Duck(np.asfortranarray(array)),
}


@pytest.fixture(scope="module")
def expected(knuckle, given):
    """Results for ordinary arrays, row by row: what a batch must give."""
    return {name: call(knuckle, name, {of: ARRAYS[of](given) for of in arrays_of(name)}) for name in batched()}


@pytest.mark.filterwarnings("ignore::crane.InvalidRowWarning")
@pytest.mark.parametrize("order", ORDERS)
def test_all_functions_read_all_orders(knuckle, given, expected, order):
    change = ORDERS[order]
    for name in batched():
        values = {}
        for of in arrays_of(name):
            value = ARRAYS[of](given)
            values[of] = {key: change(one) for key, one in value.items()} if isinstance(value, dict) else change(value)
        for found, right in zip(call(knuckle, name, values), expected[name], strict=True):
            np.testing.assert_array_equal(found, right, err_msg=f"{name}, {order}")


@pytest.mark.filterwarnings("ignore::crane.InvalidRowWarning")
def test_a_batch_in_fortran_order_is_its_rows(knuckle, given):
    """As above without the package's own reading of batches: every row alone, which has only one order."""
    q, v, t = (np.asfortranarray(array) for array in (given.q, given.v, given.t))
    for name, function in [
        ("points", lambda q, v, t: knuckle.points(q)),
        ("kinetic_energy", lambda q, v, t: knuckle.kinetic_energy(q, v)),
        ("forces", lambda q, v, t: knuckle.forces(q, v, t)),
        ("statics", lambda q, v, t: knuckle.statics(t=t, guess=q, invalid="nan").q),
        ("modes", lambda q, v, t: knuckle.modes(q, invalid="nan").omega_squared),
        ("linearise", lambda q, v, t: knuckle.linearise(q, v, v, t).stiffness),
    ]:
        batch = function(q, v, t)
        for place in np.ndindex(2, 3):
            row = function(q[place].copy(), v[place].copy(), float(t[place]))
            np.testing.assert_array_equal(batch[place][: len(row)] if row.ndim else batch[place], row, err_msg=name)


def test_broadcast_arrays_and_integers(knuckle, given):
    q = np.broadcast_to(given.q[0, 0], (2, 3, knuckle.n))
    np.testing.assert_array_equal(knuckle.mass_matrix(q), np.broadcast_to(knuckle.mass_matrix(q[0, 0]), (2, 3, 4, 4)))
    whole = np.asfortranarray(np.arange(12).reshape(3, 4) % 3)
    for kind in (np.int8, np.int64, np.uint16, bool):
        own = whole.astype(kind)
        np.testing.assert_array_equal(knuckle.points(own), knuckle.points(own.astype(float).copy()))
    np.testing.assert_array_equal(knuckle.points(whole.tolist()), knuckle.points(whole.astype(float).copy()))


def test_parameters_read_all_orders(knuckle, given):
    loads = np.arange(6.0).reshape(2, 3) * 100
    expected = knuckle.replace(payload=loads.copy())
    for name, change in ORDERS.items():
        batch = knuckle.replace(payload=change(loads))
        np.testing.assert_array_equal(batch.parameters["payload"], loads, err_msg=name)
        np.testing.assert_array_equal(batch.gravity_energy(given.q), expected.gravity_energy(given.q), err_msg=name)


def test_runs_begin_at_states_of_all_orders(knuckle, given):
    q, v = np.stack([given.q[0, 0]] * 3), np.stack([given.v[0, 0]] * 3)
    assert all(set(arrays_of(name)) <= {"q", "v", "t"} for name in ONE_STATE - {"simulation"})
    expected = knuckle.simulate(duration=0.1, q=q[0].copy(), v=v[0].copy(), verify=False).table
    for name, change in ORDERS.items():
        own = {"q": change(q)[1], "v": change(v)[1]}
        np.testing.assert_array_equal(knuckle.simulate(duration=0.1, verify=False, **own).table, expected, err_msg=name)
        simulation = knuckle.simulation(**own)
        np.testing.assert_array_equal(simulation.q, q[0], err_msg=name)
        simulation.step(0.1)
        np.testing.assert_allclose(simulation.q, expected[-1, 1 : knuckle.n + 1], atol=1e-3, err_msg=name)


def test_results_of_pandas_and_of_a_solver_are_states(knuckle):
    """Where arrays in Fortran order come from: data frames, and solutions of SciPy, whose rows are variables."""
    pandas = pytest.importorskip("pandas")
    run = knuckle.simulate(duration=0.5, output=0.05, verify=False)
    frame = run.to_pandas()[knuckle.coordinates]
    for q in (frame, frame.to_numpy(), run.table[:, 1 : knuckle.n + 1]):
        np.testing.assert_array_equal(knuckle.points(q)[:, 0, 0], knuckle.points(np.array(q, order="C"))[:, 0, 0])
        # The run records the same function.
        np.testing.assert_allclose(knuckle.points(q)[:, knuckle.info["points"].index("load_centre"), 0], run["load_centre_x"], rtol=1e-13)
    payload = pandas.Series([100.0, 300.0], index=[7, 9])
    np.testing.assert_array_equal(knuckle.replace(payload=payload).parameters["payload"], [100.0, 300.0])
    y = np.array(frame).T
    np.testing.assert_array_equal(knuckle.gravity_energy(y.T), knuckle.gravity_energy(np.array(frame)))
