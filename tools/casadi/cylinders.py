"""Cylinders between their pins: lengths in the world frame, by the law of cosines where there is a linkage; the rest is differentiated."""

from dataclasses import dataclass

import casadi as ca


@dataclass
class Cylinder:
    """A cylinder: the coordinate of its joint, its length, and what that depends on.

    `carried` holds the points and the axis of its joint, each with the index of the body that carries it and the distance along that body, and
    `length_of` the length as a function of them. `pins`: bodies on which a cylinder
    with a valve pushes, and the distances along them.
    """

    coordinate: object
    length: ca.SX
    carried: list
    length_of: object
    pins: list


def on_part_beyond(cylinder, cut, bodies):
    """Force and moment about the world's origin on everything beyond a cut, while the cylinder pushes with 1 N: its power as that is
    displaced against the rest."""
    along, about = ca.SX.sym("along", 3), ca.SX.sym("about", 3)
    displaced = []
    for vector, body, distance, is_axis in cylinder.carried:
        shift = ca.cross(about, vector) if is_axis else along + ca.cross(about, vector)
        displaced.append(vector + cut.beyond(bodies, body, distance) * shift)
    length = cylinder.length_of(*displaced)
    zeros = ca.DM.zeros(3)
    return [ca.substitute(ca.gradient(length, by), ca.vertcat(along, about), ca.vertcat(zeros, zeros)) for by in (along, about)]


def turning_axis(rotation, angle):
    """The axis about which a rotation matrix turns with an angle."""
    slope = ca.reshape(ca.jacobian(ca.vec(rotation), angle), 3, 3)
    spin = slope @ rotation.T
    return ca.vertcat(spin[2, 1], spin[0, 2], spin[1, 0])


def pin_of_rocker(pivot, head, axis, lengths, side):
    """Where rocker and link meet: from the angle at the pivot in the triangle pivot, pin, head."""
    rocker, link = lengths
    distance = ca.norm_2(head - pivot)
    cosine = (distance**2 + rocker**2 - link**2) / (2 * distance * rocker)
    along = (head - pivot) / distance
    across = ca.cross(axis, along)
    across /= ca.norm_2(across)
    turn = {"left": 1, "right": -1}[side] * ca.acos(cosine)
    return pivot + rocker * (ca.cos(turn) * along + ca.sin(turn) * across)


def state(cylinder, rate):
    """Length, its rate and its derivative by the joint's coordinate; `rate` differentiates along the motion."""
    return ca.vertcat(
        cylinder.length, rate(cylinder.length), ca.jacobian(cylinder.length, cylinder.coordinate.q)
    )
