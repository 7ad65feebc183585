"""Results of the functions of a crane."""

import html
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _native
from .mistakes import InvalidRowWarning
from .notebook import embed

if TYPE_CHECKING:
    from .model import Crane

Array = NDArray[np.float64]
Words = NDArray[np.str_]


class Energies(NamedTuple):
    """Energies by part, J, over the leading axes."""

    kinetic: Array
    gravity: Array
    supports: Array
    elements: Array
    drives: Array
    stops: Array
    connectors: Array

    @property
    def total(self) -> Array:
        """Kinetic and potential energy together, J."""
        springs = self.supports + self.elements + self.drives + self.stops + self.connectors
        return self.kinetic + self.gravity + springs


class DriveDuty(NamedTuple):
    """What a drive or a winch must be able to do: largest effort, its root mean square, fastest rate, largest power and work that it gives, and that it
    takes in as a brake; at its joint or its rope, in the units given, W and J."""

    unit: str
    unit_of_rates: str
    effort: float
    rms_effort: float
    rate: float
    power: float
    braking_power: float
    work: float
    braking_work: float


class CylinderDuty(NamedTuple):
    """What a cylinder must be able to do: largest forces, N, highest pressure, Pa, fastest speed, m/s, largest flow, m³/s, and its lengths between the
    pins, m."""

    push: float
    pull: float
    pressure: float
    speed: float
    flow: float
    shortest: float
    longest: float


class PumpDuty(NamedTuple):
    """What the pump must be able to do: largest flow, m³/s, highest pressure at which it delivers, Pa, largest power, W, and energy, J."""

    flow: float
    pressure: float
    power: float
    energy: float


class Duties(NamedTuple):
    """What drives and winches, cylinders, by their names, and the pump of a run must be able to do."""

    drives: dict[str, DriveDuty]
    cylinders: dict[str, CylinderDuty]
    pump: PumpDuty | None


class Linearisation(NamedTuple):
    """Coefficients of small motions about a pose or a motion, `A δq̈ + D δq̇ + K δq = 0`; each (..., n, n).

    Coordinates that rigid drives prescribe do not move: in these matrices they oscillate separately, at 1 rad/s.
    """

    mass: Array
    stiffness: Array
    damping: Array

    @property
    def gyroscopic(self) -> Array:
        """The skew part of D, (..., n, n): gyroscopic forces, which do no work."""
        return (self.damping - np.swapaxes(self.damping, -1, -2)) / 2.0

    @property
    def circulatory(self) -> Array:
        """The skew part of K, (..., n, n): forces without a potential."""
        return (self.stiffness - np.swapaxes(self.stiffness, -1, -2)) / 2.0

    @property
    def state_matrix(self) -> Array:
        """`[[0, 1], [−A⁻¹K, −A⁻¹D]]` of `d/dt [δq; δq̇]`, (..., 2n, 2n): `numpy.linalg.eig` gives eigenvalues, 1/s, and shapes."""
        unit = np.broadcast_to(np.eye(self.mass.shape[-1]), self.mass.shape)
        lower = np.linalg.solve(self.mass, np.concatenate([-self.stiffness, -self.damping], axis=-1))
        return np.concatenate([np.concatenate([np.zeros_like(unit), unit], axis=-1), lower], axis=-2)


@dataclass(frozen=True)
class SteadyMotion:
    """Motions at constant rates, over the leading axes; NaN where there is none.

    q, v: (..., n), pose, m and rad, and rates, m/s and rad/s.
    efforts: (..., n), forces that hold coordinates in addition to their drives, N and N m; 0 for coordinates that are not held.
    drift: (...), the maximum rate at which the pose of the other coordinates would have to change for the motion to remain steady, m/s
    and rad/s: 0 if it does.
    acceleration: (...), the maximum acceleration of a drive's motion whose coordinate is not held, m/s² and rad/s².
    reached: (...), the fraction of the rates up to which there is a steady motion: 1 if it was found.
    """

    q: Array
    v: Array
    efforts: Array
    drift: Array
    acceleration: Array
    reached: Array


