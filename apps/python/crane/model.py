"""A crane: a spec with live parameters."""

from __future__ import annotations

import difflib
import html
import itertools
import math
import os
import warnings
from collections.abc import Mapping, Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native, state_space
from ._native import real_array
from .arguments import by_name, names_of
from .closed import Closed, Fixed
from .frames import Frames, Place
from .joints import JointStates, coordinates_of, joint_states
from .mistakes import NoEquilibrium
from .notebook import embed
from .results import (
    Array,
    Buckling,
    Energies,
    Ensemble,
    Envelope,
    Equilibrium,
    Linearisation,
    Modes,
    Run,
    Sensitivity,
    Stability,
    SteadyMotion,
    Strength,
)
from .simulation import Simulation
from .state_space import Margins, StateSpace
from .vector_simulation import VectorSimulation


# Endings of files in URDF and MJCF.
ROBOTS = (".urdf", ".xml")
# The comment at the head of an imported spec under which the remarks of the import stand.
NOTES = "# What the robot has and this spec does not:"
# Numbers of a state that have one entry per coordinate.
STATE = ("q", "v", "a")


def load(
    source: str | os.PathLike[str],
    /,
    *,
    text: str | None = None,
    invalid: str = "raise",
    inputs: Mapping[str, float | None] | None = None,
    **parameters: ArrayLike,
) -> Crane:
    """Loads a crane: a shipped one by its name (`crane.shipped()` lists them), or that of a YAML file, or a robot of a file in URDF or
    MJCF, `.urdf` or `.xml`, as `crane import` converts it: `Crane.notes` lists what is left out.

    text: the spec itself; `source` is then its name in messages. It may extend shipped cranes, and files of the working folder.
    parameters: live parameters by name, in the units that `Crane.info` shows. Arrays of them make a batch: their axes are leading
    axes of all results.
    invalid: "raise" raises if parameters of an array break a rule, "nan" makes results of those rows NaN and warns.
    inputs: inputs of the spec by name, in the units that `Crane.info` shows; the others are as in the spec.

    Raises SpecError, which prints every mistake with its place and remedy; warns of anything implausible with SpecWarning.
    """
    source = os.fspath(source)
    if text is None and os.path.splitext(source)[1].lower() in ROBOTS:
        text = _native.import_robot(source, None, [], False)
        source = f"{source}.yaml"
    return Crane(source, text=text, parameters=parameters, invalid=invalid, inputs=None if inputs is None else dict(inputs))


def from_urdf(text: str, /, *, name: str = "robot.urdf", fix: str | Sequence[str] = (), repair: bool = False) -> Crane:
    """A crane from the text of a robot in URDF, as `crane import` converts it; `Crane.notes` lists what is left out.

    name: that of the file in messages.
    fix: joints that are held at zero.
    repair: whether inertias that no body can have become the nearest possible ones.

    Raises SpecError, which prints every mistake with its place and remedy.
    """
    return Crane(f"{name}.yaml", text=_native.import_robot(name, text, names_of(fix), repair))


def from_mjcf(text: str, /, *, name: str = "robot.xml", fix: str | Sequence[str] = (), repair: bool = False) -> Crane:
    """A crane from the text of a robot in MJCF, without `<include>`; otherwise as `from_urdf`."""
    return from_urdf(text, name=name, fix=fix, repair=repair)


