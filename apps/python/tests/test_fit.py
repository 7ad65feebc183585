"""Fits: against closed forms of least squares and of oscillators, and what they say where they cannot answer."""

import runpy
import sys

import crane
import numpy as np
import pytest
from conftest import ROOT
from crane.coloured import coefficient, score_covariance
from crane.experiments import Frequencies, Run, Statics

scipy = pytest.importorskip("scipy.interpolate")
special, scipy_linalg = pytest.importorskip("scipy.special"), pytest.importorskip("scipy.linalg")

# A disc on a driven axis, and an arm that a drive holds level: both have closed forms.
ARM = """
format: 1
name: arm
parameters:
  k: {value: 2e4, unit: N m/rad}
  d: {value: 300, unit: N m s/rad}
  inertia: {value: 40, unit: kg m2}
  bob: {value: 20, unit: kg}
  other: {value: 5, unit: kg}
  reach: {value: 1.5, unit: m}
links:
  - {name: stand}
  - {name: disc, joint: {revolute: {axis: z}}, mass: 10, com: [0, 0, 0], inertia: {Ixx: 50, Iyy: 50, Izz: inertia}}
  - name: arm
    on: {link: stand}
    joint: {revolute: {axis: y}}
    bodies:
      - {name: one, mass: bob, com: [reach, 0, 0]}
      - {name: two, mass: other, com: [reach, 0, 0]}
drives:
  - {coordinate: disc_psi, stiffness: k, damping: d, motion: {speed: {rate: 0.5}}}
  - {coordinate: arm_theta, stiffness: 1e12, damping: 1e4, motion: {hold: 0}}
"""
TORQUE = "arm_theta_drive_torque"
G = 9.81
NORMAL = 1.959964
T = np.arange(0.0, 2.0, 0.02)


@pytest.fixture(scope="module")
def arm():
    return crane.load("arm.yaml", text=ARM)


def angle(t, k, d, inertia, delay=0.0, rate=0.5):
    """The disc after its drive begins to turn: q = v t − e, I ë + d ė + k e = 0, e(0) = 0, ė(0) = v; for complex numbers, too."""
    t = np.where(t > np.real(delay), t - delay, 0.0)
    decay = d / (2 * inertia)
    omega = np.sqrt(k / inertia - decay**2)
    return rate * (t - np.exp(-decay * t) * np.sin(omega * t) / omega)


TRUE = {"k": 1.6e4, "d": 400.0, "inertia": 40.0, "delay": 0.06}
NOISE = 1e-3


def measured(seed, **others):
    return angle(T, **{**TRUE, **others}) + np.random.default_rng(seed).normal(0.0, NOISE, len(T))


def test_one_number_is_that_of_linear_least_squares(arm):
    """Torques −m g l of known masses: l and its deviation in closed form, with stated noise and with that of the residuals."""
    masses = np.array([10.0, 20.0, 40.0, 60.0])
    torques = -masses * G * 1.3 + np.array([0.4, -1.0, 0.7, -0.2])
    weights = -masses * G
    reach = weights @ torques / (weights @ weights)
    here = {"bob": masses, "other": 1e-6}
    stated = crane.fit(arm, ["reach"], Statics({TORQUE: torques}, noise=0.8, parameters=here))
    # To what the drive gives way, 1e-9, the stray mass, 1e-7, and the search.
    assert stated["reach"] == pytest.approx(reach, rel=1e-6)
    assert stated.deviations[0] == pytest.approx(0.8 / np.sqrt(weights @ weights), rel=1e-5)
    np.testing.assert_allclose(stated.interval("reach"), reach + np.array([-1, 1]) * NORMAL * stated.deviations[0], rtol=1e-6)
    square = np.sum((torques - weights * reach) ** 2)
    assert stated.chi2 == pytest.approx(square / 0.8**2 / 3, rel=1e-5) and stated.status == "converged"
    estimated = crane.fit(arm, ["reach"], Statics({TORQUE: torques}, parameters=here))
    deviation = np.sqrt(square / 3 / (weights @ weights))
    assert estimated.deviations[0] == pytest.approx(deviation, rel=1e-5)
    # Student's t of three degrees of freedom.
    np.testing.assert_allclose(np.diff(estimated.interval("reach")), 2 * 3.182446 * deviation, rtol=1e-5)
    # Where residuals exceed the stated noise they count, as if it had not been stated.
    small = crane.fit(arm, ["reach"], Statics({TORQUE: torques}, noise=0.08, parameters=here))
    assert small.status == "misfit" and small.deviations[0] == pytest.approx(deviation, rel=1e-5)
    assert small.interval("reach") == pytest.approx(estimated.interval("reach"), rel=1e-6)
    # A number that is hardly known at the start moves all the same.
    weak = crane.fit(arm, ["reach"], Statics({TORQUE: -4000.0}, noise=800.0))
    assert weak["reach"] == pytest.approx(4000.0 / (25.0 * G), rel=1e-5) and weak.status == "converged"
    assert not estimated.series[0].noise_stated and estimated.crane.parameters["reach"] == estimated["reach"]


