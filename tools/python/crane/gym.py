"""Environments for learning, in the interface of Gymnasium: `pip install 'crane[gym]'`.

>>> import crane.gym
>>> env = crane.gym.CraneEnv("my_crane.yaml", actions={"slew": (-0.4, 0.4)}, rates=True, observations=["column_psi", "column_psi_rate"])
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from .model import Crane, load
from .results import Array
from .vector_simulation import VectorSimulation

Band = tuple[float, float]
Results = Mapping[str, Array]
Reward = Callable[[Results], Array]


def reach(
    targets: Mapping[str, float] | Sequence[str] | str,
    swing: Mapping[str, float] | Sequence[str] = (),
    effort: Mapping[str, float] | Sequence[str] = (),
) -> Reward:
    """The reward for coming to targets and damping the swing there, per step: `−Σ ((x − x_target)/s)² − Σ (w/s)² − Σ (a/s)²`.

    targets: results with a target, by name, with the distance s that counts as 1; 1 unless given. swing: results that shall be zero, such as rates of
    a hanging load. effort: results that shall be small, such as actions (`action_slew`).
    """
    given = ([of] if isinstance(of, str) else of for of in (targets, swing, effort))
    return _Reach(*(dict(of) if isinstance(of, Mapping) else dict.fromkeys(of, 1.0) for of in given))


@dataclass(frozen=True)
class _Reach:
    """The reward that `reach` makes: distances that count as 1, by name."""

    targets: dict[str, float]
    swing: dict[str, float]
    effort: dict[str, float]

    def __call__(self, results: Results) -> Array:
        missed = sum(((results[name] - results[f"{name}_target"]) / scale) ** 2 for name, scale in self.targets.items())
        return -missed - sum((results[name] / scale) ** 2 for name, scale in {**self.swing, **self.effort}.items())


@dataclass(frozen=True)
class Task:
    """What a crane shall do in an episode: the arguments of `CraneEnv` and `CraneVectorEnv`.

    actions: inputs of the spec by name, with their least and greatest values; without bounds, None, those of the spec: plus and minus `max_effort` of
    the drive whose effort the input is. Actions are scaled: −1 is the least value, 1 the greatest.
    rates: whether actions are rates of the inputs, per second, instead of values; then bounds are those of the rates.
    observations: names of results: coordinates, their rates (`boom_psi_rate`), points (`tip_x`), inputs (`input_slew`) and targets
    (`boom_psi_target`).
    reward: a function of results by name, (rows) each, and also of actions (`action_slew`), the time `t`, and `dt`; `reach` makes one.
    targets: results with the bands from which their targets are drawn at every reset.
    bands: live parameters with the bands from which they are drawn at every reset (domain randomisation).
    starts: inputs with the bands from which their first values are drawn.
    limits: results with the bands that they may not leave: the episode terminates. tipping: the least tipping margin.
    dt: the time of an action, s; duration: that of an episode, s, after which it is truncated.
    hold: "constant" or "linear": how inputs come to their new values. It is "linear" with rates.
    penalty: the reward when an episode terminates, added to that of its last step.
    scales: of observations, by which they are divided; 1 unless given.
    """

    actions: Mapping[str, Band | None]
    reward: Reward
    observations: Sequence[str] = ()
    rates: bool = False
    targets: Mapping[str, Band] = field(default_factory=dict)
    bands: Mapping[str, Band] = field(default_factory=dict)
    starts: Mapping[str, Band] = field(default_factory=dict)
    limits: Mapping[str, Band] = field(default_factory=dict)
    tipping: float | None = None
    dt: float = 0.02
    duration: float = 10.0
    hold: str = "constant"
    penalty: float = 0.0
    scales: Mapping[str, float] = field(default_factory=dict)
    tolerance: float | None = None
    method: str | None = None


class _Episodes:
    """Episodes of a task in many cranes: what both environments share."""

    def __init__(self, crane: Crane | str, count: int, task: Task) -> None:
        self.crane = load(crane) if isinstance(crane, str) else crane
        self.task, self.count = task, count
        if self.crane.shape:
            raise ValueError("the parameters are arrays: give bands, from which each episode draws its own")
        coordinates, points = self.crane.coordinates, self.crane.info["points"]
        self._inputs = [of["name"] for of in self.crane.info["inputs"]]
        if not task.actions:
            raise ValueError("actions: name at least one input of the spec, as in actions={'slew': (-1, 1)}")
        for name in (*task.actions, *task.starts):
            _known(name, self._inputs, "input")
        for name in task.bands:
            _known(name, self.crane.parameters, "live parameter")
        bounds = {name: self._bounds(name) if band is None else band for name, band in task.actions.items()}
        self._actions = list(bounds)
        of_spec = {of["name"]: of["default"] for of in self.crane.info["inputs"] if of["name"] in task.actions}
        self._defaults = {**of_spec, **self.crane.inputs}
        self._low, self._high = (np.array([bounds[name][side] for name in bounds], dtype=float) for side in (0, 1))
        for name, (low, high) in {**bounds, **task.targets, **task.bands, **task.starts, **task.limits}.items():
            if not low <= high:
                raise ValueError(f"{name!r}: ({low}, {high}): write the least value first")
        # Where each result is: q, v, or the points, of which those that are asked for are computed.
        self._places: dict[str, tuple[str, Any]] = {}
        for j, name in enumerate(coordinates):
            self._places[name], self._places[f"{name}_rate"] = ("q", j), ("v", j)
        for i, point in enumerate(points):
            for k, axis in enumerate("xyz"):
                self._places[f"{point}_{axis}"], self._places[f"{point}_{axis}_rate"] = ("points", (i, k)), ("velocities", (i, k))
        for name in (*task.targets, *task.limits):
            _known(name, self._places, "result")
        everything = [*self._places, *(f"{name}_target" for name in task.targets), *(f"input_{name}" for name in self._inputs)]
        self.names = list(task.observations) or [*(f"{name}{of}" for of in ("", "_rate") for name in coordinates), *everything[len(self._places) :]]
        for name in (*self.names, *task.scales):
            _known(name, everything, "observation")
        self._scales = np.array([task.scales.get(name, 1.0) for name in self.names])
        self._simulation: VectorSimulation | None = None
        self._random: list[np.random.Generator] = [np.random.default_rng() for _ in range(count)]
        self._targets = {name: np.zeros(count) for name in task.targets}
        self._steps = np.zeros(count, dtype=int)
        self._most_steps = max(1, round(task.duration / task.dt))
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (len(self.names),), np.float64)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (len(self._actions),), np.float32)

    def _bounds(self, name: str) -> Band:
        bounds = self.crane._input_bounds().get(name)
        if bounds is None or self.task.rates:
            raise ValueError(f"actions[{name!r}]: the spec has no bounds for it; write them, as in actions={{{name!r}: (-1, 1)}}")
        return bounds

    def seed(self, seeds: Sequence[int | None]) -> None:
        """New random numbers in rows whose seed is given."""
        for row, seed in enumerate(seeds):
            if seed is not None:
                self._random[row] = np.random.default_rng(seed)

    def reset(self, rows: Array) -> None:
        """Begins new episodes in some rows."""
        task = self.task
        drawn = [{of: self._draw(row, bands) for of, bands in self._drawn_from().items()} for row in rows]
        for of in task.targets:
            self._targets[of][rows] = [each["targets"][of] for each in drawn]
        parameters = {of: np.array([each["bands"][of] for each in drawn]) for of in task.bands}
        inputs = {**self._defaults, **{of: np.array([each["starts"][of] for each in drawn]) for of in task.starts}}
        if self._simulation is None:
            cranes = self.crane.replace(**parameters) if parameters else self.crane
            self._simulation = cranes.vector_simulation(self.count, method=task.method, tolerance=task.tolerance, inputs=inputs)
        else:
            self._simulation.reset(rows, inputs=inputs, **parameters)
        self._steps[rows] = 0

    def _drawn_from(self) -> dict[str, Mapping[str, Band]]:
        return {"targets": self.task.targets, "bands": self.task.bands, "starts": self.task.starts}

    def _draw(self, row: int, bands: Mapping[str, Band]) -> dict[str, float]:
        return {name: self._random[row].uniform(low, high) for name, (low, high) in bands.items()}

    def step(self, actions: Array) -> tuple[Array, Array, Array, dict[str, Array]]:
        """Advances all rows: rewards, terminations, truncations, and why: texts, empty where an episode goes on."""
        task, simulation = self.task, self._simulation
        if simulation is None:
            raise gymnasium.error.ResetNeeded("call reset() before step()")
        shares = np.clip(np.asarray(actions, dtype=float).reshape(self.count, len(self._actions)), -1.0, 1.0)
        values = self._low + 0.5 * (shares + 1.0) * (self._high - self._low)
        now = simulation.inputs
        inputs = {name: now[name] + values[:, j] * task.dt if task.rates else values[:, j] for j, name in enumerate(self._actions)}
        simulation.step(task.dt, inputs, hold="linear" if task.rates else task.hold, invalid="nan")
        self._steps += 1
        results = self.results()
        results.update({f"action_{name}": values[:, j] for j, name in enumerate(self._actions)})
        why = np.array([reason or "" for reason in simulation.failures], dtype=object)
        for name, (low, high) in task.limits.items():
            out = (results[name] < low) | (results[name] > high)
            why[(why == "") & out] = f"{name} left its limits"
        if task.tipping is not None:
            margin = simulation.crane.strength(simulation.q, simulation.v, t=simulation.t).tipping_margin
            why[(why == "") & (margin < task.tipping)] = "tipping"
        terminations = why != ""
        rewards = np.broadcast_to(np.asarray(task.reward(results), dtype=float), (self.count,)) + task.penalty * terminations
        truncations = (self._steps >= self._most_steps) & ~terminations
        return rewards, terminations, truncations, why

    def results(self) -> dict[str, Array]:
        """Results by name, (rows) each; those of points are computed when one of them is read."""
        return _Results(self)

    def observations(self) -> Array:
        results = self.results()
        return np.stack([results[name] for name in self.names], axis=-1) / self._scales


class _Results(dict):
    """Results of the present states, each computed when it is first read."""

    def __init__(self, episodes: _Episodes) -> None:
        simulation = episodes._simulation
        super().__init__({f"{name}_target": value.copy() for name, value in episodes._targets.items()})
        self.update({f"input_{name}": value for name, value in simulation.inputs.items()}, t=simulation.t, dt=np.float64(episodes.task.dt))
        self._places, self._simulation, self._cranes = episodes._places, simulation, episodes.crane
        self._arrays: dict[str, Array] = {"q": simulation.q, "v": simulation.v}

    def __missing__(self, name: str) -> Array:
        kind, place = self._places[_known(name, self._places, "result")]
        if kind not in self._arrays:
            of, (q, v) = self._simulation.crane, (self._simulation.q, self._simulation.v)
            self._arrays[kind] = of.points(q) if kind == "points" else of.point_velocities(q, v)
        array = self._arrays[kind]
        self[name] = array[:, place] if isinstance(place, int) else array[:, place[0], place[1]]
        return self[name]


def _known(name: str, of: Any, what: str) -> str:
    if name not in of:
        raise ValueError(f"there is no {what} {name!r}: write one of {', '.join(of) or 'none'}")
    return name


class CraneEnv(gymnasium.Env):
    """A crane as an environment of Gymnasium: `Task` explains the arguments, such as actions and reward.

    `reset(seed=...)` draws targets, parameters and first inputs: the same seed and the same actions give the same episode, to the last bit. It can
    be copied and pickled within an episode. `info` has the results by name, and `why` an episode terminated: what left its limits, "tipping",
    or how the integration failed. Observations and rewards are those of the state reached.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 50}

    def __init__(self, crane: Crane | str, *, render_mode: str | None = None, **task: Any) -> None:
        if render_mode is not None:
            _known(render_mode, self.metadata["render_modes"], "render mode")
        self.render_mode = render_mode
        self._episodes = _Episodes(crane, 1, Task(**task))
        self.metadata = {**self.metadata, "render_fps": round(1 / self._episodes.task.dt)}
        self.observation_space, self.action_space = self._episodes.observation_space, self._episodes.action_space

    @property
    def crane(self) -> Crane:
        """The crane, with the parameters of its spec."""
        return self._episodes.crane

    @property
    def observation_names(self) -> list[str]:
        """What each number of an observation is."""
        return list(self._episodes.names)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        """Begins a new episode."""
        super().reset(seed=seed)
        self._episodes.seed([seed])
        self._episodes.reset(np.array([0]))
        return self._episodes.observations()[0], self._info("")

    def step(self, action: Array) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        """Advances the crane by `dt` with an action."""
        reward, terminated, truncated, why = self._episodes.step(np.asarray(action)[None])
        return self._episodes.observations()[0], float(reward[0]), bool(terminated[0]), bool(truncated[0]), self._info(why[0])

    def render(self) -> NDArray[np.uint8] | None:
        """The crane as it is now, (480, 640, 3) red, green and blue, with `render_mode="rgb_array"`; else nothing."""
        if self.render_mode is None:
            return None
        simulation = self._episodes._simulation
        if simulation is None:
            raise gymnasium.error.ResetNeeded("call reset() before render()")
        crane = simulation.crane
        # Room for where statics begins, too: the view then seldom moves with the crane.
        return crane.render(simulation.q[0], shown=[crane.guess.reshape(-1), simulation.q[0]])

    def _info(self, why: str) -> dict[str, Any]:
        results = self._episodes.results()
        names = [*self._episodes.names, *(name for name in results if name != "dt")]
        return {"why": why, **{name: float(results[name][0]) for name in names}}