@dataclass(frozen=True)
class Sensitivity:
    """How quantities of a crane at rest change with its numbers, over the leading axes; NaN where there is no equilibrium.

    numbers, number_units: names of live parameters or places in the spec, and units; number_values: (..., numbers).
    outputs, units, groups: names, units and kinds of the quantities. places: (..., outputs), where a largest or smallest value is,
    and the coordinates that vibrate; otherwise empty.
    values: (..., outputs). derivatives: (..., outputs, numbers), exact: in the unit of the output per unit of the number.
    q: (..., n), the pose at rest, m and rad; pose_derivatives: (..., n, numbers).
    notes: what is not among the outputs, and what to know about a derivative; a list, or one per row.
    """

    numbers: tuple[str, ...]
    number_units: tuple[str, ...]
    number_values: Array
    outputs: tuple[str, ...]
    units: tuple[str, ...]
    groups: tuple[str, ...]
    places: Words
    values: Array
    derivatives: Array
    q: Array
    pose_derivatives: Array
    notes: list[Any]

    def changes(self, change: float = 0.1) -> Array:
        """(..., outputs, numbers): change of each output when a number changes by a part of its value, in proportion."""
        return self.derivatives * change * self.number_values[..., None, :]

    def relative(self, change: float = 0.1) -> Array:
        """The same, relative to the outputs: of no use for positions, and where an output is zero."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return self.changes(change) / np.abs(self.values)[..., None]

    def derivative(self, output: str, number: str) -> Array:
        """(...), the derivative of an output by a number, by their names."""
        for name, known in ((output, self.outputs), (number, self.numbers)):
            if name not in known:
                raise KeyError(f"there is no {name!r}: write one of {', '.join(known)}")
        return self.derivatives[..., self.outputs.index(output), self.numbers.index(number)]


@dataclass(frozen=True)
class Equilibrium:
    """Where a crane rests, over the leading axes.

    q: (..., n), m and rad; NaN where there is no equilibrium.
    status: "stable", "tips over", "floats", "slides", "unstable", "singular", "not converged" or "overflow"; "invalid" for a row whose parameters or arguments
    are not allowed; a str, or (...) of them. message: the same in a sentence.
    residual: (...), relative to the balancing forces.
    steps: (...), Newton steps.
    drive_efforts: (..., drives), N m and N, efforts with which the drives hold the pose.
    support_reactions: (..., supports, 3), N, world frame.
    points: (..., points, 3), m, world frame.
    """

    q: Array
    status: str | Words
    message: str | Words
    residual: Array
    steps: int | NDArray[np.int64]
    drive_efforts: Array
    support_reactions: Array
    points: Array

    @property
    def stable(self) -> bool | NDArray[np.bool_]:
        """Whether it is a stable equilibrium: a bool, or (...) of them."""
        return self.status == "stable"


@dataclass(frozen=True)
class Modes:
    """Small vibrations about poses at rest, lowest first, over the leading axes; NaN after the last mode of a row.

    omega_squared: (..., modes), rad²/s² of undamped modes; negative where the pose is unstable.
    shapes: (..., modes, n), shapes in generalized coordinates, `xᵀ A x = 1`.
    eigenvalues: (..., damped modes), λ with Im λ ≥ 0 of damped modes, 1/s.
    dominating: names of the coordinates that dominate each undamped mode; a list per row where there are leading axes.
    damped_dominating: those of each damped mode.
    """

    q: Array
    omega_squared: Array
    shapes: Array
    eigenvalues: NDArray[np.complex128]
    dominating: list
    damped_dominating: list

    @property
    def frequencies(self) -> Array:
        """Undamped frequencies ω/2π, Hz; NaN if the pose is unstable in a mode."""
        with np.errstate(invalid="ignore"):
            return np.sqrt(self.omega_squared) / (2.0 * np.pi)

    @property
    def damping_ratios(self) -> Array:
        """Damping ratios −Re λ/|λ|: 1 for a mode that returns without oscillating, negative for one that grows."""
        size = np.abs(self.eigenvalues)
        return np.divide(-self.eigenvalues.real, size, out=np.zeros_like(size), where=size != 0.0)


@dataclass(frozen=True)
class Stability:
    """Largest stable steps of the methods of integration, s, over the leading axes; infinite where nothing limits them.

    steps: by the name of the method; (...).
    limited_by: what limits them, in words; a list per row where there are leading axes.
    """

    steps: dict[str, Any]
    limited_by: dict[str, Any]


@dataclass(frozen=True)
class Envelope:
    """The largest load within limits over positions of drives and live parameters: a load chart as arrays.

    axes: values of each axis, by name; all arrays have these axes first.
    load: (...), the largest load, in `unit`, up to which every smaller one is within all limits; NaN where not even the minimum load is.
    parameter, unit: the live parameter that is the load, and its unit.
    governing: (...), the limit that governs: "tipping", "utilisation", "pressure", "pump", "stroke", "stops", "effort", "sliding", "lift-off", "slack-ropes", "ground", "tension", "overlap",
    "deflection", "equilibrium", or "" up to the maximum load considered. governing_of: (...), the tipping line, section, cylinder, drive,
    support, rope or point.
    considered, not_considered: limits that were, and those that were not or that lack a number, in words.
    radius, height: (...), m, of `point`, from the axis `radius_from` and above the world's origin, with the largest load; with the minimum load
    where there is no largest one. point: its name, or words such as "the centre of mass of log". radius_from: such as "the axis of column_psi".
    q: (..., n), pose with the same load, m and rad.
    tipping_margin, utilisation: (...), with the crane's own load. drive_efforts: (..., drives), N m and N, with that load.
    deflections: (..., points), m, by which that load moves the points of interest.
    """

    axes: dict[str, Array]
    load: Array
    parameter: str
    unit: str
    governing: Words
    governing_of: Words
    point: str
    radius_from: str
    radius: Array
    height: Array
    q: Array
    tipping_margin: Array
    utilisation: Array
    drive_efforts: Array
    deflections: Array
    considered: list[str]
    not_considered: list[str]


@dataclass(frozen=True)
class Strength:
    """What beams, joints and the ground carry, over the leading axes.

    internal_forces: (..., cuts, 6), force, N, and moment, N m, that the part beyond each cut of `Crane.info["cuts"]` exerts on the part
    before it: of the ground in the world frame about its origin, of a joint in the frame after it about its origin, of a section of a beam
    in the section's frame, x along the beam.
    normal, shear, torsion, equivalent: (..., sections), Pa, maximum stresses at the sections of `Crane.info["sections"]`, whose `beam`, `x` (at a pad
    on which the beam slides, that with its coordinate at 0) and `place` (such as `before the head of lift`) say where they are: of normal force and bending, of shear forces, of torsion, and von Mises' equivalent of all three; NaN where moduli of the section are unknown.
    utilisation: (..., sections), equivalent stress over yield stress divided by safety factor; NaN without a yield stress.
    tipping_margin: (...), 1 − overturning / stabilising about the governing tipping line: 1 where nothing overturns the crane, 0 where it
    is about to tip; NaN where the supports form no polygon.
    stabilising, overturning: (...), N m, moments about that line.
    governing_line: (..., 2), its supports, as indices; −1 where there is no line.
    """

    internal_forces: Array
    normal: Array
    shear: Array
    torsion: Array
    equivalent: Array
    utilisation: Array
    tipping_margin: Array
    stabilising: Array
    overturning: Array
    governing_line: NDArray[np.int64]

    def __getattribute__(self, name: str) -> Any:
        value = object.__getattribute__(self, name)
        if name == "utilisation" and value.size and np.isnan(value).all():
            warnings.warn(
                "utilisation is NaN in all sections: no beam has an allowable stress; write `yield_stress` and `safety_factor` of its material in the spec",
                InvalidRowWarning,
                stacklevel=2,
            )
        return value


@dataclass(frozen=True)
class Buckling:
    """How many times its weight and loads a crane carries at rest, and what they do by the first and the second order of beam theory: the numbers of
    `crane strength --buckling`.

    linearised: critical factor of the weight of everything and of all loads, by the stiffness at rest; inf above 1000, NaN for closed loops and rigid
    couplings.
    followed: the factor up to which the crane rests, its pose followed; inf above 100.
    status: how statics ends beyond that factor; empty where a stage is out of its beam, or for inf.
    displacements: (points, 2, 3), m, by which weight and loads move the points of interest, by the first order and at rest; NaN if the crane does not
    rest nearby without weight and loads, and no beams are then listed.
    beams, places: names of the beams, and the place on each that is bent most. moments: (beams, 2), N m, the bending moments there by both orders.
    """

    linearised: float
    followed: float
    status: str
    displacements: Array
    beams: list[str]
    places: list[str]
    moments: Array


@dataclass(frozen=True)
class Run(Mapping[str, Array]):
    """A run: its columns by name, as in `run["boom_psi_drive_torque"]`, at the times `run.t`.

    units: unit of every column, by name.
    table: (times, columns), all of them in the order of `units`.
    start: what it started from. method, tolerance, step (s; the mean of an adaptive method), statistics: how it ran.
    errors: largest difference of every column from a finer run at the same times, in the column's unit: the error of the steps; None if that was
    not requested.
    missed: how far every column goes between two results beyond its minimum and maximum, in its unit: a shorter `output` shows it; None as errors.
    divergence: time in which small differences grow by a factor e, s, if the motion is chaotic.
    cautions: where the run was outside the validity of the model or the method.
    crane: the crane with the parameters and inputs of the run.
    gradients: (times, columns), derivatives of `table` by each name that `simulate(gradients=...)` was given.
    adjoint: derivatives of each number that `simulate(adjoint=...)` was given, as "boom_psi_drive_torque.peak", by all live parameters, inputs that
    are set, and starts, by their names.
    """

    units: dict[str, str]
    table: Array = field(repr=False)
    start: str
    method: str
    tolerance: float | None
    step: float
    statistics: dict[str, int]
    errors: dict[str, float] | None = field(repr=False)
    missed: dict[str, float] | None = field(repr=False)
    divergence: float | None
    cautions: list[str]
    wall_time: float
    crane: "Crane" = field(repr=False)
    gradients: dict[str, Array] = field(default_factory=dict, repr=False)
    adjoint: dict[str, dict[str, float]] = field(default_factory=dict, repr=False)

    def __repr__(self) -> str:
        """One line: the columns are many."""
        cautions = f", {len(self.cautions)} cautions" if self.cautions else ""
        return (
            f"<run of {self.crane.name}: {self.t[-1]:g} s from the {self.start}, {self.method}, {self.statistics['steps']} steps, "
            f"{len(self.t)} results of {len(self.units)} columns{cautions}>"
        )

    def __getitem__(self, name: str) -> Array:
        return self.table[:, _place(self.units, name)]

    def __iter__(self) -> Iterator[str]:
        return iter(self.units)

    def __len__(self) -> int:
        return len(self.units)

    @property
    def t(self) -> Array:
        """Times of the results, s."""
        return self["t"]

    def extremes(self, name: str) -> dict[str, float]:
        """Minimum and maximum of a column, and their first times, s."""
        column, t = self[name], self.t
        least, greatest = int(np.argmin(column)), int(np.argmax(column))
        return {
            "minimum": float(column[least]),
            "time_of_minimum": float(t[least]),
            "maximum": float(column[greatest]),
            "time_of_maximum": float(t[greatest]),
        }

    def gradient(self, column: str, name: str, of: str = "values") -> Any:
        """Derivative of a column by a live parameter, an input or a number of the initial state, in their units.

        name: one of those given to `simulate(gradients=...)`. of: "values" (an array over the times), "maximum", "minimum", "peak" (the
        largest magnitude), "final" (at the end) or "integral" (over time, by the trapezoidal rule). That of an extreme is the derivative at its first
        time: to first order the time itself does not matter. Of what was given to `simulate(adjoint=...)` there are derivatives by all
        names. Work, dissipated energy and the energy balance of a run have none.
        """
        by_all = self.adjoint.get(f"{column}.{of}") or self.adjoint.get(column if of == "peak" else "", {})
        if name in by_all:
            return by_all[name]
        if name not in self.gradients:
            known = ", ".join(by_all or self.gradients) or "none: run simulate(gradients=[...])"
            if self.adjoint and not by_all:
                raise KeyError(f"there are no gradients of {column}.{of}, only of {', '.join(self.adjoint)}, which simulate(adjoint=...) was given")
            raise KeyError(f"the run has no gradients by {name!r}: it has {known}")
        values, place = self[column], _place(self.units, column)
        slopes = self.gradients[name][:, place]
        if np.isnan(slopes).all():
            raise ValueError(f"{column} has no gradient: it is an integral over the run, by the audit of its energy")
        if of == "values":
            return slopes
        if of == "integral":
            return float(np.sum(0.5 * np.diff(self.t) * (slopes[1:] + slopes[:-1])))
        if of == "final":
            return float(slopes[-1])
        extremes = {"maximum": values, "minimum": -values, "peak": np.abs(values)}
        if of not in extremes:
            raise ValueError(f'of={of!r}: write "values", "maximum", "minimum", "peak", "final" or "integral"')
        index = int(np.argmax(extremes[of]))
        return float(np.copysign(1.0, values[index]) * slopes[index] if of == "peak" else slopes[index])

    def duties(self) -> Duties:
        """What drives, cylinders and the pump must be able to do over the run, as `crane drives` prints it; integrals by the trapezoidal rule."""
        drives, cylinders, pump = _native.duties_of(self.crane, self.table)
        return Duties(
            {name: DriveDuty(unit, unit_of_rates, *numbers) for name, unit, unit_of_rates, numbers in drives},
            {name: CylinderDuty(*numbers) for name, numbers in cylinders},
            None if pump is None else PumpDuty(*pump),
        )

    def page(self) -> str:
        """The run in 3-D, in plots and in tables: an HTML page that needs no network, to be written to a file."""
        counts = ("steps", "rejections", "evaluations", "factorisations")
        return self.crane._page(
            {
                "table": self.table,
                "start": self.start,
                "method": self.method,
                "tolerance": self.tolerance,
                "step": self.step,
                "statistics": [self.statistics[count] for count in counts],
                "errors": None if self.errors is None else list(self.errors.values()),
                "missed": None if self.missed is None else list(self.missed.values()),
                "divergence": self.divergence,
                "cautions": self.cautions,
                "wall_time": self.wall_time,
            }
        )

    def _repr_html_(self) -> str:
        """The page, for notebooks."""
        facts = f"{self.t[-1]:g} s from the {self.start}; {self.method}, {self.statistics['steps']} steps"
        cautions = "".join(f"<br>caution: {html.escape(caution)}" for caution in self.cautions)
        title = f"<b>{html.escape(self.crane.name)}</b>: {html.escape(facts)}{cautions}"
        try:
            view = embed(self.page(), f"a run of {self.crane.name} in 3-D")
        except ArithmeticError:
            view = ""
        return f"<div><p>{title}</p>{view}</div>"

    def to_pandas(self) -> Any:
        """The columns as a pandas DataFrame over time, with their units in `attrs["units"]`."""
        import pandas

        frame = pandas.DataFrame(self.table, columns=list(self.units)).set_index("t")
        frame.attrs["units"] = dict(self.units)
        return frame


@dataclass(frozen=True)
class Ensemble(Mapping[str, Array]):
    """Runs of a crane over arrays of parameters: results of each, by name, over their axes.

    Columns: `_min`, `_min_time`, `_max`, `_max_time` of `<point>_x`, `_y`, `_z`, of `<coordinate>_drive_torque` or
    `_drive_force` and of `<support>_reaction_x`, `_y`, `_z`, signed; `<point>_x_end` and so on, the last values.
    NaN where a run did not reach its end.

    units: unit of every column. status: "done", or why not. cautions: warnings about the run, or "".
    time: time reached, s. steps: steps taken. q, v: (..., n), the last pose and rates.
    cases: (...), values of the parameters, and of the inputs that are set, by name. crane: the crane with all parameters.
    """

    units: dict[str, str]
    table: Array = field(repr=False)
    status: str | Words
    cautions: str | Words
    time: Array
    steps: Array
    q: Array = field(repr=False)
    v: Array = field(repr=False)
    cases: dict[str, Array] = field(repr=False)
    crane: "Crane" = field(repr=False)

    def __repr__(self) -> str:
        """One line: the columns are many."""
        done = np.count_nonzero(np.asarray(self.status) == "done")
        return f"<{np.size(self.time)} runs of {self.crane.name}: {done} done, {len(self.units)} columns>"

    def __getitem__(self, name: str) -> Array:
        return self.table[..., _place(self.units, name)]

    def __iter__(self) -> Iterator[str]:
        return iter(self.units)

    def __len__(self) -> int:
        return len(self.units)

    @property
    def done(self) -> bool | NDArray[np.bool_]:
        """Whether each run reached its end."""
        return self.status == "done"

    def to_pandas(self) -> Any:
        """A row for each run: its parameters and inputs, then all results; units of the columns in `attrs["units"]`."""
        import pandas

        info = self.crane.info
        units = {of["name"]: of["unit"] for of in (*info["parameters"], *info["inputs"])}
        cases = {name: (value, units[name]) for name, value in self.cases.items()}
        columns = joined_columns(cases, self.columns())
        frame = pandas.DataFrame({name: np.ravel(column) for name, (column, _) in columns.items()})
        frame.attrs["units"] = {name: unit for name, (_, unit) in columns.items()}
        return frame

    def columns(self) -> dict[str, tuple[Any, str]]:
        """All results with their units, by name: over the axes of the parameters."""
        return {name: (self[name], unit) for name, unit in self.units.items()} | {
            "time": (self.time, "s"),
            "steps": (self.steps, ""),
            "cautions": (self.cautions, ""),
            "status": (self.status, ""),
        }


def joined_columns(cases: dict[str, tuple[Any, str]], results: dict[str, tuple[Any, str]]) -> dict[str, tuple[Any, str]]:
    """Columns of cases, then those of results; ValueError if two have the same name."""
    for name in results:
        if name in cases:
            raise ValueError(f"a result has the name of the parameter {name!r}: call it otherwise")
    return cases | results


def _place(units: dict[str, str], name: str) -> int:
    """Index of a column; otherwise a KeyError that names similar ones."""
    try:
        return list(units).index(name)
    except ValueError:
        import difflib

        alike = difflib.get_close_matches(name, units, 3, 0.5)
        meant = f"; did you mean {' or '.join(alike)}?" if alike else ""
        raise KeyError(f"there is no column {name!r}{meant}") from None
