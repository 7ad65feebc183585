"""Homogeneous transformations [Urbaś 2016, Eq. (3)], 4x4, as plain matrices to be multiplied."""

import casadi as ca


def translate(x=0.0, y=0.0, z=0.0):
    """Translation by (x, y, z), m."""
    transform = ca.SX.eye(4)
    transform[0, 3], transform[1, 3], transform[2, 3] = x, y, z
    return transform


def translate_along(axis, distance):
    """Translation along one axis of the frame, `axis` one of "xyz", m."""
    return translate(**{axis: distance})


def rotate(axis, angle):
    """Rotation about one axis of the frame, `axis` one of "xyz", rad."""
    first, second = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    transform = ca.SX.eye(4)
    transform[first, first] = transform[second, second] = ca.cos(angle)
    transform[second, first] = ca.sin(angle)
    transform[first, second] = -ca.sin(angle)
    return transform


def rotate_by_vector(rho):
    """exp of the cross product with a vector, by the unit quaternion (cos |ρ|/2, ρ sin(|ρ|/2)/|ρ|).

    Both functions are even in |ρ|. Below `SMALL` they are series in ρ·ρ, so that derivatives exist where ρ vanishes; the
    closed form is then evaluated at `SMALL`, or its derivative would be NaN.
    """
    squared = ca.dot(rho, rho)
    length = ca.sqrt(ca.fmax(squared, SMALL))
    is_small = squared < SMALL
    real = ca.if_else(is_small, even_series(squared / 4, 0), ca.cos(length / 2))
    vector = rho * ca.if_else(is_small, even_series(squared / 4, 1) / 2, ca.sin(length / 2) / length)
    x, y, z = ca.vertsplit(vector)
    cross = ca.vertcat(ca.horzcat(0, -z, y), ca.horzcat(z, 0, -x), ca.horzcat(-y, x, 0))
    transform = ca.SX.eye(4)
    transform[:3, :3] = ca.SX.eye(3) + 2 * real * cross + 2 * cross @ cross
    return transform


# |ρ|² below which functions of a rotation vector are series; ten terms leave 1e-24 there.
SMALL = 0.5


def even_series(x, order):
    """1 - x/(order + 2)! + x²/(order + 4)! - …: cos for order 0, sin over the angle for order 1, of an angle whose square is x."""
    term, total = ca.SX(1), ca.SX(0)
    for index in range(10):
        total += term
        term = -term * x / ((2 * index + order + 1) * (2 * index + order + 2))
    return total


def modified_dh(a, alpha, d, theta):
    """Craig's convention: Rx(alpha) Tx(a) Rz(theta) Tz(d)."""
    return rotate("x", alpha) @ translate(x=a) @ rotate("z", theta) @ translate(z=d)


def classic_dh(a, alpha, d, theta):
    """Denavit and Hartenberg's original convention: Rz(theta) Tz(d) Tx(a) Rx(alpha)."""
    return rotate("z", theta) @ translate(z=d) @ translate(x=a) @ rotate("x", alpha)


def place(transform, position):
    """Where `transform` puts a point of its frame, 3x1."""
    return (transform @ ca.vertcat(position, 1))[:3]
