"""Everything a crane's functions return, by CasADi's differentiation of T, of energies and of the dissipation.

No formula of the equations of motion is written down here: A, e, forces, K and D are derivatives of
`E_k = ½ Σ tr(Ṫ H Ṫᵀ)`, of the potential energy by part, and of Rayleigh's dissipation function.
"""

import casadi as ca
import numpy as np


def row_major(matrix):
    """Entries row by row, as a column."""
    return ca.vec(matrix.T)


class Derivations:
    """The quantities of a crane as named CasADi expressions over (t, q, v, parameters)."""

    def __init__(self, crane):
        self.crane = crane
        self.arguments = [crane.time, crane.q, crane.v, crane.parameters]
        self.quantities = {
            **self.transforms(),
            **self.dynamics(),
            **self.forces(),
            **self.statics(),
            **self.motions(),
        }

    def rate(self, expression):
        """Time derivative at given t, q, v: the directional derivative along (1, v)."""
        time, q, v, _ = self.arguments
        return ca.jtimes(expression, q, v) + ca.jtimes(expression, time, ca.SX(1))

    def transforms(self):
        """T, ∂T/∂q_i and ∂²T/∂q_m∂q_n of every body, for the coordinates that move it."""
        bodies, q = self.crane.bodies, self.crane.q
        count = q.numel()
        poses = ca.vertcat(*[row_major(body.transform) for body in bodies])
        block = [slice(16 * index, 16 * index + 16) for index in range(len(bodies))]
        first = ca.jacobian(poses, q)
        second = {}
        for m in range(count):
            reached = ca.vertcat(*[first[block[p], m] for p, body in enumerate(bodies) if body.degrees_of_freedom > m])
            second[m] = ca.jacobian(reached, q[m:])

        def pair(p, m, n):
            skipped = sum(body.degrees_of_freedom <= m for body in bodies)
            return second[m][block[p - skipped], n - m]

        moving = [(p, range(body.degrees_of_freedom)) for p, body in enumerate(bodies)]
        return {
            "transforms": poses,
            "transform_derivatives": ca.vertcat(*[first[block[p], i] for p, dof in moving for i in dof]),
            "transform_second_derivatives": ca.vertcat(
                *[pair(p, m, n) for p, dof in moving for m in dof for n in dof if n >= m]
            ),
        }

    def kinetic_energy(self):
        """`½ Σ tr(Ṫ H Ṫᵀ)` [Urbaś 2016, Eq. (4)]."""
        energy = ca.SX(0)
        for body in self.crane.bodies:
            rate = self.rate(body.transform)
            energy += ca.trace(rate @ body.pseudo_inertia @ rate.T) / 2
        return energy

    def gravity_energy(self):
        """`-Σ g · ∫ r dm`, the generalisation of [Urbaś 2016, Eq. (6)] to any direction of gravity."""
        moments = sum((body.transform @ body.pseudo_inertia[:, 3] for body in self.crane.bodies), ca.SX(4, 1))
        return -ca.dot(self.crane.gravity, moments[:3])

    def dynamics(self):
        """A and e from Lagrange's operators on E_k and E_g [Urbaś 2016, Eqs. (5)-(9)]."""
        q, v = self.crane.q, self.crane.v
        kinetic, gravity = self.kinetic_energy(), self.gravity_energy()
        mass_matrix, momentum = ca.hessian(kinetic, v)
        inertia_force = ca.jtimes(momentum, q, v) - ca.gradient(kinetic, q)
        bias = -(inertia_force + ca.gradient(gravity, q))
        return {
            "mass_matrix": row_major(ca.densify(mass_matrix)),
            "mass_matrix_lower": row_major(ca.densify(ca.tril(mass_matrix))),
            "bias": bias,
            "bias_with_mass_matrix": bias,
            "kinetic_energy": kinetic,
            "linearised_mass": row_major(ca.densify(mass_matrix)),
        }

    def potentials(self):
        """Potential energy and Rayleigh's function by part [Urbaś 2016, Eqs. (14), (16), (17), (19)]."""
        crane = self.crane

        def sum_of(terms):
            return sum(terms, ca.SX(0))

        def stored(springs):
            return sum_of(s.stiffness * (s.motion - s.coordinate.q) ** 2 / 2 for s in springs)

        def lost(springs):
            return sum_of(s.damping * (self.rate(ca.SX(s.motion)) - s.coordinate.v) ** 2 / 2 for s in springs)

        return {
            "support": (
                sum_of(ca.dot(s.stiffness, s.elongation**2) / 2 for s in crane.supports),
                sum_of(ca.dot(s.damping, self.rate(s.elongation) ** 2) / 2 for s in crane.supports),
            ),
            "element": (stored(crane.elements), lost(crane.elements)),
            "drive": (stored(crane.drives), lost(crane.drives)),
            "hinge": (ca.SX(0), lost(crane.hinges)),
        }

    def forces(self):
        """Generalized forces `-∂E_p/∂q - ∂R/∂q̇` by part and in all; power lost 2R; D = ∂²R/∂q̇²."""
        q, v = self.crane.q, self.crane.v
        parts = self.potentials()
        energies = {part: energy for part, (energy, _) in parts.items()}
        by_part = {part: -ca.gradient(e, q) - ca.gradient(r, v) for part, (e, r) in parts.items()}
        dissipation_function = sum(lost for _, lost in parts.values())
        forces = sum(by_part.values())
        damping = -ca.substitute(ca.jacobian(forces, v), v, ca.DM.zeros(v.shape))
        return {
            **{f"{part}_forces": force for part, force in by_part.items()},
            "forces": forces,
            "gravity_energy": self.gravity_energy(),
            **{f"{part}_energy": energies[part] for part in ("support", "element", "drive")},
            "dissipation": 2 * dissipation_function,
            "linearised_damping": row_major(ca.densify(damping)),
        }

    def driving_forces(self):
        """`t_dr` of each drive: the generalized force of all drives on its own coordinate."""
        energy, lost = self.potentials()["drive"]
        coordinates = [drive.coordinate for drive in self.crane.drives]
        return ca.vertcat(*[-ca.gradient(energy, c.q) - ca.gradient(lost, c.v) for c in coordinates])

    def statics(self):
        """Gradient and Hessian of the whole potential energy at t = 0."""
        potential = self.gravity_energy() + sum(energy for energy, _ in self.potentials().values())
        stiffness, residual = ca.hessian(ca.substitute(potential, self.crane.time, 0), self.crane.q)
        stiffness = row_major(ca.densify(stiffness))
        springs = ca.hessian(sum(energy for energy, _ in self.potentials().values()), self.crane.q)[0]
        return {
            "static_residual": residual,
            "tangent_stiffness": stiffness,
            "linearised_stiffness": stiffness,
            SPRINGS: row_major(ca.densify(springs)),
        }

    def motions(self):
        """Points and their velocities, reactions of the supports, and what the drives prescribe and deliver."""
        crane = self.crane
        points = ca.vertcat(*crane.points.values())
        prescribed = ca.vertcat(*[ca.SX(drive.motion) for drive in crane.drives])
        rates = self.rate(prescribed)
        return {
            "points": points,
            "point_velocities": self.rate(points),
            "support_reactions": ca.vertcat(
                *[-s.stiffness * s.elongation - s.damping * self.rate(s.elongation) for s in crane.supports]
            ),
            "drive_motions": row_major(ca.horzcat(prescribed, rates)),
            "drive_power": ca.dot(self.driving_forces(), rates),
        }

    def sizes(self):
        """How many numbers each quantity has."""
        own = {name: expression.numel() for name, expression in self.quantities.items() if name != SPRINGS}
        return own | dict.fromkeys(SOLUTIONS, self.crane.q.numel())

    def evaluate(self, states):
        """All quantities at all states: name -> array with a row a state."""
        columns = [states.time[None, :], states.q.T, states.v.T, states.parameters.T]
        names = list(self.quantities)
        function = ca.Function("quantities", self.arguments, [ca.densify(self.quantities[name]) for name in names])
        values = function(*columns)
        values = {name: value.full().T for name, value in zip(names, values)}
        return values | solutions(values, states.v)


