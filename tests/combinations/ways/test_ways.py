"""One random crane by every way to compute it: Python, the command's tables, JSON and text, the page, functional mock-up units, C."""

import base64
import csv
import ctypes
import json
import re
import subprocess
from decimal import Decimal

import crane as package
import numpy as np
import pytest
from fmpy import simulate_fmu

# Functions of C that are compared, with the arguments that they take besides constants and inputs.
FUNCTIONS = {"mass_matrix": "q", "bias": "qv", "forward_dynamics": "tqv", "static_residual": "tqp", "tangent_stiffness": "tqp"}
DURATION, OUTPUT = 0.4, 0.1


@pytest.fixture
def loaded(specs, seed):
    """The crane in Python, and a pose at which it stands; cranes that do not stand are not compared."""
    crane = package.load(str(specs(seed)))
    equilibrium = crane.statics(invalid="nan")
    if not equilibrium.stable:
        pytest.skip("does not stand")
    return crane, np.asarray(equilibrium.q)


def states(q, count=3):
    random = np.random.default_rng(5)
    return q + 1e-3 * random.standard_normal((count, q.size)), 0.1 * random.standard_normal((count, q.size))


def functions_of(file):
    """The functions to compare of a crane: accelerations do not follow from pose and rates if oil or bristles have states, and those of
    generated code are of the open chain."""
    others = any(key in file.read_text() for key in ("valve", "bristle", "loop_joints"))
    return {function: arguments for function, arguments in FUNCTIONS.items() if not (others and function == "forward_dynamics")}


def test_the_command_writes_what_python_computes(specs, seed, loaded, command, tmp_path):
    """The same runs by the same library: equal to the digits that the table has."""
    crane, _ = loaded
    run = crane.simulate(duration=DURATION, output=OUTPUT, verify=False)
    command("simulate", specs(seed), "--duration", DURATION, "--output", OUTPUT, "--no-verify", "--out", tmp_path)
    with open(tmp_path / f"random_{seed}.csv", newline="") as file:
        header, *rows = csv.reader(file)
    table = np.array(rows, dtype=float)
    for column, title in enumerate(header):
        name = title.split(" [")[0]
        size = max(1.0, np.abs(run[name]).max())
        assert np.abs(table[:, column] - run[name]).max() < 1e-9 * size, name


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_units_move_as_the_command_does(specs, seed, loaded, command, tmp_path, version):
    """Steps of co-simulation continue the history, so they are the steps of a run."""
    crane, _ = loaded
    unit = tmp_path / "unit.fmu"
    command("export", specs(seed), "--format", "fmu", "--fmi", version, "-o", unit)
    run = crane.simulate(duration=DURATION, output=OUTPUT, verify=False)
    names = [name for name in run.units if name not in ("t", "drive_work", "dissipated_energy", "load_work", "energy_balance")]
    result = simulate_fmu(str(unit), stop_time=DURATION, step_size=OUTPUT, output_interval=OUTPUT, output=names)
    for name in names:
        size = max(1.0, np.abs(run[name]).max())
        assert np.abs(result[name] - run[name]).max() < 1e-9 * size, name


def test_c_computes_what_python_computes(specs, seed, loaded, command, tmp_path):
    """The same operations in another compiler: rounding, which a solve magnifies."""
    crane, q = loaded
    if json.loads(command("info", specs(seed), "--format", "json")).get("inputs"):
        pytest.skip("functions of cranes with inputs take these, too")
    compared = functions_of(specs(seed))
    source, library = tmp_path / "crane.c", tmp_path / "crane.so"
    command("export", specs(seed), "--format", "c", "--functions", ",".join(compared), "-o", source)
    subprocess.run(["cc", "-std=c99", "-O1", "-shared", "-fPIC", source, "-o", library, "-lm"], check=True, cwd=tmp_path)
    functions = ctypes.CDLL(str(library))
    name = f"random_{seed}"
    # Constants are numbers that depend on parameters alone; no crane here has as many.
    constants = ctypes.create_string_buffer(8 * 100_000)
    header = next(tmp_path.glob("*.h")).read_text()
    defaults = [parameter["default"] for parameter in crane.info["parameters"]]
    if f"{name}_set_params" in header:
        given = (ctypes.c_double * max(1, len(defaults)))(*defaults)
        getattr(functions, f"{name}_set_params")(given, constants)
    n, t = q.size, 0.3
    positions = np.zeros(n)
    for drive, motion in zip(crane.info["drives"], crane.drive_motions(t)):
        positions[crane.coordinates.index(drive["coordinate"])] = motion[0]
    for pose, rates in zip(*states(q)):
        own = {"q": pose, "v": rates, "t": t, "p": positions}
        for function, arguments in compared.items():
            out = np.zeros((n, n) if function in ("mass_matrix", "tangent_stiffness") else n)
            values = [ctypes.c_double(own[a]) if a == "t" else own[a].ctypes.data_as(ctypes.c_void_p) for a in arguments]
            prefix = [constants] if f"{name}_{function}(const {name}_constants" in header.replace("\n", " ") else []
            getattr(functions, f"{name}_{function}")(*prefix, *values, out.ctypes.data_as(ctypes.c_void_p))
            given = [own[a] for a in arguments if a in "qv"] + [t] * ("t" in arguments)
            expected = getattr(crane, function)(*given)
            assert np.abs(out - expected).max() < 1e-8 * np.abs(expected).max(), function