def test_frequencies_by_order_and_by_name(arm):
    """ω² = k/I: k from one frequency with the deviation 2 k σ/f, whichever mode it is."""
    frequency = np.sqrt(1.7e4 / 40) / (2 * np.pi)
    for values in ([frequency], {"disc_psi": frequency}, {"frequency_1": frequency}):
        found = crane.fit(arm, ["k"], Frequencies(values, noise=0.01))
        assert found["k"] == pytest.approx(1.7e4, rel=1e-8)
        assert found.deviations[0] == pytest.approx(2 * 1.7e4 * 0.01 / frequency, rel=1e-6)
        assert found.degrees == 0 and "nothing shows whether the model is right" in str(found)
    # The second mode: m l² is the inertia of the arm.
    second = np.sqrt(1e12 / (25.0 * 1.4**2)) / (2 * np.pi)
    for values in ([None, second], {"arm_theta": second}):
        assert crane.fit(arm, ["reach"], Frequencies(values, noise=1.0))["reach"] == pytest.approx(1.4, rel=1e-6)


def test_a_run_finds_what_a_closed_form_was_made_with(arm):
    """Without noise: to the errors of runs of tolerance 1e-8, and of splines through results every 10 ms."""
    experiment = Run(T, {"disc_psi": angle(T, **TRUE)}, noise=NOISE, parameters={"inertia": 40.0}, dead_time="delay")
    found = crane.fit(arm, {"k": None, "d": None, "delay": (0, 0.2)}, experiment)
    for name in ("k", "d", "delay"):
        assert found[name] == pytest.approx(TRUE[name], rel=3e-4)
    assert any("only" in caution and "stated noise" in caution for caution in found.cautions)


def test_derivatives_of_runs_and_dead_times_are_those_of_the_closed_form(arm):
    """By complex steps, which have no error; the acceleration jumps at the end of the dead time, where splines err by 1e-3 of the largest derivative."""
    names = ["k", "d", "delay"]
    model = Run(T, {"disc_psi": 0 * T}, parameters={"inertia": 40.0}, dead_time="delay").model_of(arm, names)
    steps = {name: 3e-4 * TRUE[name] for name in names}
    slopes = model.derivatives({name: TRUE[name] for name in names}, names, steps)
    for place, name in enumerate(names):
        exact = np.imag(angle(T, **{**TRUE, name: TRUE[name] + 1e-20j * TRUE[name]})) / (1e-20 * TRUE[name])
        np.testing.assert_allclose(slopes[:, place], exact, atol=2e-3 * np.abs(exact).max())


