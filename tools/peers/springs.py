"""The forces of a crane as springs and dampers in plain numbers, while its drives stand still."""

from dataclasses import dataclass

import casadi as ca
import numpy as np


@dataclass
class Springs:
    """On each coordinate: stiffness, damping, and the position where it is at rest.

    On the base: for each linear elongation `rows @ q - rest_lengths` of a support a stiffness and a damping.
    """

    stiffness: np.ndarray
    damping: np.ndarray
    rest: np.ndarray
    rows: np.ndarray
    rest_lengths: np.ndarray
    row_stiffness: np.ndarray
    row_damping: np.ndarray

    def principal_rows(self):
        """The fewest equivalent rows: for each ratio of damping to stiffness, those along the principal axes.

        Returns (row, rest length, stiffness, damping) of each.
        """
        springs = []
        ratios = self.row_damping / self.row_stiffness
        for ratio in np.unique(ratios):
            chosen = ratios == ratio
            rows, stiffness = self.rows[chosen], self.row_stiffness[chosen]
            eigenvalues, axes = np.linalg.eigh(rows.T @ (stiffness[:, None] * rows))
            pull = rows.T @ (stiffness * self.rest_lengths[chosen])
            for value, axis in zip(eigenvalues, axes.T):
                if value > 1e-12 * eigenvalues[-1]:
                    springs.append((axis, axis @ pull / value, value, ratio * value))
        return springs

    def base_matrices(self):
        """Stiffness and damping matrix of the supports, and their force at q = 0."""
        stiffness, damping = ((self.rows.T * numbers) @ self.rows for numbers in (self.row_stiffness, self.row_damping))
        return stiffness, damping, self.rows.T @ (self.row_stiffness * self.rest_lengths)


def read_springs(crane, time):
    """The springs of a crane at a time when no drive moves, with its parameters at their defaults."""
    q, size = crane.q, len(crane.coordinates)
    stiffness, damping, rest = np.zeros((3, size))
    elongations = ca.vertcat(*[support.elongation for support in crane.supports])
    springs = crane.elements + crane.drives + crane.joint_dampers
    numbers_of = [ca.vertcat(*map(ca.SX, (s.motion, s.stiffness, s.damping))) for s in springs]
    function = ca.Function(
        "springs",
        [crane.time, q, crane.parameters],
        [
            ca.vertcat(*numbers_of),
            ca.densify(ca.jacobian(elongations, q)),
            elongations,
            ca.vertcat(*[support.stiffness for support in crane.supports]),
            ca.vertcat(*[support.damping for support in crane.supports]),
        ],
    )
    defaults = ca.DM([*crane.spec.defaults.values()])
    numbers, rows, shift, row_stiffness, row_damping = (
        value.full() for value in function(time, ca.DM.zeros(size), defaults)
    )
    index = {coordinate.name: i for i, coordinate in enumerate(crane.coordinates)}
    for spring, (motion, spring_stiffness, spring_damping) in zip(springs, numbers.reshape(-1, 3)):
        i = index[spring.coordinate.name]
        if stiffness[i] and spring_stiffness:
            raise ValueError(f"{spring.coordinate.name}: two springs")
        stiffness[i] += spring_stiffness
        damping[i] += spring_damping
        rest[i] += motion
    return Springs(stiffness, damping, rest, rows, -shift.ravel(), row_stiffness.ravel(), row_damping.ravel())
