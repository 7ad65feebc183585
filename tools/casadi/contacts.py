"""One-sided supports, which press on the ground and never pull.

Only the energy as a function of the elongation e and the force of the damper are written down; the rest is differentiated. With the
penetration `d = max(0, -e_z)`, lateral stiffness and all damping are scaled by `w = x² (3 - 2x)`, where x is s_z d over the pressing
force of full hold, at most 1.
"""

from dataclasses import dataclass

import casadi as ca


@dataclass
class Contact:
    """A one-sided support at a state: Jacobian of its elongation, energy, force on the crane, lost power, matrices for linearisation."""

    jacobian: ca.SX
    energy: ca.SX
    force: ca.SX
    lost: ca.SX
    at_rest: ca.SX
    step_stiffness: ca.SX
    step_damping: ca.SX


def contact(support, q, v):
    """The law of a one-sided support; `at_rest` is its damping in q at rest, the last two are for implicit steps."""
    e, rate = ca.SX.sym("e", 3), ca.SX.sym("rate", 3)
    pressed = ca.if_else(e[2] <= 0, -e[2], 0)
    x = ca.fmin(1, support.stiffness[2] * pressed / support.full_hold)
    share = x**2 * (3 - 2 * x)
    energy = (support.stiffness[2] * pressed**2 + share * ca.dot(support.stiffness[:2], e[:2] ** 2)) / 2
    spring = -ca.gradient(energy, e)
    damper = -share * support.damping * rate
    total = spring + damper
    presses = total[2] > 0
    force = ca.vertcat(total[:2], ca.if_else(presses, total[2], 0))
    # Power not stored in the spring: that of the damper, and of the spring where both together would pull.
    lost = -ca.dot(ca.vertcat(damper[:2], ca.if_else(presses, damper[2], -spring[2])), rate)
    # Never negative: the slope of the force along z, the scaled stiffness sideways.
    normal = ca.if_else(presses, ca.fmax(0, -ca.jacobian(total[2], e[2])), 0)
    stiffness = ca.vertcat(share * support.stiffness[:2], normal)
    damping = share * support.damping
    step_damping = ca.vertcat(damping[:2], ca.if_else(presses, damping[2], 0))

    jacobian = ca.jacobian(support.elongation, q)
    here = lambda expression: ca.substitute(expression, ca.vertcat(e, rate), ca.vertcat(support.elongation, jacobian @ v))
    over_q = lambda diagonal: jacobian.T @ ca.diag(here(diagonal)) @ jacobian
    pull = ca.SX.sym("pull", 3)
    turned = ca.jacobian(jacobian.T @ pull, q)
    geometric = ca.substitute(turned, pull, here(-spring))
    return Contact(
        jacobian,
        here(energy),
        here(force),
        here(lost),
        over_q(damping),
        over_q(stiffness) + geometric,
        over_q(step_damping),
    )
