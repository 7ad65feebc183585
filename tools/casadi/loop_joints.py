"""Joints that close loops: their equations from the YAML, and accelerations by Lagrange multipliers."""

from dataclasses import dataclass

import casadi as ca
import numpy as np


@dataclass
class LoopJoint:
    """A joint, what is zero while it is closed, and the links that it holds: body and distance along it of each end on one; or an exact pad."""

    name: str
    gaps: list
    ends: list
    pad: object = None


def frame_of(written, spans, spec, carrier):
    """Rotation and point of an end."""
    body, at = end_of(written, spans, spec, carrier)
    if body is None:
        return ca.SX.eye(3), at
    return body.transform[:3, :3], body.transform[:3, :3] @ at + body.transform[:3, 3]


def end_of(written, spans, spec, carrier):
    """Body of an end, None for the world, and its place there."""
    at = spec.vector(written["at"])
    return carrier(spec, at, spans[written["link"]]) if "link" in written else (None, at)


def across(axis):
    """An axis as a unit vector, and two directions normal to it: axes of the frame, if it is one of them."""
    axis = np.array(axis, float) / np.linalg.norm(axis)
    for place in range(3):
        if abs(axis[place]) >= 1:
            units = np.eye(3)
            return units[place], units[(place + 1) % 3], units[(place + 2) % 3]
    start = np.eye(3)[np.argmin(abs(axis))]
    first = start - axis * (axis @ start)
    first /= np.linalg.norm(first)
    return axis, first, np.cross(axis, first)


def seen_at(crane, one, other, guess):
    """The axes of the first link as the second sees them at the guess."""
    entries = lambda rotation: ca.vertsplit(ca.vec(ca.substitute(rotation, crane.q, guess)))
    values = lambda rotation: np.array([crane.spec.default(entry) for entry in entries(rotation)]).reshape(3, 3).T
    return values(other).T @ values(one)


def read_loop_joint(crane, written, spans, carrier, guess):
    """What is zero: points together, directions of axes, distances from a line, or from a length."""
    spec = crane.spec
    (one, point), (other, end) = (frame_of(written[key], spans, spec, carrier) for key in ("from", "to"))
    way = one.T @ (end - point)
    joint = written["joint"]
    kind, keys = (joint, {}) if isinstance(joint, str) else next(iter(joint.items()))
    if kind == "ball":
        gaps = [way]
    elif kind == "rod":
        gaps = [ca.norm_2(end - point) - spec.number(keys["length"])]
    elif kind == "slide":
        _, first, second = across(keys["axis"])
        gaps = [ca.dot(ca.SX(first), way), ca.dot(ca.SX(second), way)]
    else:
        axis, first, second = across(keys["axis"])
        along, *_ = across(keys.get("to_axis", keys["axis"]))
        # Both axes point the same way at the guess.
        turned = one.T @ (other @ ca.SX(along * np.sign(along @ seen_at(crane, one, other, guess) @ axis)))
        gaps = [way, -ca.dot(ca.SX(second), turned), ca.dot(ca.SX(first), turned)]
    ends = [end_of(written[key], spans, spec, carrier) for key in ("from", "to")]
    return LoopJoint(written["name"], gaps, [(body, at[0]) for body, at in ends if body is not None])


@dataclass
class Pin:
    """A pin that turns: its angle, its friction, and for both of its ends the index of the body (None for the world), the distance along it, and the
    moment that a torque of 1 N m exerts on it."""

    angle: ca.SX
    friction: object
    ends: list

    def wrenches(self, within=False):
        """What acts on bodies at a torque of 1 N m; `within`: if it acts between two bodies."""
        if within and None in [body for body, *_ in self.ends]:
            return
        for body, along, moment in self.ends:
            if body is not None:
                yield body, along, ca.SX(3, 1), moment


def read_pin(crane, written, spans, carrier, guess, friction):
    """The angle between two directions normal to the axis, one of each link, which are alike at the guess."""
    keys = written["joint"]["pin"]
    (one, _), (other, _) = (frame_of(written[key], spans, crane.spec, carrier) for key in ("from", "to"))
    axis, first, second = across(keys["axis"])
    along, *_ = across(keys.get("to_axis", keys["axis"]))
    seen = seen_at(crane, one, other, guess)
    # Both axes point the same way at the guess.
    along = along * np.sign(along @ seen @ axis)
    # Of the two directions normal to the axis of the first link, the one that is less along that of the second.
    u, w = (direction - along * (along @ direction) for direction in (seen @ first, seen @ second))
    reference = u if np.linalg.norm(u) > np.linalg.norm(w) else np.cross(w, along)
    reference /= np.linalg.norm(reference)
    turned, u, w = other @ ca.SX(reference), one @ ca.SX(first), one @ ca.SX(second)
    # By virtual work: how the angle changes if the second body turns a little.
    spin = ca.SX.sym("spin", 3)
    moved = turned + ca.cross(spin, turned)
    angle = ca.atan2(ca.dot(w, moved), ca.dot(u, moved))
    at_rest = lambda expression: ca.substitute(expression, spin, ca.DM.zeros(3))
    moment = at_rest(ca.gradient(angle, spin))
    ends = []
    for key, own in (("from", moment), ("to", -moment)):
        body, at = None, crane.spec.vector(written[key]["at"])
        if "link" in written[key]:
            carried, at = carrier(crane.spec, at, spans[written[key]["link"]])
            body = next(index for index, known in enumerate(crane.bodies) if known is carried)
        ends.append((body, at[0], own))
    return Pin(at_rest(angle), friction, ends)


def quantities(joints, q, v):
    """φ, φ̇ and J̇ q̇ of every equation, and J."""
    gaps = ca.vertcat(ca.SX(0, 1), *[gap for joint in joints for gap in joint.gaps])
    rates = ca.jtimes(gaps, q, v)
    states = ca.horzcat(gaps, rates, ca.jtimes(rates, q, v))
    return {"loop_states": ca.vec(states.T), "loop_jacobians": ca.vec(ca.densify(ca.jacobian(gaps, q)).T)}


def closed(mass, forces, jacobians, curvatures, given, prescribed):
    """Accelerations with closed loops, state by state: `[A Jᵀ; J 0] [q̈; λ] = [e + f; −J̇ q̇]` by least squares, because equations may depend on
    each other; prescribed coordinates have the accelerations `given`."""
    free = [i for i in range(mass.shape[1]) if i not in prescribed]
    out = given.copy()
    for state in range(len(mass)):
        a, j = mass[state], jacobians[state]
        right = forces[state][free] - a[np.ix_(free, prescribed)] @ given[state][prescribed]
        gaps = -curvatures[state] - j[:, prescribed] @ given[state][prescribed]
        scale = 1 / np.sqrt(np.diag(a)[free])
        scaled = a[np.ix_(free, free)] * scale[:, None] * scale
        rows = j[:, free] * scale
        whole = np.block([[scaled, rows.T], [rows, np.zeros((len(j), len(j)))]])
        found = np.linalg.lstsq(whole, np.concatenate([scale * right, gaps]), rcond=1e-13)[0]
        out[state][free] = scale * found[: len(free)]
    return out
