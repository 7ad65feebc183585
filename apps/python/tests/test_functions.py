"""Arrays in, arrays out: shapes, batches, laws of mechanics, bad rows."""

import crane
import numpy as np
import pytest
from crane import _native


def axes_of(words):
    """The extents of a result's axes, of a crane."""
    return lambda c: tuple(int(word) if word.isdigit() else c.n if word == "n" else len(c.info.get(word, ())) for word in words)


def arguments(states):
    """The arguments of functions by their names; the rates are also the accelerations."""
    t, q, v = states
    return {"t": t, "q": q, "v": v, "a": v}


# Every function of a state, its arguments, and the axes of its result: those of the table of quantities, and others.
FUNCTIONS = [(name, takes, axes_of(axes)) for name, takes, axes in _native.functions()] + [
    ("forward_dynamics_derivatives", "qvt", axes_of(["3", "n", "n"])),
    ("_small_motions", "q", axes_of(["3", "n", "n"])),
]


@pytest.mark.parametrize(("name", "takes", "axes"), FUNCTIONS)
def test_a_batch_is_its_rows_to_the_last_bit(flexible, states, name, takes, axes):
    given = arguments(states)
    function = getattr(flexible, name)
    batch = function(*(given[argument] for argument in takes))
    assert batch.shape == (7, *axes(flexible))
    for row in range(7):
        alone = function(*(given[argument][row] for argument in takes))
        assert alone.shape == axes(flexible)
        np.testing.assert_array_equal(batch[row], alone)


@pytest.mark.parametrize(("name", "takes", "axes"), FUNCTIONS)
def test_parameters_are_leading_axes_too(flexible, states, name, takes, axes):
    masses = np.array([0.0, 150.0, 700.0])
    given = {argument: values[:2, None] for argument, values in arguments(states).items()}
    batch = getattr(flexible.replace(load_mass=masses), name)(*(given[argument] for argument in takes))
    assert batch.shape == (2, 3, *axes(flexible))
    for row, mass in enumerate(masses):
        alone = getattr(flexible.replace(load_mass=mass), name)(*(given[argument][1, 0] for argument in takes))
        np.testing.assert_array_equal(batch[1, row], alone)


def test_the_equations_of_motion_hold(flexible, states):
    t, q, v = states
    a = flexible.forward_dynamics(q, v, t)
    forces = flexible.forces(q, v, t)
    # A q̈ = e + f, and inverse dynamics gives f back: the recursion and the mass matrix differ by rounding, cond(A) ε.
    scale = np.abs(forces).max()
    np.testing.assert_allclose(flexible.inverse_dynamics(q, v, a), forces, atol=1e-9 * scale)
    products = np.einsum("...ij,...j->...i", flexible.mass_matrix(q), a)
    np.testing.assert_allclose(products - flexible.bias(q, v), flexible.inverse_dynamics(q, v, a), atol=1e-12 * scale)


def test_jacobians_are_derivatives_of_positions(flexible, states):
    _, q, v = states
    jacobians = flexible.point_jacobians(q)
    np.testing.assert_allclose(np.einsum("...pij,...j->...pi", jacobians, v), flexible.point_velocities(q, v), atol=1e-12)
    # Central differences: errors of (1e-6)² times third derivatives of some metres, and rounding of 1e-16/1e-6.
    step = 1e-6 * np.eye(flexible.n)
    difference = (flexible.points(q[0] + step) - flexible.points(q[0] - step)) / 2e-6
    np.testing.assert_allclose(np.moveaxis(difference, 0, -1), jacobians[0], atol=1e-8)


def test_energies_and_powers_balance(flexible, states):
    """dE/dt = power of the drives − dissipation, along the motion that the accelerations make."""
    t, q, v = states
    a = flexible.forward_dynamics(q, v, t)
    h = 1e-6
    energy = [flexible.energies(q + s * h * v + s * s * h * h / 2 * a, v + s * h * a, t + s * h).total for s in (-1, 1)]
    rate = (energy[1] - energy[0]) / (2 * h)
    expected = flexible.drive_power(q, v, t) - flexible.dissipation(q, v, t)
    # The difference quotient has an error of h² ω² of the internal powers, with ω some 1e4 rad/s of the stiffest springs.
    scale = np.abs(flexible.forces(q, v, t) * v).sum(axis=-1)
    assert np.all(np.abs(rate - expected) < 1e-3 * scale)


def test_broadcasting_is_that_of_numpy(flexible, states):
    _, q, v = states
    assert flexible.bias(q[:, None], v[None, :3]).shape == (7, 3, 25)
    assert flexible.bias(q[0], v).shape == (7, 25)
    assert flexible.mass_matrix(q[:0]).shape == (0, 25, 25)
    assert flexible.points(q[None]).shape == (1, 7, 2, 3) or len(flexible.info["points"]) != 2
    with pytest.raises(ValueError, match="do not match"):
        flexible.bias(q, v[:3])


