"""Specs: names, files, text, mistakes, warnings; what a crane says about itself; copies."""

import pickle
import warnings

import crane
import numpy as np
import pytest

from conftest import PENDULUM


def test_shipped_cranes_load_by_name():
    assert "eight_link_flexible" in crane.shipped()
    for name in crane.shipped():
        assert crane.load(name).name == name


def test_a_file_and_its_text_are_the_same_crane(tmp_path, pendulum):
    path = tmp_path / "pendulum.yaml"
    path.write_text(PENDULUM)
    from_file = crane.load(path, bob=2.0)
    assert from_file.spec_hash == pendulum.spec_hash
    # m g l sin φ at φ = 0.3, about −y: 2 · 9.81 · 1.5 sin 0.3.
    torque = from_file.static_residual([0.3])[0]
    assert abs(abs(torque) - 2 * 9.81 * 1.5 * np.sin(0.3)) < 1e-12


def test_mistakes_are_drawn_with_place_and_remedy():
    with pytest.raises(crane.SpecError) as caught:
        crane.load("bad.yaml", text=PENDULUM.replace("mass: bob", "mass: -3").replace("revolute", "revolut"))
    message = str(caught.value)
    assert "bad.yaml:" in message and "revolut" in message and "help" in message, message
    assert caught.value.codes and all(code.startswith("E") for code in caught.value.codes)


def test_a_name_that_is_nothing():
    with pytest.raises(FileNotFoundError, match="there is no crane `eight_link`.*eight_link_rigid"):
        crane.load("eight_link")
    with pytest.raises(FileNotFoundError):
        crane.load("nowhere.yaml")


def test_what_is_implausible_is_a_warning():
    with pytest.warns(crane.SpecWarning, match="W0"):
        crane.load("thin.yaml", text=PENDULUM.replace("Iyy: 0.05, Izz: 0.05", "Iyy: 0.05, Izz: 0.0515"))


ROBOT = """<robot name="arm"><link name="base"/>
<link name="upper"><visual/><inertial><origin xyz="0.5 0 0"/><mass value="2"/><inertia ixx="0.1" iyy="0.2" izz="0.2"/></inertial></link>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/></joint></robot>"""


def test_robots_load_from_files_and_texts(tmp_path):
    for name in ("arm.urdf", "ARM.URDF"):
        (tmp_path / name).write_text(ROBOT)
        arm = crane.load(tmp_path / name)
        # I + m r² about y.
        assert abs(arm.mass_matrix([0.3])[0, 0] - (0.2 + 2 * 0.25)) < 1e-15
    assert arm.notes == ["Left out, shapes and colours: <visual>."]
    assert pickle.loads(pickle.dumps(arm)).notes == arm.notes
    assert crane.from_urdf(ROBOT).mass_matrix([0.3])[0, 0] == arm.mass_matrix([0.3])[0, 0]
    assert crane.load("knuckle_boom").notes == []
    body = "<body name='a'><joint axis='0 1 0'/><inertial pos='0.5 0 0' mass='2' diaginertia='0.1 0.2 0.2'/></body>"
    (tmp_path / "body.xml").write_text(f"<mujocoinclude>{body}</mujocoinclude>")
    (tmp_path / "scene.xml").write_text("<mujoco><worldbody><include file='body.xml'/></worldbody></mujoco>")
    for robot in (crane.load(tmp_path / "scene.xml"), crane.from_mjcf(f"<mujoco><worldbody>{body}</worldbody></mujoco>")):
        assert abs(robot.mass_matrix([0.3])[0, 0] - 0.7) < 1e-15
    with pytest.raises(crane.SpecError, match="U012"):
        crane.from_urdf(ROBOT, fix=["shoulder"])
    impossible = ROBOT.replace('iyy="0.2" izz="0.2"', 'iyy="0.2" izz="0.9"')
    with pytest.raises(crane.SpecError, match="E051"):
        crane.from_urdf(impossible)
    assert "Repaired" in crane.from_urdf(impossible, repair=True).notes[-1]
    with pytest.raises(FileNotFoundError):
        crane.load("nowhere.urdf")


def test_the_package_has_a_version():
    assert crane.__version__.count(".") == 2


def test_names_and_units(flexible):
    info = flexible.info
    assert len(info["coordinates"]) == flexible.n == 25
    assert info["coordinates"][0] == {"name": "truck_x", "unit": "m", "force_unit": "N", "role": "base"}
    assert flexible.parameters["load_mass"] == flexible.replace().parameters["load_mass"]
    assert "load_mass" in repr(flexible)
    assert flexible.replace(load_mass=[1.0, 2.0]).shape == [2]


def test_a_crane_goes_through_a_pickle(flexible):
    changed = flexible.replace(load_mass=np.array([10.0, 20.0]))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        copy = pickle.loads(pickle.dumps(changed))
    assert type(copy) is crane.Crane
    np.testing.assert_array_equal(copy.mass_matrix(flexible.guess), changed.mass_matrix(flexible.guess))


def test_the_stubs_say_what_the_module_says():
    """Functions, arguments and docstrings of crane/_native.pyi are those of the native module."""
    import ast
    import inspect
    from pathlib import Path

    from crane import _native

    tree = ast.parse(Path(_native.__file__).with_name("_native.pyi").read_text())
    classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
    stubs = {node.name: node for node in classes["Crane"].body if isinstance(node, ast.FunctionDef) and node.name != "__new__"}
    native = {name for name in vars(_native.Crane) if not name.startswith("__")}
    assert set(stubs) == native
    for name, stub in stubs.items():
        if any(isinstance(decorator, ast.Name) and decorator.id == "property" for decorator in stub.decorator_list):
            continue
        function = getattr(_native.Crane, name)
        said = [argument.arg for argument in stub.args.posonlyargs + stub.args.args + stub.args.kwonlyargs]
        assert said == list(inspect.signature(function).parameters), name
        if "(..." in (ast.get_docstring(stub) or ""):
            assert ast.get_docstring(stub) == inspect.getdoc(function), name


def test_a_text_extends_shipped_cranes_and_files(tmp_path, monkeypatch, knuckle):
    text = "format: 1\nextends: knuckle_boom\nname: mine\nparameters: {payload: {value: 123, unit: kg}}\n"
    mine = crane.load("mine.yaml", text=text)
    assert mine.name == "mine" and mine.parameters["payload"] == 123 and mine.n == knuckle.n
    np.testing.assert_array_equal(mine.mass_matrix(mine.guess), knuckle.replace(payload=123).mass_matrix(mine.guess))
    # What was assembled needs no files, and is not extended again.
    monkeypatch.chdir(tmp_path)
    (tmp_path / "base.yaml").write_text(PENDULUM)
    own = crane.load("own.yaml", text="format: 1\nextends: base.yaml\nname: own\n")
    (tmp_path / "base.yaml").unlink()
    for copied in (pickle.loads(pickle.dumps(own)), crane.load("again.yaml", text=own.spec)):
        assert copied.name == "own" and copied.spec_hash == own.spec_hash
    with pytest.raises(crane.SpecError, match="own.yaml"):
        crane.load("own.yaml", text="format: 1\nextends: base.yaml\nname: own\n")