def test_gradients_of_runs_are_their_differences(arm):
    """Differences to one side over 3e-4 of a number err by about as much."""
    names, numbers = ["k", "d"], {name: TRUE[name] for name in ("k", "d", "delay")}
    model = Run(T, {"disc_psi": 0 * T}, parameters={"inertia": 40.0}, dead_time="delay").model_of(arm, [*names, "delay"])
    found = model._gradients(numbers, names)
    differences = model._differences(numbers, names, {name: 3e-4 * TRUE[name] for name in names})
    np.testing.assert_allclose(found / np.abs(differences).max(axis=0), differences / np.abs(differences).max(axis=0), atol=1e-3)
    # Another method, or rates with the pose at rest, whose derivatives a given start does not have.
    for given in ({"method": "bdf"}, {"v": np.zeros(arm.n)}):
        other = Run(T, {"disc_psi": 0 * T}, parameters={"inertia": 40.0}, **given).model_of(arm, names)
        assert other._gradients(numbers, names) is None
        assert other.derivatives(numbers, names, {name: 3e-4 * TRUE[name] for name in names}).shape == (len(T), 2)


def test_intervals_hold_what_they_promise(arm):
    """Of 25 repetitions about 24 contain the true number; fewer than 20 have a probability of 1 in 800."""
    inside = np.zeros(3)
    names = ["k", "d", "delay"]
    for seed in range(25):
        experiment = Run(T, {"disc_psi": measured(seed)}, parameters={"inertia": 40.0}, dead_time="delay")
        found = crane.fit(arm, {"k": None, "d": None, "delay": (0, 0.2)}, experiment)
        assert found.status == "converged", found.cautions
        inside += [found.interval(name)[0] <= TRUE[name] <= found.interval(name)[1] for name in names]
    assert np.all(inside >= 20), inside
    # Not because they are wide.
    assert np.all(found.quantile * found.deviations < 0.1 * found.estimates)


def coloured(count, rho, seed):
    """Noise of standard deviation 1, each value ρ times the one before and something new."""
    random = np.random.default_rng(seed)
    new = np.sqrt(1 - rho**2) * random.normal(size=count)
    noise = [random.normal()]
    for value in new[1:]:
        noise.append(rho * noise[-1] + value)
    return np.array(noise)


def test_intervals_hold_with_coloured_noise():
    """Least squares of a constant and an oscillation, 300 values, 400 repetitions: 95 % of the intervals hold, to 2.5 standard deviations of such a
    share, 0.027, and 0.01 for what 300 values leave open. As if noise were white, 40 % of them do."""
    count, rho = 300, 0.9
    t = np.linspace(0, 6, count)
    jacobian = np.stack([np.ones(count), np.exp(-0.3 * t) * np.sin(4 * t)], axis=1)
    inverse = np.linalg.inv(jacobian.T @ jacobian)
    inside, white, scores = [], [], []
    for seed in range(400):
        noise = coloured(count, rho, seed)
        found = inverse @ jacobian.T @ noise
        residuals = noise - jacobian @ found
        follows = residuals[1:] @ residuals[:-1] / (residuals @ residuals)
        estimate = coefficient(follows, count, 2, count)
        scores.append(score_covariance(jacobian, residuals, estimate))
        deviations = np.sqrt(np.diag(inverse @ scores[-1] @ inverse))
        quantile = special.stdtrit(count * (1 - estimate) / (1 + estimate), 0.975)
        inside.append(np.abs(found) < quantile * deviations)
        white.append(np.abs(found) < NORMAL * np.sqrt(np.diag(inverse)))
    assert np.all(np.abs(np.mean(inside, axis=0) - 0.95) < 0.037), np.mean(inside, axis=0)
    assert np.all(np.mean(white, axis=0) < 0.5)
    # What is estimated is Jᵀ Γ J with the covariances Γ of the noise, in the middle of the repetitions to a tenth: 16 independent values know it no better.
    exact = jacobian.T @ scipy_linalg.toeplitz(rho ** np.arange(count)) @ jacobian
    np.testing.assert_allclose(np.diag(np.median(scores, axis=0)), np.diag(exact), rtol=0.1)


