"""A crane as a tree of rigid links in plain numbers, as any library of multibody dynamics accepts it.

The reader is that of the check with CasADi. Its transforms are decomposed numerically: a link's pose in the frame of the
link that carries it is `M exp(B_1 q_1) exp(B_2 q_2) …`, a product of exponentials with constant M and constant axes B in the link's
own frame, whatever D-H rows, placements and massless frames it was written with.
"""

import sys
from dataclasses import dataclass
from itertools import combinations
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

    coordinate: int
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
    """A rigid body: its pose M at q = 0 in the frame of the link that carries it, its joints in order, its inertia.

    `parent`: the index of the link that carries it, -1 for the world. `com` and `tensor`: centre of mass, and inertia about it, in the link's frame.
    """

    parent: int
    placement: np.ndarray
    joints: list
    mass: float
    com: np.ndarray
    tensor: np.ndarray


@dataclass
class Step:
    """A joint that turns about or slides along `axis`, x, y or z, of its own frame, and the inertia that it carries.

    `parent`: the index of the step that carries it, -1 for the world. `placement`: the frame's pose at q = 0 in the frame of that
    joint. `mass`, `com`, `tensor`: of the link that the
    joint completes, in its frame; zero for the joints before it.
    """

    parent: int
    coordinate: int
    is_rotation: bool
    axis: str
    placement: np.ndarray
    mass: float
    com: np.ndarray
    tensor: np.ndarray


@dataclass
class Chain:
    """Links, each after the one that carries it, gravity, m/s², and the inertia of each coordinate's rotor, kg m² or kg."""

    links: list
    gravity: np.ndarray
    armature: np.ndarray

    @property
    def size(self):
        """How many coordinates."""
        return sum(len(link.joints) for link in self.links)

    def steps(self):
        """The same joint by joint, for libraries with joints of one degree of freedom."""
        steps, ends = [], [(-1, np.eye(4))]
        for link in self.links:
            before, end = ends[link.parent + 1]
            start = end @ link.placement
            for joint in link.joints:
                frame, nothing = joint.frame, (0.0, np.zeros(3), np.zeros((3, 3)))
                place = (before, joint.coordinate, joint.is_rotation, joint.letter, whole(start @ frame))
                steps.append(Step(*place, *nothing))
                before, start = len(steps) - 1, np.linalg.inv(frame)
            end = start
            ends.append((before, end))
            rotation, origin = end[:3, :3], end[:3, 3]
            last = steps[before]
            last.mass, last.com = link.mass, whole(rotation @ link.com + origin)
            last.tensor = whole(rotation @ link.tensor @ rotation.T)
        return steps


def read_chain(crane):
    """The tree of a crane with its parameters at their defaults.

    Bodies that move together become one link; massless bodies pass their coordinates on to the next, if no branches begin there; bodies
    that do not move are omitted.
    """
    groups = {}
    for body in at_zero(crane):
        groups.setdefault(body.moved_by, []).append(body)
    links, places = [], {}
    for moved_by in moving_groups(groups):
        carrier, *others = groups[moved_by]
        inertia = carrier.inertia
        for body in others:
            offset = np.linalg.solve(carrier.pose, body.pose)
            inertia = inertia + offset @ body.inertia @ offset.T
        below = [moved_by[:count] for count in range(len(moved_by)) if moved_by[:count] in places]
        parent, before = places[below[-1]] if below else (-1, np.eye(4))
        own = range(len(below[-1]) if below else 0, len(moved_by))
        joints = [joint(moved_by[k], np.linalg.solve(carrier.pose, carrier.motions[k])) for k in own]
        placement = whole(np.linalg.solve(before, carrier.pose))
        places[moved_by] = len(links), carrier.pose
        links.append(Link(parent, placement, joints, *mass_com_tensor(inertia)))
    armature = ca.SX.zeros(crane.q.shape)
    for coordinate, inertia in crane.rotors:
        armature[crane.coordinates.index(coordinate)] += inertia
    gravity, armature = evaluate(crane, [crane.gravity, armature])
    return Chain(links, gravity.ravel(), armature.ravel())


def moving_groups(groups):
    """The coordinates that move each link: those of bodies with mass, and those where branches begin."""
    heavy = [moved_by for moved_by, bodies in groups.items() if moved_by and any(body.mass != 0 for body in bodies)]
    shared = {common_start(*pair) for pair in combinations(heavy, 2)}
    return [moved_by for moved_by in groups if moved_by in heavy or (moved_by and moved_by in shared)]


def common_start(first, second):
    """The coordinates with which two lists begin alike."""
    alike = [one == other for one, other in zip(first, second)]
    return first[: alike.index(False) if False in alike else len(alike)]


@dataclass
class AtZero:
    """A body at q = 0: the coordinates that move it, its pose in the world, ∂T/∂q of these coordinates, its pseudo-inertia."""

    moved_by: tuple
    pose: np.ndarray
    motions: list
    inertia: np.ndarray

    @property
    def mass(self):
        """Its mass, kg."""
        return self.inertia[3, 3]


def at_zero(crane):
    """All bodies at q = 0."""
    bodies = []
    for body in crane.bodies:
        along = [crane.coordinates[index].q for index in body.moved_by]
        derivatives = [ca.jacobian(ca.vec(body.transform), ca.vertcat(*along))] if along else []
        pose, inertia, *motions = evaluate(crane, [body.transform, body.pseudo_inertia, *derivatives])
        columns = motions[0].T if motions else []
        bodies.append(AtZero(tuple(body.moved_by), pose, [column.reshape(4, 4, order="F") for column in columns], inertia))
    return bodies


def evaluate(crane, expressions):
    """Values at q = 0 with the parameters at their defaults."""
    function = ca.Function("at_zero", [crane.q, crane.parameters], expressions)
    return [
        value.full() for value in function.call([ca.DM.zeros(crane.q.shape), ca.DM([*crane.spec.defaults.values()])])
    ]


def joint(coordinate, generator):
    """The joint of a generator `[ω̃ v; 0 0]`: its axis, and the point of the axis nearest to the origin."""
    turning = np.array([generator[2, 1], generator[0, 2], generator[1, 0]])
    sliding = generator[:3, 3]
    if np.linalg.norm(turning) < 0.5:
        return Joint(coordinate, False, whole(sliding), np.zeros(3))
    return Joint(coordinate, True, whole(turning), whole(np.cross(turning, sliding)))


def mass_com_tensor(pseudo_inertia):
    """Mass, centre of mass and inertia about it of `H = ∫ r rᵀ dm`."""
    mass = pseudo_inertia[3, 3]
    if mass == 0:
        return 0.0, np.zeros(3), np.zeros((3, 3))
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
