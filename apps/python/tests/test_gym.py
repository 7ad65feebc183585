"""Environments of Gymnasium."""

import copy
import importlib.util
import pickle
import warnings

import crane
import numpy as np
import pytest
from conftest import ROOT

gymnasium = pytest.importorskip("gymnasium")

from crane.gym import CraneEnv, CraneVectorEnv, reach  # noqa: E402
from gymnasium.vector import AutoresetMode, SyncVectorEnv  # noqa: E402
from test_stepping import STEERED  # noqa: E402

spec = importlib.util.spec_from_file_location("slewing", ROOT / "examples/python/slewing.py")
slewing = importlib.util.module_from_spec(spec)
spec.loader.exec_module(slewing)

TASK = {
    "actions": {"slew": (-0.5, 0.5)},
    "rates": True,
    "observations": ["column_psi", "column_psi_rate", "load_x", "load_vx", "column_psi_target", "input_slew"],
    "targets": {"column_psi": (-1.0, 1.0)},
    "bands": {"load_mass": (200.0, 1500.0)},
    "starts": {"slew": (-0.2, 0.2)},
    "reward": reach({"column_psi": 0.5}, swing=["load_phi_rate"], effort={"action_slew": 5.0}),
    "duration": 0.2,
}


def environment(**changes):
    return CraneEnv(crane.load("slewing_crane", text=slewing.SPEC), **{**TASK, **changes})


def vector(count, **changes):
    return CraneVectorEnv(crane.load("slewing_crane", text=slewing.SPEC), count, **{**TASK, **changes})


def test_the_checker_of_gymnasium_passes():
    from gymnasium.utils.env_checker import check_env

    with warnings.catch_warnings():
        # It recommends bounded observations, and environments that are made by name.
        warnings.simplefilter("ignore")
        check_env(environment(), skip_render_check=True)


def test_the_same_seed_is_the_same_episode():
    first, second = (environment() for _ in range(2))
    actions = np.random.default_rng(0).uniform(-1, 1, (12, 1))
    for seed in (7, 8):
        paths = []
        for env in (first, second):
            observed, info = env.reset(seed=seed)
            paths.append([observed, *(env.step(action)[0] for action in actions)])
        np.testing.assert_array_equal(*paths)
    assert np.abs(first.reset(seed=7)[0] - first.reset(seed=8)[0]).max() > 1e-3
    assert info["why"] == "" and abs(info["column_psi_target"]) <= 1.0


def test_rows_are_single_environments_to_the_last_bit():
    """Over the end of an episode: rows begin again in the step after it."""
    together = vector(3)
    observed, _ = together.reset(seed=20)
    singles = [environment() for _ in range(3)]
    for row, env in enumerate(singles):
        np.testing.assert_array_equal(observed[row], env.reset(seed=20 + row)[0])
    random, ended = np.random.default_rng(1), False
    for step in range(15):
        actions = random.uniform(-1, 1, (3, 1)).astype(np.float32)
        observed, rewards, terminated, truncated, _ = together.step(actions)
        assert truncated.tolist() == [step == 9] * 3 and not terminated.any()
        for row, env in enumerate(singles):
            if ended:
                np.testing.assert_array_equal(observed[row], env.reset()[0])
                assert rewards[row] == 0.0
            else:
                expected = env.step(actions[row])
                np.testing.assert_array_equal(observed[row], expected[0])
                assert rewards[row] == expected[1] and truncated[row] == expected[3]
        ended = truncated[0]
    assert together.observation_space.contains(observed) and together.action_space.contains(actions)


def same(ours, theirs):
    """Compares what both vector environments tell, to the last bit."""
    if isinstance(theirs, dict):
        assert ours.keys() == theirs.keys()
        for name in theirs:
            same(ours[name], theirs[name])
    elif theirs.dtype == object:
        assert ours.dtype == object
        for one, other in zip(ours, theirs, strict=True):
            np.testing.assert_array_equal(one, other)
    else:
        np.testing.assert_array_equal(ours, theirs, strict=True)