def test_anything_that_numpy_understands_is_taken(knuckle):
    q = knuckle.guess
    expected = knuckle.mass_matrix(q)
    for given in (list(q), tuple(q), q[::-1][::-1], np.asfortranarray(q), q.astype(int).astype(float) + (q - q.astype(int))):
        np.testing.assert_array_equal(knuckle.mass_matrix(given), expected)
    np.testing.assert_allclose(knuckle.mass_matrix(q.astype(np.float32)), expected, rtol=1e-5)


@pytest.mark.parametrize(
    ("given", "error", "words"),
    [
        ([0.0, 1.0], ValueError, "q has 2 numbers in its last axis, but knuckle_boom has 4 coordinates: "),
        (1.0, ValueError, "q is one number"),
        ("abcd", TypeError, "q holds text, not numbers"),
        ([0.0, np.nan, 0.0, 0.0], ValueError, r"q\[1\] \(.*\) is NaN, not a finite number"),
        ([0.0, 0.0, 0.0, np.inf], ValueError, r"q\[3\] \(.*\) is inf, not a finite number"),
    ],
)
def test_wrong_arguments_say_what_is_wrong(knuckle, given, error, words):
    with pytest.raises(error, match=words):
        knuckle.mass_matrix(given)


def test_bad_rows_are_named_or_nan(flexible, states):
    _, q, _ = states
    q = np.repeat(q[:, None], 3, axis=1)
    q[4, 2, 7] = np.nan
    q[6, 0, 0] = -np.inf
    with pytest.raises(ValueError, match=r"row \[4, 2\]: q\[7\] \(.*\) is NaN"):
        flexible.mass_matrix(q)
    with pytest.warns(crane.InvalidRowWarning, match=r"2 rows are NaN: row \[4, 2\].*row \[6, 0\]: q\[0\]"):
        matrices = flexible.mass_matrix(q, invalid="nan")
    bad = np.zeros((7, 3), dtype=bool)
    bad[4, 2] = bad[6, 0] = True
    assert np.isnan(matrices[bad]).all() and np.isfinite(matrices[~bad]).all()
    with pytest.raises(ValueError, match='write "raise" or "nan"'):
        flexible.mass_matrix(q, invalid="ignore")


def test_bad_parameters_are_named_or_nan(flexible):
    with pytest.raises(crane.ParameterError, match="must not be negative"):
        flexible.replace(load_mass=-1.0)
    with pytest.raises(crane.ParameterError, match=r"row \[1\]: .*E032"):
        flexible.replace(load_mass=[1.0, -1.0])
    with pytest.warns(crane.InvalidRowWarning, match=r"row \[1\]"):
        batch = flexible.replace(load_mass=[1.0, -1.0, 3.0], invalid="nan")
    with pytest.warns(crane.InvalidRowWarning, match="E032"):
        energies = batch.gravity_energy(flexible.guess, invalid="nan")
    np.testing.assert_array_equal(np.isnan(energies), [False, True, False])
    np.testing.assert_array_equal(energies[2], flexible.replace(load_mass=3.0).gravity_energy(flexible.guess))
    with pytest.raises(TypeError, match="no live parameter `load`"):
        flexible.replace(load=1.0)


def test_derivatives_of_accelerations_are_those_of_differences(flexible, states):
    t, q, v = (values[0] for values in states)
    of_q, of_v, inverse = flexible.forward_dynamics_derivatives(q, v, t)
    # Accelerations are quadratic in the rates, so that differences over any distance are exact to rounding.
    ahead, behind = (flexible.forward_dynamics(q, v + sign * np.eye(flexible.n), t) for sign in (1, -1))
    np.testing.assert_allclose((ahead - behind).T / 2, of_v, atol=1e-9 * np.abs(of_v).max())
    # Richardson's extrapolation leaves errors of h⁴, and rounding over 1e-3.
    def slope(h):
        ahead, behind = (flexible.forward_dynamics(q + sign * h * np.eye(flexible.n), v, t) for sign in (1, -1))
        return (ahead - behind).T / (2 * h)

    np.testing.assert_allclose((4 * slope(1e-3) - slope(2e-3)) / 3, of_q, atol=1e-7 * np.abs(of_q).max())
    np.testing.assert_allclose(inverse @ flexible.mass_matrix(q), np.eye(flexible.n), atol=1e-8)


def test_a_residual_is_what_a_motion_requires_beyond_the_forces(flexible, states):
    t, q, v = states
    required, forces = flexible.inverse_dynamics(q, v, v), flexible.forces(q, v, t)
    scale = np.abs(required).max() + np.abs(forces).max()
    # Rounding of forces of this size.
    np.testing.assert_allclose(flexible.dynamic_residual(q, v, v, t), required - forces, atol=1e-13 * scale)
    zeros = 0 * q[0]
    at_rest = flexible.dynamic_residual_derivatives(q[0], zeros, zeros, t[0])[0]
    tangent = flexible.tangent_stiffness(q[0], t[0])
    np.testing.assert_allclose(at_rest, tangent, atol=1e-12 * np.abs(tangent).max())
