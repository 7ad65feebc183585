"""Gradients of runs, against differences of runs."""

import numpy as np
import pytest

import crane

#: Duration and interval of results, s, and a tolerance at which differences of runs have eight digits.
RUN = {"duration": 2.0, "output": 0.02, "tolerance": 1e-10, "verify": False}


@pytest.fixture(scope="module")
def run():
    """A crane that swings, with its gradients."""
    return crane.load("knuckle_boom").simulate(**RUN, gradients=["payload"])


def differences(of):
    """Central difference of a function of a run by the payload: the error is of the square of the step, 1e-7."""
    c = crane.load("knuckle_boom")
    less, more = (of(c.replace(payload=800.0 + step).simulate(**RUN, method="rosw4")) for step in (-0.5, 0.5))
    return more - less


def test_columns_have_the_derivatives_of_differences(run):
    for column in ("load_centre_x", "load_centre_z", "load_centre_vx"):
        expected = differences(lambda other: other[column])
        found = run.gradient(column, "payload")
        # The payload hardly moves the crane: its effect on velocities, 2e-5 m/s per kg, is known to the tolerance over the step.
        assert np.max(np.abs(found - expected)) < 1e-5 * np.max(np.abs(expected)) + 1e-8, column
    assert run.gradients["payload"].shape == run.table.shape
    assert run.method == "rosw4"


def test_peaks_and_integrals_have_the_derivatives_of_differences(run):
    column = next(name for name in run if name.endswith("_drive_torque"))
    ways = {
        "maximum": lambda other: np.max(other[column]),
        "minimum": lambda other: np.min(other[column]),
        "peak": lambda other: np.max(np.abs(other[column])),
        "integral": lambda other: np.sum(0.5 * np.diff(other.t) * (other[column][1:] + other[column][:-1])),
    }
    for of, value in ways.items():
        # A tenth of the largest: the extreme may be where the payload hardly counts.
        size = np.max(np.abs(run.gradient(column, "payload"))) * 0.1
        assert run.gradient(column, "payload", of=of) == pytest.approx(differences(value), rel=1e-4, abs=1e-4 * size), of


def test_the_adjoint_mode_finds_the_same_by_everything(run):
    c = crane.load("knuckle_boom")
    column = next(name for name in run if name.endswith("_drive_torque"))
    asked = [f"{column}.peak", "load_centre_x.final", "load_centre_z.integral", "load_centre_z.minimum"]
    found = c.simulate(**RUN, adjoint=asked)
    assert list(found.adjoint) == asked
    starts = [f"{part}.{name}" for part in ("q0", "v0") for name in c.coordinates]
    forward = c.simulate(**RUN, gradients=["payload", *starts])
    for number in asked:
        name, of = number.split(".")
        by_all = found.adjoint[number]
        assert list(by_all) == ["payload", *starts]
        size = max(abs(forward.gradient(name, start, of=of)) for start in starts)
        for key in by_all:
            expected = forward.gradient(name, key, of=of)
            # The steps of both modes differ; columns are differenced along other directions.
            assert by_all[key] == pytest.approx(expected, rel=1e-4, abs=1e-7 * size), (number, key)
            assert found.gradient(name, key, of=of) == by_all[key]


def test_an_adjoint_run_estimates_its_errors():
    c = crane.load("knuckle_boom")
    found = c.simulate(duration=1.0, output=0.1, adjoint="load_centre_x.final")
    assert 0 < found.errors["load_centre_x"] < 1e-3
    assert found.gradient("load_centre_x", "payload", of="final") == found.adjoint["load_centre_x.final"]["payload"]
    assert c.simulate(duration=0.1, output=0.1, verify=False, adjoint="load_centre_x").gradient("load_centre_x", "payload", of="peak")


def test_steps_follow_what_is_differentiated():
    """At rest the motion itself takes long steps; the derivative by a rate of the beam vibrates."""
    c = crane.load("cantilever")
    how = {"duration": 0.05, "output": 0.05, "tolerance": 1e-8, "verify": False}
    name = "v0.beam_1_psi"
    forward = c.simulate(**how, gradients=[name]).gradient("tip_y", name, of="final")
    backward = c.simulate(**how, adjoint="tip_y.final", gradients=[name]).adjoint["tip_y.final"][name]
    # Both follow the vibration to the tolerance, in other steps.
    assert backward == pytest.approx(forward, rel=1e-3)


