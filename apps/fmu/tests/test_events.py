"""Events in model exchange: times at which a load or a winch jumps, and states at which a contact begins or ends."""

import ctypes

import numpy as np
import pytest
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi2 import FMU2Model
from fmpy.fmi3 import FMU3Model
from fmpy.validation import validate_fmu

VERSIONS = ["2.0", "3.0"]
# A damped pendulum at rest that is struck for 20 ms after 10 s: long after a solver takes long steps.
STRUCK = """
format: 1
name: struck
links:
  - {name: rod, joint: {revolute: {axis: y}}, mass: 2, com: [0, 0, -1.5], inertia: {Ixx: 0.001, Iyy: 0.05, Izz: 0.05}}
damping: {rod_theta: 20}
loads: [{name: blow, link: rod, at: [0, 0, -1.5], force: [100, 0, 0], scale: {table: {times: [10, 10.01, 10.02], values: [0, 1, 0]}}}]
points: [{name: end, link: rod, at: [0, 0, -1.5]}]
run: {duration: 20, output: 0.1}
"""
# A block on a rail with an end stop at 0.1 m and a rope of 0.3 m to a point on the other side; and a winch that hauls from 1 to 3 s.
SLIDE = """
format: 1
name: slide
gravity: [0, 0, 0]
analyses: [dynamics]
links: [{name: slide, joint: {prismatic: {axis: x}}, mass: 4, com: [0, 0, 0]}]
stops: {slide_x: {max: 0.1, stiffness: 4e3}}
connectors:
  - {name: line, from: {at: [0.2, 0, 0]}, to: {link: slide, at: [0, 0, 0]}, law: {rope: {stiffness: 1e3, length: 0.3}}}
  - {name: haul, from: {at: [-9, 0, 0]}, to: {link: slide, at: [0, 0, 0]}, law: {rope: {stiffness: 1e-3, motion: {quintic: {from: 20, to: 19, begin: 1, duration: 2}}}}}
run: {duration: 2, output: 0.1}
"""


@pytest.fixture(scope="session")
def unit_of(export, tmp_path_factory):
    """The unit of a text, in one version."""
    folder = tmp_path_factory.mktemp("events")

    def make(name, text, version):
        file = folder / f"{name}.yaml"
        file.write_text(text)
        return str(file), export(str(file), "--fmi", version, name=f"{name}-{version}")

    return make


@pytest.fixture
def model(tmp_path):
    """Opens units for model exchange, initialised, with the next time event, s, or None."""
    opened = []

    def make(file, version):
        description = read_model_description(file)
        kind = FMU2Model if version == "2.0" else FMU3Model
        token = description.guid if version == "2.0" else description.instantiationToken
        folder = extract(file, str(tmp_path / f"model{len(opened)}"))
        unit = kind(guid=token, unzipDirectory=folder, modelIdentifier=description.modelExchange.modelIdentifier, instanceName="crane")
        opened.append(unit)
        unit.instantiate()
        if version == "2.0":
            unit.setupExperiment()
        unit.enterInitializationMode()
        unit.exitInitializationMode()
        unit.count = description.numberOfEventIndicators
        return unit

    yield make
    for unit in opened:
        unit.terminate()
        unit.freeInstance()


def next_event(unit, version):
    *_, is_defined, time = unit.newDiscreteStates() if version == "2.0" else unit.updateDiscreteStates()
    return time if is_defined else None


@pytest.mark.parametrize("version", VERSIONS)
def test_a_short_blow_is_not_stepped_over(version, unit_of, simulate):
    spec, file = unit_of("struck", STRUCK, version)
    result = simulate_fmu(file, fmi_type="ModelExchange", stop_time=20, output_interval=0.1, relative_tolerance=1e-9, output=["rod_theta"])
    # The spline's two halves are 3s² − 2s³: its area is half of its width. A blow of 1 N s on 1.5 m turns the rod, which the damper
    # and gravity, much slower than the blow, then bring back: θ̈ = −(d θ̇ + m g l θ)/J.
    inertia = 0.05 + 2 * 1.5**2
    rate = 100 * 0.5 * 0.02 * 1.5 / inertia
    roots = np.roots([inertia, 20, 2 * 9.81 * 1.5])
    peak = np.log(roots[1] / roots[0]) / (roots[0] - roots[1])
    swing = abs(rate / (roots[0] - roots[1]) * (np.exp(roots[0] * peak) - np.exp(roots[1] * peak)))
    # The blow is as if struck at its middle, to (20 ms/1 s)²; sin θ is θ to 1e-3; output every 0.1 s meets the peak to 1e-2.
    assert abs(np.abs(result["rod_theta"]).max() / swing - 1) < 0.02
    own = simulate(spec, "--tolerance", "1e-9", "--output", "0.1")
    time, rows = np.unique(result["time"].round(9), return_index=True)
    rows = rows[np.isin(time, own["t"].round(9))]
    assert np.abs(result["rod_theta"][rows] - own["rod_theta"]).max() < 1e-6


@pytest.mark.parametrize("version", VERSIONS)
def test_times_of_loads_and_winches_are_time_events(version, unit_of, model):
    unit = model(unit_of("struck", STRUCK, version)[1], version)
    times = [next_event(unit, version)]
    for time in (9.0, 10.0, 10.015, 10.02):
        unit.setTime(time)
        times.append(next_event(unit, version))
    assert times[:3] == [10, 10, 10.01] and times[3:] == [10.02, None]
    unit = model(unit_of("slide", SLIDE, version)[1], version)
    assert next_event(unit, version) == 1.0
    unit.setTime(1.5)
    assert next_event(unit, version) == 3.0


