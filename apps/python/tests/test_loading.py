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


GRIPPER = """<robot name="gripper"><link name="base"/><link name="palm"><inertial><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1"/></inertial></link>
<link name="left"><inertial><origin xyz="0 0.02 0.05"/><mass value="0.2"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4"/></inertial></link>
<link name="right"><inertial><origin xyz="0 -0.02 0.05"/><mass value="0.3"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4"/></inertial></link>
<joint name="wrist" type="revolute"><parent link="base"/><child link="palm"/><axis xyz="0 1 0"/></joint>
<joint name="one" type="prismatic"><parent link="palm"/><child link="left"/><axis xyz="0 1 0"/></joint>
<joint name="two" type="prismatic"><parent link="palm"/><child link="right"/><axis xyz="0 1 0"/><mimic joint="one" multiplier="-1" offset="0.01"/></joint></robot>"""


def test_a_joint_that_mimics_another_follows_it_exactly_in_every_way_to_move():
    # The fingers move against each other, along y, about which the wrist turns: (m₁ + m₂) ÿ = g_y (m₁ − m₂).
    text = crane.from_urdf(GRIPPER).spec + "gravity: [0, 3, -9.81]\n"
    gripper = crane.load("gripper.yaml", text=text)
    q, v = np.array([[0.3, 0.01, 0.0], [-0.2, 0.02, -0.01]]), np.array([[0.5, 0.1, -0.1], [0.0, -0.2, 0.2]])
    accelerations = gripper.forward_dynamics(q, v)
    expected = 3 * (0.2 - 0.3) / (0.2 + 0.3)
    np.testing.assert_allclose(accelerations[:, 1:], [[expected, -expected]] * 2, rtol=0, atol=1e-13)
    run = gripper.simulate(q=[0, 0.005, 0.005], duration=0.2, output=0.1)
    # F on the follower: m₂ (ÿ₂ − g_y) = −F.
    np.testing.assert_allclose(run["right_y_follows_force"], 0.3 * (3 + expected), rtol=0, atol=1e-6)
    stepped = gripper.vector_simulation(9, q=np.repeat(q[:1], 9, axis=0), v=np.repeat(v[:1], 9, axis=0))
    stepped.step(0.1)
    np.testing.assert_allclose(stepped.q[:, 2], 0.01 - stepped.q[:, 1], rtol=0, atol=1e-15)
    with pytest.raises(ValueError, match="rigid coupling right_y_follows.*give the coupling a `stiffness` instead of `rigid: true`"):
        gripper.forward_dynamics_derivatives(q, v)


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


def test_drives_are_described_where_parameters_put_them():
    drive = "drives: [{coordinate: rod_theta, stiffness: 1e4, motion: {hold: angle}}]"
    text = PENDULUM.replace("bob: {value", "angle: {value: 0.1, unit: rad}, bob: {value") + drive
    plain = crane.load("p.yaml", text=text)
    assert [c.info["drives"][0]["start"] for c in (plain, plain.replace(angle=0.4))] == [0.1, 0.4]


def test_a_crane_goes_through_a_pickle(flexible):
    changed = flexible.replace(load_mass=np.array([10.0, 20.0]))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        copy = pickle.loads(pickle.dumps(changed))
    assert type(copy) is crane.Crane
    np.testing.assert_array_equal(copy.mass_matrix(flexible.guess), changed.mass_matrix(flexible.guess))


def test_the_stubs_say_what_the_module_says():
    """Functions, arguments and docstrings of crane/_native.pyi are those that Python finds in the native module."""
    import ast
    import inspect
    from pathlib import Path

    from crane import _native

    def names(node):
        return {child.name: child for child in node.body if isinstance(child, ast.FunctionDef | ast.ClassDef)}

    module = names(ast.parse(Path(_native.__file__).with_name("_native.pyi").read_text()))
    assert set(module) == set(_native.__all__)
    for owner, stubs in [(_native, module), *((getattr(_native, name), names(module[name])) for name in ("Crane", "Motions"))]:
        assert {name for name in vars(owner) if not name.startswith("__")} == {name for name in stubs if not name.startswith("__")}
        for name, stub in stubs.items():
            native = inspect.getattr_static(owner, name)
            if not name.startswith("__"):
                assert ast.get_docstring(stub) == inspect.getdoc(native), name
            if callable(native) and isinstance(stub, ast.FunctionDef) and name != "__new__":
                said = [argument.arg for argument in stub.args.posonlyargs + stub.args.args + stub.args.kwonlyargs]
                assert said == list(inspect.signature(native).parameters), name


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


# Two links and a hand on the second; the third axis is that of the wrist.
TWO_LINKS = """<robot name="two"><link name="base"/>
<link name="upper"><inertial><origin xyz="0 0 0.2"/><mass value="3"/><inertia ixx="0.05" iyy="0.05" izz="0.004"/></inertial></link>
<link name="fore"><inertial><origin xyz="0 0 0.15"/><mass value="2"/><inertia ixx="0.03" iyy="0.03" izz="0.002"/></inertial></link>
<link name="hand"><inertial><origin xyz="0 0 0.05"/><mass value="0.5"/><inertia ixx="0.001" iyy="0.001" izz="5e-4"/></inertial></link>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.3"/><axis xyz="0 1 0"/></joint>
<joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="0 0.1 0.4"/><axis xyz="0 1 0"/></joint>
<joint name="wrist" type="revolute"><parent link="fore"/><child link="hand"/><origin xyz="0.2 -0.1 0.3" rpy="0.1 0.2 0.3"/>
<axis xyz="1 0 0"/></joint></robot>"""
# The link `fore` as a beam, written by hand: from its frame to (0.2, -0.1, 0.3).
BY_HAND = """format: 1
name: by_hand
materials: {alloy: {E: 7e10, G: 2.6e10, density: 2700}}
links:
  - {name: upper, placement: {transform: {translation: [0, 0, 0.3]}}, joint: {revolute: {axis: y}}, mass: 3, com: [0, 0, 0.2], inertia: {Ixx: 0.05, Iyy: 0.05, Izz: 0.004}}
  - {name: fore, placement: {transform: {translation: [0, 0.1, 0.4]}}, joint: {revolute: {axis: y}}}
  - name: fore_beam
    placement: {transform: {rotation: [{z: PSI}, {y: THETA}]}}
    beam: {length: LENGTH, sections: 4, material: alloy, section: {tube: {diameter: 0.04, thickness: 0.002}}}
  - name: hand
    placement: {transform: {rotation: [{y: BACK}, {z: ACROSS}, {z: 0.3}, {y: 0.2}, {x: 0.1}]}}
    joint: {revolute: {axis: x}}
    mass: 0.5
    com: [0, 0, 0.05]
    inertia: {Ixx: 0.001, Iyy: 0.001, Izz: 5e-4}
"""
ALLOY = {"E": 7e10, "G": 2.6e10, "density": 2700}


