"""Units in FMPy: valid, and with the same motion as that of the command."""

import numpy as np
import pytest
from conftest import Slave, states_and_rates
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu

FLEXIBLE = "eight_link_flexible"
HYDRAULIC = "eight_link_hydraulic"
CRANES = [
    "cantilever",
    "double_pendulum",
    "eight_link_flexible",
    "eight_link_hydraulic",
    "eight_link_identified",
    "eight_link_rigid",
    "eight_link_two_flexible",
    "knuckle_boom",
]
# A rod of 1.5 m on a pin, with a load of `bob` kg and 0.05 kg m² at its end.
PENDULUM = """
format: 1
name: pendulum
analyses: [dynamics]
parameters: {bob: {value: 2, unit: kg, about: 'what hangs, "m" < M & so on'}}
links:
  - {name: rod, joint: {revolute: {axis: y}}, mass: bob, com: [0, 0, -1.5], inertia: {Ixx: 0.001, Iyy: 0.05, Izz: 0.05}}
points:
  - {name: bob_end, link: rod, at: [0, 0, -1.5]}
guess: {rod_theta: 0.5}
run: {duration: 2, output: 0.1}
"""


@pytest.fixture(scope="session")
def pendulum(export, tmp_path_factory):
    file = tmp_path_factory.mktemp("pendulum") / "pendulum.yaml"
    file.write_text(PENDULUM)
    return export(str(file), name="pendulum")


def acceleration(angle, bob):
    """Acceleration of the pendulum, rad/s²."""
    return -bob * 9.81 * 1.5 * np.sin(angle) / (0.05 + bob * 1.5**2)


@pytest.mark.parametrize("name", CRANES)
def test_every_shipped_crane_is_a_valid_unit(name, export):
    assert validate_fmu(export(name)) == []


def test_the_description_has_units_parameters_and_texts(pendulum):
    assert validate_fmu(pendulum) == []
    description = read_model_description(pendulum)
    variables = {variable.name: variable for variable in description.modelVariables}
    bob = variables["bob"]
    assert (bob.causality, bob.variability, bob.start, bob.unit) == ("parameter", "tunable", "2", "kg")
    assert bob.description == 'what hangs, "m" < M & so on'
    units = {unit.name: unit.baseUnit for unit in description.unitDefinitions}
    assert (units["J"].kg, units["J"].m, units["J"].s) == (1, 2, -2)
    assert (units["rad/s2"].rad, units["rad/s2"].s) == (1, -2)
    assert variables["rod_theta_acceleration"].derivative is variables["rod_theta_rate"]
    assert variables["rod_theta_rate"].derivative is variables["rod_theta"]
    assert [variables[name].causality for name in ("bob_end_x", "rod_theta", "kinetic_energy")] == [
        "output",
        "output",
        "local",
    ]


@pytest.mark.parametrize("name_of_crane", [FLEXIBLE, HYDRAULIC])
def test_co_simulation_is_the_run_of_the_command(name_of_crane, export, simulate):
    own = simulate(name_of_crane, "--duration", "3", "--output", "0.01")
    names = [name for name in own if name not in ("t", "drive_work", "dissipated_energy", "energy_balance")]
    result = simulate_fmu(export(name_of_crane), stop_time=3, step_size=0.01, output_interval=0.01, output=names)
    assert len(result) == len(own["t"]) == 301
    for name in names:
        # The same steps by the same library: the difference is rounding of the times, which FMPy accumulates.
        size = max(1.0, np.abs(own[name]).max())
        assert np.abs(result[name] - own[name]).max() < 1e-9 * size, name


def test_model_exchange_by_another_solver_is_the_same_motion(export, simulate):
    """SUNDIALS' CVode follows the accelerations and stops where a drive's motion is not smooth."""
    own = simulate("knuckle_boom", "--tolerance", "1e-9", "--output", "0.1")
    names = ["load_centre_x", "load_centre_z", "hook_theta", "hook_theta_rate", "main_boom_theta_drive_torque"]
    result = simulate_fmu(
        export("knuckle_boom"),
        fmi_type="ModelExchange",
        stop_time=10,
        output_interval=0.1,
        relative_tolerance=1e-9,
        output=names,
    )
    # At an event there are two rows; the command has the time once.
    time, rows = np.unique(result["time"].round(9), return_index=True)
    rows = rows[np.isin(time, own["t"].round(9))]
    assert len(rows) == len(own["t"]) == 101
    for name in names:
        # Both solvers are set to 1e-9 per step; the torque is that of a stiff spring, 4e6 N m/rad.
        size = 4e6 if name.endswith("torque") else 1.0
        assert np.abs(result[name][rows] - own[name]).max() < 1e-6 * size, name


