"""Frames on links against transformations of the bodies, whose derivatives the package has."""

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
    with pytest.raises(crane.SpecError, match="hok"):
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
