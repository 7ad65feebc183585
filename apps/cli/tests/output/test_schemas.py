"""Validates the JSON that commands print against the schemas in apps/cli/schemas, with jsonschema."""

import json
from pathlib import Path

import jsonschema
import pytest

ROOT = Path(__file__).resolve().parents[4]

CRANES = ["eight_link_flexible", "cantilever", "knuckle_boom", "double_pendulum"]
SHORT = ["--duration", "0.2"]

# An inverted pendulum: statics finds no stable pose.
UPSIDE_DOWN = """
format: 1
name: upside_down
links:
  - {name: rod, joint: {revolute: {axis: y}}, mass: 2, com: [0, 0, 1.5], inertia: {Ixx: 0.001, Iyy: 0.05, Izz: 0.05}}
points: [{name: top, link: rod, at: [0, 0, 1.5]}]
"""

MISTAKEN = """format: 1
name: mistaken
links:
  - {name: rod, joint: {revolute: {axis: y}}, masss: 2, com: [0, 0, -1.5], inertia: {Ixx: 0.001, Iyy: 0.05, Izz: 0.05}}
"""


@pytest.mark.parametrize("crane_name", CRANES)
def test_statics(output, crane_name):
    found = output("statics", "statics", crane_name)
    assert found["stable"] is True and [of["crane"] for of in found["cranes"]] == [crane_name]


def test_statics_without_a_stable_pose(output):
    found = output("statics", "statics", "-", code=1, text=UPSIDE_DOWN)
    assert found["stable"] is False and found["cranes"][0]["status"] == "unstable"
    assert output("strength", "strength", "-", code=1, text=UPSIDE_DOWN)["stable"] is False


@pytest.mark.parametrize("crane_name", CRANES)
def test_modes(output, crane_name):
    found = output("modes", "modes", crane_name)
    assert found["stable"] is True and found["units"]["undamped"]["frequency"] == "Hz"
    assert all(isinstance(name, str) for mode in found["undamped"] for name in mode["dominated_by"])


@pytest.mark.parametrize("options", [[], ["--time", "2.5"], ["--hold", "boom_psi=40deg", "--hold", "column_psi_rate=0.2"]])
def test_linearise(output, options):
    found = output("linearise", "linearise", "eight_link_rigid", *options)
    count = len(found["coordinates"])
    assert found["about"] == ("a steady motion" if options else "a pose at rest")
    assert all(len(found[key]) == count for key in ("mass", "damping", "stiffness", "gyroscopic", "circulatory"))
    assert all(len(shape) == count for shape in found["shapes"]) and len(found["shapes"]) == len(found["modes"])
    assert {row["coordinate"] for row in found["held"]} == ({"boom_psi", "column_psi"} if "--hold" in options else set())


@pytest.mark.parametrize("crane_name", ["eight_link_hydraulic", "two_arms", "knuckle_boom"])
def test_state_space(output, crane_name):
    found = output("linearise", "linearise", crane_name, "--measure", "truck_x_rate" if crane_name != "knuckle_boom" else "hook_theta")
    model = found["state_space"]
    assert len(model["a"]) == len(model["b"]) == len(model["states"]) == len(model["state_units"])
    assert len(model["c"]) == len(model["d"]) == 1 and len(model["d"][0]) == len(model["inputs"])
    assert ("mass" in found) == (crane_name != "eight_link_hydraulic")


@pytest.mark.parametrize("ranges", [[], ["--range", "main_boom_theta=0:60deg:2", "--range", "payload=100:800:2"]])
def test_margins(output, ranges):
    found = output("margins", "margins", "knuckle_boom", "--on", "main_boom_theta_rate", "--p", 0.8, "--delay", 0.06, *ranges)
    assert found["count"] == len(found["margins"]) == (4 if ranges else 1)
    assert found["units"]["margins"]["phase_margin"] == "rad" and found["loop"]["units"] == "rad/s per rad"


@pytest.mark.parametrize("along", [0, 3])
def test_stability(output, tmp_path, along):
    found = output("stability", "stability", "knuckle_boom", "--along", along, "--out", tmp_path)
    assert {row["method"] for row in found["limits"]} == {"rk4", "dopri5", "rosw4", "bdf"}


@pytest.mark.parametrize("options", [[], ["--method", "rk4"], ["--no-verify"]])
def test_simulate(output, tmp_path, options):
    found = output("simulate", "simulate", "knuckle_boom", *SHORT, *options, "--out", tmp_path)
    assert (found["tolerance"] is None) == ("rk4" in options)
    assert all((row["error"] is None) == ("--no-verify" in options) for row in found["extremes"])


@pytest.mark.parametrize("method", ["bdf", "rk4"])
def test_ensemble(output, tmp_path, method):
    table = tmp_path / "loads.csv"
    table.write_text("payload [kg]\n200\n800\n")
    found = output("ensemble", "simulate", "knuckle_boom", "--ensemble", table, "--method", method, *SHORT, "--out", tmp_path)
    assert found["cranes"] == found["reached_the_end"] == 2


