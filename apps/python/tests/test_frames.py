"""Frames on links against transformations of the bodies, whose derivatives the package has."""

import xml.etree.ElementTree as ET

import numpy as np
import pytest

import crane
from conftest import PENDULUM

# An element of a beam with a symmetric joint of sections, a rigid link beyond it, a branch.
CASES = [
    ("eight_link_flexible", {"middle": ("boom", [1.3, 0.1, -0.2]), "tool": ("grapple", [0.1, -0.2, -0.5])}, ["boom_1", "grapple"]),
    ("two_arms", {"lamp": ("lamp", [0.2, 0.1, 0.3])}, ["lamp"]),
    ("knuckle_boom", {"hook": "hook"}, ["hook"]),
]


def at_random(c, count):
    generator = np.random.default_rng(5)
    return c.statics().q + 0.2 * generator.normal(size=(count, c.n)), generator.normal(size=(count, c.n)), generator.normal(size=(count, c.n))


@pytest.mark.parametrize("name, places, bodies", CASES)
def test_frames_are_those_of_their_bodies(name, places, bodies):
    c = crane.load(name)
    frames = c.frames(places)
    q, v, a = at_random(c, 3)
    poses, jacobians = frames.poses(q), frames.jacobians(q)
    indices = [[body["name"] for body in c.info["bodies"]].index(body) for body in bodies]
    transforms, derivatives = c.transforms(q)[:, indices], c.transform_derivatives(q)[:, indices]
    # Axes are those of the bodies; differences of points some metres away round to 1e-15.
    np.testing.assert_allclose(poses[..., :3, :3], transforms[..., :3, :3], atol=1e-13)
    # ∂R/∂q_j = [ω_j] R, and the origin moves with its body.
    turning = derivatives[..., :3, :3] @ np.swapaxes(transforms[..., None, :3, :3], -1, -2)
    omega = np.stack([turning[..., 2, 1], turning[..., 0, 2], turning[..., 1, 0]], axis=-2)
    np.testing.assert_allclose(jacobians[..., 3:, :], omega, atol=1e-12)
    local = np.einsum("...ki,...k->...i", transforms[..., :3, :3], poses[..., :3, 3] - transforms[..., :3, 3])
    moved = np.einsum("...jik,...k->...ij", derivatives[..., :3, :3], local) + np.swapaxes(derivatives[..., :3, 3], -1, -2)
    np.testing.assert_allclose(jacobians[..., :3, :], moved, atol=1e-11)
    twists = np.einsum("...ij,...j->...i", jacobians, v[:, None])
    np.testing.assert_allclose(frames.velocities(q, v), twists, atol=1e-11)


@pytest.mark.parametrize("name, places, bodies", CASES)
def test_accelerations_are_rates_of_twists(name, places, bodies):
    c = crane.load(name)
    frames = c.frames(places)
    q, v, a = at_random(c, 3)
    found = frames.accelerations(q, v, a)
    # Central differences along the motion q + v h + a h²/2: their error is h² times third derivatives, some 100, and rounding over h.
    h = 1e-5
    later, before = (frames.velocities(q + s * h * v + h**2 / 2 * a, v + s * h * a) for s in (1, -1))
    np.testing.assert_allclose((later - before) / (2 * h), found, rtol=1e-6, atol=1e-6)
    own = np.einsum("...ij,...j->...i", frames.jacobians(q), a[:, None])
    np.testing.assert_allclose(found - frames.accelerations(q, v), own, atol=1e-10)


def test_the_parameters_and_inputs_are_those_of_the_crane():
    c = crane.load("knuckle_boom", payload=123.0)
    frames = c.frames({"hook": "hook"})
    assert frames._crane.parameters == c.parameters
    # A point of the spec, without the other points of a frame.
    q = c.statics().q
    assert frames.poses(q).shape == (1, 4, 4)