def test_coloured_noise_is_said_and_widens_intervals(arm):
    """With stated noise of the right size: before, `converged`, with intervals that miss by up to ten deviations. Of 12 repetitions about 11 contain the
    true number; fewer than 9 have a probability of 1 in 400."""
    inside = np.zeros(3)
    names = ["k", "d", "delay"]
    for seed in range(12):
        noisy = angle(T, **TRUE) + NOISE * coloured(len(T), 0.9, seed)
        experiment = Run(T, {"disc_psi": noisy}, noise=NOISE, parameters={"inertia": 40.0}, dead_time="delay")
        found = crane.fit(arm.replace(k=1.6e4, d=400.0), {"k": None, "d": None, "delay": (0, 0.2)}, experiment)
        inside += [found.interval(name)[0] <= TRUE[name] <= found.interval(name)[1] for name in names]
        # It is said whether the noise is mostly coloured, 0.7, or partly: of 100 values the correlation is not known better.
        assert (found.status == "misfit") == (found.series[0].follows > 0.7)
        assert any("follow each other" in caution and "100 values are worth about" in caution for caution in found.cautions)
        assert found.independent < 0.3 * found.degrees
    assert np.all(inside >= 9), inside
    # Several series: the one that is white counts as before, and the other less.
    both = {"disc_psi": angle(T, **TRUE) + NOISE * coloured(len(T), 0.9, 1), "disc_psi_rate": rate(T) + 0.01 * coloured(len(T), 0.0, 2)}
    runs = Run(T, both, noise={"disc_psi": NOISE, "disc_psi_rate": 0.01}, parameters={"inertia": 40.0}, dead_time=TRUE["delay"])
    found = crane.fit(arm.replace(k=1.6e4, d=400.0), ["k", "d"], runs)
    assert sum("follow each other" in caution for caution in found.cautions) == 1
    assert len(T) < found.independent < 1.3 * len(T)


def rate(t):
    """The rate of the disc, by complex steps."""
    return np.imag(angle(t + 1e-20j, **TRUE)) / 1e-20


HOOK = """
format: 1
extends: knuckle_boom
name: hook
parameters:
  d_hook: {value: 40, unit: N m s/rad}
  k_main: {value: 4e6, unit: N m/rad}
  d_main: {value: 6e4, unit: N m s/rad}
damping: {hook_theta: d_hook}
drives:
  - {coordinate: main_boom_theta, stiffness: k_main, damping: d_main}
"""


def test_four_numbers_of_a_noisy_run_with_defaults():
    """With SciPy's own differences such a fit ends at 143 instead of 55 and calls this converged."""
    start = crane.load("hook.yaml", text=HOOK)
    true = {"d_hook": 55.0, "k_main": 3e6, "d_main": 4e4, "payload": 620.0}
    run = start.replace(**true).simulate(duration=6, output=0.02, tolerance=1e-9, verify=False)
    rng = np.random.default_rng(1)
    deviations = {"hook_theta": 1e-3, "main_boom_theta": 2e-4, "main_boom_theta_drive_torque": 300.0}
    columns = {name: run[name] + rng.normal(0.0, deviation, len(run.t)) for name, deviation in deviations.items()}
    found = crane.fit(start, list(true), Run(run.t, columns))
    assert found.status == "converged" and not found.cautions
    low, high = found.interval("d_hook")
    assert low <= 55 <= high and high - low < 0.3 * 55, found
    # Of four numbers one is outside its 95 % interval in a fifth of all fits; none is beyond three deviations but in one of a hundred.
    assert np.all(np.abs(found.estimates - list(true.values())) < 3 * found.deviations), found
    # Noise that was not stated is that of the residuals, 303 values each: to 4 %, three times that.
    for one in found.series:
        assert one.noise[0] == pytest.approx(deviations[one.column], rel=0.12) and not one.noise_stated