def test_pressures_are_states_of_model_exchange(export, simulate):
    own = simulate(HYDRAULIC, "--tolerance", "1e-9", "--duration", "0.5", "--output", "0.1")
    scales = {"log_middle_z": 1.0, "boom_cylinder_piston_pressure": 24e6, "boom_cylinder_valve": 1.0, "pump_pressure": 24e6}
    result = simulate_fmu(
        export(HYDRAULIC),
        fmi_type="ModelExchange",
        stop_time=0.5,
        # CVode stops after 500 steps between two outputs.
        output_interval=0.01,
        relative_tolerance=1e-9,
        output=list(scales),
    )
    time, rows = np.unique(result["time"].round(9), return_index=True)
    rows = rows[np.isin(time, own["t"].round(9))]
    assert len(rows) == len(own["t"]) == 6
    for name, scale in scales.items():
        assert np.abs(np.diff(own[name])).max() > 1e-3 * scale, name
        # Both solvers are set to 1e-9 per step.
        assert np.abs(result[name][rows] - own[name]).max() < 1e-6 * scale, name


def test_a_state_has_the_oil(export, slave):
    names = ["log_middle_z", "boom_cylinder_piston_pressure", "boom_cylinder_valve", "pump_pressure"]
    unit = slave(export(HYDRAULIC))
    unit.follow(0, 1, 20)
    state, here = unit.getFMUstate(), unit.get(*names)
    unit.follow(1, 1.5, 10)
    went_on = unit.get(*names)
    unit.setFMUstate(state)
    assert (unit.get(*names) == here).all()
    unit.follow(1, 1.5, 10)
    # A restored motion begins with short steps: it differs by the tolerance, for a pressure by that fraction of the pump's.
    assert np.allclose(unit.get(*names), went_on, rtol=0, atol=[1e-4, 24e2, 1e-3, 24e2])
    unit.freeFMUstate(state)


def test_parameters_of_the_importer_and_of_the_export_are_those_of_the_command(export, simulate, slave):
    own = simulate("knuckle_boom", "--set", "payload=300", "--duration", "0.5", "--output", "0.5")
    expected = [own[name][-1] for name in ("load_centre_x", "load_centre_z")]
    for unit in [slave(export("knuckle_boom"), payload=300), slave(export("knuckle_boom", "--set", "payload=300", name="300"))]:
        assert unit.get("payload") == [300]
        unit.follow(0, 0.5, 50)
        assert np.abs(unit.get("load_centre_x", "load_centre_z") - expected).max() < 1e-9


def test_inputs_of_the_importer_are_those_of_the_command(steered, simulate, slave):
    """Inputs that are set before the start, and inputs that are not set."""
    file, unit = steered
    assert validate_fmu(unit) == []
    inputs = {variable.name: variable for variable in read_model_description(unit).modelVariables if variable.causality == "input"}
    assert {name: (of.unit, of.start, of.variability) for name, of in inputs.items()} == {
        "lever": ("rad", "0", "continuous"),
        "gust": ("N", "0", "continuous"),
    }
    for given in [{}, {"gust": 500.0}, {"lever": 0.4, "gust": -300.0}]:
        own = simulate(file, "--output", "0.01", *[f"--input={name}={value}" for name, value in given.items()])
        one = slave(unit, **given)
        one.follow(0, 2, 200)
        names = ["boom_psi", "boom_psi_rate", "load_psi", "hook_x", "hook_z", "boom_psi_drive_torque"]
        last = np.array([own[name][-1] for name in names])
        np.testing.assert_allclose(one.get(*names), last, rtol=1e-9, atol=1e-9)


