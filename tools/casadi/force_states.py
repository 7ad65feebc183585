"""Forces with states in addition to pose and rates: the oil of cylinders with valves, feet that slide, and bristles of joints that stick."""

import casadi as ca

from contacts import sliding
from hydraulics import Oil


class ForceStates:
    """The states x of a crane's forces, their names in results, their scales and rates, and the generalized forces."""

    def __init__(self, crane, rate):
        oil = Oil(crane, rate)
        self.names, self.scales, self.forces = list(oil.names), list(oil.scales), oil.forces
        states, rates = [oil.x], [oil.rates]
        feet = [support for support in crane.supports if support.friction is not None]
        ways = []
        for foot in feet:
            slid = ca.SX.sym(f"{foot.name}_slid", 2)
            force, slides = sliding(foot, rate, slid)
            ways.append((slid, slides))
            self.forces += ca.jacobian(foot.elongation[:2], crane.q).T @ force
        # All along x, then all along y.
        for index, axis in enumerate("xy"):
            states += [slid[index] for slid, _ in ways]
            rates += [slides[index] for _, slides in ways]
            self.names += [f"{foot.name}_slid_{axis}" for foot in feet]
            self.scales += [1e-2] * len(feet)
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