@pytest.mark.parametrize(
    ("numbers", "experiment", "words"),
    [
        (["bob", "reach"], Statics({TORQUE: -400.0}, noise=1.0, parameters={"other": 1e-6}), "their product bob · reach"),
        (["bob", "other"], Statics({TORQUE: -400.0}, noise=1.0), "their sum bob + other"),
        (["k", "inertia"], Frequencies({"disc_psi": 3.0}, noise=0.01), "their ratio k/inertia"),
        (["k", "d", "inertia"], Run(T, {"disc_psi": angle(T, 1.6e4, 400.0, 40.0)}, noise=NOISE), "only as their ratios"),
        (["reach"], Statics({TORQUE: -400.0}, noise=800.0), "reach not at all"),
        (["k", "reach"], Statics({TORQUE: -400.0}, noise=1.0), "k not at all"),
    ],
)
def test_what_cannot_be_told_apart_is_said(arm, numbers, experiment, words):
    found = crane.fit(arm.replace(k=1.5e4), numbers, experiment)
    assert found.status == "not identifiable" and len(found.indistinct) == 1
    assert words in found.indistinct[0] and words in str(found)
    with pytest.raises(ValueError, match="cannot be drawn"):
        found.confidence(lambda c: c.n)


def test_what_is_known_of_numbers_that_are_not(arm):
    """The product is known, and with it the torque of another payload is not, but that of the same one is."""
    found = crane.fit(arm, ["bob", "reach"], Statics({TORQUE: -400.0}, noise=1.0, parameters={"other": 1e-6}))
    assert found.interval("bob")[1] == np.inf
    same = found.confidence(TORQUE, other=1e-6)
    assert same.value == pytest.approx(-400.0, rel=1e-5) and same.high - same.value == pytest.approx(NORMAL, rel=1e-3)
    assert np.isinf(found.confidence(TORQUE, other=100.0).high)


def test_a_wrong_model_and_an_outlier_are_said(arm):
    numbers = {"k": None, "d": None, "delay": (0, 0.2)}
    wrong = Run(T, {"disc_psi": measured(1)}, noise=NOISE, parameters={"inertia": 80.0}, dead_time=0.0)
    found = crane.fit(arm, ["d"], wrong)
    assert found.status == "misfit" and found.chi2 > 10 and "times the stated noise" in str(found)
    # Without a stated noise, residuals that follow each other tell.
    silent = crane.fit(arm, ["k"], Run(T, {"disc_psi": measured(1)}, parameters={"d": 50.0}, dead_time=0.0))
    assert silent.status == "misfit" and any("follow each other" in caution for caution in silent.cautions)
    spoilt = measured(1)
    spoilt[40] += 0.05
    found = crane.fit(arm, numbers, Run(T, {"disc_psi": spoilt}, noise=NOISE, parameters={"inertia": 40.0}, dead_time="delay"))
    assert found.status == "misfit" and found.chi2 > 10
    assert any("at 0.8 s" in caution and "outlier" in caution for caution in found.cautions)


def test_a_bound_and_an_early_end_are_said(arm):
    experiment = Run(T, {"disc_psi": measured(1)}, noise=NOISE, parameters={"inertia": 40.0}, dead_time=0.06)
    found = crane.fit(arm, {"k": (1.8e4, None), "d": None}, experiment)
    assert found.at_bound == ("k",) and found["k"] == pytest.approx(1.8e4, rel=1e-3) and np.isnan(found.deviations[0])
    assert "k ended at a bound" in str(found) and found.status == "at a bound"
    early = crane.fit(arm.replace(k=5e4), ["k", "d"], experiment, evaluations=2)
    assert early.status == "not converged" and "another step would move the numbers" in early.cautions[0]


