"""Forces with states in addition to pose and rates: the oil of cylinders with valves, and bristles of joints that stick."""

import casadi as ca

from hydraulics import Oil


class ForceStates:
    """The states x of a crane's forces, their names in results, their scales and rates, and the generalized forces."""

    def __init__(self, crane, rate):
        oil = Oil(crane, rate)
        self.names, self.scales, self.forces = list(oil.names), list(oil.scales), oil.forces
        states, rates = [oil.x], [oil.rates]
        for friction in crane.frictions:
            if friction.bristle is None:
                continue
            stiffness, damping = friction.bristle
            z, speed = ca.SX.sym(f"{friction.coordinate.name}_bristle"), friction.coordinate.v
            level = friction.coulomb + (friction.breakaway - friction.coulomb) * ca.exp(-((speed / friction.stribeck) ** 2))
            bends = speed - stiffness * ca.fabs(speed) / level * z
            states.append(z)
            rates.append(bends)
            self.names.append(f"{friction.coordinate.name}_bristle")
            self.scales.append(float(friction.breakaway) / stiffness)
            self.forces[crane.coordinates.index(friction.coordinate)] -= stiffness * z + damping * bends
        self.x, self.rates = ca.vertcat(*states), ca.vertcat(*rates)