def test_a_link_of_a_robot_bends():
    robot = crane.from_urdf(TWO_LINKS)
    bending = robot.with_beam("fore", sections=4, material=ALLOY, section={"tube": {"diameter": 0.04, "thickness": 0.002}})
    assert [name for name in bending.coordinates if "beam" not in name] == robot.coordinates
    psi, theta, length = np.arctan2(-0.1, 0.2), np.arctan2(-0.3, np.hypot(0.2, 0.1)), np.sqrt(0.14)
    numbers = {"PSI": psi, "THETA": theta, "BACK": -theta, "ACROSS": -psi, "LENGTH": length}
    text = BY_HAND
    for name, number in numbers.items():
        text = text.replace(name, repr(float(number)))
    by_hand = crane.load("by_hand.yaml", text=text)
    assert bending.coordinates == by_hand.coordinates
    q = 0.1 * np.sin(1.0 + np.arange(bending.n))
    v = 0.1 * np.cos(2.0 + np.arange(bending.n))
    for one, other in ((bending.mass_matrix(q), by_hand.mass_matrix(q)), (bending.forward_dynamics(q, v), by_hand.forward_dynamics(q, v))):
        # Rounding of the angles of the placement, through a mass matrix of condition 1e6.
        assert np.allclose(one, other, rtol=1e-9, atol=1e-9 * np.abs(other).max())
    # Upright, the robot falls: some squares are negative.
    squares = [c.modes(np.zeros(c.n)).omega_squared for c in (bending, by_hand)]
    assert np.allclose(*squares, rtol=1e-8)
    # Undeformed, the hand is where it was.
    straight = np.zeros(bending.n)
    for index, name in enumerate(robot.coordinates):
        straight[bending.coordinates.index(name)] = 0.2 + 0.1 * index
    rigid = robot.frames({"hand": "hand"}).poses([0.2, 0.3, 0.4])
    assert np.allclose(bending.frames({"hand": "hand"}).poses(straight), rigid, atol=1e-12)


def test_combinations_are_cranes_of_their_own():
    text = PENDULUM + "combinations: [{name: lifting, weight: 1.2, masses: {bob: 1.5}}]\n"
    plain = crane.load("p.yaml", text=text)
    assert plain.combinations == ["lifting"]
    lifting = plain.combined("lifting")
    assert lifting.parameters == plain.parameters
    q = np.full(plain.n, 0.3)
    weight = [c.static_residual(q)[0] for c in (plain, lifting)]
    assert np.isclose(weight[1], 1.5 * weight[0], rtol=1e-14)
    with pytest.raises(ValueError, match="lifting"):
        plain.combined("test_load")


def test_links_that_cannot_bend_say_why():
    robot = crane.from_urdf(TWO_LINKS)
    beam = {"sections": 2, "material": ALLOY, "section": {"circle": {"diameter": 0.02}}}
    with pytest.raises(ValueError, match="there is no link `elbow`; the links are upper, fore, hand"):
        robot.with_beam("elbow", **beam)
    with pytest.raises(ValueError, match="give the point `to` which the beam leads"):
        robot.with_beam("hand", **beam)
    with pytest.raises(ValueError, match=r"`hand` is neither a link that goes on from `upper` \(fore\) nor a point"):
        robot.with_beam("upper", to="hand", **beam)
    with pytest.raises(ValueError, match="`fore_beam` bends already"):
        robot.with_beam("fore", **beam).with_beam("fore_beam", **beam)
    with pytest.raises(crane.SpecError, match="E010"):
        robot.with_beam("fore", thickness=3, **beam)
    # A tool that the file fixes to a link is part of its mass, and a place where its beam may end.
    tool = '<link name="tool"><inertial><mass value="2"/><origin xyz="0 0 0.1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    joint = '<joint name="flange" type="fixed"><parent link="hand"/><child link="tool"/><origin xyz="0 0 0.3"/></joint>'
    carrying = crane.from_urdf(TWO_LINKS.replace("</robot>", f"{tool}{joint}</robot>"))
    # The hand has 0.5 kg, the tool 2 kg, 0.3 m of a rod of 20 mm 0.25 kg.
    with pytest.warns(UserWarning, match=r"what is fixed to it \(tool\), and weighs 2\.24\d kg less"):
        bending = carrying.with_beam("hand", to="tool", **beam)
    assert np.allclose(bending.frames("tool").poses(np.zeros(bending.n)), carrying.frames("tool").poses(np.zeros(carrying.n)), atol=1e-12)
    # A hand that bends has its end at a point.
    assert robot.with_beam("hand", to=[0, 0, 0.1], **beam).n == robot.n + 6