def test_several_starts_find_the_lower_minimum(arm):
    """From half a turn out of phase the first minimum is a wrong one."""
    experiment = Run(T, {"disc_psi": angle(T, 1.6e4, 40.0, 40.0)}, noise=1e-4, parameters={"inertia": 40.0, "d": 40.0})
    far = crane.fit(arm.replace(k=6e4), {"k": (1e3, 1e5)}, experiment)
    assert far["k"] == pytest.approx(6e4, rel=0.5) and far.status == "misfit"
    found = crane.fit(arm.replace(k=6e4), {"k": (1e3, 1e5)}, experiment, starts=4, evaluations=40)
    assert found["k"] == pytest.approx(1.6e4, rel=1e-4) and any("starts ended here" in caution for caution in found.cautions)


def test_several_experiments_with_conditions_of_their_own(arm):
    """Frequencies with two known discs, a torque, and a change of a torque by a known mass."""
    frequency = [np.sqrt(1.7e4 / inertia) / (2 * np.pi) for inertia in (30.0, 60.0)]
    found = crane.fit(
        arm,
        ["k", "reach", "bob"],
        [
            *(Frequencies([value], noise=0.01, parameters={"inertia": inertia}) for value, inertia in zip(frequency, (30.0, 60.0), strict=True)),
            Statics({TORQUE: -G * 1.4 * 25.0}, noise=1.0, parameters={"other": 1e-6}),
            Statics({TORQUE: -G * 1.4 * 50.0}, noise=1.0, parameters={"other": 60.0}, reference={"other": 10.0}, name="change"),
        ],
    )
    assert found["k"] == pytest.approx(1.7e4, rel=1e-6)
    assert found["reach"] == pytest.approx(1.4, rel=1e-6) and found["bob"] == pytest.approx(25.0, rel=1e-5)
    assert [one.experiment for one in found.series] == ["frequencies 1", "frequencies 2", "statics", "change"]
    # A change of 50 kg: the deviation of the reach is σ/(m g).
    assert found.deviations[1] == pytest.approx(1.0 / (50.0 * G), rel=1e-4)
    # The torque alone knows the product: bob has the deviations 1/(1.4 g) and, by the reach, 25/(1.4 · 50 g).
    assert found.correlations[1, 2] == pytest.approx(-1 / np.sqrt(5), rel=1e-3) and np.isnan(found.correlations).sum() == 0


STEERED = """
format: 1
extends: arm
name: steered
inputs: {lever: {value: 0, unit: rad}}
drives:
  - {coordinate: disc_psi, motion: {input: lever}}
"""


def test_inputs_over_time_are_splines(arm, tmp_path, monkeypatch):
    """Measured positions of the drive as an input: the run is that of the same table in a spec."""
    (tmp_path / "arm.yaml").write_text(ARM)
    monkeypatch.chdir(tmp_path)
    steered = crane.load("steered.yaml", text=STEERED.replace("extends: arm", "extends: arm.yaml"))
    times = np.linspace(0.0, 2.0, 41)
    values = 0.2 * np.sin(3 * times) ** 2
    table = f"{{table: {{times: {times.tolist()}, values: {values.tolist()}, shape: spline}}}}"
    same = crane.load("same.yaml", text=STEERED.replace("extends: arm", "extends: arm.yaml").replace("{value: 0, unit", f"{{motion: {table}, unit"))
    run = same.replace(k=1.6e4, d=400.0).simulate(duration=2, output=0.02, tolerance=1e-8, verify=False)
    spline = scipy.CubicSpline(times, values, bc_type="clamped")
    for given in ((times, values), spline(run.t)):
        experiment = Run(run.t, {"disc_psi": run["disc_psi"]}, noise=1e-3, inputs={"lever": given})
        found = crane.fit(steered, ["k", "d"], experiment)
        exact = isinstance(given, tuple)
        assert found["k"] == pytest.approx(1.6e4, rel=1e-6 if exact else 1e-3)
    fixed = crane.fit(steered, ["k"], Statics({"disc_psi_drive_torque": 0.0}, noise=1.0, inputs={"lever": 0.3}))
    assert fixed.status == "not identifiable"