@pytest.mark.parametrize("mode", AutoresetMode)
def test_episodes_follow_each_other_as_in_gymnasium(mode):
    """Over terminations and truncations, step by step. Episodes that begin outside the limits end at once, others later or after ten steps."""
    changes = {"limits": {"column_psi": (-0.15, 0.15)}, "penalty": -3.0}
    ours = vector(4, autoreset_mode=mode.value, **changes)
    theirs = SyncVectorEnv([lambda: environment(**changes)] * 4, autoreset_mode=mode)
    assert ours.metadata["autoreset_mode"] is theirs.metadata["autoreset_mode"] is mode
    same(dict(enumerate(ours.reset(seed=3))), dict(enumerate(theirs.reset(seed=3))))
    random, seen = np.random.default_rng(1), set()
    for step in range(32):
        actions = random.uniform(-1, 1, (4, 1)).astype(np.float32)
        found, expected = ours.step(actions), theirs.step(actions)
        same(dict(enumerate(found)), dict(enumerate(expected)))
        terminated, truncated = found[2:4]
        seen |= {(bool(one), bool(other)) for one, other in zip(terminated, truncated, strict=True)}
        ended = terminated | truncated
        if mode == AutoresetMode.DISABLED and ended.any():
            with pytest.raises(gymnasium.error.ResetNeeded, match="have ended"):
                ours.step(actions)
            options = {"load_mass": 300.0 + step} if step % 2 else {}
            resets = [env.reset(seed=[step, None, None, 7], options={"reset_mask": ended, **options}) for env in (ours, theirs)]
            same(*(dict(enumerate(reset)) for reset in resets))
    assert seen == {(False, False), (True, False), (False, True)}


def test_options_are_for_one_episode():
    env = environment()
    plain, told = env.reset(seed=5)
    mass = env._episodes._simulation.parameters["load_mass"][0]
    start = {"slew": 0.3, "load_phi": 0.2, "pin_theta_rate": 0.1}
    observed, info = env.reset(seed=5, options={"load_mass": 3.0, "start": start, "targets": {"column_psi": 0.7}})
    simulation = env._episodes._simulation
    assert simulation.parameters["load_mass"] == 3.0 and info["input_slew"] == 0.3 and info["column_psi_target"] == 0.7
    # The coordinates that are given; the column rests where the input of the start holds it, to the sag of its drive.
    q, v = (dict(zip(env.crane.coordinates, of[0], strict=True)) for of in (simulation.q, simulation.v))
    assert q["load_phi"] == 0.2 and v == {"column_psi": 0.0, "pin_theta": 0.1, "load_phi": 0.0}
    assert q["column_psi"] == pytest.approx(0.3, abs=1e-9) and info["column_psi"] == observed[0]
    # The same crane elsewhere: the first step is that of a simulation with these numbers.
    crane_of = env.crane.replace(load_mass=3.0, inputs={"slew": 0.3})
    alone = crane_of.vector_simulation(1, q=simulation.q, v=simulation.v)
    env.step([1.0])
    np.testing.assert_array_equal(simulation.q, alone.step(0.02, {"slew": 0.3 + 0.5 * 0.02}, hold="linear").q)
    # The next episode is what it would have been: the same numbers were drawn.
    np.testing.assert_array_equal(env.reset(seed=5)[0], plain)
    assert env._episodes._simulation.parameters["load_mass"][0] == mass
    # Without bands, too: parameters and inputs go back to those of the spec.
    fixed = environment(bands={}, starts={})
    fixed.reset(options={"load_mass": 3.0, "start": {"slew": 0.1}})
    fixed.reset()
    assert fixed._episodes._simulation.parameters["load_mass"] == 800 and fixed._episodes._simulation.inputs["slew"] == 0.0

    together = vector(3)
    together.reset(seed=5)
    masses = np.array([3.0, 4.0, 5.0])
    _, info = together.reset(options={"reset_mask": np.array([True, False, True]), "load_mass": masses, "start": {"slew": 0.1}})
    now = together._episodes._simulation.parameters["load_mass"]
    assert now[[0, 2]].tolist() == [3.0, 5.0] and now[1] > 200 and info["_input_slew"].tolist() == [True, False, True]
    assert info["input_slew"].tolist() == [0.1, 0.0, 0.1]


def test_options_that_do_not_exist_are_refused():
    env, together = environment(), vector(2)
    for options, words in [
        ({"mass": 3.0}, "no option 'mass': write one of load_mass, start, targets"),
        ({"reset_mask": np.array([True])}, "no option 'reset_mask'"),
        ({"start": {"slow": 1.0}}, "no input or coordinate 'slow': write one of slew, column_psi, pin_theta, load_phi, column_psi_rate"),
        ({"targets": {"tip_x": 1.0}}, "no target 'tip_x': write one of column_psi"),
        ({"load_mass": [1.0, 2.0]}, r"'load_mass' has shape \(2,\): give one number$"),
        ({"load_mass": -3.0}, "load_mass"),
    ]:
        with pytest.raises(ValueError, match=words):
            env.reset(options=options)
    with pytest.raises(ValueError, match=r"shape \(3,\): give one number, or 2 of them"):
        together.reset(options={"load_mass": np.ones(3)})
    with pytest.raises(gymnasium.error.ResetNeeded, match="all rows"):
        together.reset(options={"reset_mask": np.array([True, False])})
    for mask in ([1, 0], [True], [False, False]):
        with pytest.raises(ValueError, match="2 booleans, at least one of them true"):
            together.reset(options={"reset_mask": mask})
    with pytest.raises(ValueError, match="not a valid AutoresetMode"):
        vector(2, autoreset_mode="never")


