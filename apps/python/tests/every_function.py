"""Every function of a crane, from the package itself, with the arrays that it takes."""

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
    "weights": lambda s: s.v,
    "changes": lambda s: {"q": s.v},
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
    "function": "dynamic_residual",
    "index": 0,
    "x": [],
    "bend": 45.0,
    "audit": False,
    "verify": False,
    "inputs": None,
    "on": "main_boom_theta",
    "p": 0.5,
    "invalid": "raise",
}
# Functions that take one state, or none, and what else they need.
ONE_STATE = {"simulate", "simulation", "_record", "_motions"}
NO_STATE = {"_acting", "_coordinates", "buckling", "_buckling", "_changed", "_fixed_bodies", "_with_beam", "with_beam", "combined", "frames", "joint_states", "coordinates_of", "_recalled", "_input_bounds", "vector_simulation", "replace", "page", "render", "_render", "export", "picture", "_parameter_rows", "_frame_poses", "_page", "_envelope", "sensitivity", "_sensitivity", "_vjp", "_jvp", "_product_shape", "_product_numbers"}


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
