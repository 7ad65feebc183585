"""What is no real number is refused by every function, and no panic comes out of any."""

import crane
import numpy as np
import pytest
from crane import _native
from conftest import ROOT
from every_function import ARRAYS, TIMING, Duck, arrays_of, batched, call, given  # noqa: F401

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


def test_one_number_may_have_a_unit(knuckle):
    assert knuckle.replace(payload="0.9 t")._parameter_rows(0) == knuckle.replace(payload=900.0)._parameter_rows(0)
    for wrong, words in (("1.5 m", "payload is in kg, and `1.5 m` is a length"), ("2 tons", "there is no unit `tons`"), ("five", "not a valid value")):
        with pytest.raises(ValueError, match=words):
            knuckle.replace(payload=wrong)


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
        lambda: knuckle._motions(TIMING, True, 0.0, q, q, [1.0] * 7),
        lambda: knuckle._motions(TIMING, True, np.nan, q, q, []),
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


def test_attributes_that_nobody_reads_are_refused(knuckle):
    with pytest.raises(AttributeError, match=r"never changes: `c\.replace\(payload=\.\.\.\)`"):
        knuckle.payload = 100.0
    simulation = knuckle.simulation()
    with pytest.raises(AttributeError, match=r"`step\(dt, payload=\.\.\.\)` sets a live parameter"):
        simulation.payload = 100.0
    with pytest.raises(AttributeError, match="method and tolerance are arguments"):
        simulation.method = "rk4"
    with pytest.raises(AttributeError, match=r"`reset\(rows, payload=\.\.\.\)`"):
        knuckle.vector_simulation(2).payload = 100.0
    assert knuckle.parameters["payload"] == 800.0


def test_loops_are_no_urdf():
    harvester = crane.load(str(ROOT / "specs/examples/parallel_harvester.yaml"))
    with pytest.raises(ValueError, match="has a loop, which `parallel_pin` closes; URDF describes open chains"):
        harvester.export("urdf")
