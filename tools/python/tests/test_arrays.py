"""Arrays of any order, stride and type: every function gives the same numbers, to the last bit, or refuses what is no real number."""

import dataclasses
import inspect

import crane
import numpy as np
import pytest
from crane import _native

# Every argument of a function that is an array, and how it is made of states.
ARRAYS = {
    "q": lambda s: s.q,
    "v": lambda s: s.v,
    "a": lambda s: s.v[..., ::-1].copy(),
    "t": lambda s: s.t,
    "guess": lambda s: s.q,
    "start": lambda s: s.q,
    "rates": lambda s: s.v,
    "positions": lambda s: s.q,
    "ranges": lambda s: {"main_boom_theta": s.t[0] / 16, "knuckle_theta": -s.t[1] / 8},
}
TIMING = {"method": None, "duration": 0.1, "output": None, "tolerance": None, "step": None, "safe_step": False, "force": False}
# Arguments that are none.
OTHERS = {
    "held": [(1, True)],
    "asked": None,
    "timing": TIMING,
    "progress": None,
    "run": None,
    "format": "urdf",
    "index": 0,
    "x": [],
    "bend": 45.0,
    "verify": False,
    "inputs": None,
    "invalid": "raise",
}
# Functions that take one state, or none, and what else they need.
ONE_STATE = {"simulate", "simulation", "_record", "_motion"}
NO_STATE = {"replace", "page", "export", "picture", "_parameter_rows", "_page", "_envelope"}


@dataclasses.dataclass
class States:
    """Leading axes (2, 3): all numbers are multiples of 1/8, so that half precision has them, too."""

    t: np.ndarray
    q: np.ndarray
    v: np.ndarray


@pytest.fixture(scope="module")
def given(knuckle):
    rng = np.random.default_rng(4)
    eighths = lambda *shape: rng.integers(-4, 5, shape) / 8
    return States(4 + eighths(2, 3), eighths(2, 3, knuckle.n), eighths(2, 3, knuckle.n))


def functions():
    """All public and internal functions of a crane, from the package itself."""
    members = {**vars(_native.Crane), **vars(crane.Crane)}
    names = [name for name, member in members.items() if callable(member) and not name.startswith("__") and name != "_repr_html_"]
    return sorted(names)


def arguments_of(name):
    parameters = inspect.signature(getattr(crane.Crane, name)).parameters.values()
    return [parameter for parameter in parameters if parameter.name != "self"]


def arrays_of(name):
    return [parameter.name for parameter in arguments_of(name) if parameter.name in ARRAYS]


def batched():
    return [name for name in functions() if name not in ONE_STATE | NO_STATE]


def test_every_function_is_known():
    """A function with an argument of a new name must say here what it is; otherwise no other test would try its arrays."""
    for name in functions():
        if name in ONE_STATE | NO_STATE:
            continue
        assert arrays_of(name), f"{name} takes no array that ARRAYS knows"
        for parameter in arguments_of(name):
            known = parameter.name in ARRAYS or parameter.name in OTHERS or parameter.default is not inspect.Parameter.empty
            assert known, f"{name}({parameter.name})"


def call(c, name, values):
    """The result of a function with some arrays, as a list of arrays."""
    needed = {p.name: OTHERS[p.name] for p in arguments_of(name) if p.name in OTHERS and p.default is inspect.Parameter.empty}
    quick = {"duration": 0.1} if name == "simulate_ensemble" else {}
    if "invalid" in [parameter.name for parameter in arguments_of(name)]:
        quick["invalid"] = "nan"
    values = dict(values)
    if name == "steady_motion":
        values["rates"] = {"main_boom_theta": values["rates"][..., 1]}
        values["positions"] = {"main_boom_theta": values["positions"][..., 1]}
    return list(numbers_in(getattr(c, name)(**needed, **values, **quick)))


def numbers_in(value):
    """All arrays inside a result."""
    if dataclasses.is_dataclass(value):
        value = [getattr(value, field.name) for field in dataclasses.fields(value)]
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, (list, tuple)) and not (value and isinstance(value[0], (int, float, str))):
        for item in value:
            yield from numbers_in(item)
    elif not isinstance(value, crane.Crane):
        yield np.asarray(value)


