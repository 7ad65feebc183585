"""Joints of a robot under the names and in the order of its file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ._native import real_array
from .arguments import by_name
from .info import NamedJoint
from .loops import CLOSED, closed
from .results import Array

if TYPE_CHECKING:
    from .model import Crane


class JointStates(NamedTuple):
    """Joints as the message `sensor_msgs/JointState` of ROS has them: names, and positions and velocities (..., joints), rad and m, rad/s and m/s."""

    name: tuple[str, ...]
    position: Array
    velocity: Array


def joint_states(crane: Crane, q: ArrayLike, v: ArrayLike | None) -> JointStates:
    """As `Crane.joint_states`."""
    joints = _joints(crane)
    q, v = np.broadcast_arrays(_state(crane, "q", q), np.zeros(crane.n) if v is None else _state(crane, "v", v))
    found = np.zeros((2, *q.shape[:-1], len(joints)))
    for index, joint in enumerate(joints):
        found[0, ..., index] = joint["at"]
        if joint["coordinate"] is not None:
            place = crane.coordinates.index(joint["coordinate"])
            found[..., index] += (q[..., place], v[..., place])
    return JointStates(tuple(joint["name"] for joint in joints), found[0], found[1])


def coordinates_of(crane: Crane, positions: Mapping[str, ArrayLike], q: ArrayLike | None) -> Array:
    """As `Crane.coordinates_of`."""
    joints = {joint["name"]: joint for joint in _joints(crane)}
    positions = by_name("positions", positions, f'{{"{next(iter(joints), "joint")}": 0.1}}')
    numbers = {name: real_array(f"joint {name!r}", position) for name, position in positions.items()}
    for name, position in numbers.items():
        if not np.isfinite(position).all():
            raise ValueError(f"joint {name!r} is at {position}: write finite numbers")
    start = crane.guess if q is None else _state(crane, "q", q)
    found = np.array(np.broadcast_to(start, (*np.broadcast_shapes(start.shape[:-1], *(given.shape for given in numbers.values())), crane.n)))
    given = []
    for name, position in numbers.items():
        if name not in joints:
            raise ValueError(f"there is no joint {name!r}: write one of {', '.join(joints)}")
        joint = joints[name]
        if joint["coordinate"] is not None:
            given.append(joint["coordinate"])
            found[..., crane.coordinates.index(joint["coordinate"])] = position - joint["at"]
        elif np.any(np.abs(position - joint["at"]) > CLOSED):
            raise ValueError(f"joint {name!r} is held at {joint['at']}")
    found, _, gaps = closed(crane, found, np.zeros_like(found), given)
    if gaps.size and np.abs(gaps).max() > CLOSED:
        raise ValueError(f"no pose has these positions: loops and joints that follow others are open by {np.abs(gaps).max():.2g} m or rad")
    return found


def _state(crane: Crane, name: str, given: ArrayLike) -> Array:
    numbers = crane._coordinates(name, given)
    if not np.isfinite(numbers).all():
        raise ValueError(f"{name} is {numbers}: write finite numbers")
    return numbers


def _joints(crane: Crane) -> list[NamedJoint]:
    """Those that the spec names, or its coordinates."""
    return crane.info["joints"] or [{"name": name, "coordinate": name, "at": 0.0} for name in crane.coordinates]