def test_states_are_copied_within_an_episode():
    env = environment()
    env.reset(seed=3)
    env.step([0.5])
    others = [copy.deepcopy(env), pickle.loads(pickle.dumps(env))]
    expected = [env.step([0.5])[0], env.reset()[0]]
    for other in others:
        np.testing.assert_array_equal([other.step([0.5])[0], other.reset()[0]], expected)


def test_rewards_are_those_of_the_results():
    env = environment(starts={}, targets={"column_psi": (0.4, 0.4)})
    env.reset(seed=1)
    observed, reward, *_, info = env.step([1.0])
    swing = env._episodes._simulation.v[0, env.crane.coordinates.index("load_phi")]
    assert reward == pytest.approx(-(((observed[0] - 0.4) / 0.5) ** 2) - swing**2 - 0.1**2, rel=1e-12)
    # The greatest rate for one step of 0.02 s, and what the crane is.
    assert info["input_slew"] == pytest.approx(0.01) and info["column_psi"] == observed[0]
    masses = set()
    for seed in range(5):
        env.reset(seed=seed)
        masses.add(float(env._episodes._simulation.parameters["load_mass"][0]))
    assert len(masses) == 5 and all(200 <= mass <= 1500 for mass in masses)
    own = environment(reward=lambda results: results["load_x"] * results["dt"])
    observed, _ = own.reset(seed=1)
    observed, reward, *_ = own.step([0.0])
    assert reward == pytest.approx(0.02 * observed[2])


def test_an_episode_ends_at_limits_and_when_it_fails():
    env = environment(limits={"column_psi": (-0.1, 0.1)}, starts={}, duration=5.0, penalty=-100.0)
    env.reset(seed=1)
    for _ in range(30):
        *_, reward, terminated, truncated, info = env.step([1.0])
        if terminated:
            break
    assert terminated and not truncated and info["why"] == "column_psi left its limits" and reward < -99
    # Terminated in its last step, it is not truncated as well.
    at_once = environment(limits={"column_psi": (-0.1, 0.1)}, starts={"slew": (0.2, 0.2)}, duration=0.02)
    at_once.reset(seed=1)
    assert at_once.step([0.0])[2:4] == (True, False)
    failing = environment(tolerance=1e-12, bands={}, starts={})
    failing.reset(seed=1)
    failing._episodes._simulation.reset([0], q=failing._episodes._simulation.q, v=np.full((1, 3), 1e9))
    *_, terminated, _, info = failing.step([0.0])
    assert terminated and info["why"]


def test_bounds_of_efforts_come_from_the_spec():
    text = STEERED.replace("effort: {input: boom}", "effort: {input: boom}, max_effort: 3e5")
    c = crane.load("steered.yaml", text=text)
    env = CraneEnv(c, actions={"boom": None}, reward=reach(["hook_theta"]), targets={"hook_theta": (0, 0)}, observations=["input_boom"])
    env.reset(seed=0)
    np.testing.assert_allclose([env.step([1.0])[0][0], env.step([-0.5])[0][0], env.step([7.0])[0][0]], [3e5, -1.5e5, 3e5])
    with pytest.raises(ValueError, match="no bounds"):
        CraneEnv(c, actions={"push": None}, reward=reach([]))


def test_what_is_refused():
    for changes, words in [
        ({"actions": {}}, "at least one input"),
        ({"actions": {"slow": (0, 1)}}, "no input 'slow': write one of slew"),
        ({"bands": {"mass": (0, 1)}}, "no live parameter 'mass': write one of load_mass"),
        ({"targets": {"tip_x": (0, 1)}}, "no result 'tip_x'"),
        ({"observations": ["colum_psi"]}, "no observation 'colum_psi'"),
        ({"limits": {"column_psi": (1, 0)}}, "write the least value first"),
    ]:
        with pytest.raises(ValueError, match=words):
            environment(**changes)
    with pytest.raises(gymnasium.error.ResetNeeded):
        environment().step([0.0])


