"""Recursions over a chain as CasADi expressions, from which CasADi writes C.

Twists and forces are pairs of columns: (v, ω) and (f, n). CasADi folds the zeros and ones of placements and axes.
"""

from dataclasses import dataclass

import casadi as ca

AXES = {"x": ca.DM([1, 0, 0]), "y": ca.DM([0, 1, 0]), "z": ca.DM([0, 0, 1])}
PLANES = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}


def functions(chain):
    """`forward_dynamics(q, v, f) -> q̈` and `mass_matrix_and_bias(q, v) -> A, e` of a chain."""
    q, v, f = (ca.SX.sym(name, chain.size) for name in ("q", "v", "f"))

    def function(name, arguments, *results):
        return ca.Function(name, arguments, ca.cse([ca.densify(result) for result in results]))

    return [
        function("forward_dynamics", [q, v, f], forward_dynamics(chain, q, v, f)),
        function("mass_matrix_and_bias", [q, v], *mass_matrix_and_bias(chain, q, v)),
    ]


def write_c(functions_of_chain, path):
    """Writes the functions as C."""
    generator = ca.CodeGenerator(path.name)
    for function in functions_of_chain:
        generator.add(function)
    generator.generate(f"{path.parent}/")


def elementary_rotation(axis, angle):
    """Rotation about x, y or z."""
    first, second = PLANES[axis]
    rotation = ca.SX.eye(3)
    rotation[first, first] = rotation[second, second] = ca.cos(angle)
    rotation[second, first], rotation[first, second] = ca.sin(angle), -ca.sin(angle)
    return rotation


def symmetric(matrix):
    """The upper triangle, mirrored: what is below it is then never computed."""
    return ca.triu2symm(ca.triu(matrix))


@dataclass
class Inertia:
    """An articulated inertia about the frame's origin: f = M v + G ω, n = Gᵀ v + J ω."""

    M: ca.SX
    G: ca.SX
    J: ca.SX

    @staticmethod
    def of(step):
        """The link that a step carries."""
        com = ca.skew(step.com)
        G = -step.mass * com
        return Inertia(ca.SX(step.mass * ca.DM.eye(3)), ca.SX(G), ca.SX(step.tensor - step.mass * com @ com))

    def turned(self, rotation):
        """The same in a frame in which this one has the orientation `rotation`."""
        M, G, J = (rotation @ block @ rotation.T for block in (self.M, self.G, self.J))
        return Inertia(symmetric(M), G, symmetric(J))

    def shifted(self, offset):
        """The same about a point from which this origin is at `offset`."""
        if ca.SX(offset).is_zero():
            return self
        p = ca.skew(offset)
        G = self.G - self.M @ p
        return Inertia(self.M, G, symmetric(self.J - self.G.T @ p + p @ G))

    def plus(self, other):
        """Both together."""
        return Inertia(self.M + other.M, self.G + other.G, self.J + other.J)

    def times(self, v, w):
        """Force and moment, or momenta, of a motion."""
        return self.M @ v + self.G @ w, self.G.T @ v + self.J @ w


def forward_dynamics(chain, q, v, tau):
    """q̈ by the articulated-body algorithm [Featherstone 2008, section 7.3], each joint in its own frame."""
    steps = chain.steps()
    velocity = ca.SX(3, 1), ca.SX(3, 1)
    motions, inertias, forces, biases = [], [], [], []
    for index, step in enumerate(steps):
        axis, rate = AXES[step.axis], v[index]
        motion = Motion(step, q[index])
        linear, angular = motion.into(*velocity)
        if step.is_rotation:
            angular = angular + axis * rate
            biases.append((ca.cross(linear, axis * rate), ca.cross(angular, axis * rate)))
        else:
            linear = linear + axis * rate
            biases.append((ca.cross(angular, axis * rate), ca.SX(3, 1)))
        velocity = linear, angular
        inertia = Inertia.of(step)
        momentum, spin = inertia.times(linear, angular)
        motions.append(motion)
        inertias.append(inertia)
        forces.append((ca.cross(angular, momentum), ca.cross(angular, spin) + ca.cross(linear, momentum)))

    gains, rests = [None] * len(steps), [None] * len(steps)
    for index in reversed(range(len(steps))):
        step, inertia, (f, n) = steps[index], inertias[index], forces[index]
        k = "xyz".index(step.axis)
        if step.is_rotation:
            U = inertia.G[:, k], inertia.J[:, k]
            D, rest = inertia.J[k, k], tau[index] - n[k]
        else:
            U = inertia.M[:, k], inertia.G[k, :].T
            D, rest = inertia.M[k, k], tau[index] - f[k]
        gain = U[0] / D, U[1] / D
        gains[index], rests[index] = gain, rest / D
        if index == 0:
            break
        passed = Inertia(
            symmetric(inertia.M - gain[0] @ U[0].T),
            inertia.G - gain[0] @ U[1].T,
            symmetric(inertia.J - gain[1] @ U[1].T),
        )
        along = passed.times(*biases[index])
        f, n = f + along[0] + gain[0] * rest, n + along[1] + gain[1] * rest
        inertias[index - 1] = inertias[index - 1].plus(motions[index].inertia_out(passed))
        f, n = motions[index].force_out(f, n)
        forces[index - 1] = forces[index - 1][0] + f, forces[index - 1][1] + n

    accelerations = []
    acceleration = ca.SX(-chain.gravity), ca.SX(3, 1)
    for index, step in enumerate(steps):
        linear, angular = motions[index].into(*acceleration)
        linear, angular = linear + biases[index][0], angular + biases[index][1]
        accelerations.append(rests[index] - ca.dot(gains[index][0], linear) - ca.dot(gains[index][1], angular))
        along = AXES[step.axis] * accelerations[-1]
        acceleration = (linear, angular + along) if step.is_rotation else (linear + along, angular)
    return ca.vertcat(*accelerations)