def test_places_that_make_no_sense_are_refused():
    c = crane.load("knuckle_boom")
    with pytest.raises(ValueError, match="write \\(link, \\[x, y, z\\]\\)"):
        c.frames({"tool": ("hook", [0.0, 1.0])})
    with pytest.raises(ValueError, match="no link or frame .hok.: did you mean hook"):
        c.frames({"tool": "hok"})


def test_a_regressor_times_parameters_is_inverse_dynamics():
    """A rod of the fixture's numbers, moments moved to its pin by hand, with gravity that is not upright; 1e-12 of the torques is rounding."""
    c = crane.load("pendulum.yaml", text=PENDULUM + "gravity: [1.5, -0.5, -9]\n")
    rng = np.random.default_rng(2)
    q, v, a = rng.normal(size=(3, 2, 5, 1))
    matrix = c.frames({"rod": "rod"}).regressor(q, v, a)
    assert matrix.shape == (2, 5, 1, 10)
    parameters = [2.0, 0.0, 0.0, 2.0 * -1.5, 0.001 + 2.0 * 1.5**2, 0.0, 0.0, 0.05 + 2.0 * 1.5**2, 0.0, 0.05]
    np.testing.assert_allclose(matrix @ parameters, c.inverse_dynamics(q, v, a), rtol=1e-12)


def test_a_regressor_is_what_a_mass_on_a_flexible_crane_adds():
    """300 kg more of the log, whose centre is 1 m below the grapple: of forces up to 1e6 N m, the difference rounds to 1e-10 of the largest."""
    c, more = crane.load("eight_link_flexible"), crane.load("eight_link_flexible", load_mass=800.0)
    q, v, a = at_random(c, 4)
    log = np.zeros(10)
    log[[0, 4, 7, 9]] = 300.0 * np.array([1.0, 0.148324**2, 1.15931**2, 1.15931**2])
    added = more.inverse_dynamics(q, v, a) - c.inverse_dynamics(q, v, a)
    np.testing.assert_allclose(c.frames({"log": ("grapple", [0.0, 0.0, 1.0])}).regressor(q, v, a) @ log, added, atol=1e-10 * np.abs(added).max())


@pytest.mark.parametrize("name", ["knuckle_boom", "eight_link_rigid"])
def test_regressors_identify_cranes(name):
    """Parameters by least squares from states at random predict other states: all that is rigid is a sum of columns, whatever the spec has."""
    c = crane.load(name)
    frames = c.frames({body["link"]: body["link"] for body in c.info["bodies"]})
    (q, v, a), others = at_random(c, 60), np.random.default_rng(6).normal(size=(3, 8, c.n))
    found = np.linalg.lstsq(np.concatenate(frames.regressor(q, v, a)), np.concatenate(c.inverse_dynamics(q, v, a)), rcond=None)[0]
    expected = c.inverse_dynamics(*others)
    np.testing.assert_allclose(frames.regressor(*others) @ found, expected, atol=1e-9 * np.abs(expected).max())


# Axes that lie along no axis of a frame, links that fixed joints merge, also with the ground, and a name that no spec can have for a link.
ROBOT = """<robot name="arm">
  <link name="base"/>
  <link name="Stand"/>
  <link name="upper"><inertial><origin xyz="0.4 0 0.1"/><mass value="6"/><inertia ixx="0.3" iyy="0.4" izz="0.5" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="bracket"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="wrist-2 link"><inertial><mass value="2"/><inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="tool0"/>
  <link name="camera"/>
  <joint name="floor" type="fixed"><parent link="base"/><child link="Stand"/><origin xyz="0.1 0.2 1" rpy="0.3 -0.2 0.5"/></joint>
  <joint name="shoulder" type="revolute"><parent link="Stand"/><child link="upper"/><origin xyz="0 0 0.2" rpy="0 1 0"/><axis xyz="0 -1 0"/></joint>
  <joint name="plate" type="fixed"><parent link="upper"/><child link="bracket"/><origin xyz="0.3 0 0.1" rpy="0.1 0.2 0.3"/></joint>
  <joint name="wrist" type="continuous"><parent link="bracket"/><child link="wrist-2 link"/><origin xyz="0.5 0 0" rpy="0 0 -1.2"/><axis xyz="1 2 -2"/></joint>
  <joint name="flange" type="fixed"><parent link="wrist-2 link"/><child link="tool0"/><origin xyz="0 0.1 0.2" rpy="1 -0.4 2"/></joint>
  <joint name="mount" type="fixed"><parent link="upper"/><child link="camera"/><origin xyz="0.05 0 0.2" rpy="-1.1 0 0"/></joint>
</robot>"""