@pytest.mark.parametrize("options", [[], ["--run", *SHORT]])
@pytest.mark.parametrize("crane_name", CRANES)
def test_strength(output, crane_name, options):
    found = output("strength", "strength", crane_name, *options)
    assert ("extremes_of_loads" in found) == bool(options)
    assert (found["tipping_margin"] is None) == (crane_name != "eight_link_flexible")


def test_strength_with_buckling(output):
    found = output("strength", "strength", "eight_link_flexible", "--buckling")
    assert found["critical_factor"]["followed"] is None or found["critical_factor"]["followed"]["factor"] > 1
    orders = {row["quantity"]: row for row in found["second_order"]}
    assert orders["bending of boom"]["place"].startswith("boom") and orders["bending of boom"]["factor"] > 0


COMBINED = """
format: 1
name: combined
parameters: {payload: {value: 20, unit: kg}}
links:
  - {name: arm, joint: {revolute: {axis: y}}, beam: {length: 2, sections: 2, material: {E: 2.1e11, G: 8.1e10, density: 7850}, section: {box: {height: 0.1, width: 0.1, thickness: 0.005}}}}
  - {name: load, mass: payload, com: [0, 0, 0]}
drives: [{coordinate: arm_theta, stiffness: 1e6, damping: 1e3, motion: {hold: 0}}]
points: [{name: tip, link: load, at: [0, 0, 0]}]
combinations: [{name: working, weight: 1.2, masses: {payload: 1.5}}, {name: as_written}]
"""


def test_combinations(output):
    found = output("strength", "strength", "-", "--combinations", text=COMBINED)
    assert [row["combination"] for row in found["combinations"]] == ["working", "as_written"]
    forces = [row for row in found["worst_cases"] if row["quantity"] == "force of the joint"]
    assert {row["with_the_combination"] for row in forces} == {"working"}
    found = output("statics", "statics", "-", "--combinations", text=COMBINED)
    assert set(found["drives"][0]["value"]) == {"working", "as_written"}


def test_fatigue(output):
    found = output("fatigue", "fatigue", "eight_link_flexible", "--cycles", "1e5", "--category", "71MPa", "--duration", "2", "--interval", "0.02")
    assert found["life"] > 0 and {row["beam"] for row in found["fatigue"]} and found["units"]["fatigue"]["largest_range"] == "Pa"


def test_drives(output, tmp_path):
    parts = tmp_path / "parts.csv"
    parts.write_text("part,bore [mm],rod [mm],pressure [bar]\nA,80,50,250\n")
    found = output("drives", "drives", "eight_link_hydraulic", "--duration", "0.5", "--parts", parts)
    assert {row["for"] for row in found["parts"]} == {row["cylinder"] for row in found["cylinder_duties"]}
    assert found["units"]["parts"]["pressure"] == "Pa" and len(found["duties"]) >= len(found["cylinder_duties"])


def test_factors(output):
    found = output("factors", "factors", "eight_link_flexible", "--duration", "1", "--interval", "0.02", "--tabulated")
    assert any(row["quantity"] == "stress of boom" for row in found["factors"]) or found["greatest_factor"] > 0


# A point of a load chart.
LARGEST = ["--largest-load", "--tipping", "0.2", "--with", "links.boom.beam.section.box.height"]


@pytest.mark.parametrize("options", [[], ["--with", "links.boom.beam.section.box.height,load_mass", "--of", "stresses,frequencies"], LARGEST])
def test_sensitivity(output, options):
    found = output("sensitivity", "sensitivity", "eight_link_flexible", *options)
    assert len(found["changes"]) == len(found["outputs"]) * len(found["parameters"])
    assert found["stable"] is True and found["units"]["changes"]["relative"] == "1"
    assert {row["group"] for row in found["outputs"]} >= {"stresses", "frequencies"}


def test_sensitivity_of_a_run(output):
    found = output("sensitivity", "sensitivity", "knuckle_boom", "--run", "--duration", "1", "--of", "load_centre_z.final,knuckle_theta_drive_torque")
    assert [row["output"] for row in found["outputs"]] == ["load_centre_z.final", "knuckle_theta_drive_torque.peak"]
    assert {row["group"] for row in found["outputs"]} == {"run"} and found["method"] == "rosw4" and found["duration"] == 1


@pytest.mark.parametrize(
    "more",
    [
        [],
        ["--range", "extension_x=0.1:0.5:2", "--range", "knuckle_theta=20deg:60deg:2"],
        ["--effort", "main_boom_theta=1e5", "--deflection", "boom_tip=0.1"],
    ],
    ids=["one range", "several ranges", "limits"],
)
def test_envelope(output, tmp_path, more):
    ranges = ["--range", "main_boom_theta=0:60deg:3"]
    found = output("envelope", "envelope", "knuckle_boom", *ranges, *more, "--greatest-load", 5000, "--out", tmp_path)
    assert found["load"] == "payload" and found["poses"] >= 3 and found["units"]["load_chart"]["radius"] == "m"
    assert found["limits"]["considered"] and found["limits"]["not_considered"]