def test_bands_of_numbers_that_are_computed(arm):
    """g l σ/√… in closed form, by derivatives and by draws: 400 of them give a deviation to 4 %, an interval to 10 %."""
    masses = np.array([10.0, 20.0, 40.0, 60.0])
    found = crane.fit(arm, ["reach"], Statics({TORQUE: -masses * G * 1.3}, noise=0.8, parameters={"bob": masses, "other": 1e-6}))
    deviation = 0.8 / np.linalg.norm(masses * G)
    torque = found.confidence(TORQUE, bob=100.0, other=1e-6)
    assert torque.high - torque.value == pytest.approx(NORMAL * 100.0 * G * deviation, rel=1e-4)
    with pytest.raises(ValueError, match="draws=0: write how many"):
        found.confidence(lambda c: c.n, draws=0)
    drawn = found.confidence(lambda c: c.statics().drive_efforts[1], draws=400, bob=100.0, other=1e-6)
    assert drawn.high - drawn.low == pytest.approx(torque.high - torque.low, rel=0.15)
    assert drawn.value == pytest.approx(torque.value, rel=1e-9) and drawn.draws.shape == (400,)
    chart = found.confidence(lambda c: [c.parameters["reach"], 2 * c.parameters["reach"]], draws=20)
    np.testing.assert_allclose(chart.low[1], 2 * chart.low[0])


def test_the_table_has_units_and_says_what_was_measured(arm):
    experiment = Run(T, {"disc_psi": measured(3)}, parameters={"inertia": 40.0}, dead_time="delay")
    found = crane.fit(arm, {"k": None, "d": None, "delay": (0, 0.2)}, experiment)
    text = str(found)
    assert "N m/rad" in text and "run: disc_psi" in text and "estimated" in text and "noise estimated from the residuals, 97 degrees" in text
    assert repr(found).startswith("<fit of arm: converged; k=") and dict(found).keys() == {"k", "d", "delay"} and found.converged
    assert found.series[0].unit == "rad" and len(found.series[0].residuals) == len(T)


def test_the_page_shows_all_that_is_printed(arm):
    """Well-formed, without requests and scripts; every number and caution, a dot for every value and residual; names cannot be markup."""
    from xml.etree import ElementTree

    hostile = crane.load("arm.yaml", text=ARM.replace("unit: N m s/rad", "unit: '<b>&'"))
    spoilt = measured(1)
    spoilt[40] += 0.05
    run = Run(T, {"disc_psi": spoilt}, noise=NOISE, parameters={"inertia": 40.0}, dead_time="delay", name="<script>")
    found = crane.fit(hostile, {"k": None, "d": None, "delay": (0, 0.2)}, [run, Frequencies([3.2], noise=0.1)])
    page = found.page()
    body = page[page.index("<body>") : page.index("</body>") + 7]
    tree = ElementTree.fromstring(body)
    text = " ".join(" ".join(tree.itertext()).split())
    numbers, values, words = found.tables()
    for cell in [cell for row in numbers + values for cell in row] + words + found.cautions:
        assert " ".join(cell.split()) in text
    assert len(tree.findall(".//circle")) == 2 * len(T) and "<script" not in page and "http" not in page.replace("http-equiv", "")
    assert "default-src 'none'" in page and "iframe" in found._repr_html_()