def _load_again(source: str, text: str, parameters: dict[str, Any], inputs: dict[str, float]) -> Crane:
    """A crane from a pickle, without repeating its warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return Crane(source, text=text, parameters=parameters, invalid="nan", inputs=inputs)


class Crane(Closed, _native.Crane):
    """A crane with its live parameters. It never changes; `replace` makes another.

    n: number of coordinates. States are arrays (..., n): coordinates q in m and rad, rates v in m/s and rad/s, both in the order
    of `coordinates`. Leading axes of q, v, t and of parameters that are arrays broadcast as in NumPy. Times t are in s. The
    world's z axis points up.

    Functions take `invalid`: "raise" raises a ValueError that names the first row with a number that is not finite, "nan" makes
    the results of such rows NaN and warns with InvalidRowWarning. Several threads may use one crane; it can be pickled, and
    used after a fork.
    """

    _instead = "a crane never changes: `c.replace(NAME=...)` makes one with another value of a live parameter, `c.replace(inputs={'NAME': ...})` of an input"

    def __reduce__(self) -> tuple:
        return _load_again, (self.source, self.spec, self.parameters, self.inputs)

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, _: Any) -> Self:
        return self

    def __repr__(self) -> str:
        values = ", ".join(f"{name}={value}" for name, value in self.parameters.items() if np.ndim(value) == 0)
        batch = f", shape={self.shape}" if self.shape else ""
        return f"<crane {self.name}: {self.n} coordinates{', ' if values else ''}{values}{batch}>"

    @property
    def notes(self) -> list[str]:
        """What an imported robot has and the crane does not, and what was changed, one sentence each; of other cranes nothing."""
        _, found, after = self.spec.partition(f"{NOTES}\n")
        lines = after.splitlines() if found else []
        return [line.removeprefix("#   ") for line in itertools.takewhile(lambda line: line.startswith("#   "), lines)]

    def page(self) -> str:
        """The crane in 3-D at rest, with its modes and tables: an HTML page that needs no network, to be written to a file.

        Of a crane whose parameters are arrays, the page shows the first row.
        """
        return self._page()

    def render(
        self,
        q: ArrayLike | None = None,
        width: int = 640,
        height: int = 480,
        *,
        azimuth: float | None = None,
        elevation: float | None = None,
        shown: ArrayLike = (),
    ) -> NDArray[np.uint8]:
        """A picture of the crane in a pose, as the page shows it in 3-D: (height, width, 3), red, green and blue.

        q: the pose; the static equilibrium unless given. Of a crane whose parameters are arrays, the picture shows the first row.
        width, height: picture elements, at most 4096 each.
        azimuth, elevation: from where it is seen, about z from x on and above the ground, rad; from the page's corner unless given.
        shown: poses (..., n) for which the picture has room, too: pictures of a motion with the same ones are seen from one place as long as
        the crane stays among them.
        """
        q = self.statics().q if q is None else q
        return self._render(q, shown if np.size(shown) else q, width, height, azimuth, elevation)

    def _repr_html_(self) -> str:
        """The page with a table of parameters and inputs, for notebooks."""
        info = self.info
        rows = [(of["name"], self.parameters[of["name"]], of["unit"], of["about"]) for of in info["parameters"]]
        rows += [(of["name"], self.inputs.get(of["name"], "as the spec says"), of["unit"], of["about"]) for of in info["inputs"]]
        cells = [(name, _shown(value), unit, about) for name, value, unit, about in rows]
        head = "".join(f"<th>{heading}</th>" for heading in ("parameter or input", "value", "unit", "what it is"))
        body = "".join(f"<tr>{''.join(f'<td>{html.escape(cell)}</td>' for cell in row)}</tr>" for row in cells)
        table = f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>" if cells else ""
        title = html.escape(f"{self.name}: {self.title}" if self.title else self.name)
        try:
            view = embed(self.page(), f"{self.name} in 3-D")
        except ArithmeticError:
            view = self.picture()
        first = "<br>in 3-D: the first row of the parameters" if self.shape else ""
        return f"<div><p><b>{title}</b><br>{self.n} coordinates, {len(info['bodies'])} bodies{first}</p>{view}{table}</div>"

    def replace(
        self, *, invalid: str = "raise", inputs: dict[str, float | None] | None = None, **parameters: ArrayLike
    ) -> Self:
        """The same crane with other live parameters and inputs; the others keep their values. Nothing is recompiled.

        inputs: by name; None lets an input follow the spec again. All functions of the crane use them.
        """
        return type(self)(self.source, parameters=parameters, invalid=invalid, like=self, inputs=inputs)

    def combined(self, combination: str, /) -> Self:
        """The same crane with the partial factors of one of the `combinations` of its spec: `crane.combined("lifting").statics()`.

        Raises ValueError if it has no such combination.
        """
        if combination not in self.combinations:
            known = ", ".join(self.combinations) or "none"
            raise ValueError(f"{self.name} has no combination {combination!r}; its combinations: {known}")
        changed = self._changed({"combination": combination})
        return type(self)(self.source, text=changed, parameters=self.parameters, inputs=self.inputs)

    def with_beam(
        self,
        link: str,
        /,
        *,
        sections: int,
        material: str | Mapping[str, float | str],
        section: Mapping[str, Any] | None = None,
        to: str | Sequence[float] | None = None,
        **beam: Any,
    ) -> Self:
        """The same crane with a rigid link that bends: `robot.with_beam("forearm_link", sections=4, material=..., section=...)`.

        A beam leads from the frame of the link to that of the link which goes on from it. It takes the place of the mass and the inertia
        of the link; its own follow from section, density and `extra_mass`. Its link is called `<link>_beam`, its coordinates
        `<link>_beam_1_psi` and so on; those of the joints keep their names. Other links that go on from the link stay on its frame,
        which does not bend; points of interest between both ends move with the beam.

        sections: number of sections. material: the name of a material of the spec, or `{"E": ..., "G": ..., "density": ...}`, in Pa and kg/m³.
        section: such as `{"tube": {"diameter": 0.1, "thickness": 0.003}}`, in m; other keys of a beam (`parts`, `extra_mass`, `damping`, …) as
        in a spec.
        to: the link at whose frame the beam ends, where several go on from `link`; the point of interest or the frame on it at which it ends; or a
        point in its frame, m.

        Warns if the crane loses mass and its file fixes something to the link, such as a tool, which is part of the link's mass.

        Raises ValueError if the link cannot become a beam, and SpecError for wrong keys of the beam.
        """
        keys = {"sections": sections, "material": material, "section": section, **beam}
        keys = {key: value for key, value in keys.items() if value is not None}
        to, point = (to, None) if to is None or isinstance(to, str) else (None, [float(x) for x in to])
        bending = type(self)(self.source, text=self._with_beam(link, to, point, keys), parameters=self.parameters, inputs=self.inputs)
        before, after = (sum(body["mass"] for body in crane.info["bodies"]) for crane in (self, bending))
        fixed = ", ".join(self._fixed_bodies(link))
        if fixed and after < before:
            warnings.warn(
                f"the beam takes the place of the mass of `{link}` and of what is fixed to it ({fixed}), and weighs {before - after:.4g} kg less: write what it "
                "carries as its `extra_mass`, or fix it by a joint of its own",
                stacklevel=2,
            )
        return bending

    @property
    def parameters(self) -> dict[str, Any]:
        """Live parameters: one number each, or an array over the leading axes. `replace` sets them, in another crane."""
        names = [parameter["name"] for parameter in self.info["parameters"]]
        return Fixed({name: self._parameter_rows(index) for index, name in enumerate(names)})

    @property
    def inputs(self) -> dict[str, float]:
        """Inputs that are set, by name. `replace` sets them, in another crane."""
        return Fixed(super().inputs)

    def strength(
        self,
        q: ArrayLike | None = None,
        v: ArrayLike | None = None,
        a: ArrayLike | None = None,
        t: ArrayLike | None = None,
        *,
        invalid: str = "raise",
    ) -> Strength:
        """Stresses of beams and the tipping margin, over the leading axes.

        q: poses, the static equilibrium unless given; v: rates, at rest unless given.
        a: accelerations; unless given, those that follow from q, v and t, or zero at rest. t: times of applied loads, s.
        """
        q = self.statics(invalid=invalid).q if q is None else q
        if a is None and v is not None:
            a = self.forward_dynamics(q, v, t, invalid=invalid)
        rows = self._strength(q, v, a, t, invalid=invalid)
        sections, (margin, stabilising, overturning, *feet) = rows[..., :-5], np.moveaxis(rows[..., -5:], -1, 0)
        stresses = sections.reshape(*rows.shape[:-1], -1, 5)
        line = np.stack(feet, axis=-1)
        return Strength(
            self.internal_forces(q, v, a, t, invalid=invalid),
            *(stresses[..., place] for place in range(5)),
            margin,
            stabilising,
            overturning,
            np.where(np.isnan(line), -1, line).astype(int),
        )

    def buckling(self) -> Buckling:
        """Critical factors of weight and loads at rest, and displacements and bending moments by the first and the second order."""
        found = self._buckling()
        if found is None:
            # Says why.
            self.statics()
            raise NoEquilibrium(f"{self.name} does not rest with its drives at the beginning of their motions")
        return Buckling(**found)

    def linearise(
        self,
        q: ArrayLike,
        v: ArrayLike | None = None,
        a: ArrayLike | None = None,
        t: ArrayLike | None = None,
        *,
        invalid: str = "raise",
    ) -> Linearisation:
        """Coefficients of small motions: A, K, D, each (..., n, n), about poses at rest at t = 0, or about motions if v, a or t is given.

        At rest K is `tangent_stiffness`. Coordinates that rigid drives prescribe do not move: in their rows and columns all three are zero, except for 1 on the
        diagonals of A and K, so that A is not `mass_matrix` there.

        About a motion K and D contain centrifugal and gyroscopic terms: `K = ∂(A a − e − f)/∂q`, `D = −∂(e + f)/∂v`. v and a are
        zero unless given: with a = 0 about a motion at constant rates, which `steady_motion` finds.
        """
        if v is None and a is None and t is None:
            matrices = self._small_motions(q, invalid=invalid)
        else:
            v, a = (np.zeros(self.n) if rates is None else rates for rates in (v, a))
            matrices = self._small_motions_about(q, v, a, t, invalid=invalid)
        return Linearisation(*(matrices[..., place, :, :] for place in range(3)))

    def state_space(
        self,
        q: ArrayLike,
        v: ArrayLike | None = None,
        t: ArrayLike | None = None,
        x: ArrayLike | None = None,
        *,
        inputs: str | Sequence[str] | None = None,
        outputs: str | Sequence[str] | None = None,
        valves: str = "shut",
        steady: bool = False,
        invalid: str = "raise",
    ) -> StateSpace:
        """A linear model about states q, v at times t, at rest and at t = 0 unless given, which need not be equilibria.

        x: states of forces, (..., their number), as `State.x` has them: pressures, spools, bristles. Unless given, they hold the pose at rest, with
        valves that are "shut", or "slightly open": then with the mean of the slopes in both directions, which a servo meets about rest.
        steady: the accelerations are zero, whatever holds the crane, instead of those that follow from the state.
        inputs: names, those of the spec unless given. Of every drive there are also `<coordinate>_prescribed` and `<coordinate>_prescribed_rate`,
        position and rate of its motion, each while the other stays, `<coordinate>_drive_torque` or `_drive_force`, an effort in addition, and of a
        cylinder with a valve `<cylinder>_valve`, its command.
        outputs: names of columns of a run; coordinates, their rates and points (`tip_x`) unless given.
        """
        return state_space.about(self, (q, v, t, x), inputs, outputs, invalid, valves=valves, steady=steady)

    def state_derivatives(
        self,
        q: ArrayLike,
        v: ArrayLike,
        x: ArrayLike | None = None,
        t: ArrayLike | None = None,
        *,
        invalid: str = "raise",
    ) -> tuple[Array, Array]:
        """Accelerations q̈, (..., n), and rates ẋ of the states of forces, (..., their number), at states q, v, x and times t, s, 0 unless given: the
        right-hand side of the equations of motion, also with valves, joints that stick and closed loops.

        x: states of forces, as `State.x` has them; unless given, they hold the pose at rest.
        """
        both = self._state_derivatives(q, v, x, t, invalid=invalid)
        n = len(self.coordinates)
        return both[..., :n], both[..., n:]

    def vjp(
        self,
        function: str,
        weights: ArrayLike,
        q: ArrayLike | None = None,
        v: ArrayLike | None = None,
        a: ArrayLike | None = None,
        t: ArrayLike | None = None,
        *,
        invalid: str = "raise",
    ) -> dict[str, Array]:
        """Vector-Jacobian product wᵀ ∂f/∂x of a function, by its name as "dynamic_residual", at those of q, v, a that it takes, and times t, s, 0 unless
        given: by "t", "q", "v", "a", every live parameter ("payload") and every input ("inputs.r"), for a few times the cost of f.

        weights: w, (..., and the axes of f).
        """
        axes = self._product_shape(function)
        flat = real_array("weights", weights)
        if list(flat.shape[flat.ndim - len(axes) :]) != axes:
            raise ValueError(f"weights have shape {flat.shape}, but {function} has {tuple(axes)} results, which are the last axes")
        flat = flat.reshape(*flat.shape[: flat.ndim - len(axes)], math.prod(axes))
        all_numbers = self._vjp(function, flat, q, v, a, t, invalid=invalid)
        found, first = {}, 0
        for name, count in self._product_numbers():
            found[name] = all_numbers[..., first : first + count] if name in STATE else all_numbers[..., first]
            first += count
        return found

    def jvp(
        self,
        function: str,
        changes: Mapping[str, ArrayLike],
        q: ArrayLike | None = None,
        v: ArrayLike | None = None,
        a: ArrayLike | None = None,
        t: ArrayLike | None = None,
        *,
        invalid: str = "raise",
    ) -> Array:
        """Jacobian-vector product ∂f/∂x δx of a function, by its name as "forward_dynamics", at those of q, v, a that it takes, and times t, s, 0 unless given.

        changes: δx by name: "t", "q", "v", "a", live parameters ("payload"), inputs ("inputs.r"); what is not named does not change.
        """
        self._product_shape(function)
        numbers = self._product_numbers()
        names = [name for name, _ in numbers]
        for name in by_name("changes", changes, '{"q": dq}'):
            if name not in names:
                similar = difflib.get_close_matches(str(name).split(".")[-1], names + [known.split(".")[-1] for known in names], n=1)
                meant = next((f"did you mean {known}? " for known in names for close in similar if known.split(".")[-1] == close), "")
                raise KeyError(f"nothing is called {name!r}: {meant}write one of {', '.join(names)}")
        given = {name: (self._coordinates if name in STATE else real_array)(f"the change of {name}", change) for name, change in changes.items()}
        given = {name: change if name in STATE else change[..., None] for name, change in given.items()}
        try:
            shape = np.broadcast_shapes(*(change.shape[:-1] for change in given.values()))
        except ValueError:
            shapes = ", ".join(f"{name} {change.shape[:-1]}" for name, change in given.items())
            raise ValueError(f"the leading axes of the changes do not broadcast: {shapes}") from None
        flat = [np.broadcast_to(given.get(name, np.zeros(count)), (*shape, count)) for name, count in numbers]
        return self._jvp(function, np.concatenate(flat, axis=-1), q, v, a, t, invalid=invalid)

    def columns_at(
        self,
        q: ArrayLike,
        v: ArrayLike,
        x: ArrayLike | None = None,
        t: ArrayLike | None = None,
        *,
        names: str | Sequence[str] | None = None,
        invalid: str = "raise",
    ) -> dict[str, Array]:
        """What the columns of a run are at states q, v, x and times t, s, 0 unless given: forces, pressures, powers, accelerations, by name.

        x: states of forces, as `State.x` has them; unless given, they hold the pose at rest.
        names: of columns; all unless given.
        """
        numbers, known = self._columns_at(q, v, x, t, invalid=invalid)
        asked = known if names is None else names_of(names)
        for name in asked:
            if name not in known:
                raise ValueError(f"there is no column {name!r}: write one of {', '.join(known)}")
        return {name: numbers[..., known.index(name)] for name in asked}

    def margins(
        self,
        on: str,
        p: float,
        *,
        i: float = 0.0,
        d: float = 0.0,
        filter: float = 0.0,
        lead: tuple[float, float] = (0.0, 0.0),
        delay: float = 0.0,
        lag: float = 0.0,
        measure: str | None = None,
        q: ArrayLike | None = None,
        t: ArrayLike | None = None,
        invalid: str = "raise",
    ) -> Margins:
        """Stability margins of a control loop about poses at rest, over parameters that are arrays and over poses.

        `C(s) = (p + i/s + d s/(1 + filter s)) (1 + lead[0] s)/(1 + lead[1] s) exp(−delay s)/(1 + lag s)` acts on `on`: a driven coordinate for the motion
        of its drive, `<coordinate>_rate` for the rate of that motion, or an input as `state_space` names them. It sees the reference minus
        `measure`, a column of a run, the coordinate of the drive unless given.
        q: poses; unless given the equilibria with the drives as at times t.

        Raises ArithmeticError if a loop has no margins, because it is open or its gain does not fall at high frequencies.
        """
        inputs, powers, coordinate = self._acting(on)
        measured = measure or coordinate
        if measured is None:
            raise ValueError(f"on={on!r} does not say what the loop measures: name a column of a run, as in measure='tip_z'")
        if q is None:
            q = self.statics(t=t, invalid=invalid).q
        model = state_space.about(
            self, (q, None, t, None), inputs, [measured], invalid, valves="slightly open", steady=True
        )
        numbers = [float(number) for number in (p, i, d, filter, *lead, delay, lag)]
        return state_space.margins(self, model, powers, numbers, invalid)

    def frames(self, frames: str | Sequence[str] | Mapping[str, Place]) -> Frames:
        """Frames fixed to links, by names of their own: `{"tool": ("grapple", [0, 0, -0.5])}`, an origin in the frame of a link, m, with the axes of
        the link (on a beam, of the rigid element there); `{"tool": "grapple"}` is the frame of the link.

        Instead of a link, a name may be one of `frames` of the spec (`Crane.info["frames"]`), which come first: those of an imported robot are the frames
        of its file. Names alone, `"tool0"` or `["tool0", "base_link"]`, are those frames or links under these names.
        """
        return Frames(self, frames)

    def joint_states(self, q: ArrayLike, v: ArrayLike | None = None) -> JointStates:
        """Positions and velocities of joints, by the names and in the order of the robot's file, as `sensor_msgs/JointState` of ROS has them:
        `(name, position, velocity)`, both (..., joints), rad and m; at rest without v.

        Joints are those of `joints` of the spec (`Crane.info["joints"]`), of which imported robots have all that their file lets move, also those that
        follow others or are held; else coordinates under their own names. A joint with several axes is one joint per axis, as
        in the file's notes.
        """
        return joint_states(self, q, v)

    def coordinates_of(self, positions: Mapping[str, ArrayLike], q: ArrayLike | None = None) -> Array:
        """(..., n): the pose in which joints are at these positions, rad or m, by the names that `joint_states` gives them.

        q: (..., n), where the others are; the guess unless given. Joints that follow those given, exactly, follow them; loops are closed.

        Raises ValueError if there is no such joint, or no such pose.
        """
        return coordinates_of(self, positions, q)

    def steady_motion(
        self,
        *,
        rates: Mapping[str, ArrayLike] | None = None,
        positions: Mapping[str, ArrayLike] | None = None,
        t: ArrayLike = 0.0,
        start: ArrayLike | None = None,
        invalid: str = "raise",
    ) -> SteadyMotion:
        """The motion at constant rates in which all other coordinates stay where they are.

        rates, m/s and rad/s, and positions, m and rad: of coordinates that are held, by name; numbers, or arrays, whose axes are leading axes
        of the result. Driven coordinates that are not held have the rates of their motions at times t, s, all others zero.
        start: (..., n), pose at rest from which the rates are increased; the equilibrium unless given.

        Raises NoEquilibrium if a row has no steady motion; with invalid="nan" its numbers are NaN and `reached` is below 1.
        """
        for name in (*(rates or {}), *(positions or {})):
            if name not in self.coordinates:
                raise ValueError(f"there is no coordinate {name!r}: write one of {', '.join(self.coordinates)}")
        held_rates = {name: real_array(f"rates[{name!r}]", number) for name, number in (rates or {}).items()}
        held_positions = {name: real_array(f"positions[{name!r}]", number) for name, number in (positions or {}).items()}
        held = [name for name in self.coordinates if name in held_rates or name in held_positions]
        axes = np.broadcast_shapes(*(numbers.shape for numbers in (*held_rates.values(), *held_positions.values())))

        def rows(numbers: Mapping[str, Array]) -> Array:
            row = np.zeros((*axes, self.n))
            for name, number in numbers.items():
                row[..., self.coordinates.index(name)] = number
            return row

        if start is None:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                rest = self.statics(t=t, invalid="nan").q
            start = np.where(np.isnan(rest), self.guess, rest)
        places = [(self.coordinates.index(name), name in held_positions) for name in held]
        found = self._steady_motion(places, start, rows(held_rates), rows(held_positions), t, invalid=invalid)
        q, v, efforts = (found[..., self.n * place : self.n * (place + 1)] for place in range(3))
        drift, acceleration, reached = (found[..., place] for place in (-3, -2, -1))
        if invalid == "raise" and np.any(reached < 1.0):
            least = 100.0 * np.min(reached)
            raise NoEquilibrium(
                f"no steady motion: the search ends at {least:.1f} % of the rates; hold what nothing constrains, or use smaller rates"
            )
        return SteadyMotion(q, v, efforts, drift, acceleration, reached)

    def energies(self, q: ArrayLike, v: ArrayLike, t: ArrayLike = 0.0, *, invalid: str = "raise") -> Energies:
        """Energies by part, each (...), J."""
        return Energies(
            self.kinetic_energy(q, v, invalid=invalid),
            self.gravity_energy(q, invalid=invalid),
            self.support_energy(q, invalid=invalid),
            self.element_energy(q, invalid=invalid),
            self.drive_energy(q, t, invalid=invalid),
            self.stop_energy(q, invalid=invalid),
            self.connector_energy(q, t, invalid=invalid),
        )

    def statics(
        self,
        *,
        t: ArrayLike | None = None,
        hold: Mapping[str, ArrayLike | str] | None = None,
        guess: ArrayLike | None = None,
        tolerance: float | None = None,
        iterations: int | None = None,
        load_steps: int | None = None,
        invalid: str = "raise",
    ) -> Equilibrium:
        """Static equilibrium by Newton's method, and by continuation if that fails.

        t: times at which the drives' motions stop, s; guess: (..., n), where to begin. The axes of all are leading axes of the result.
        hold: positions of drives, m and rad or as text with a unit, by the name of a coordinate or of its link if that has only one drive, as
        `{"boom": "20 deg", "jib": np.radians([0, 10])}`; what is not named is where its motion begins. The poses are those of `envelope` and of
        `crane statics --hold`.
        tolerance: residual relative to the balancing forces; iterations: Newton steps; load_steps: steps of the continuation.

        Raises NoEquilibrium if a row has no stable one; with invalid="nan" it warns, and `status` says why.
        """
        held = None if hold is None else list(by_name("hold", hold, '{"boom": "20 deg"}').items())
        found = self._equilibria(t, held, guess, tolerance, iterations, load_steps, invalid)
        shape = tuple(found.pop("shape"))
        words = {key: _shaped(found.pop(key), shape) for key in ("status", "message", "steps")}
        return Equilibrium(**found, **words)

    def envelope(
        self,
        ranges: Mapping[str, ArrayLike],
        *,
        load: str | None = None,
        greatest_load: float | None = None,
        tipping: float | None = 0.0,
        utilisation: float | None = 1.0,
        efforts: Mapping[str, float] | None = None,
        deflections: Mapping[str, float] | None = None,
        without: str | Sequence[str] = (),
        lift_off: bool = False,
        slack_ropes: bool = False,
        load_factor: float = 1.0,
        point: str | None = None,
        progress: Any = None,
    ) -> Envelope:
        """The largest load within limits, at rest, for all combinations of positions of drives, m and rad, and live parameters.

        The limits that the spec gives are always considered: pressures of relief valves and pump, strokes, end stops of driven joints,
        `max_effort`, `max_tension` and the friction under feet, except those named in `without`: "pressure", "pump", "stroke", "stops", "max-effort", "sliding", "ground", "tension", "overlap". `considered` and
        `not_considered` of the result list all limits.

        ranges: values by the name of a coordinate, of its link if that has only one drive, or of a live parameter; each is an axis of the
        result. What is not named keeps its initial value.
        load: live parameter that is the load, the only one in kg unless given. greatest_load: the maximum considered.
        tipping: minimum tipping margin; utilisation: maximum utilisation of beams with a yield stress; None: no such limit.
        efforts: maximum torque or force of drives, N m and N. deflections: how far the load may move points of interest, m.
        lift_off: every support carries something; slack_ropes: all ropes are taut.
        load_factor: the load is multiplied by it before it is compared with the limits, as for a test load or a dynamic factor.
        point: the one whose radius and height are given; unless given, the only one on what carries the load, otherwise the load's centre of mass.
        `progress(done, all)` is called from time to time.
        """
        ranges = by_name("ranges", ranges, '{"boom": np.radians([0, 30, 60])}')
        axes = {name: np.atleast_1d(real_array(f"ranges[{name!r}]", values)) for name, values in ranges.items()}
        for name, values in axes.items():
            if values.ndim != 1:
                raise ValueError(f"ranges[{name!r}] has {values.ndim} axes: give a list of numbers")
        asked = {
            "ranges": [(name, values.tolist()) for name, values in axes.items()],
            "load": load,
            "greatest_load": greatest_load,
            "tipping": tipping,
            "utilisation": utilisation,
            "efforts": list((efforts or {}).items()),
            "deflections": list((deflections or {}).items()),
            "without": names_of(without),
            "lift_off": lift_off,
            "slack_ropes": slack_ropes,
            "load_factor": load_factor,
            "point": point,
        }
        found = self._envelope(asked, progress)
        shape = tuple(found.pop("shape"))
        words = {key: np.asarray(found.pop(key)).reshape(shape) for key in ("governing", "governing_of")}
        return Envelope(axes=axes, **found, **words)

    def modes(self, q: ArrayLike | None = None, *, invalid: str = "raise") -> Modes:
        """Undamped and damped modes about poses at rest; about the static equilibrium unless poses are given."""
        q = self.statics(invalid=invalid).q if q is None else self._coordinates("q", q)
        found = self._modes(q, invalid)
        lists = [found["dominating"], found["damped_dominating"]]
        if not found["shape"]:
            lists = [rows[0] for rows in lists]
        eigenvalues = found["real"] + 1j * found["imaginary"]
        return Modes(q, found["omega_squared"], found["shapes"], eigenvalues, *lists)

    def sensitivity(self, numbers: str | Sequence[str] | None = None, *, frequencies: int = 3, invalid: str = "raise") -> Sensitivity:
        """Exact derivatives of the crane at rest: of positions, efforts, pressures, reactions, stresses, tipping margin and frequencies.

        numbers: live parameters by name, all of them unless given, and numbers of the spec by their places, as in
        "links.boom.beam.section.box.height": keys, names of entries of lists, and indices from 0.
        frequencies: how many of the lowest ones.

        Numbers that cannot be live parameters have differences of whole cranes, which `notes` says.

        Feet, ropes and stops act as they do at rest, and what governs keeps governing: a derivative ends where one of these changes.
        Raises NoEquilibrium if a row has no stable one; with invalid="nan" its numbers are NaN.
        """
        names = [parameter["name"] for parameter in self.info["parameters"]] if numbers is None else names_of(numbers)
        if frequencies < 0:
            raise ValueError(f"frequencies={frequencies}: write how many of the lowest ones, 0 or more")
        if not names:
            raise ValueError(
                f'{self.name} has no live parameters: name numbers by their places, such as "links.boom.mass", or define `parameters:`'
            )
        found = self._sensitivity(names, frequencies, invalid)
        shape = tuple(found.pop("shape"))
        places = np.asarray(found["places"], dtype=np.str_).reshape(*shape, len(found["outputs"]))
        return Sensitivity(
            tuple(names),
            tuple(found["number_units"]),
            found["numbers"],
            tuple(found["outputs"]),
            tuple(found["units"]),
            tuple(found["groups"]),
            places,
            found["values"],
            found["derivatives"],
            found["q"],
            found["pose_derivatives"],
            found["notes"] if shape else found["notes"][0],
        )

    def stability(self, q: ArrayLike | None = None, *, invalid: str = "raise") -> Stability:
        """Largest stable steps of all methods of integration about poses at rest, and what limits them."""
        q = self.statics(invalid=invalid).q if q is None else q
        found = self._stable_steps(q, invalid)
        shape = tuple(found["shape"])
        steps, why = {}, {}
        for method, (step, words) in found["steps"].items():
            steps[method] = step if shape else float(step)
            why[method] = words if shape else words[0]
        return Stability(steps, why)

    def simulate(
        self,
        *,
        duration: float | None = None,
        output: float | None = None,
        method: str | None = None,
        tolerance: float | None = None,
        step: float | str | None = None,
        force: bool = False,
        q: ArrayLike | None = None,
        v: ArrayLike | None = None,
        verify: bool = True,
        bend_limit: float | None = None,
        inputs: dict[str, float | None] | None = None,
        gradients: str | Sequence[str] | None = None,
        adjoint: str | Sequence[str] | Mapping[str, str] | None = None,
    ) -> Run:
        """A run from the static equilibrium at rest, or from pose q and rates v.

        duration: s; output: interval of results, s; the spec's unless given.
        method: "bdf" (default), "rosw4", "dopri5", or "rk4" with constant `step` in s ("auto": the largest safe one).
        tolerance: error per step that an adaptive method accepts, m and rad (2e-5).
        force: run even if the step exceeds the largest stable step.
        verify: repeat the run more finely to estimate the error of every column.
        bend_limit: bending or torsion of a beam section, degrees, beyond which there is a caution.
        inputs: of the spec, by name; constant throughout the run.
        gradients: names of what the run is differentiated by, for `Run.gradient`: live parameters ("payload"), inputs that are set
        ("inputs.r"), and starts of coordinates and of their rates ("q0.boom_psi", "v0.boom_psi"). The method is then "rosw4".
        adjoint: names of what is differentiated, by those numbers or by all of them, back from the end of the run: "boom_psi_drive_torque.peak", or
        another measure of a column: "maximum", "minimum", "final", "integral". `Run.adjoint` has the derivatives.

        Ctrl-C ends it with KeyboardInterrupt.
        """
        if isinstance(adjoint, Mapping):
            adjoint = [f"{column}.{of}" for column, of in adjoint.items()]
        names, asked = (None if given is None else names_of(given) for given in (gradients, adjoint))
        if not all(isinstance(name, str) for name in [*(names or ()), *(asked or ())]):
            raise TypeError('gradients and adjoint are names: write "payload", or "boom_psi_drive_torque.peak"')
        if names is not None or asked is not None:
            if method not in (None, "rosw4") or step is not None:
                given = f"step={step!r}" if method in (None, "rosw4") else f"method={method!r}"
                raise ValueError(f'{given} has no gradients: leave it out, or write method="rosw4"')
            method = "rosw4"
            if self.shape:
                raise ValueError("the parameters are arrays, and runs of many cranes have no derivatives: run the cranes one by one")
        if not isinstance(verify, (bool, np.bool_)):
            raise TypeError(f"verify={verify!r}: write True or False")
        timing = _timing(method, duration, output, tolerance, step, force)
        limits = {} if bend_limit is None else {"bend": bend_limit}
        crane = self.replace(inputs=inputs) if inputs else self
        found = crane._record(timing, q, v, verify, **limits, gradients=names, adjoint=asked)
        units = dict(found.pop("columns"))
        of_finer = {name: found.pop(name) for name in ("errors", "missed")}
        by_name = {name: None if numbers is None else dict(zip(units, numbers, strict=True)) for name, numbers in of_finer.items()}
        return Run(units=units, crane=crane, **by_name, **found)

    def simulate_ensemble(
        self,
        *,
        duration: float | None = None,
        output: float | None = None,
        method: str | None = None,
        tolerance: float | None = None,
        step: float | str | None = None,
        force: bool = False,
        q: ArrayLike | None = None,
        v: ArrayLike | None = None,
        inputs: Mapping[str, ArrayLike | None] | None = None,
        invalid: str = "raise",
        progress: Any = None,
    ) -> Ensemble:
        """A run for every row of the parameters, each from its own static equilibrium, on all threads.

        Arguments are those of `simulate`. Poses q and rates v at the start, (..., n), and inputs may be arrays: their leading axes and those of
        the parameters broadcast as in NumPy. Adaptive methods run up to eight cranes as one, with steps that are short enough for each: results are
        those of single runs within the tolerance. `progress(done, all)` is called from time to time. With invalid="nan" runs that fail leave NaN, and `status` says why.
        """
        inputs = None if inputs is None else dict(inputs)
        found = self._run_ensemble(_timing(method, duration, output, tolerance, step, force), invalid, progress, q, v, inputs)
        shape = tuple(found.pop("shape"))
        set_inputs = {name: value for name, value in {**self.inputs, **(inputs or {})}.items() if value is not None}
        cases = {name: np.broadcast_to(value, shape) for name, value in {**self.parameters, **set_inputs}.items()}
        words = {key: _shaped(found.pop(key), shape) for key in ("status", "cautions")}
        return Ensemble(units=dict(found.pop("columns")), cases=cases, crane=self, **found, **words)

    def simulation(self, *, method: str | None = None, tolerance: float | None = None, step: float | None = None, **start: Any) -> Simulation:
        """A simulation that is stepped from outside: `Simulation`. `start`: t, q and v; the static equilibrium at rest unless given."""
        return Simulation(self, _timing(method, None, None, tolerance, step, True), **start)

    def vector_simulation(
        self,
        count: int | None = None,
        *,
        method: str | None = None,
        tolerance: float | None = None,
        step: float | None = None,
        **start: Any,
    ) -> VectorSimulation:
        """Simulations of many cranes of this spec that are stepped together: `VectorSimulation`.

        count: how many; unless given, as many as parameters, inputs or start states that are arrays have rows.
        `start`: t, q, v and inputs; each crane's own static equilibrium at rest unless given.
        """
        return VectorSimulation(self, _timing(method, None, None, tolerance, step, True), count, **start)


def _timing(
    method: str | None,
    duration: float | None,
    output: float | None,
    tolerance: float | None,
    step: float | str | None,
    force: bool,
) -> dict[str, Any]:
    """Settings of a run, for the native part."""
    if isinstance(step, str) and step != "auto":
        raise ValueError(f'step={step!r}: write a number of seconds, or "auto"')
    for name, number, unit in (("duration", duration, "s"), ("output", output, "s"), ("tolerance", tolerance, "m and rad")):
        if number is not None and (np.ndim(number) or not np.issubdtype(np.asarray(number).dtype, np.number)):
            raise TypeError(f"{name}={number!r}: write one number, in {unit}")
    return {
        "method": method,
        "duration": duration,
        "output": output,
        "tolerance": tolerance,
        "step": None if step == "auto" else step,
        "safe_step": step == "auto",
        "force": force,
    }


def _shown(value: Any) -> str:
    """A parameter in a few characters: an array by its shape and range."""
    if isinstance(value, str):
        return value
    if np.ndim(value) == 0:
        return f"{value:g}"
    return f"{np.shape(value)}: {np.min(value):g} to {np.max(value):g}"


def _shaped(rows: list, shape: tuple[int, ...]) -> Any:
    """A list of rows over leading axes: the row itself if there are none."""
    return np.asarray(rows).reshape(shape) if shape else rows[0]
