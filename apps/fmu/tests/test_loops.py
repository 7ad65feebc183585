"""Units of cranes with closed loops: for co-simulation alone."""

import re
from ctypes import c_double
from pathlib import Path

import numpy as np
import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu
from test_misuse import raw, refused

PAGE = Path(__file__).parents[3] / "docs/manual/loops.md"


@pytest.fixture(scope="session")
def four_bar(tmp_path_factory):
    """The four-bar of the manual, with friction in its last pin, an input and a live mass."""
    text = re.search(r"```yaml\n(.*?)```", PAGE.read_text(), re.S).group(1)
    text = text.replace("    joint: {pin: {axis: [0, 1, 0], to_axis: [0, 0, 1]}}\n", "    joint: {pin: {axis: [0, 1, 0], to_axis: [0, 0, 1]}}\n    friction: {coulomb: 2, width: 0.01}\n")
    text = text.replace("    mass: 6\n", "    mass: swing\n")
    text += "parameters: {swing: {value: 6, unit: kg}}\ninputs: {push: {unit: N}}\n"
    text += "loads: [{name: hand, link: coupler, at: [0.5, 0, 0], force: [0, 0, 1], scale: {input: push}}]\n"
    file = tmp_path_factory.mktemp("loops") / "four_bar.yaml"
    file.write_text(text)
    return file


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_co_simulation_is_the_run_of_the_command(version, four_bar, export, simulate):
    unit = export(str(four_bar), "--fmi", version, name=f"four_bar{version}")
    assert validate_fmu(unit) == []
    assert read_model_description(unit).modelExchange is None
    own = simulate(str(four_bar), "--output", "0.02")
    names = [name for name in own if name not in ("t", "drive_work", "dissipated_energy", "load_work", "energy_balance")]
    assert {"ground_pin_force_x", "ground_pin_angle", "ground_pin_friction_torque"} <= set(names)
    result = simulate_fmu(unit, stop_time=4, step_size=0.02, output_interval=0.02, output=names)
    assert len(result) == len(own["t"]) == 201
    for name in names:
        # The same steps by the same library: the difference is rounding of the times, which FMPy accumulates; reactions follow from accelerations.
        size = max(1.0, np.abs(own[name]).max())
        assert np.abs(result[name] - own[name]).max() < 1e-8 * size, name


def test_loops_stay_closed_while_an_importer_changes_parameters_and_inputs(four_bar, export, slave):
    unit = slave(export(str(four_bar), name="four_bar_changed"))
    for step in range(50):
        unit.set(swing=6 + 0.1 * step, push=20.0 * np.sin(step))
        unit.doStep(0.02 * step, 0.02)
        crank, coupler, rocker = np.cumsum(unit.get("crank_psi", "coupler_psi", "rocker_psi"))
        ways = 0.4 * np.exp(1j * crank) + 1.1 * np.exp(1j * coupler) + 0.9 * np.exp(1j * rocker)
        assert abs(ways - 1.2) < 1e-10


def test_an_importer_cannot_integrate_or_change_a_state_alone(four_bar, export, slave):
    unit = slave(export(str(four_bar), name="four_bar_states"))
    states = (c_double * 6)()
    words = "loop joint ground_pin ties coordinates to each other", "use the unit for co-simulation"
    refused(unit, lambda: raw(unit, "fmi2SetContinuousStates", states, 6), *words)
    angle, force = (unit.references[name] for name in ("crank_psi", "ground_pin_force_x"))
    words = "crank_psi cannot change alone", "loop joint ground_pin ties it to others"
    refused(unit, lambda: unit.getDirectionalDerivative([force], [angle], [1.0]), *words)