class Duck:
    """Something that NumPy converts, as xarray's arrays are."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return np.array(self.array, dtype=dtype)

    def __getitem__(self, place):
        return Duck(self.array[place])


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


REFUSED = {
    "complex": (lambda array: array + 0j, "holds complex numbers"),
    "complex Fortran": (lambda array: np.asfortranarray(array + 1j), "holds complex numbers"),
    "text": (lambda array: array.astype(str), "holds text"),
    "bytes": (lambda array: array.astype("S8"), "holds text"),
    "objects": (lambda array: array.astype(object), "holds Python objects"),
    "none": (lambda array: None if array.ndim > 3 else np.full(array.shape, None), "holds Python objects"),
    "dates": (lambda array: np.zeros(array.shape, "datetime64[s]"), "holds dates"),
    "records": (lambda array: np.zeros(array.shape, [("x", float)]), "holds records"),
}


@pytest.mark.parametrize("kind", REFUSED)
def test_all_functions_refuse_what_is_no_number(knuckle, given, kind):
    change, words = REFUSED[kind]
    for name in batched():
        plain = {of: ARRAYS[of](given) for of in arrays_of(name)}
        for of in plain:
            wrong = {key: change(one) for key, one in plain[of].items()} if isinstance(plain[of], dict) else change(plain[of])
            with pytest.raises(TypeError, match=words):
                call(knuckle, name, {**plain, of: wrong})


def test_numbers_that_are_none_are_refused(knuckle, given):
    for wrong in ("5", np.array("5"), np.array(["5"]), 1j, np.complex128(5), np.array(5 + 0j), None, object()):
        with pytest.raises(TypeError, match="payload holds"):
            knuckle.replace(payload=wrong)
        with pytest.raises(TypeError, match="t holds" if wrong is not None else "t holds|no"):
            knuckle.statics(t=wrong if wrong is not None else np.array(None))
        with pytest.raises(TypeError):
            knuckle.simulation(q=knuckle.guess, t=wrong)
    with pytest.raises(TypeError, match="q is not an array of numbers"):
        knuckle.points([[0.0, 1.0], [2.0]])
    hidden = np.ma.masked_array(given.q, mask=False)
    hidden[1, 2, 0] = np.ma.masked
    with pytest.raises(ValueError, match=r"row \[1, 2\]: q\[0\] .* is NaN"):
        knuckle.points(hidden)


@pytest.mark.filterwarnings("ignore::crane.InvalidRowWarning")
def test_no_panic_comes_out_of_internal_functions(knuckle, given):
    """A panic would be a `PanicException`, which is no `Exception`: whatever an internal function is given, it returns or raises one of those."""
    q = given.q[0, 0]
    run = {"table": np.zeros((1, 2)), "start": "", "method": "?", "tolerance": None, "step": 0.0, "statistics": [0] * 4}
    run |= {"differences": None, "divergence": None, "cautions": [], "wall_time": np.nan}
    columns = len(knuckle.simulate(duration=0.1, verify=False).units)
    asked = {"ranges": [], "load": None, "greatest_load": None, "tipping": None, "utilisation": None, "efforts": [], "deflections": [], "point": None}
    calls = [
        lambda: knuckle._steady_motion([(99, True)], q, q, q),
        lambda: knuckle._steady_motion([(0, False), (0, True)] * 9, q, q, q, invalid="nan"),
        lambda: knuckle._parameter_rows(99),
        lambda: knuckle._parameter_rows(2**63),
        lambda: knuckle._motion(TIMING, 0.0, q, q, [1.0] * 7),
        lambda: knuckle._motion(TIMING, np.nan, q, q, []),
        lambda: knuckle._record(TIMING, q, q, False, np.nan),
        lambda: knuckle._page(run),
        lambda: knuckle._page(run | {"method": "bdf"}),
        lambda: knuckle._page(run | {"method": "bdf", "table": np.full((3, columns), np.nan)}),
        lambda: knuckle._page(run | {"method": "bdf", "table": np.zeros((0, columns))}),
        lambda: knuckle._page(run | {"method": "bdf", "table": np.zeros((3, columns)), "differences": [0.0]}),
        lambda: knuckle._page(run | {"method": "bdf", "table": np.zeros((3, columns)), "statistics": [2**62] * 4, "step": np.inf}),
        lambda: knuckle._envelope(asked),
        lambda: knuckle._envelope(asked | {"ranges": [("main_boom_theta", [])]}),
        lambda: knuckle._envelope(asked | {"ranges": [("main_boom_theta", [0.0]), ("payload", [0.0])], "load": "payload"}),
        lambda: knuckle._run_ensemble(TIMING | {"duration": 1e300}),
        lambda: knuckle.replace(payload=np.zeros((0, 3)))._run_ensemble(TIMING),
        lambda: knuckle.replace(payload=np.zeros((0, 3))).statics(),
        lambda: knuckle.replace(payload=np.zeros((0, 3))).modes(q),
        lambda: knuckle.replace(payload=np.zeros((0, 3))).stability(q),
        lambda: knuckle.replace(payload=np.zeros((0, 3))).strength(q),
        lambda: knuckle.replace(payload=np.zeros((0, 3))).envelope({"main_boom_theta": [0.0]}),
        lambda: knuckle.replace(payload=np.zeros((0, 3))).export("urdf"),
        lambda: knuckle.replace(payload=np.zeros((0, 3))).page(),
        lambda: knuckle.statics(iterations=0),
        lambda: _native.Crane("x", text="\0" * 9),
        lambda: _native.Crane("x", like=knuckle, parameters={1: 2}),
        lambda: _native.real_array("x", Duck("text")),
    ]
    for number, one in enumerate(calls):
        try:
            one()
        except Exception:
            pass
        except BaseException as panic:
            raise AssertionError(f"call {number}") from panic