def posed(rotation, at):
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation, at
    return pose


def about(axis, angle):
    """Rodrigues' formula."""
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def of_urdf(text, angles):
    """Poses of all links in the world by the names of the file, with the joints, by name or in the order of the file, at angles."""
    robot = ET.fromstring(text)
    if not isinstance(angles, dict):
        angles = dict(zip((joint.get("name") for joint in robot.iter("joint") if joint.get("type") != "fixed"), angles, strict=True))
    poses = {"base": np.eye(4)}
    for joint in robot.iter("joint"):
        origin = joint.find("origin")
        roll, pitch, yaw = (float(word) for word in origin.get("rpy", "0 0 0").split())
        fixed = about([0, 0, 1], yaw) @ about([0, 1, 0], pitch) @ about([1, 0, 0], roll)
        axis = joint.find("axis")
        turned = np.eye(3) if axis is None else about([float(word) for word in axis.get("xyz").split()], angles[joint.get("name")])
        place = posed(fixed @ turned, [float(word) for word in origin.get("xyz").split()])
        poses[joint.find("child").get("link")] = poses[joint.find("parent").get("link")] @ place
    return poses


def test_links_of_a_robot_are_where_its_file_has_them():
    """Some ten products of numbers of size 1, of which the spec has 15 digits: 1e-14."""
    robot = crane.from_urdf(ROBOT)
    q = np.random.default_rng(7).uniform(-3, 3, (5, 2))
    expected = [of_urdf(ROBOT, row) for row in q]
    names = list(expected[0])
    frames = robot.frames(names)
    assert frames.names == tuple(names)
    wanted = np.array([[row[name] for name in names] for row in expected])
    np.testing.assert_allclose(frames.poses(q), wanted, atol=1e-13)
    np.testing.assert_array_equal(robot.frames("tool0").poses(q), frames.poses(q)[:, [names.index("tool0")]])
    # What stands on the ground does not move.
    v, a = np.random.default_rng(8).normal(size=(2, 5, 2))
    standing = [names.index("base"), names.index("Stand")]
    for moves in (frames.velocities(q, v), frames.accelerations(q, v, a), frames.jacobians(q).sum(axis=-1)):
        assert not moves[:, standing].any() and moves.any()
    # A place in the axes of the file, and the same as a point of interest.
    place = frames.poses(q)[:, names.index("upper")] @ [0.4, 0.0, 0.1, 1.0]
    np.testing.assert_allclose(robot.frames({"centre": ("upper", [0.4, 0.0, 0.1])}).poses(q)[:, 0, :3, 3], place[:, :3], atol=1e-13)
    points = crane.load("robot.yaml", text=robot._changed({"points": [{"name": "centre", "frame": "upper", "at": [0.4, 0, 0.1]}, {"name": "tip", "frame": "tool0"}]}))
    found = points.points(q)[:, [points.info["points"].index(name) for name in ("centre", "tip")]]
    np.testing.assert_allclose(found, np.stack([place[:, :3], wanted[:, names.index("tool0"), :3, 3]], axis=1), atol=1e-13)