class Motion:
    """The pose of a joint's frame in that of the joint before: a constant placement, then one elementary motion."""

    def __init__(self, step, position):
        self.placed, self.origin = step.placement[:3, :3], step.placement[:3, 3]
        self.turn = elementary_rotation(step.axis, position) if step.is_rotation else None
        self.slide = None if step.is_rotation else AXES[step.axis] * position

    def into(self, v, w):
        """A twist of the joint before, in this frame."""
        v, w = self.placed.T @ (v + ca.cross(w, ca.SX(self.origin))), self.placed.T @ w
        if self.turn is None:
            return v + ca.cross(w, self.slide), w
        return self.turn.T @ v, self.turn.T @ w

    def force_out(self, f, n):
        """A force in the frame of the joint before."""
        if self.turn is None:
            n = n + ca.cross(self.slide, f)
        else:
            f, n = self.turn @ f, self.turn @ n
        f, n = self.placed @ f, self.placed @ n
        return f, n + ca.cross(ca.SX(self.origin), f)

    def inertia_out(self, inertia):
        """An inertia in the frame of the joint before."""
        inertia = inertia.shifted(self.slide) if self.turn is None else inertia.turned(self.turn)
        return inertia.turned(ca.SX(self.placed)).shifted(self.origin)


@dataclass
class RigidInertia:
    """A rigid inertia about the world's origin: mass, first moment s, tensor J; f = m v + ω × s, n = s × v + J ω."""

    mass: float
    moment: ca.SX
    tensor: ca.SX

    @staticmethod
    def of(step, rotation, origin):
        """The link that a step carries, at its pose in the world."""
        com = origin + rotation @ step.com
        tensor = rotation @ step.tensor @ rotation.T + step.mass * (ca.dot(com, com) * ca.SX.eye(3) - com @ com.T)
        return RigidInertia(step.mass, step.mass * com, symmetric(tensor))

    def plus(self, other):
        """Both together."""
        return RigidInertia(self.mass + other.mass, self.moment + other.moment, self.tensor + other.tensor)

    def times(self, v, w):
        """Force and moment, or momenta, of a motion."""
        return self.mass * v + ca.cross(w, self.moment), ca.cross(self.moment, v) + self.tensor @ w


def mass_matrix_and_bias(chain, q, v):
    """A by composite rigid bodies, e by Newton's and Euler's equations, both in the world frame."""
    rotation, origin = ca.SX.eye(3), ca.SX(3, 1)
    velocity, acceleration = (ca.SX(3, 1), ca.SX(3, 1)), (ca.SX(-chain.gravity), ca.SX(3, 1))
    twists, inertias, forces = [], [], []
    for index, step in enumerate(chain.steps()):
        origin = origin + rotation @ step.placement[:3, 3]
        rotation = rotation @ step.placement[:3, :3]
        axis = rotation @ AXES[step.axis]
        if step.is_rotation:
            twist = ca.cross(origin, axis), axis
            rotation = rotation @ elementary_rotation(step.axis, q[index])
        else:
            twist = axis, ca.SX(3, 1)
            origin = origin + axis * q[index]
        rate = twist[0] * v[index], twist[1] * v[index]
        # Twists act on each other by (v, ω) × (v', ω') = (ω × v' + v × ω', ω × ω').
        acceleration = (
            acceleration[0] + ca.cross(velocity[1], rate[0]) + ca.cross(velocity[0], rate[1]),
            acceleration[1] + ca.cross(velocity[1], rate[1]),
        )
        velocity = velocity[0] + rate[0], velocity[1] + rate[1]
        inertia = RigidInertia.of(step, rotation, origin)
        momentum, spin = inertia.times(*velocity)
        f, n = inertia.times(*acceleration)
        f, n = f + ca.cross(velocity[1], momentum), n + ca.cross(velocity[1], spin) + ca.cross(velocity[0], momentum)
        twists.append(twist)
        inertias.append(inertia)
        forces.append((f, n))

    size = chain.size
    mass_matrix, bias = ca.SX(size, size), ca.SX(size, 1)
    for j in reversed(range(size)):
        if j + 1 < size:
            inertias[j] = inertias[j].plus(inertias[j + 1])
            forces[j] = forces[j][0] + forces[j + 1][0], forces[j][1] + forces[j + 1][1]
        bias[j] = -ca.dot(twists[j][0], forces[j][0]) - ca.dot(twists[j][1], forces[j][1])
        f, n = inertias[j].times(*twists[j])
        for i in range(j + 1):
            mass_matrix[i, j] = mass_matrix[j, i] = ca.dot(twists[i][0], f) + ca.dot(twists[i][1], n)
    return mass_matrix, bias
