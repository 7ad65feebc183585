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


def modified_dh(a, alpha, d, theta):
    """Craig's row: Rx(alpha) Tx(a) Rz(theta) Tz(d)."""
    return rotate("x", alpha) @ translate(x=a) @ rotate("z", theta) @ translate(z=d)


def classic_dh(a, alpha, d, theta):
    """Denavit's and Hartenberg's own row: Rz(theta) Tz(d) Tx(a) Rx(alpha)."""
    return rotate("z", theta) @ translate(z=d) @ translate(x=a) @ rotate("x", alpha)


def place(transform, position):
    """Where `transform` puts a point of its frame, 3x1."""
    return (transform @ ca.vertcat(position, 1))[:3]