def test_bodies_and_sites_of_mjcf_are_where_the_file_has_them():
    """A body that turns about an anchor beside its frame, from `ref`: MuJoCo's documentation of joints, with matrices by hand."""
    robot = crane.from_mjcf(
        """<mujoco><compiler angle="radian"/><worldbody><body name="Post" pos="0 0 1">
        <body name="arm" pos="0.1 0 0.2" euler="0.3 0 0"><joint name="hinge" axis="1 1 0" pos="0 0 0.1" ref="0.5"/>
        <inertial pos="0.2 0 0" mass="1" diaginertia="0.1 0.1 0.1"/>
        <site name="grip" pos="0.3 0 0" euler="0 0.4 0"/><body name="hand" pos="0.4 0 0"><site name="tip" pos="0 0 0.1"/></body></body></body></worldbody></mujoco>"""
    )
    angle, anchor = 1.3, np.array([0.0, 0.0, 0.1])
    turned = about([1, 1, 0], angle - 0.5)
    arm = posed(about([1, 0, 0], 0.3), [0.1, 0.0, 1.2]) @ posed(turned, anchor - turned @ anchor)
    hand = arm @ posed(np.eye(3), [0.4, 0, 0])
    expected = {
        "world": np.eye(4),
        "Post": posed(np.eye(3), [0, 0, 1]),
        "arm": arm,
        "hand": hand,
        "grip": arm @ posed(about([0, 1, 0], 0.4), [0.3, 0, 0]),
        "tip": hand @ posed(np.eye(3), [0, 0, 0.1]),
    }
    np.testing.assert_allclose(robot.frames(list(expected)).poses([angle]), list(expected.values()), atol=1e-13)


def test_frames_go_with_a_link_that_bends():
    """An unloaded beam lies where the link was. The frame of the link is turned by half a turn about z."""
    robot = crane.from_urdf(ROBOT)
    tube = {"tube": {"diameter": 0.06, "thickness": 0.002}}
    with pytest.warns(UserWarning, match="bracket"):
        bending = robot.with_beam("upper", sections=3, material={"E": 7e10, "G": 2.6e10, "density": 2700}, section=tube, to=(-0.5, 0.1, 0.2))
    links = {frame["name"]: frame["link"] for frame in bending.info["frames"]}
    assert links["camera"] == links["bracket"] == "upper_beam"
    q, whole = np.array([0.7, -0.4]), np.zeros(bending.n)
    whole[[bending.coordinates.index(name) for name in robot.coordinates]] = q
    names = ["upper", "bracket", "camera", "tool0"]
    np.testing.assert_allclose(bending.frames(names).poses(whole), robot.frames(names).poses(q), atol=1e-13)


def test_frames_in_the_world_follow_live_parameters():
    text = PENDULUM.replace("parameters: {", "parameters: {height: {value: 2, unit: m}, ")
    c = crane.load("pendulum.yaml", text=text + "frames: [{name: mast top, transform: {translation: [0, 0, height], rotation: {x: 90 deg}}}]\n")
    poses = c.replace(height=np.array([1.0, 3.0])).frames({"top": ("mast top", [0, 0.5, 0]), "rod": "rod"}).poses([0.0])
    np.testing.assert_array_equal(poses[:, 0, :3, 3], [[0, 0, 1.5], [0, 0, 3.5]])
    np.testing.assert_array_equal(poses[0, 0, :3, 2], [0, -1, 0])


# Of two branches, of which the file describes the wrist between the finger and its tip. The tip follows the finger, backwards and from where it is not at zero.
FINGER = """<link name="finger"><inertial><mass value="0.1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="tip"><inertial><mass value="0.1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="finger 1" type="revolute"><parent link="upper"/><child link="finger"/><origin xyz="0 0.1 0" rpy="0.2 0 0"/><axis xyz="0 0 -1"/></joint>"""
TIP = """<joint name="finger 2" type="revolute"><parent link="finger"/><child link="tip"/><origin xyz="0 -0.1 0"/><axis xyz="0 1 1"/>
    <mimic joint="finger 1" multiplier="-0.5" offset="0.25"/></joint>"""
HAND = ROBOT.replace('<joint name="mount"', f'{TIP}<joint name="mount"').replace('<joint name="wrist"', f'{FINGER}<joint name="wrist"')