@pytest.mark.parametrize("version", VERSIONS)
def test_indicators_change_their_sign_where_contacts_begin(version, unit_of, model):
    file = unit_of("slide", SLIDE, version)[1]
    assert validate_fmu(file) == []
    unit = model(file, version)
    assert unit.count == 3
    found = {}
    for x in (0.0, 0.099, 0.101, -0.099, -0.101):
        unit.setContinuousStates((ctypes.c_double * 2)(x, 0.0), 2)
        indicators = (ctypes.c_double * 3)()
        unit.getEventIndicators(indicators, 3)
        found[x] = [number > 0 for number in indicators]
    # The stop, the line, and the haul line, which is slack.
    assert found == {
        0.0: [True, True, True],
        0.099: [True, True, True],
        0.101: [False, True, True],
        -0.099: [True, True, True],
        -0.101: [True, False, True],
    }


@pytest.mark.parametrize("version", VERSIONS)
def test_a_foot_that_lifts_is_an_event(version, export, simulate):
    """The solver stops where the foot leaves the ground, and follows the command's motion."""
    file = export("loader_tipping", "--fmi", version, name=f"events-{version}")
    assert read_model_description(file).numberOfEventIndicators == 4
    own = simulate("loader_tipping", "--tolerance", "1e-9", "--output", "0.1", "--duration", "7")
    gap = "rear_right_contact_indicator"
    names = ["hook_theta", "sling_phi", "truck_z", gap]
    names = [name for name in names if name in own or name == gap]
    options = {"fmi_type": "ModelExchange", "stop_time": 7, "output_interval": 0.1, "relative_tolerance": 1e-9}
    result = simulate_fmu(file, output=names, **options)
    # At the event itself the gap may be exactly zero.
    lifts = np.flatnonzero((result[gap][:-1] <= 0) & (result[gap][1:] > 0))
    assert len(lifts) >= 1
    # An event is recorded twice, before and after; there the gap is zero, to the solver's tolerance of a time and the speed of the foot.
    between = ~np.isclose(result["time"] * 10, np.round(result["time"] * 10), atol=1e-6)
    assert between.any() and np.abs(result[gap][between]).min() < 1e-9
    time, rows = np.unique(result["time"].round(9), return_index=True)
    rows = rows[np.isin(time, own["t"].round(9))]
    assert len(names) > 2
    for name in names[:-1]:
        # Both are set to 1e-9 a step.
        assert np.abs(result[name][rows] - own[name]).max() < 1e-6, name


# A hook that is lowered on its spring and damper loses its load as it passes −0.5 m, and catches another that flies upward.
LIFT = """
format: 1
name: lift
parameters: {load: {value: 590, unit: kg}}
links: [{name: hook, joint: {prismatic: {axis: z}}, mass: load, com: [0, 0, 0]}]
drives: [{coordinate: hook_z, stiffness: 5e4, damping: 800, motion: {speed: {rate: -0.4}}}]
points: [{name: hook_point, link: hook}]
events:
- {name: drop, when: {result: hook_z, below: -0.5}, set: {load: 90}}
- {name: catch, at: 1.505, set: {load: 300}, joins: {velocity: [0, 0, 0.8], point: hook_point}}
run: {duration: 2, output: 0.01}
"""


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("kind", ["CoSimulation", "ModelExchange"])
def test_units_have_the_events_of_a_run(version, kind, unit_of, simulate):
    spec, file = unit_of("lift", LIFT, version)
    assert validate_fmu(file) == []
    names = ["hook_z", "hook_z_rate", "load", "drop_time"]
    result = simulate_fmu(file, fmi_type=kind, stop_time=2, output_interval=0.01, relative_tolerance=1e-9, step_size=0.01, output=names)
    own = simulate(spec, "--tolerance", "1e-9")
    # At an event there are rows before and after it: the last of a time is that after.
    time, rows = np.unique(result["time"][::-1].round(9), return_index=True)
    result = result[::-1][rows]
    for t, q, v, drop in zip(own["t"], own["hook_z"], own["hook_z_rate"], own["drop_time"], strict=True):
        if abs(t - own["drop_time"][-1]) < 0.006:
            continue
        (row,) = np.flatnonzero(np.abs(time - t) < 1e-9)[:1]
        # The importer finds when the hook passes to its tolerance; its own solver is at 1e-9 of rates of 1 m/s.
        assert abs(result["hook_z"][row] - q) < 2e-5 and abs(result["hook_z_rate"][row] - v) < 2e-4, (t, q, result["hook_z"][row])
        assert abs(result["drop_time"][row] - drop) < 2e-5
    assert result["load"][-1] == 300 and result["load"][0] == 590


@pytest.mark.parametrize("version", VERSIONS)
def test_events_happen_in_event_mode(version, unit_of, model):
    unit = model(unit_of("lift", LIFT, version)[1], version)
    assert unit.count == 1
    assert next_event(unit, version) == 1.505
    indicator = (ctypes.c_double * 1)()

    def at(t, z, v):
        unit.setTime(t)
        unit.setContinuousStates((ctypes.c_double * 2)(z, v), 2)
        unit.getEventIndicators(indicator, 1)
        return indicator[0]

    assert at(0.5, -0.4, -0.4) == pytest.approx(-0.1) and at(0.6, -0.6, -0.4) == pytest.approx(0.1)
    assert next_event(unit, version) == 1.505
    # It has happened, and does not happen again.
    assert at(0.7, -0.4, -0.4) == 1
    at(1.505, -0.6, -0.4)
    unit.enterEventMode()
    assert next_event(unit, version) is None
    states = (ctypes.c_double * 2)()
    unit.getContinuousStates(states, 2)
    # Momentum: 90 kg at −0.4 m/s and 210 kg at 0.8 m/s.
    assert states[1] == pytest.approx((-90 * 0.4 + 210 * 0.8) / 300, rel=1e-12)