def test_an_input_moves_the_crane_from_when_it_is_set(steered, slave):
    one, other = slave(steered[1]), slave(steered[1])
    for unit in (one, other):
        unit.follow(0, 0.5, 5)
    assert one.get("boom_psi") == other.get("boom_psi")
    other.set(gust=500.0)
    # Moment about the pin: 4 m · 500 N.
    names = ("boom_psi_acceleration", "load_psi_acceleration")
    assert other.get("boom_psi") == one.get("boom_psi") and other.get(*names)[0] > one.get(*names)[0] + 0.1
    other.set(gust=0.0)
    np.testing.assert_allclose(other.get(*names), one.get(*names), rtol=1e-12)
    state = other.getFMUstate()
    other.set(lever=0.3)
    assert other.get("lever") == [0.3] and other.get("boom_psi_prescribed") == [0.3]
    other.setFMUstate(state)
    assert other.get("boom_psi_prescribed") == one.get("boom_psi_prescribed")
    # Accelerations are linear in the wind: the derivative with respect to it is the difference for 1 N.
    references = [other.references[name] for name in names]
    derivative = other.getDirectionalDerivative(references, [other.references["gust"]], [1.0])
    before = other.get(*names)
    other.set(gust=1.0)
    np.testing.assert_allclose(derivative, other.get(*names) - before, rtol=1e-4, atol=1e-12)
    with pytest.raises(Exception):
        other.set(gust=np.nan)


def test_a_parameter_can_change_while_the_crane_moves(pendulum, slave):
    unit = slave(pendulum)
    assert abs(unit.get("rod_theta_acceleration")[0] - acceleration(0.5, 2)) < 1e-12
    unit.follow(0, 0.2, 2)
    angle, before = unit.get("rod_theta", "rod_theta_acceleration")
    assert abs(before - acceleration(angle, 2)) < 1e-12
    unit.set(bob=50)
    assert unit.get("rod_theta") == [angle]
    assert abs(unit.get("rod_theta_acceleration")[0] - acceleration(angle, 50)) < 1e-12
    unit.follow(0.2, 0.3, 1)
    assert abs(unit.get("rod_theta_acceleration")[0] - acceleration(unit.get("rod_theta")[0], 50)) < 1e-12


def test_a_state_is_kept_and_brought_back(export, slave):
    names = ["load_centre_x", "load_centre_z", "hook_theta_rate"]
    file = export("knuckle_boom")
    unit = slave(file)
    unit.follow(0, 1, 20)
    state = unit.getFMUstate()
    unit.follow(1, 2, 20)
    went_on = unit.get(*names)
    again = []
    for _ in range(2):
        unit.setFMUstate(state)
        unit.follow(1, 2, 20)
        again.append(unit.get(*names))
    assert (again[0] == again[1]).all()
    # A restored motion has no history: its first steps differ, within a few times the tolerance of 2e-5.
    assert 0 < np.abs(again[0] - went_on).max() < 1e-4
    # Serialised, in another instance with another payload.
    unit.setFMUstate(state)
    unit.set(payload=500)
    other = slave(file, payload=100)
    other.setFMUstate(other.deSerializeFMUstate(unit.serializeFMUstate(state)))
    assert other.get("payload") == [800]
    other.follow(1, 2, 20)
    assert (other.get(*names) == again[0]).all()
    unit.freeFMUstate(state)


def test_two_instances_are_independent(export, slave):
    names = ["load_centre_x", "load_centre_z"]
    file = export("knuckle_boom")
    alone = slave(file, payload=300)
    alone.follow(0, 1, 50)
    light, heavy, flexible = slave(file, payload=300), slave(file, payload=1200), slave(export(FLEXIBLE))
    for step in range(50):
        for unit in (light, heavy, flexible):
            unit.doStep(step * 0.02, 0.02)
    assert (light.get(*names) == alone.get(*names)).all()
    assert np.abs(light.get(*names) - heavy.get(*names)).max() > 1e-4
    assert flexible.get("time") == [1.0]


