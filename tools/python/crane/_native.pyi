"""The native part of `crane`."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .info import Info

Array = NDArray[np.float64]

class SpecError(ValueError):
    """The mistakes of a spec, shown with their locations and remedies."""

    codes: list[str]

class ParameterError(ValueError):
    """Live parameters whose values break a rule of the spec language."""

class NoEquilibrium(ArithmeticError):
    """Statics found no stable equilibrium."""

class SpecWarning(UserWarning):
    """Implausible numbers of a spec, shown with their locations and remedies."""

class InvalidRowWarning(UserWarning):
    """Rows of a batch whose results are NaN, with the reasons."""

def shipped() -> list[str]:
    """Names of the cranes that come with the package."""

def set_threads(count: int | None = None) -> None:
    """Sets how many threads a call uses; None: as many as the machine has."""

def threads() -> int:
    """How many threads a call uses."""

def real_array(name: str, object: ArrayLike) -> Array:
    """A new array of the numbers of anything that NumPy converts to an array of real numbers; masked ones are NaN. TypeError names what
    is none."""

class Motion:
    """A motion that continues from result to result, with the history of its method."""

    def advance(self, dt: float) -> tuple[float, Array, Array, Array, tuple[float, float, float]]:
        """Advances by `dt`, s; returns time, pose, rates, states of forces; work of the drives, dissipated energy and
        work of the loads since the start, J."""
    def statistics(self) -> dict[str, int]:
        """Steps, rejections, evaluations and factorisations so far."""

class Crane:
    """A crane with its parameters: native part of `crane.Crane`."""

    def __new__(
        cls,
        named: str,
        text: str | None = None,
        parameters: dict[str, ArrayLike] | None = None,
        invalid: str = "raise",
        like: Crane | None = None,
        inputs: dict[str, float | None] | None = None,
    ) -> Crane: ...
    @property
    def name(self) -> str:
        """Name of the crane."""
    @property
    def title(self) -> str:
        """One line about it."""
    @property
    def spec(self) -> str:
        """Its spec, YAML."""
    @property
    def spec_hash(self) -> str:
        """Hash of the spec."""
    @property
    def source(self) -> str:
        """Origin of the spec, as shown in messages."""
    @property
    def shape(self) -> list[int]:
        """Leading axes of the parameters; empty where all are numbers."""
    @property
    def n(self) -> int:
        """Number of coordinates."""
    @property
    def coordinates(self) -> list[str]:
        """Names of the coordinates, in the order of q."""
    @property
    def guess(self) -> Array:
        """(..., n): where statics begins, m and rad; NaN for parameters that break a rule."""
    @property
    def info(self) -> Info:
        """Coordinates, bodies, drives, supports, points and parameters: names, units and descriptions."""
    def picture(self) -> str:
        """A picture of the chain: its bodies and coordinates at the guess, SVG."""
    def _page(self, run: dict[str, Any] | None = None) -> str:
        """The crane in 3-D and in tables as an HTML page: at rest, or with a run of it."""
    def export(self, format: str) -> str:
        """The crane for other programs: "urdf", "springs" (what URDF cannot express, YAML) or "mjcf", with the present parameters."""
    def _parameter_rows(self, index: int) -> Any:
        """Values of a live parameter, by its place, over the leading axes."""
    def _equilibria(
        self,
        t: ArrayLike | None = None,
        guess: ArrayLike | None = None,
        tolerance: float | None = None,
        iterations: int | None = None,
        load_steps: int | None = None,
        invalid: str = "raise",
    ) -> dict[str, Any]:
        """Equilibria: `Crane.statics` makes an `Equilibrium` of them."""
    def _envelope(
        self, asked: dict[str, Any], progress: Callable[[int, int], Any] | None = None
    ) -> dict[str, Any]:
        """Largest loads: `Crane.envelope` makes an `Envelope` of them."""
    def _modes(self, q: ArrayLike, invalid: str = "raise") -> dict[str, Any]:
        """Modes about poses: `Crane.modes` names them."""
    def _stable_steps(self, q: ArrayLike, invalid: str = "raise") -> dict[str, Any]:
        """Largest stable steps about poses: `Crane.stability` names them."""
    def _record(
        self, timing: dict[str, Any], q: ArrayLike | None = None, v: ArrayLike | None = None, verify: bool = True, bend: float = ...
    ) -> dict[str, Any]:
        """A run: `Crane.simulate` makes a `Run` of it."""
    def _run_ensemble(
        self,
        timing: dict[str, Any],
        invalid: str = "raise",
        progress: Callable[[int, int], Any] | None = None,
        q: ArrayLike | None = None,
        v: ArrayLike | None = None,
        inputs: dict[str, ArrayLike | None] | None = None,
    ) -> dict[str, Any]:
        """Runs over parameters, starts and inputs: `Crane.simulate_ensemble` makes an `Ensemble` of them."""
    def _motion(self, timing: dict[str, Any], t: float, q: ArrayLike, v: ArrayLike, x: ArrayLike) -> Motion:
        """A motion of the crane from a time, s, a pose, rates and states of forces, with its parameters and inputs."""
    @property
    def inputs(self) -> dict[str, float]:
        """Inputs that are set, by name."""
    def internal_forces(
        self,
        q: ArrayLike,
        v: ArrayLike | None = None,
        a: ArrayLike | None = None,
        t: ArrayLike | None = None,
        *,
        invalid: str = "raise",
    ) -> Array:
        """(..., cuts, 6): force, N, and moment, N m, that the part beyond each cut exerts on the part before it; `Crane.info["cuts"]`
        lists the cuts. a: accelerations; at rest unless v and a are given."""
    def _strength(
        self,
        q: ArrayLike,
        v: ArrayLike | None = None,
        a: ArrayLike | None = None,
        t: ArrayLike | None = None,
        *,
        invalid: str = "raise",
    ) -> Array:
        """(..., 5 sections + 5): stresses and utilisation of every section of beams, then margin, moments and supports of the governing
        tipping line; `Crane.strength` names them."""
    def transforms(self, q: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., bodies, 4, 4): transforms of the bodies into the world frame, m."""
    def transform_derivatives(self, q: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., bodies, n, 4, 4): `∂T/∂q_j`; zero for coordinates that do not move a body."""
    def transform_second_derivatives(self, q: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., bodies, n, n, 4, 4): `∂²T/∂q_m∂q_n`."""
    def points(self, q: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., points, 3): positions of the points of interest, world frame, m."""
    def point_velocities(self, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., points, 3): their velocities, m/s."""
    def point_jacobians(self, q: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., points, 3, n): derivatives of their positions with respect to q, m/m and m/rad."""
    def mass_matrix(self, q: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., n, n): the mass matrix A, symmetric positive definite; kg, kg m, kg m²."""
    def bias(self, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., n): velocity and gravity forces e of `A q̈ = e + f`, N and N m: the negative of Pinocchio's `nle` and of
        MuJoCo's `qfrc_bias`, which are on the left-hand side."""
    def forces(self, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> Array:
        """(..., n): generalized forces f of supports, elements, drives and joint dampers, N and N m. t: s, 0 unless given."""
    def element_forces(self, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., n): generalized forces of the springs and dampers between rigid elements, N m."""
    def drive_forces(self, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> Array:
        """(..., n): generalized forces of the drives, N and N m."""
    def stop_forces(self, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., n): generalized forces of the end stops, N and N m."""
    def friction_forces(self, v: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., n): generalized forces of friction in joints, N and N m."""
    def load_forces(self, q: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> Array:
        """(..., n): generalized forces of the loads applied from outside, N and N m. t: s, 0 unless given."""
    def connector_forces(self, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> Array:
        """(..., n): generalized forces of the connectors, N and N m. t: s, 0 unless given."""
    def connector_lengths(self, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., connectors, 2): lengths of the connectors, m, and their rates, m/s."""
    def connector_tensions(self, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> Array:
        """(..., connectors, 3): forces of the connectors, N, positive in tension, and their derivatives with respect to length, N/m, and
        rate, N s/m."""
    def drive_forces_at_rest(self, q: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> Array:
        """(..., n): generalized forces of the drives, including rigid ones, that hold the crane at rest where they are at times t, N and N m."""
    def support_reactions(self, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., supports, 3): forces of the supports on the crane, world frame, N."""
    def support_gaps(self, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., supports, 2): how far one-sided supports are above the ground, m, negative where pressed in, and its rate, m/s; 0 for others."""
    def cylinder_states(self, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., cylinders, 3): length of each cylinder, m, its rate, m/s, and its derivative with respect to the joint's coordinate,
        m/rad or m/m."""
    def cylinder_jacobians(self, q: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., cylinders, n): derivatives of the length of each cylinder with respect to the coordinates, m/rad or m/m. A cylinder with a valve
        that pushes with F exerts the generalized forces F times its row. Zeros for a crane without valves."""
    def drive_limits(self, t: ArrayLike, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., drives, 2): maximum effort of each drive, N or N m, 0 if it has no limit, and its stiffness at the state, N/m or N m/rad.
        Zeros for a crane without limits."""
    def drive_motions(self, t: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., drives, 2): prescribed positions and rates of the drives at times t, m and rad, m/s and rad/s."""
    def valve_openings(self, t: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., drives, 2): commands over time of the drives' valves at times t, −1 to 1, and their rates, 1/s; zeros without one."""
    def loop_states(self, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., equations, 3): gaps of the equations of loop joints, m and 1, their rates, and the part of their second rates that does not
        depend on accelerations."""
    def loop_jacobians(self, q: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., equations, n): derivatives of the gaps of loop joints with respect to q."""
    def forward_dynamics(self, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> Array:
        """(..., n): accelerations q̈ of `A q̈ = e + f`, with closed loops, m/s² and rad/s²."""
    def inverse_dynamics(self, q: ArrayLike, v: ArrayLike, a: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., n): generalized forces that a motion requires in total, `A a − e`, N and N m."""
    def static_residual(self, q: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> Array:
        """(..., n): `∂E_p/∂q` with the drives where they are at times t, zero in equilibrium, N and N m."""
    def tangent_stiffness(self, q: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> Array:
        """(..., n, n): `∂²E_p/∂q²` with the drives where they are at times t, N/m, N and N m."""
    def _small_motions(self, q: ArrayLike, *, invalid: str = "raise") -> Array:
        """(..., 3, n, n): A, K and D of small motions about poses at rest; `linearise` names them."""
    def _small_motions_about(
        self, q: ArrayLike, v: ArrayLike, a: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise"
    ) -> Array:
        """(..., 3, n, n): A, K and D of small motions about motions; `linearise` names them."""
    def _steady_motion(
        self,
        held: list[tuple[int, bool]],
        start: ArrayLike,
        rates: ArrayLike,
        positions: ArrayLike,
        t: ArrayLike | None = None,
        *,
        invalid: str = "raise",
    ) -> Array:
        """(..., 3 n + 3): poses, rates and efforts of steady motions, drift, acceleration, part reached; `steady_motion` names them.
        held: coordinates, and whether a position is given; their rates and positions are at the same indices in `rates` and `positions`."""
    def kinetic_energy(self, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> Array:
        """(...): kinetic energy, J."""
    def gravity_energy(self, q: ArrayLike, *, invalid: str = "raise") -> Array:
        """(...): potential energy of gravity, zero at the world's origin, J."""
    def support_energy(self, q: ArrayLike, *, invalid: str = "raise") -> Array:
        """(...): energy of the supports' springs, J."""
    def element_energy(self, q: ArrayLike, *, invalid: str = "raise") -> Array:
        """(...): energy of the springs between rigid elements, J."""
    def drive_energy(self, q: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> Array:
        """(...): energy of the drives' springs, J."""
    def stop_energy(self, q: ArrayLike, *, invalid: str = "raise") -> Array:
        """(...): energy of the end stops, J."""
    def connector_energy(self, q: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> Array:
        """(...): energy of the connectors, J."""
    def drive_power(self, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> Array:
        """(...): power that the drives' motions put in, W."""
    def dissipation(self, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> Array:
        """(...): power that all dampers dissipate, W."""