# Step of `implicit_solution`, s; that of the program that evaluates.
IMPLICIT_STEP = 0.01
# Found from the other quantities at each state.
SOLUTIONS = ["forward_dynamics", "lane_forward_dynamics", "mass_solution", "implicit_solution"]
# The stiffness of all springs, for these alone: nothing generated has it by itself.
SPRINGS = "impedance_stiffness"


def solutions(values, v):
    """Accelerations and solutions of linear systems, by dense factors of the derived matrices."""
    count = v.shape[1]
    mass, damping, stiffness = (
        values[name].reshape(-1, count, count) for name in ("mass_matrix", "linearised_damping", SPRINGS)
    )
    implicit = mass + IMPLICIT_STEP * damping + IMPLICIT_STEP**2 * stiffness
    del values[SPRINGS]
    accelerations = solve_scaled(mass, values["bias"] + values["forces"])
    found = [accelerations, accelerations, solve_scaled(mass, v), solve_scaled(implicit, v)]
    return dict(zip(SOLUTIONS, found))


def solve_scaled(matrices, right):
    """`A x = r` for positive definite A, with unit diagonal by scaling: less of A's condition is lost."""
    scale = 1 / np.sqrt(np.einsum("sii->si", matrices))
    scaled = matrices * scale[:, :, None] * scale[:, None, :]
    return scale * np.linalg.solve(scaled, (scale * right)[:, :, None])[:, :, 0]