def test_directional_derivatives_are_those_of_the_pendulum(pendulum, slave):
    unit = slave(pendulum)
    angle, rate, acceleration_, height = (
        unit.references[name] for name in ("rod_theta", "rod_theta_rate", "rod_theta_acceleration", "bob_end_z")
    )
    found = unit.getDirectionalDerivative([acceleration_, height, rate], [angle, rate], [2.0, 3.0])
    expected = [2 * acceleration(np.pi / 2 - 0.5, 2), 2 * 1.5 * np.sin(0.5), 3.0]
    off = np.abs(np.array(found) - expected)
    # Of outputs central differences with steps of 6e-6: truncation 1e-11, rounding 1e-10.
    assert off[1] < 1e-8 and max(off[0], off[2]) < 1e-13
    assert unit.get("rod_theta") == [0.5]
    assert unit.getDirectionalDerivative([height], [angle], [0.0]) == [0.0]


def test_directional_derivatives_of_rates_are_exact(export, slave):
    """Along a sum of directions they are sums, of rounding errors alone: with valves, their states, joints that stick and feet, in motion."""
    file = export("eight_link_hydraulic")
    unit = slave(file)
    unit.follow(0, 0.2, 4)
    states, rates = states_and_rates(file)
    assert len(states) == len(rates) == 2 * 23 + 3 * 3 + 1 + 2 + 2 * 8
    references = [unit.references[name] for name in rates]
    size = lambda name: 1e5 if name.endswith("_pressure") else 1e-3
    together = unit.getDirectionalDerivative(references, [unit.references[name] for name in states], [size(name) for name in states])
    columns = [np.array(unit.getDirectionalDerivative(references, [unit.references[name]], [size(name)])) for name in states]
    assert np.abs(sum(columns) - together).max() < 1e-11 * np.abs(columns).max()
    for row, name in enumerate(rates):
        here = [column[row] for column in columns]
        assert abs(sum(here) - together[row]) <= 1e-10 * np.abs(here).max(), name


def test_a_start_at_a_later_time_rests_with_the_drives_as_they_are_then(export, simulate, slave):
    own = simulate("knuckle_boom", "--duration", "5", "--output", "5")
    unit = slave(export("knuckle_boom"), start=5.0)
    prescribed, angle, rate = unit.get("knuckle_theta_prescribed", "knuckle_theta", "knuckle_theta_rate")
    assert abs(prescribed - own["knuckle_theta_prescribed"][-1]) < 1e-12
    assert abs(angle - prescribed) < 0.02 and rate == 0
    unit.follow(5, 5.5, 5)
    assert unit.get("time") == [5.5]


def test_mistakes_of_the_importer_are_refused_with_words(export, slave, tmp_path):
    file = export("knuckle_boom")
    unit = slave(file)

    def refused(call, *words):
        unit.messages.clear()
        with pytest.raises(Exception):
            call()
        said = " ".join(unit.messages)
        assert all(word in said for word in words), said

    refused(lambda: unit.set(payload=-5), "payload", "-5", "E03")
    refused(lambda: unit.set(payload=float("nan")), "payload", "finite")
    refused(lambda: unit.set(hook_theta=0.1), "hook_theta", "cannot be set")
    refused(lambda: unit.getReal([10_000]), "no variable 10000")
    refused(lambda: unit.getInteger([0]), "Integer")
    refused(lambda: unit.doStep(0.5, 0.1), "t = 0.5", "is at t = 0")
    refused(lambda: unit.doStep(0.0, -1.0), "-1", "above 0")
    # None of this has damaged the crane.
    assert unit.get("payload") == [800]
    unit.follow(0, 0.1, 1)
    stranger = Slave(file, tmp_path / "stranger", guid="another")
    with pytest.raises(Exception):
        stranger.open()
    assert "export the unit again" in " ".join(stranger.messages)


def test_a_crane_that_cannot_rest_says_why(export, slave, tmp_path):
    """Statics of an inverted pendulum."""
    spec = tmp_path / "loose.yaml"
    spec.write_text(PENDULUM.replace("[dynamics]", "[statics, dynamics]").replace("0.5", "3.1415"))
    unit = Slave(export(str(spec), name="loose"), tmp_path / "loose")
    unit.open()
    with pytest.raises(Exception):
        unit.begin()
    assert "stable equilibrium" in " ".join(unit.messages) and "guess" in " ".join(unit.messages)
    unit.freeInstance()
