# Written by `cargo xtask bless` from apps/python/src.
"""
The native part of `crane`.
"""

from _typeshed import SupportsGetItem, SupportsLenAndGetItem
from collections.abc import Callable
from crane.info import Info
from numpy import float64, uint8
from numpy.typing import ArrayLike, NDArray
from typing import Any, SupportsFloat, SupportsIndex, final
from typing_extensions import disjoint_base

__all__ = ["Crane", "Motions", "duties_of", "fatigue_of", "functions", "import_robot", "loop_margins", "real_array", "set_threads", "shipped", "threads"]

@disjoint_base
class Crane:
    """
    A crane with its parameters: native part of `crane.Crane`.
    """
    def __new__(cls, /, named: str, text: str | None = None, parameters: dict[str, ArrayLike] | None = None, invalid: str = "raise", like: Crane | None = None, inputs: dict[str, float | None] | None = None) -> Crane: ...
    def _acting(self, /, on: str) -> tuple[list[str], list[int], str | None]:
        """
        The inputs that a loop on something moves, and the powers of s by which each follows; then the coordinate of its drive.
        """
    def _buckling(self, /) -> dict[str, Any] | None:
        """
        Critical factors of weight and loads, and displacements and bending moments by both orders: `Crane.buckling` names them. None if the crane does not rest.
        """
    def _changed(self, /, changes: dict[str, Any]) -> str:
        """
        Its spec with changes, keys with what is laid over their values, None to remove them: a spec that `load(text=...)` takes.
        """
    def _columns_at(self, /, q: ArrayLike, v: ArrayLike, x: ArrayLike | None = None, t: ArrayLike | None = None, *, invalid: str = "raise") -> tuple[NDArray[float64], list[str]]:
        """
        (..., columns): the columns of a run at states, and their names; `Crane.columns_at` names them.
        """
    def _coordinates(self, /, name: str, numbers: ArrayLike) -> NDArray[float64]:
        """
        (..., n): coordinates, rates or accelerations, by the names of columns if they have some.
        """
    def _envelope(self, /, asked: dict[str, Any], progress: Callable[[int, int], Any] | None = None) -> dict[str, Any]:
        """
        Largest loads over the axes: `Crane.envelope` makes an `Envelope` of them.
        """
    def _equilibria(self, /, t: ArrayLike | None = None, hold: SupportsGetItem[int, tuple[str, ArrayLike]] | None = None, guess: ArrayLike | None = None, tolerance: SupportsFloat | SupportsIndex | None = None, iterations: SupportsIndex | None = None, load_steps: SupportsIndex | None = None, invalid: str = "raise") -> dict[str, Any]:
        """
        Equilibria over parameters, times, guesses and positions of drives: `Crane.statics` makes an `Equilibrium` of them.
        """
    def _fixed_bodies(self, /, link: str) -> list[str]:
        """
        Names of the bodies of a link besides its own: of a robot, what its file fixes to the link.
        """
    def _frame_poses(self, /) -> NDArray[float64]:
        """
        (..., frames, 4, 4): poses of the frames that the spec names, each in the frame of its body, or in the world; m.
        """
    def _input_bounds(self, /) -> dict[str, tuple[float, float]]:
        """
        Least and greatest values of inputs that are efforts of drives with a `max_effort`, N m or N, by name.
        """
    def _jvp(self, /, function: str, changes: ArrayLike, q: ArrayLike | None = None, v: ArrayLike | None = None, a: ArrayLike | None = None, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., results): derivatives of a function, times changes of all numbers.
        """
    def _modes(self, /, q: ArrayLike, invalid: str = "raise") -> dict[str, Any]:
        """
        Modes about poses, over parameters and poses: `Crane.modes` names them.
        """
    def _motions(self, /, timing: dict[str, Any], audit: bool, t: SupportsFloat | SupportsIndex, q: ArrayLike | None = None, v: ArrayLike | None = None, x: SupportsGetItem[int, SupportsFloat | SupportsIndex] = ..., inputs: dict[str, ArrayLike | None] | None = None, marks: SupportsGetItem[int, SupportsFloat | SupportsIndex] | None = None) -> Motions:
        """
        Motions from a time, s, for every row of parameters, starts and inputs; from their equilibria at rest unless q and v are given. `marks`: what events of
        earlier motions have done.
        """
    def _page(self, /, run: dict[str, Any] | None = None) -> str:
        """
        The crane in 3-D and in tables as an HTML page that needs no network: at rest, or with a run of it.
        """
    def _parameter_rows(self, /, index: SupportsIndex) -> Any:
        """
        Values of a live parameter, by its index, over the leading axes.
        """
    def _product_numbers(self, /) -> list[tuple[str, int]]:
        """
        Names of all numbers that functions depend on, and how many each has.
        """
    def _product_shape(self, /, function: str) -> list[int]:
        """
        Axes of the results of a function that has products.
        """
    def _recalled(self, /, timing: dict[str, Any], audit: bool, memories: SupportsGetItem[int, SupportsGetItem[int, SupportsFloat | SupportsIndex]]) -> Motions:
        """
        The motions from which these memories are: they go on with the same numbers, to the last bit.
        """
    def _record(self, /, timing: dict[str, Any], q: ArrayLike | None = None, v: ArrayLike | None = None, verify: bool = True, bend: SupportsFloat | SupportsIndex = ..., gradients: SupportsGetItem[int, str] | None = None, adjoint: SupportsGetItem[int, str] | None = None) -> dict[str, Any]:
        """
        A run with all its results: `Crane.simulate` makes a `Run` of it.
        """
    def _render(self, /, q: ArrayLike, shown: ArrayLike, width: SupportsIndex, height: SupportsIndex, azimuth: SupportsFloat | SupportsIndex | None = None, elevation: SupportsFloat | SupportsIndex | None = None) -> NDArray[uint8]:
        """
        The crane in pose `q`, as the page shows it in 3-D, height × width × 3; `shown`: poses for which there is room, too.
        """
    def _run_ensemble(self, /, timing: dict[str, Any], invalid: str = "raise", progress: Callable[[int, int], Any] | None = None, q: ArrayLike | None = None, v: ArrayLike | None = None, inputs: dict[str, ArrayLike | None] | None = None) -> dict[str, Any]:
        """
        Runs with every row of parameters, starts and inputs, with the extremes and final state of each: `Crane.simulate_ensemble` makes an
        `Ensemble` of them.
        """
    def _sensitivity(self, /, numbers: SupportsGetItem[int, str], frequencies: SupportsIndex = 3, invalid: str = "raise") -> dict[str, Any]:
        """
        Derivatives over parameters, by numbers of these names or places: `Crane.sensitivity` makes a `Sensitivity` of them.
        """
    def _small_motions(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., 3, n, n): A, K and D of small motions about poses at rest; `linearise` names them.
        """
    def _small_motions_about(self, /, q: ArrayLike, v: ArrayLike, a: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., 3, n, n): A, K and D of small motions about motions; `linearise` names them.
        """
    def _stable_steps(self, /, q: ArrayLike, invalid: str = "raise") -> dict[str, Any]:
        """
        The largest stable step of each method about poses, s, and what limits it: `Crane.stability` names them.
        """
    def _state_derivatives(self, /, q: ArrayLike, v: ArrayLike, x: ArrayLike | None = None, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n + states): accelerations and rates of the states of forces; `Crane.state_derivatives` separates them.
        """
    def _state_space(self, /, q: ArrayLike, v: ArrayLike | None = None, t: ArrayLike | None = None, x: ArrayLike | None = None, *, valves: str = "shut", steady: bool = False, inputs: SupportsGetItem[int, str] | None = None, outputs: SupportsGetItem[int, str] | None = None, invalid: str = "raise") -> dict[str, Any]:
        """
        Linear models about states: `Crane.state_space` makes a `StateSpace` of them.
        """
    def _steady_motion(self, /, held: SupportsGetItem[int, tuple[SupportsIndex, bool]], start: ArrayLike, rates: ArrayLike, positions: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., 3 n + 3): poses, rates and efforts of steady motions, drift, acceleration, part reached; `steady_motion` names them.
        held: coordinates, and whether a position is given; their rates and positions are at the same indices in `rates` and `positions`.
        """
    def _strength(self, /, q: ArrayLike, v: ArrayLike | None = None, a: ArrayLike | None = None, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., 5 sections + 5): stresses and utilisation of every section of beams, then margin, moments and supports of the governing
        tipping line; `Crane.strength` names them.
        """
    def _vjp(self, /, function: str, weights: ArrayLike, q: ArrayLike | None = None, v: ArrayLike | None = None, a: ArrayLike | None = None, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., numbers): weights of the results of a function, times its derivatives; `Crane.vjp` names them.
        """
    def _with_beam(self, /, link: str, to: str | None, point: SupportsLenAndGetItem[SupportsFloat | SupportsIndex] | None, keys: dict[str, Any]) -> str:
        """
        Its spec with a beam in the place of a rigid link, from the link's frame to another one's, or to a point in it; `keys` are those of the beam.
        """
    def bias(self, /, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n): Bias e: velocity and gravity forces, N and N m.
        They are on the right-hand side of `A q̈ = e + f`: the negative of the bias force C of Featherstone, of Pinocchio's `nle` and of
        MuJoCo's `qfrc_bias`, which are on the left-hand side.
        """
    @property
    def combinations(self, /) -> list[str]:
        """
        Names of the combinations of weights and loads of its spec.
        """
    def connector_energy(self, /, q: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (...): Energy of connectors, J.
        t: s, 0 unless given.
        """
    def connector_forces(self, /, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n): Generalized forces of connectors, N and N m.
        t: s, 0 unless given.
        """
    def connector_jacobians(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., connectors, n): How the length of every connector changes with the coordinates, one row per connector, m/rad and 1.
        """
    def connector_lengths(self, /, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., connectors, 2): Length ℓ (m) of every connector, and its rate ℓ̇ (m/s).
        """
    def connector_tensions(self, /, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., connectors, 3): Force F of every connector (N), positive where it pulls, and its derivatives ∂F/∂ℓ (N/m) and ∂F/∂ℓ̇ (N s/m).
        t: s, 0 unless given.
        """
    @property
    def coordinates(self, /) -> list[str]:
        """
        Names of the coordinates, in the order of q.
        """
    def cylinder_jacobians(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., cylinders, n): Derivatives of the length of every cylinder with respect to the coordinates, m/m and m/rad.
        A cylinder with a valve that pushes with F exerts the generalized forces `F ∂ℓ/∂q`. Zeros for a crane without valves.
        """
    def cylinder_states(self, /, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., cylinders, 3): Length of every cylinder, m, its rate, m/s, and its derivative with respect to the joint's coordinate, m/rad or m/m.
        NaN where the linkage of a cylinder cannot be assembled.
        """
    def dissipation(self, /, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (...): Power that all dampers dissipate, W.
        t: s, 0 unless given.
        """
    def drive_energy(self, /, q: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (...): Energy of the drives' springs, J.
        t: s, 0 unless given.
        """
    def drive_forces(self, /, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n): Generalized forces of the drives, N and N m.
        t: s, 0 unless given.
        """
    def drive_forces_at_rest(self, /, q: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n): Generalized forces of the drives that hold the crane at rest at given positions, N and N m.
        ℓ₀ is the length of a cylinder with the joint at the position of its drive and straight beams, and k the stiffness of the drive over
        the squared lever arm there. In Python, the drives are where they are at times t.
        t: s, 0 unless given.
        """
    def drive_limits(self, /, t: ArrayLike, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., drives, 2): Maximum effort of every drive, N m or N, 0 without a limit, and its stiffness at the state, N m/rad or N/m.
        Zeros for a crane without limits.
        """
    def drive_motions(self, /, t: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., drives, 2): Prescribed position q_dr (m, rad) and rate q̇_dr (m/s, rad/s) of every drive.
        """
    def drive_power(self, /, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (...): Power of the prescribed motions, W.
        t: s, 0 unless given.
        """
    def dynamic_residual(self, /, q: ArrayLike, v: ArrayLike, a: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n): Generalized forces r that a motion requires beyond those that act, N and N m.
        What a drive or another force would have to add: positive where it pushes towards larger coordinates; zero in all coordinates that
        move freely with a = q̈. For coordinates that rigid drives prescribe, f contains no force of these drives, and r is the effort that they
        need. The forces of cylinders with a valve, of bristles and of joints that close loops are not part of f.
        t: s, 0 unless given.
        """
    def dynamic_residual_derivatives(self, /, q: ArrayLike, v: ArrayLike, a: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., 2, n, n): Derivatives ∂r/∂q (N/m, N, N m) and ∂r/∂v (N s/m, N s, N m s) of the residual r = A a − e − f.
        Row i and column j of each matrix: the change of `r_i` with `q_j`, and with `q̇_j`. At rest ∂r/∂q is the tangent stiffness, and ∂r/∂v
        the damping matrix.
        t: s, 0 unless given.
        """
    def element_energy(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (...): Energy of the springs between rigid elements, J.
        """
    def element_forces(self, /, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n): Generalized forces of the springs and dampers between rigid elements, N m.
        """
    def export(self, /, format: str) -> str:
        """
        The crane for other programs: "urdf", "springs" (what URDF cannot express, YAML) or "mjcf", with the present parameters.
        """
    def force_derivatives(self, /, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., 2, n, n): Derivatives ∂f/∂q (N/m, N, N m) and ∂f/∂v (N s/m, N s, N m s) of the generalized forces f, without efforts of rigid drives.
        Row i and column j of each matrix: the change of `f_i` with `q_j`, and with `q̇_j`. f is that of `dynamic_residual`: without the efforts of
        rigid drives, which `forces` has.
        t: s, 0 unless given.
        """
    def forces(self, /, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n): Generalized forces of everything except inertia and gravity, N and N m.
        The forces of cylinders with a valve depend on their pressures and are not included. Those of rigid drives are, as the efforts with which
        `A q̈ = e + f` also holds in the rows of the coordinates that they prescribe; in an open chain.
        t: s, 0 unless given.
        """
    def forward_dynamics(self, /, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n): Accelerations q̈, m/s² and rad/s².
        In O(n): A is never formed. The forces of cylinders with a valve are not included. Of the open chain, except in Python.
        t: s, 0 unless given.
        """
    def forward_dynamics_derivatives(self, /, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., 3, n, n): derivatives ∂q̈/∂q, ∂q̈/∂v and ∂q̈/∂τ = A⁻¹ of the accelerations of `forward_dynamics`, τ generalized forces; row i and
        column j of each: the change of `q̈_i` with `q_j`, with `q̇_j` and with `τ_j`. For coordinates that rigid drives prescribe the rows are zero, and so
        are their columns of A⁻¹.
        t: s, 0 unless given.
        """
    def friction_forces(self, /, v: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n): Generalized forces of joint friction, N and N m.
        """
    def gravity_energy(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (...): Potential energy of gravity, zero at the world's origin, J.
        """
    @property
    def guess(self, /) -> NDArray[float64]:
        """
        (..., n): where statics begins, m and rad; NaN for parameters that break a rule.
        """
    @property
    def info(self, /) -> Info:
        """
        Coordinates, bodies, drives, supports, points and parameters: names, units and descriptions.
        """
    @property
    def inputs(self, /) -> dict[str, float]:
        """
        Inputs that are set, by name.
        """
    def internal_forces(self, /, q: ArrayLike, v: ArrayLike | None = None, a: ArrayLike | None = None, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., cuts, 6): force, N, and moment, N m, that the part beyond each cut exerts on the part before it, with the forces of cylinders
        and of joints that close loops; `Crane.info["cuts"]` lists the cuts. a: accelerations; at rest unless v and a are given.
        """
    def inverse_dynamics(self, /, q: ArrayLike, v: ArrayLike, a: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n): Generalized forces that a motion requires in total, N and N m.
        The torque of robotics, with inertia and gravity alone: what all forces together must be. `crane eval` takes the accelerations q̈ from
        the equations of motion.
        """
    def inverse_mass_matrix(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n, n): Inverse A⁻¹ of the mass matrix: accelerations per generalized force; 1/kg, 1/(kg m) and 1/(kg m²).
        Zero in rows and columns of coordinates that rigid drives prescribe. Of the open chain.
        """
    def joint_damper_forces(self, /, v: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n): Generalized forces of viscous damping in passive joints, N and N m.
        """
    def kinetic_energy(self, /, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (...): Kinetic energy, J.
        """
    def load_forces(self, /, q: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n): Generalized forces of the loads applied from outside, N and N m.
        t: s, 0 unless given.
        """
    def load_power(self, /, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (...): Power that the loads applied from outside put in, W.
        t: s, 0 unless given.
        """
    def loop_jacobians(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., loop_equations, n): How the gaps of the loop joints change with the coordinates, one row per equation.
        """
    def loop_states(self, /, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., loop_equations, 3): Every equation of the loop joints: its gap φ (m, and 1 for the direction of a pin), the rate of φ, and the part of its second rate that does not depend on accelerations.
        """
    def mass_matrix(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n, n): Mass matrix A; kg, kg m and kg m².
        Symmetric positive definite.
        """
    @property
    def n(self, /) -> int:
        """
        Number of coordinates.
        """
    @property
    def name(self, /) -> str:
        """
        Name of the crane.
        """
    def picture(self, /) -> str:
        """
        A diagram of the crane: its bodies and coordinates at the guess, with the present parameters, SVG.
        """
    def point_accelerations(self, /, q: ArrayLike, v: ArrayLike, a: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., points, 3): Accelerations of the points of interest in the world frame, m/s².
        An accelerometer at the point measures these minus the acceleration of gravity. `crane eval` takes the accelerations q̈ from the equations
        of motion.
        """
    def point_jacobians(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., points, 3, n): Derivatives J of the points' positions with respect to the coordinates; m/rad and 1.
        For each point the rows x, y and z: the velocities of the points are J q̇.
        """
    def point_velocities(self, /, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., points, 3): Velocities of the points of interest in the world frame, m/s.
        """
    def points(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., points, 3): Positions of the points of interest in the world frame, m.
        """
    @property
    def shape(self, /) -> list[int]:
        """
        Leading axes of the parameters; empty where all are numbers.
        """
    @property
    def source(self, /) -> str:
        """
        Origin of the spec, as shown in messages.
        """
    @property
    def spec(self, /) -> str:
        """
        Its spec, YAML.
        """
    @property
    def spec_hash(self, /) -> str:
        """
        Hash of the spec.
        """
    def static_residual(self, /, q: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n): Gradient of the potential energy with the drives at given positions, zero in equilibrium; N and N m.
        In Python, the drives are where they are at times t.
        t: s, 0 unless given.
        """
    def stop_energy(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (...): Energy of the end stops, J.
        """
    def stop_forces(self, /, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n): Generalized forces of the end stops, N and N m.
        """
    def support_elongations(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., supports, 3): How far every support is from where the spec puts it, in the world frame, m.
        Zeros for a crane without one-sided supports, as for the next four.
        """
    def support_energy(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (...): Energy of the supports' springs, J.
        """
    def support_forces(self, /, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n): Generalized forces of the supports, N and N m.
        """
    def support_gaps(self, /, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., supports, 2): How far one-sided supports are above the ground, m, negative where they are pressed in, and its rate, m/s; 0 for others.
        """
    def support_grips(self, /, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., supports, 3): Pressing force of one-sided supports, the lateral force up to which they stick, and the one that keeps them where the spec puts them, N; 0 for others.
        """
    def support_jacobians(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., supports, 3, n): How the elongations of the supports change with the coordinates: three rows per support; m/rad and 1.
        """
    def support_positions(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., supports, 3): Positions of the supports' attachment points in the world frame, m.
        """
    def support_reactions(self, /, q: ArrayLike, v: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., supports, 3): Forces of the supports on the crane in the world frame, N.
        """
    def tangent_stiffness(self, /, q: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., n, n): Tangent stiffness K: derivative of the residual, its symmetric part; N/m, N and N m.
        Positive definite if the equilibrium is stable. A prescribed coordinate, whose residual is 0, has 1 on the diagonal and zeros elsewhere
        in its row and column. In Python, the drives are where they are at times t.
        t: s, 0 unless given.
        """
    @property
    def title(self, /) -> str:
        """
        One line about it.
        """
    def transform_derivatives(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., bodies, n, 4, 4): Derivatives ∂T/∂q_j of every body, for all coordinates j that move it; 1, m, 1/m.
        """
    def transform_second_derivatives(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., bodies, n, n, 4, 4): `∂²T/∂q_m∂q_n`.
        """
    def transforms(self, /, q: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., bodies, 4, 4): Transforms T of all bodies into the world frame; translations in m.
        """
    def valve_openings(self, /, t: ArrayLike, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (..., drives, 2): Command of the valve of every drive over time, −1 to 1, and its rate, 1/s; zeros without one.
        """
    def winch_power(self, /, q: ArrayLike, v: ArrayLike, t: ArrayLike | None = None, *, invalid: str = "raise") -> NDArray[float64]:
        """
        (...): Power that winches put in, W.
        t: s, 0 unless given.
        """

@final
class Motions:
    """
    Motions of cranes of one spec; each continues with the history of its method.
    """
    def __len__(self, /) -> int: ...
    def advance(self, /, dt: SupportsFloat | SupportsIndex, steps: SupportsIndex, inputs: dict[str, Any], linear: bool) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64]]:
        """
        Advances all by `dt`, s, several times, with new values of inputs by name: numbers, arrays (rows) or (steps, rows), or None for that of
        the spec. Returns times (steps, rows), and poses and rates (steps, rows, n); rows that fail stay at their last state.
        """
    def can_set(self, /, name: str) -> bool:
        """
        Whether an input can be set, and released, while the motions go on: it does not follow a motion of the spec.
        """
    def check(self, /) -> None:
        """
        Raises why the first row that ended has ended.
        """
    def failures(self, /) -> list[str | None]:
        """
        Why each row ended; None for those that go on.
        """
    def marks(self, /, row: SupportsIndex) -> dict[str, float]:
        """
        What events of a row have done, by name: the time of each, s; 0 if it is still to come, NaN if its condition has to cease before, −1 if its time was
        before the start.
        """
    def memory(self, /, row: SupportsIndex) -> NDArray[float64]:
        """
        All numbers from which the motion of a row can be made again.
        """
    def parameters(self, /) -> NDArray[float64]:
        """
        The live parameters, (rows, parameters), which events may have set.
        """
    def put(self, /, rows: SupportsGetItem[int, SupportsIndex], others: Motions) -> None:
        """
        Exchanges rows for those of other motions of the same cranes, one after the other.
        """
    def states(self, /) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64], NDArray[float64], NDArray[float64]]:
        """
        States reached: times (rows), poses and rates (rows, n), states of forces (rows, states), and work of the drives, dissipated energy and
        work of the loads since the start, J, (rows, 3).
        """
    def statistics(self, /, row: SupportsIndex) -> dict[str, int]:
        """
        Steps, rejections, evaluations and factorisations so far, of a row.
        """
    def steer(self, /, dt: SupportsFloat | SupportsIndex, places: SupportsGetItem[int, SupportsIndex], values: ArrayLike, linear: bool) -> NDArray[float64]:
        """
        Advances all by `dt`, s, with new values, (rows, inputs), of inputs by their places in the spec. Returns times, poses and rates, (rows, 1 + 2 n): as
        `advance` does, for callers to whom its arrays would take longer than the step.
        """

def duties_of(crane: Crane, table: NDArray[float64]) -> tuple[list[tuple[str, str, str, list[float]]], list[tuple[str, list[float]]], list[float] | None]:
    """
    What drives, cylinders and the pump of a run must be able to do: `Run.duties` names it.
    """

def fatigue_of(manoeuvres: SupportsGetItem[int, tuple[Crane, NDArray[float64], SupportsFloat | SupportsIndex]], categories: SupportsGetItem[int, tuple[str | None, Any]], slope: SupportsFloat | SupportsIndex, safety_factor: SupportsFloat | SupportsIndex) -> list[tuple[str, float, str, float, float, list[tuple[float, list[float], list[list[float]]]]]]:
    """
    What runs that repeat do to every place of beams: `crane.fatigue` names it. `categories`: of beams by their names, `None` that of all others.
    """

def functions() -> list[tuple[str, list[str], list[str]]]:
    """
    Methods of the table of quantities: name, arguments, and axes of the result of one state.
    """

def import_robot(named: str, text: str | None, fix: SupportsGetItem[int, str], repair: bool) -> str:
    """
    The spec of a robot in URDF or MJCF, as `crane import` writes it: of a file, with those in MJCF that it includes, or of a text.
    """

def loop_margins(a: NDArray[float64], b: NDArray[float64], c: NDArray[float64], d: NDArray[float64], powers: SupportsGetItem[int, SupportsIndex], numbers: SupportsLenAndGetItem[SupportsFloat | SupportsIndex], invalid: str) -> NDArray[float64]:
    """
    (rows, 11): margins of a loop around plants, row by row: `Crane.margins` names them; NaN where there are none.

    a: (rows, n, n), b: (rows, n, k), c: (rows, n), d: (rows, k): state matrices, what follows the input with these powers of s, the output.
    numbers: p, i, d, filter, both times of a lead, delay, lag.
    """

def real_array(name: str, object: ArrayLike) -> NDArray[float64]:
    """
    A new array of the numbers of anything that `NumPy` converts to an array of real numbers; masked ones are NaN.
    `TypeError` names what is none.
    """

def set_threads(count: SupportsIndex | None = None) -> None:
    """
    Sets how many threads a call uses; None: as many as the machine has.
    """

def shipped() -> list[str]:
    """
    Names of the cranes that come with the package.
    """

def threads() -> int:
    """
    How many threads a call uses.
    """