class CraneVectorEnv(gymnasium.vector.VectorEnv):
    """Many cranes as a vector environment of Gymnasium, stepped together on all threads: `Task` explains the arguments.

    An episode that ends begins again at the next step, whose action is ignored and whose reward is 0 (`AutoresetMode.NEXT_STEP`).
    `reset(seed=s)` seeds row i with s + i: it has the episodes of a `CraneEnv` that is reset with that seed, to the last bit.
    """

    metadata = {"render_modes": [], "autoreset_mode": gymnasium.vector.AutoresetMode.NEXT_STEP}

    def __init__(self, crane: Crane | str, num_envs: int, **task: Any) -> None:
        self._episodes = _Episodes(crane, num_envs, Task(**task))
        self.num_envs = num_envs
        self.single_observation_space, self.single_action_space = self._episodes.observation_space, self._episodes.action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._ended = np.zeros(num_envs, dtype=bool)

    @property
    def crane(self) -> Crane:
        """The crane, with the parameters of its spec."""
        return self._episodes.crane

    @property
    def observation_names(self) -> list[str]:
        """What each number of an observation is."""
        return list(self._episodes.names)

    def reset(self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        """Begins new episodes in all rows, or in those of `options["reset_mask"]`."""
        if isinstance(seed, int | np.integer):
            seed = [int(seed) + row for row in range(self.num_envs)]
        seeds = [None] * self.num_envs if seed is None else list(seed)
        if len(seeds) != self.num_envs:
            raise ValueError(f"seed: {len(seeds)} numbers for {self.num_envs} environments")
        self._episodes.seed(seeds)
        mask = (options or {}).get("reset_mask")
        rows = np.arange(self.num_envs) if mask is None or self._episodes._simulation is None else np.flatnonzero(mask)
        self._episodes.reset(rows)
        self._ended[rows] = False
        return self._episodes.observations(), {}

    def step(self, actions: Array) -> tuple[Array, Array, Array, Array, dict[str, Any]]:
        """Advances all cranes by `dt`."""
        again = np.flatnonzero(self._ended)
        before = self._episodes
        rewards, terminations, truncations, why = before.step(actions)
        if len(again):
            before.reset(again)
            rewards[again], terminations[again], truncations[again], why[again] = 0.0, False, False, ""
        self._ended = terminations | truncations
        info = {"why": why, "_why": why != ""} if (why != "").any() else {}
        return before.observations(), rewards, terminations, truncations, info