def test_cylinders(output):
    found = output("statics", "statics", ROOT / "tests/no-std/exact.yaml")
    rows = {(row["cylinder"], row["quantity"]): row for row in found["cylinders"]}
    assert {cylinder for cylinder, _ in rows} == {"slew", "lift"}
    assert rows["lift", "length"]["unit"] == "m" and rows["lift", "stiffness of its oil"]["unit"] == "N m/rad"
    assert ("slew", "stiffness of its oil") not in rows


@pytest.mark.parametrize("command", ["statics", "strength", "modes"])
def test_poses(output, command):
    found = output("poses", command, "knuckle_boom", "--hold", "main_boom=-30deg", "--range", "payload=100:800:3")
    assert found["count"] == found["stable_poses"] == len(found["poses"]) == 3
    assert [row["payload"] for row in found["poses"]] == [100, 450, 800] and found["units"]["poses"]["radius"] == "m"


@pytest.mark.parametrize("pair", [["eight_link_flexible"], ["double_pendulum", "knuckle_boom"]])
def test_compare(output, tmp_path, pair):
    found = output("compare", "compare", *pair, *SHORT, "--out", tmp_path)
    labels = {of["label"] for of in found["cranes"]}
    assert len(labels) == 2 and all(set(row["value"]) == labels for row in found["summary"])


@pytest.mark.parametrize("crane_name", ["knuckle_boom", "eight_link_flexible", ROOT / "tests/no-std/exact.yaml"])
def test_run(output, tmp_path, crane_name):
    found = output("run", "run", crane_name, *SHORT, "--out", tmp_path)
    labels = {of["label"] for of in found["cranes"]}
    assert found["stable"] is True and all(set(row["value"]) == labels for row in found["summary"])
    assert ("deflection" in found) == (len(labels) == 2) == (crane_name == "eight_link_flexible")


@pytest.mark.parametrize("crane_name", [*CRANES, "eight_link_hydraulic", ROOT / "tests/no-std/exact.yaml"])
def test_info(output, crane_name):
    found = output("info", "info", crane_name)
    assert [row["index"] for row in found["q"]] == list(range(found["coordinates"]))
    assert found["bodies"][-1]["degrees_of_freedom"] == found["coordinates"]
    assert ("inputs" in found) == (crane_name not in [*CRANES, "eight_link_hydraulic"])


def test_list(output):
    found = output("list", "list")
    assert {row["name"]: row["coordinates"] for row in found["cranes"]}.items() >= {"double_pendulum": 2, "eight_link_rigid": 13}.items()


def test_check(output):
    found = output("check", "check", "cantilever")
    assert found["valid"] is True and found["diagnostics"] == [] and found["crane"] == "cantilever"


def test_check_of_a_mistake(output, crane, tmp_path):
    spec = tmp_path / "mistaken.yaml"
    spec.write_text(MISTAKEN)
    found = output("check", "check", spec, code=1)
    assert found["valid"] is False and found["crane"] is None
    mistake = found["diagnostics"][0]
    line = MISTAKEN.splitlines()[3]
    assert mistake["severity"] == "error" and mistake["file"] == str(spec)
    assert (mistake["line"], mistake["column"]) == (4, line.index("masss") + 1)
    assert (mistake["end_line"], mistake["end_column"]) == (4, line.index("masss") + 6)
    assert "masss" in mistake["message"] and "mass" in mistake["help"]
    # The same for human readers: everything goes to standard error.
    code, out, err = crane("check", spec)
    assert code == 1 and out == "" and mistake["code"] in err and mistake["message"] in err


def test_check_of_a_warning(output):
    text = (ROOT / "codegen/tests/implausible/W005_length_in_mm.yaml").read_text()
    found = output("check", "check", "-", text=text)
    assert found["valid"] is True and {warning["severity"] for warning in found["diagnostics"]} == {"warning"}
    assert {warning["file"] for warning in found["diagnostics"]} == {"standard input"}
    assert "W005" in {warning["code"] for warning in found["diagnostics"]}
    assert output("check", "check", "-", "--strict", code=1, text=text)["valid"] is False


def test_a_schema_notices_another_key(output, crane):
    schema = json.loads(crane("schema", "statics")[1])
    found = output("statics", "statics", "knuckle_boom")
    for wrong in ({**found, "colour": "red"}, {key: value for key, value in found.items() if key != "stable"}, {**found, "stable": "yes"}):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(wrong, schema, cls=jsonschema.Draft202012Validator)


def test_standard_input_for_every_analysis(crane, tmp_path):
    text = (
        "format: 1\nname: pendulum\nlinks:\n"
        "  - {name: rod, joint: {revolute: {axis: y}}, mass: 2, com: [0, 0, -1.5], inertia: {Ixx: 0.001, Iyy: 0.05, Izz: 0.05}}\n"
    )
    for arguments in (["check", "-"], ["statics", "-"], ["modes", "-"], ["explain", "-"], ["generate", "-"], ["simulate", "-", "--out", tmp_path]):
        code, out, err = crane(*arguments, text=text)
        assert code == 0 and "rod" in out or "pendulum" in out, err
    code, _, err = crane("statics", "-", text="")
    assert code != 0 and "standard input" in err