def test_energies_of_stiff_springs_are_differenced_to_both_sides():
    text = (
        "format: 1\nname: arm\ninputs: {lever: {value: 0.4, unit: rad}}\n"
        "links: [{name: boom, placement: {transform: {rotation: {x: 90 deg}}}, joint: revolute, mass: 200, com: [2, 0, 0], "
        "inertia: {gyration: [0.1, 1.2, 1.2]}}]\n"
        "drives: [{coordinate: boom_psi, stiffness: 2e9, damping: 2e4, motion: {input: lever}}]\n"
    )
    c = crane.load("arm.yaml", text=text)
    how = {"duration": 0.1, "tolerance": 1e-10, "verify": False, "inputs": {"lever": 0.4}}
    forward = c.simulate(**how, gradients=["inputs.lever"]).gradient("drive_energy", "inputs.lever", of="final")
    backward = c.simulate(**how, adjoint="drive_energy.final").adjoint["drive_energy.final"]["inputs.lever"]
    # Differences of 1e9 N m by 1e-7 rad leave rounding of some 1e-6 J.
    assert backward == pytest.approx(forward, rel=2e-2, abs=1e-5)


def test_a_pose_at_rest_moves_also_with_given_rates():
    c = crane.load("knuckle_boom")
    how = {"duration": 0.3, "output": 0.1, "tolerance": 1e-10, "verify": False, "v": np.zeros(c.n)}
    less, more = (c.replace(payload=payload).simulate(**how, method="rosw4")["load_centre_z"][-1] for payload in (799.5, 800.5))
    found = c.simulate(**how, gradients="payload").gradient("load_centre_z", "payload", of="final")
    assert found == pytest.approx(more - less, rel=1e-4)
    assert c.simulate(**how, adjoint="load_centre_z.final").adjoint["load_centre_z.final"]["payload"] == pytest.approx(found, rel=1e-4)


def test_a_start_may_be_given(run):
    c = crane.load("knuckle_boom")
    q = run.table[0, 1 : 1 + c.n]
    name = c.info["coordinates"][-1]["name"]
    given = c.simulate(**RUN, q=q, gradients=[f"q0.{name}", f"v0.{name}"])
    assert given.gradient(name, f"q0.{name}")[0] == 1.0
    assert given.gradient(f"{name}_rate", f"v0.{name}")[0] == 1.0


def test_what_has_no_gradient_is_refused(run):
    c = crane.load("knuckle_boom")
    for names, words in [(["mass"], "payload"), (["inputs.r"], "differentiate"), (["q0.r"], "q0.")]:
        with pytest.raises(ValueError, match=words):
            c.simulate(**RUN, gradients=names)
    with pytest.raises(ValueError, match="rosw4"):
        c.simulate(**RUN, method="bdf", gradients=["payload"])
    with pytest.raises(KeyError, match="payload"):
        run.gradient("load_centre_x", "mass")
    with pytest.raises(ValueError, match="integral"):
        run.gradient("drive_work", "payload")
    with pytest.raises(ValueError, match="maximum"):
        run.gradient("load_centre_x", "payload", of="mean")
    with pytest.raises(ValueError, match="peak, maximum"):
        c.simulate(**RUN, adjoint=["load_centre_x.mean"])
    with pytest.raises(ValueError, match="did you mean `load_centre_x`"):
        c.simulate(**RUN, adjoint=["load_center_x.peak"])
    with pytest.raises(ValueError, match="has no derivatives"):
        c.simulate(**RUN, adjoint=["drive_work.final"])
    with pytest.raises(TypeError, match="are names"):
        c.simulate(**RUN, adjoint=[("load_centre_x", "peak")])
    with pytest.raises(ValueError, match="is the time"):
        c.simulate(**RUN, adjoint=["t.final"])
    found = c.simulate(duration=0.1, verify=False, adjoint={"load_centre_x": "final"}, gradients=["payload"])
    assert list(found.adjoint) == ["load_centre_x.final"] and list(found.adjoint["load_centre_x.final"]) == ["payload"]
    with pytest.raises(KeyError, match="only of load_centre_x.final"):
        found.gradient("load_centre_x", "payload")
    with pytest.raises(ValueError, match="one by one"):
        c.replace(payload=[1.0, 2.0]).simulate(adjoint="load_centre_x.final")