def test_joints_have_the_names_order_sign_and_zero_of_the_file():
    """Links are where the file has them with its joints at the positions asked; fixed joints are none. Products of some ten matrices round to 1e-14."""
    robot = crane.from_urdf(HAND)
    names = ("shoulder", "finger 1", "wrist", "finger 2")
    positions = np.random.default_rng(9).uniform(-1, 1, (3, 5))
    given = dict(zip(("wrist", "finger 1", "shoulder"), positions, strict=True))
    q = robot.coordinates_of(given)
    assert q.shape == (5, robot.n)
    state = robot.joint_states(q, np.arange(robot.n))
    assert state.name == names
    # The order of q is another one, so that the test can fail.
    assert [joint["coordinate"] for joint in robot.info["joints"]] != robot.coordinates
    expected = {**given, "finger 2": 0.25 - 0.5 * given["finger 1"]}
    np.testing.assert_allclose(state.position, np.stack([expected[name] for name in names], axis=-1), atol=1e-14)
    rates = {joint["name"]: robot.coordinates.index(joint["coordinate"]) for joint in robot.info["joints"]}
    np.testing.assert_array_equal(state.velocity, np.broadcast_to([rates[name] for name in names], (5, 4)))
    links = [link.get("name") for link in ET.fromstring(HAND).iter("link")]
    for row in range(5):
        poses = of_urdf(HAND, dict(zip(names, state.position[row], strict=True)))
        np.testing.assert_allclose(robot.frames(links).poses(q[row]), [poses[link] for link in links], atol=1e-13)
    # The one that follows tells where the other one is.
    np.testing.assert_allclose(robot.coordinates_of({"finger 2": 0.5, "shoulder": 1.0}), robot.coordinates_of({"finger 1": -0.5, "shoulder": 1.0}), atol=1e-14)
    # Those that are not given stay.
    np.testing.assert_array_equal(robot.coordinates_of({"wrist": 0.0}, q)[:, :3], q[:, :3])
    with pytest.raises(ValueError, match="no pose has these positions: .* open by 0.5"):
        robot.coordinates_of({"finger 1": 0.0, "finger 2": 0.75})
    with pytest.raises(ValueError, match="there is no joint 'elbow': write one of shoulder, finger 1"):
        robot.coordinates_of({"elbow": 0.0})
    with pytest.raises(ValueError, match="q has 3 numbers in its last axis, but arm has 4 coordinates"):
        robot.joint_states(np.zeros(3))


def test_held_joints_stand_and_joints_of_several_axes_are_one_per_axis():
    held = crane.from_urdf(HAND, fix=["finger 2"])
    np.testing.assert_allclose(held.joint_states([0.1, 0.2]).position, [0.1, 0.5, 0.2, 0.0], atol=1e-15)
    with pytest.raises(ValueError, match="'finger 1' is held at 0.5"):
        held.coordinates_of({"finger 1": 0.0})
    np.testing.assert_array_equal(held.coordinates_of({"finger 1": 0.5, "wrist": 0.3}), [0.0, 0.3])
    heavy = '<link name="Stand"><inertial><mass value="9"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    floating = HAND.replace('name="floor" type="fixed"', 'name="floor" type="floating"').replace('<link name="Stand"/>', heavy)
    names = crane.from_urdf(floating).joint_states(np.zeros(10)).name
    assert names[:7] == ("floor_x", "floor_y", "floor_z", "floor_psi", "floor_theta", "floor_phi", "shoulder")


def test_joints_of_a_crane_are_its_coordinates(knuckle):
    q = np.arange(knuckle.n) / 8
    state = knuckle.joint_states(q)
    assert state.name == tuple(knuckle.coordinates) and not state.velocity.any()
    np.testing.assert_array_equal(state.position, q)
    assert crane.load("knuckle_boom").coordinates_of(dict(zip(state.name, q, strict=True))).tolist() == q.tolist()
    named = crane.load("pendulum.yaml", text=PENDULUM + "joints: [{name: Pin 1, coordinate: rod_theta, at: 0.5}]\n")
    assert named.joint_states([0.25]).position == [0.75] and named.coordinates_of({"Pin 1": 0.75}) == [0.25]