def test_what_no_episode_could_use_is_refused_before():
    for wrong, kind, words in (
        ({"reward": None}, TypeError, "reward=None: give a function of results"),
        ({"dt": -0.1}, ValueError, "dt is -0.1: write a number above 0"),
        ({"duration": np.nan}, ValueError, "duration is nan"),
        ({"scales": {"load_x": 0.0}}, ValueError, r"scales\['load_x'\] is 0.0"),
    ):
        with pytest.raises(kind, match=words):
            environment(**wrong)
    with pytest.raises(ValueError, match="num_envs=0"):
        vector(0)
    with pytest.raises(ValueError, match="the distance of 'column_psi' that counts as 1 is 0.0: write a number above 0"):
        reach({"column_psi": 0.0})
    env = environment(reward=lambda results: np.nan)
    env.reset(seed=0)
    with pytest.raises(ValueError, match="the reward is NaN"):
        env.step([0.0])
    with pytest.raises(ValueError, match="actions hold NaN"):
        env.step([np.nan])


def test_actions_beyond_one_are_clipped():
    ends = []
    for action in (1.0, 5.0):
        env = environment()
        env.reset(seed=3)
        ends.append(env.step([action])[0])
    np.testing.assert_array_equal(*ends)


def test_a_policy_learns_to_damp_the_swing(capsys):
    """A few rounds of the example already swing less than the untrained policy."""
    policy = slewing.train(rounds=4, directions=8)
    assert capsys.readouterr().out.count("mean reward") == 4
    found = slewing.compare(policy, count=8)
    assert found["learnt"][0] > found["untrained"][0]


def test_an_episode_ends_when_the_crane_tips():
    """The margin that is asked for is that of a crane at rest with nothing that overturns it: any crane has less."""
    text = (
        "format: 1\nextends: loader_tipping\nname: tips\ninputs: {lever: {unit: rad}}\n"
        "drives: [{coordinate: boom_psi, motion: {hold: 55 deg}, offset: lever}]\n"
    )
    c = crane.load("tips.yaml", text=text)
    for tipping, ends in ((0.0, False), (1.0, True)):
        env = CraneEnv(c, actions={"lever": (-0.05, 0.05)}, rates=True, reward=reach([]), tipping=tipping)
        env.reset(seed=0)
        *_, terminated, _, info = env.step([0.0])
        assert terminated is ends and info["why"] == ("tipping" if ends else "")


def test_a_rendered_crane_moves():
    """Pictures are those of `Crane.render` in the state reached; without a render mode there are none."""
    env = environment(render_mode="rgb_array", dt=0.1)
    assert (env.metadata["render_modes"], env.metadata["render_fps"]) == (["rgb_array"], 10)
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.render()
    env.reset(seed=3)
    first = env.render()
    assert (first.shape, first.dtype) == ((480, 640, 3), np.uint8)
    np.testing.assert_array_equal(env.render(), first)
    env.step(np.ones(1))
    assert (env.render() != first).any()
    silent = environment()
    silent.reset(seed=3)
    assert silent.render() is None
    with pytest.raises(ValueError, match="no render mode 'human': write one of rgb_array"):
        environment(render_mode="human")


@pytest.mark.parametrize("given", ["one_theta", "two_theta"])
def test_what_a_rigid_coupling_ties_starts_together(given):
    """In an episode that begins where one of both coordinates is given, the other is where the coupling has it, as are their rates."""
    geared = crane.load(
        "geared.yaml",
        text="""format: 1
name: geared
inputs: {push: {value: 0, unit: N m}}
links:
  - {name: one, joint: {revolute: {axis: y}}, mass: 5, com: [0, 0, -0.5], inertia: {gyration: [0.2, 0.2, 0.2]}}
  - {name: two, placement: {transform: {translation: [0, 0, -1]}}, joint: {revolute: {axis: y}}, mass: 3, com: [0, 0, -0.4], inertia: {gyration: [0.2, 0.2, 0.2]}}
couplings: [{name: gear, coordinate: two_theta, follows: one_theta, ratio: 2, offset: 0.1, rigid: true}]
drives: [{coordinate: one_theta, effort: {input: push}}]
""",
    )
    task = {"actions": {"push": (-1, 1)}, "observations": ["one_theta", "two_theta", "one_theta_rate", "two_theta_rate"], "duration": 0.2}
    env = CraneVectorEnv(geared, 3, **task, reward=reach({}, swing=["one_theta_rate"]))
    places = np.array([0.1, 0.3, -0.2])
    observed, _ = env.reset(seed=1, options={"start": {given: places, f"{given}_rate": 0.5}})
    one, two, one_rate, two_rate = observed.T
    np.testing.assert_array_equal(one if given == "one_theta" else two, places)
    np.testing.assert_allclose([two, two_rate], [2 * one + 0.1, 2 * one_rate], rtol=0, atol=1e-15)
    for _ in range(3):
        observed, *_ = env.step(np.ones((3, 1), np.float32))
    np.testing.assert_allclose(observed[:, 1], 2 * observed[:, 0] + 0.1, rtol=0, atol=1e-15)
