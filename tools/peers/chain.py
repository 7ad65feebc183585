"""A crane as a chain of rigid links in plain numbers, as any library of multibody dynamics accepts it.

The reader is that of the check with CasADi. Its transforms are decomposed numerically: a link's pose in the frame of the
previous link is `M exp(B_1 q_1) exp(B_2 q_2) …`, a product of exponentials with constant M and constant axes B in the link's
own frame, whatever D-H rows, placements and massless frames it was written with.
"""

import sys
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

import casadi as ca
import numpy as np

TOOLS = Path(__file__).resolve().parents[1]
sys.path.append(str(TOOLS / "casadi"))

# cos 90° is 6e-17: an entry this close to an integer is replaced by it, so that libraries can leave zeros out.
ROUND_OFF = 4e-15


@dataclass
class Joint:
    """A coordinate: a rotation about an axis through `point`, or a translation along it, in the link's frame at q = 0."""

    is_rotation: bool
    axis: np.ndarray
    point: np.ndarray

    @property
    def letter(self):
        """Which axis of `frame` it turns about or slides along."""
        return "xyz"[np.argmax(self.axis)] if self.is_along_frame else "z"

    @property
    def is_along_frame(self):
        """Whether the axis is x, y or z of the link's frame."""
        return sorted(self.axis) == [0, 0, 1]

    @property
    def frame(self):
        """A frame at `point` whose x, y or z is the axis, in the link's frame at q = 0."""
        frame = np.eye(4)
        if not self.is_along_frame:
            across = np.cross(np.eye(3)[np.argmin(np.abs(self.axis))], self.axis)
            x = across / np.linalg.norm(across)
            frame[:3, :3] = np.column_stack([x, np.cross(self.axis, x), self.axis])
        frame[:3, 3] = self.point
        return frame


@dataclass
class Link:
    """A rigid body: its pose M at q = 0 in the frame of the previous link, its joints in order, its inertia.

    `com` and `tensor`: centre of mass, and inertia about it, in the link's frame.
    """

    placement: np.ndarray
    joints: list
    mass: float
    com: np.ndarray
    tensor: np.ndarray


@dataclass
class Step:
    """A joint that turns about or slides along `axis`, x, y or z, of its own frame, and the inertia that it carries.

    `placement`: the frame's pose at q = 0 in the frame of the previous joint. `mass`, `com`, `tensor`: of the link that the
    joint completes, in its frame; zero for the joints before it.
    """

    is_rotation: bool
    axis: str
    placement: np.ndarray
    mass: float
    com: np.ndarray
    tensor: np.ndarray


@dataclass
class Chain:
    """Links from the base to the tip, gravity, m/s², and the inertia of each joint's rotor, kg m² or kg."""

    links: list
    gravity: np.ndarray
    armature: np.ndarray

    @property
    def size(self):
        """How many coordinates."""
        return sum(len(link.joints) for link in self.links)

    def steps(self):
        """The same chain joint by joint, for libraries with joints of one degree of freedom."""
        steps, end = [], np.eye(4)
        for link in self.links:
            start = end @ link.placement
            for joint in link.joints:
                frame = joint.frame
                steps.append(
                    Step(joint.is_rotation, joint.letter, whole(start @ frame), 0.0, np.zeros(3), np.zeros((3, 3)))
                )
                start = end = np.linalg.inv(frame)
            rotation, origin = end[:3, :3], end[:3, 3]
            last = steps[-1]
            last.mass, last.com = link.mass, whole(rotation @ link.com + origin)
            last.tensor = whole(rotation @ link.tensor @ rotation.T)
        return steps


def read_chain(crane):
    """The chain of a crane with its parameters at their defaults.

    Bodies that move together become one link; massless bodies pass their coordinates on to the next; bodies that do not
    move are omitted.
    """
    heavy = [body for body in at_zero(crane) if body.inertia[3, 3] != 0 and body.motions]
    links, before, passed = [], np.eye(4), 0
    for count, rigid in groupby(heavy, key=lambda body: len(body.motions)):
        carrier, *others = rigid
        inertia = carrier.inertia
        for body in others:
            offset = np.linalg.solve(carrier.pose, body.pose)
            inertia = inertia + offset @ body.inertia @ offset.T
        joints = [joint(np.linalg.solve(carrier.pose, motion)) for motion in carrier.motions[passed:]]
        placement = whole(np.linalg.solve(before, carrier.pose))
        links.append(Link(placement, joints, *mass_com_tensor(inertia)))
        before, passed = carrier.pose, count
    armature = ca.SX.zeros(crane.q.shape)
    for coordinate, inertia in crane.rotors:
        armature[crane.coordinates.index(coordinate)] += inertia
    gravity, armature = evaluate(crane, [crane.gravity, armature])
    return Chain(links, gravity.ravel(), armature.ravel())


@dataclass
class AtZero:
    """A body at q = 0: its pose in the world, ∂T/∂q of the coordinates that move it, its pseudo-inertia."""

    pose: np.ndarray
    motions: list
    inertia: np.ndarray


def at_zero(crane):
    """All bodies at q = 0."""
    bodies = []
    for body in crane.bodies:
        along = [crane.coordinates[index].q for index in body.moved_by]
        derivatives = [ca.jacobian(ca.vec(body.transform), ca.vertcat(*along))] if along else []
        pose, inertia, *motions = evaluate(crane, [body.transform, body.pseudo_inertia, *derivatives])
        columns = motions[0].T if motions else []
        bodies.append(AtZero(pose, [column.reshape(4, 4, order="F") for column in columns], inertia))
    return bodies


def evaluate(crane, expressions):
    """Values at q = 0 with the parameters at their defaults."""
    function = ca.Function("at_zero", [crane.q, crane.parameters], expressions)
    return [
        value.full() for value in function.call([ca.DM.zeros(crane.q.shape), ca.DM([*crane.spec.defaults.values()])])
    ]


def joint(generator):
    """The joint of a generator `[ω̃ v; 0 0]`: its axis, and the point of the axis nearest to the origin."""
    turning = np.array([generator[2, 1], generator[0, 2], generator[1, 0]])
    sliding = generator[:3, 3]
    if np.linalg.norm(turning) < 0.5:
        return Joint(False, whole(sliding), np.zeros(3))
    return Joint(True, whole(turning), whole(np.cross(turning, sliding)))


def mass_com_tensor(pseudo_inertia):
    """Mass, centre of mass and inertia about it of `H = ∫ r rᵀ dm`."""
    mass = pseudo_inertia[3, 3]
    com = pseudo_inertia[:3, 3] / mass
    about_com = pseudo_inertia[:3, :3] - mass * np.outer(com, com)
    return mass, com, np.trace(about_com) * np.eye(3) - about_com


def whole(numbers):
    """The numbers, with those that are integers up to round-off made exact."""
    rounded = np.round(numbers)
    return np.where(np.abs(numbers - rounded) < ROUND_OFF, rounded, numbers) + 0.0


def as_text(chain):
    """Gravity, then one line per joint: is_rotation axis, rotation and translation of its placement, mass, com, tensor."""
    lines = [chain.gravity]
    for step in chain.steps():
        rotation, translation = step.placement[:3, :3], step.placement[:3, 3]
        numbers = [*rotation.ravel(), *translation, step.mass, *step.com, *step.tensor.ravel()]
        lines.append([int(step.is_rotation), step.axis, *map(float, numbers)])
    return "\n".join(" ".join(map(str, line)) for line in lines) + "\n"