def test_arrays_of_any_order_are_the_same_numbers(specs, seed, loaded):
    crane, q = loaded
    poses, rates = states(q, 6)
    for pose, rate in [(np.asfortranarray(poses), rates), (poses, np.asfortranarray(rates)), (poses[::-1][::-1], rates.tolist())]:
        for function in {"mass_matrix", "bias", "forward_dynamics"} & functions_of(specs(seed)).keys():
            arguments = (pose,) if function == "mass_matrix" else (pose, rate)
            usual = (poses,) if function == "mass_matrix" else (poses, rates)
            assert (getattr(crane, function)(*arguments) == getattr(crane, function)(*usual)).all(), function


def shows(text, value):
    """Whether a number of a table is a value, rounded to the digits that it has."""
    return abs(float(text) - value) <= 0.501 * 10.0 ** Decimal(text).as_tuple().exponent


def number(text):
    """A number, or `None` if a cell has something else."""
    try:
        return float(text)
    except ValueError:
        return None


def test_statics_as_json_and_as_text_are_what_python_computes(specs, seed, loaded, command):
    """JSON has all digits; the text shows the same numbers with fewer."""
    crane, _ = loaded
    equilibrium = crane.statics()
    told = json.loads(command("statics", specs(seed), "--format", "json"))
    assert told["cranes"][0]["status"] == equilibrium.status
    for key, expected in [("drives", equilibrium.drive_efforts), ("points", equilibrium.points)]:
        values = [[row[axis] for axis in "xyz"] if key == "points" else row["value"] for row in told[key]]
        size = max(1.0, np.abs(expected).max(initial=0.0))
        assert np.abs(np.array(values).reshape(np.shape(expected)) - expected).max(initial=0.0) < 1e-9 * size, key
    supports = [support["name"] for support in crane.info["supports"]]
    feet = np.array([[row[axis] for axis in "xyz"] for row in told["reactions"] if row["support"] in supports])
    if feet.size:
        assert np.abs(feet - equilibrium.support_reactions).max() < 1e-9 * np.abs(equilibrium.support_reactions).max()
    lines = [line.split() for line in command("statics", specs(seed)).splitlines()]
    for drive in told["drives"]:
        assert any(line[:1] == [drive["drive"]] and shows(line[1], drive["value"]) for line in lines if len(line) > 1), drive
    for point in told["points"]:
        shown = [line[1:4] for line in lines if line[:1] == [point["point"]] and line[-1] == "m"]
        assert any(all(map(shows, row, [point[axis] for axis in "xyz"])) for row in shown), point


def test_the_page_contains_what_python_computes(specs, seed, loaded, command, tmp_path):
    """The page has the run in single precision, and each number of its tables also with all digits."""
    crane, _ = loaded
    run = crane.simulate(duration=DURATION, output=OUTPUT, verify=False)
    command("report", specs(seed), "--duration", DURATION, "--interval", OUTPUT, "--no-verify", "-o", tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text()
    data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.DOTALL)[1])
    packed = data["cranes"][-1]["run"]
    columns = np.frombuffer(base64.b64decode(packed["data"]), dtype="<f4").reshape(len(packed["columns"]), -1)
    for column, values in zip(packed["columns"], columns):
        size = max(1.0, np.abs(run[column["name"]]).max())
        assert column["unit"] == run.units[column["name"]]
        assert np.abs(values[:: packed["every"]] - run[column["name"]][:: packed["every"]]).max() < 1e-6 * size, column["name"]
    grids = {grid["key"]: grid for grid in data["tables"]["grids"]}
    drives = [float(exact[1]) for exact in grids["drives"]["exact"]]
    expected = crane.statics().drive_efforts
    assert np.abs(drives - expected).max() < 1e-9 * max(1.0, np.abs(expected).max())
    for grid in data["tables"]["grids"]:
        for row, exact in zip(grid["rows"], grid["exact"]):
            for shown, whole in zip(row, map(number, exact)):
                assert whole is None or shows(shown, whole), (grid["title"], row, exact)


def test_cranes_carry_and_buckle_in_python_as_the_command_prints(specs, seed, loaded, command):
    crane, _ = loaded
    printed, found = json.loads(command("strength", specs(seed), "--buckling", "--format", "json")), crane.buckling()
    forces = crane.strength().internal_forces
    joints = [(cut["link"] or "ground", force) for cut, force in zip(crane.info["cuts"], forces) if cut["kind"] in ("ground", "joint")]
    assert [name for name, _ in joints] == [row["joint"] for row in printed["loads"]]
    for (name, force), row in zip(joints, printed["loads"]):
        np.testing.assert_allclose(force, [row[of] for of in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")], rtol=0, atol=1e-9 * np.abs(forces).max(), err_msg=name)
    factors = printed["critical_factor"]
    of_path = factors["followed"] or {"factor": np.inf, "status": ""}
    assert found.followed == of_path["factor"] and found.status in (of_path["status"], "")
    assert (factors["linearised"] or None) == (found.linearised if np.isfinite(found.linearised) else None)
    orders = printed["second_order"]
    moved = [[row["first_order"], row["second_order"]] for row in orders if row["quantity"].startswith("displacement")]
    bent = [[row["first_order"], row["second_order"]] for row in orders if row["quantity"].startswith("bending")]
    if moved:
        np.testing.assert_allclose(np.linalg.norm(found.displacements, axis=-1), moved, rtol=1e-12)
    np.testing.assert_array_equal(found.moments, np.reshape(bent, (-1, 2)))
