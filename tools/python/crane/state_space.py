"""Linear models about a state, with inputs and outputs by their names."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .results import Array

if TYPE_CHECKING:
    from .model import Crane

# An input is changed until accelerations change by this part of their size: rounding and curvature then stay below 1e-9 of an entry.
_PART = 1e-5
# Change of an input by which its effect is found first, relative to its value or to 1.
_PROBE = 1e-6


@dataclass(frozen=True)
class StateSpace:
    """`d/dt δx = A δx + B δu`, `δy = C δx + D δu` about a state x = (q, q̇), which need not be at rest; over the leading axes.

    A: (..., 2n, 2n). B: (..., 2n, inputs). C: (..., outputs, 2n). D: (..., outputs, inputs).
    states, inputs, outputs: names; state_units, input_units, output_units: their units.

    It unpacks into A, B, C, D: `scipy.signal.StateSpace(*model)`, `control.ss(*model)`.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    state_units: tuple[str, ...]
    input_units: tuple[str, ...]
    output_units: tuple[str, ...]

    def __iter__(self) -> Iterator[Array]:
        return iter((self.A, self.B, self.C, self.D))

    def frequency_response(self, frequencies: ArrayLike) -> NDArray[np.complex128]:
        """(..., frequencies, outputs, inputs): `C (iω − A)⁻¹ B + D` at frequencies in Hz: amplitude and phase of each output per unit of each input."""
        turning = 2j * np.pi * np.atleast_1d(np.asarray(frequencies, dtype=float))
        unit = np.eye(self.A.shape[-1])
        A, B, C, D = (matrix[..., None, :, :] for matrix in self)
        return C @ np.linalg.solve(turning[:, None, None] * unit - A, B.astype(complex)) + D


def about(
    crane: "Crane",
    q: ArrayLike,
    v: ArrayLike | None,
    t: ArrayLike | None,
    inputs: Sequence[str] | None,
    outputs: Sequence[str] | None,
    invalid: str,
) -> StateSpace:
    """The linear model of a crane about a state: see `Crane.state_space`."""
    coordinates, n = crane.info["coordinates"], crane.n
    v = np.zeros(n) if v is None else v
    of_q, of_v, _ = np.moveaxis(crane.forward_dynamics_derivatives(q, v, t, invalid=invalid), -3, 0)
    unit = np.broadcast_to(np.eye(n), of_q.shape)
    A = np.concatenate([np.concatenate([np.zeros_like(of_q), unit], -1), np.concatenate([of_q, of_v], -1)], -2)

    known = {given["name"]: given for given in crane.info["inputs"]}
    names = tuple(known) if inputs is None else tuple(inputs)
    columns = [_by_input(crane, (q, v, t), _known(name, known, "input"), invalid) for name in names]
    accelerations = np.stack(columns, axis=-1) if columns else np.zeros((*of_q.shape[:-1], 0))
    B = np.concatenate([np.zeros_like(accelerations), accelerations], axis=-2)

    rows, units = _outputs(crane, q, invalid)
    wanted = tuple(rows) if outputs is None else tuple(outputs)
    C = np.stack([np.broadcast_to(_known(name, rows, "output"), (*A.shape[:-2], 2 * n)) for name in wanted], axis=-2)
    states = [(c["name"], c["unit"]) for c in coordinates] + [(f"{c['name']}_rate", f"{c['unit']}/s") for c in coordinates]
    return StateSpace(
        A,
        B,
        C,
        np.zeros((*C.shape[:-1], len(names))),
        tuple(name for name, _ in states),
        names,
        wanted,
        tuple(unit for _, unit in states),
        tuple(known[name]["unit"] for name in names),
        tuple(units[name] for name in wanted),
    )


def _known(name, of, what):
    if name not in of:
        raise ValueError(f"there is no {what} {name!r}: write one of {', '.join(of) or 'none: the spec has no inputs'}")
    return of[name]


def _by_input(crane, at, given, invalid):
    """∂q̈/∂u of one input, (..., n), by central differences; accelerations are linear in most inputs, so their step may be large."""
    name = given["name"]
    if name in crane.inputs:
        value = crane.inputs[name]
    elif given["moves"]:
        raise ValueError(f"input {name!r} follows a motion of the spec: set it, as in `c.replace(inputs={{{name!r}: 0.1}})`, or leave it out")
    else:
        value = given["default"]

    def accelerations(change):
        return crane.replace(inputs={name: value + change}).forward_dynamics(*at, invalid=invalid)

    step = _PROBE * max(1.0, abs(value))
    here = accelerations(0.0)
    effect = np.nanmax(np.abs(accelerations(step) - here), initial=0.0)
    if effect > 0.0:
        step *= _PART * max(1.0, np.nanmax(np.abs(here), initial=0.0)) / effect
    return (accelerations(step) - accelerations(-step)) / (2.0 * step)


def _outputs(crane, q, invalid):
    """Rows of C and units of everything that can be an output, by the names of the columns of a run."""
    n = crane.n
    rows, units = {}, {}
    for j, coordinate in enumerate(crane.info["coordinates"]):
        for name, unit, place in (
            (coordinate["name"], coordinate["unit"], j),
            (f"{coordinate['name']}_rate", f"{coordinate['unit']}/s", n + j),
        ):
            rows[name], units[name] = np.eye(2 * n)[place], unit
    jacobians = crane.point_jacobians(q, invalid=invalid)
    for i, point in enumerate(crane.info["points"]):
        for k, axis in enumerate("xyz"):
            row = jacobians[..., i, k, :]
            rows[f"{point}_{axis}"], units[f"{point}_{axis}"] = np.concatenate([row, np.zeros_like(row)], axis=-1), "m"
    return rows, units
