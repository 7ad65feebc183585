"""Units of a compiled crane: valid, and with the numbers of a live one."""

import zipfile

import numpy as np
import pytest
from conftest import Slave
from fmpy import simulate_fmu
from fmpy.validation import validate_fmu

GIVEN = {"payload": 95.0, "gust": 500.0}


@pytest.fixture(scope="session")
def units(steered, export):
    """The spec, and compiled units of both versions, of one library."""
    spec = steered[0]
    return spec, {version: export(spec, "--compile", "--fmi", version, name=f"compiled-{version}") for version in ("2.0", "3.0")}


@pytest.mark.parametrize("version", ["2.0", "3.0"])
@pytest.mark.parametrize("given", [{}, GIVEN])
def test_co_simulation_is_the_run_of_the_command(version, given, units, simulate):
    spec, files = units
    assert validate_fmu(files[version]) == []
    options = [f"--set=payload={given['payload']}", f"--input=gust={given['gust']}"] if given else []
    own = simulate(spec, "--output", "0.01", *options)
    names = [name for name in own if name not in ("t", "drive_work", "dissipated_energy", "energy_balance", "load_work")]
    result = simulate_fmu(files[version], start_values=given, stop_time=2, step_size=0.01, output_interval=0.01, output=names)
    assert len(result) == len(own["t"]) == 201
    for name in names:
        # As for a live unit: the command's crane is live, so that machine code differs from it by rounding alone.
        size = max(1.0, np.abs(own[name]).max())
        assert np.abs(result[name] - own[name]).max() < 1e-9 * size, name


def test_parameters_and_inputs_change_under_way(units, steered, slave):
    compiled, live = slave(units[1]["2.0"]), slave(steered[1])
    names = ("boom_psi", "load_psi", "hook_x", "boom_psi_acceleration", "load_psi_acceleration")
    before = compiled.get(*names)
    for unit in (compiled, live):
        unit.follow(0, 0.5, 5)
        unit.set(**GIVEN)
        unit.follow(0.5, 1, 5)
    np.testing.assert_allclose(compiled.get(*names), live.get(*names), rtol=1e-9, atol=1e-9)
    references = [compiled.references[name] for name in names]
    directions = [unit.getDirectionalDerivative(references, [unit.references["gust"]], [1.0]) for unit in (compiled, live)]
    # Of outputs central differences with steps of 6e-6 of values whose rounding is 1e-15.
    np.testing.assert_allclose(*directions, rtol=1e-8, atol=1e-8)
    compiled.reset()
    compiled.begin()
    assert (compiled.get(*names) == before).all() and compiled.get("payload", "gust").tolist() == [80, 0]


def test_a_changed_spec_is_refused(units, tmp_path):
    """The library holds the crane as it was compiled."""
    changed = tmp_path / "changed.fmu"
    with zipfile.ZipFile(units[1]["2.0"]) as archive, zipfile.ZipFile(changed, "w") as copy:
        for name in archive.namelist():
            content = archive.read(name)
            copy.writestr(name, content.replace(b"mass: 200", b"mass: 210") if name.endswith(".yaml") else content)
    unit = Slave(str(changed), tmp_path / "changed")
    with pytest.raises(Exception):
        unit.open()
    said = " ".join(unit.messages)
    assert "crane.yaml" in said and "compiled" in said and "export the unit again" in said, said


def test_a_library_is_ready_made_or_compiled_but_not_both(refused):
    said = refused("export", "double_pendulum", "--format", "fmu", "--compile", "--library", "unit.so")
    assert "--library" in said and "--compile" in said
    assert "--format fmu" in refused("export", "double_pendulum", "--format", "c", "--compile")