@pytest.mark.parametrize(
    ("numbers", "experiment", "message"),
    [
        (["nothing"], Statics({TORQUE: 1.0}), "no live parameter 'nothing'.*write one of k, d, inertia"),
        ({"k": (3e4, 4e4)}, Statics({TORQUE: 1.0}), "k begins at 20000, outside its bounds"),
        ({"k": (2, 1)}, Statics({TORQUE: 1.0}), "do not increase"),
        ({"k": 3}, Statics({TORQUE: 1.0}), r"write \(minimum, maximum\)"),
        (["k"], [], "no experiments"),
        ([], Statics({TORQUE: 1.0}), "no numbers"),
        (["k"], Statics({"torque": 1.0}), "no output 'torque' at rest"),
        (["k"], Statics({TORQUE: [1.0, 2.0]}), "there are 1 rows"),
        (["k"], Statics({TORQUE: 1.0}, noise=0.0), "above 0"),
        (["k"], Statics({TORQUE: 1.0}, noise={"torque": 1.0}), "not among what was measured"),
        (["k"], Statics({TORQUE: 1.0}), "noise cannot be estimated"),
        (["k"], Frequencies({"stand_psi": 1.0}), "no output 'stand_psi'"),
        (["k"], Run(T, {"disc": T}), "no column 'disc'; did you mean disc_psi"),
        (["k"], Run(T, {"disc_psi": T[1:]}), "one value for each time"),
        (["k"], Run(T[::-1], {"disc_psi": T}), "times from 0 on that increase"),
        (["k"], Run(T, {"disc_psi": T}, dead_time="late"), "'late' is not among the numbers to fit"),
        (["k"], Run(T, {"disc_psi": T}, inputs={"lever": T}), "no input 'lever'"),
        (["k"], Run(T, {"disc_psi": T}, parameters={"kk": 1.0}), "run: .*kk"),
    ],
)
def test_mistakes_are_refused(arm, numbers, experiment, message):
    with pytest.raises((ValueError, KeyError, TypeError), match=message):
        crane.fit(arm, numbers, experiment)


def test_without_scipy_it_says_what_to_install(arm, monkeypatch):
    monkeypatch.setitem(sys.modules, "scipy", None)
    with pytest.raises(ImportError, match=r"pip install 'crane\[fit\]'"):
        crane.fit(arm, ["k"], Statics({TORQUE: 1.0}))


def test_velocity_steps_of_a_real_crane(capsys, tmp_path, monkeypatch):
    """The example of the manual, for the slewing column: with 127 ms of dead time the shipped stiffness is confirmed, within the spread."""
    pytest.importorskip("matplotlib")
    out = tmp_path / "steps.svg"
    monkeypatch.setattr(sys, "argv", ["velocity_steps.py", "--axes", "slew", "--starts", "1", "--out", str(out)])
    names = runpy.run_path(str(ROOT / "examples/python/velocity_steps.py"), run_name="__main__")
    said = capsys.readouterr().out
    assert "slew         0.45     1.423" in said and out.read_text().count("<path") > 10
    axis = names["MEASURED"]["slew"]
    # The crane of the example is the shipped one: its drives, in other places.
    shipped = crane.load("eight_link_identified")
    q = shipped.statics().q
    index = shipped.coordinates.index("column_psi")
    moved = q.copy()
    moved[index] += 1e-3
    stiffness = names["DRIVES"]["column_psi"][0]
    change = shipped.drive_forces(moved, 0 * q, 0.0)[index] - shipped.drive_forces(q, 0 * q, 0.0)[index]
    assert change == pytest.approx(-1e-3 * stiffness, rel=1e-6)
    assert axis["edges"] == 8 and "Geryyy/crane_model" in (ROOT / "examples/python/velocity_steps.json").read_text()


def test_drives_found_again():
    """The study of the manual: at the true numbers the residuals are the noise, 10,000 values of it, and nothing is hidden."""
    names = runpy.run_path(str(ROOT / "examples/python/found_again.py"))
    exact = names["crane_with_live_drives"]()
    run = exact.simulate(duration=20, output=0.002, tolerance=1e-9, verify=False)
    columns, noise, late = names["measure"](run, np.random.default_rng(1))
    dead_time = dict.fromkeys(columns, names["DEAD_TIME"])
    found = crane.fit(exact, {"f_grapple": (0, None), "k_column": None}, Run(names["T"], columns, noise=noise, dead_time=dead_time, output=0.02))
    assert found.status == "converged" and found.chi2 == pytest.approx(1.0, abs=0.05) and set(late) == set(columns)
    for name, value in (("f_grapple", 20.0), ("k_column", 3.19e5)):
        assert abs(found[name] - value) < 3 * found.deviations[found.names.index(name)]
