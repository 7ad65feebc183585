"""One-sided supports, which press on the ground, never pull, and hold sideways by friction.

A pad is a spring and a damper in parallel; the ground lets it slide where their lateral force F exceeds the coefficient of friction times
the force N with which the pad presses. How far it has slid is a state of a run (`force_states.py`); functions of pose and rates have it where
the spec puts it. Powers, pulls and the matrices of small motions follow from force and energy by differentiation.
"""

from dataclasses import dataclass

import casadi as ca

# A lateral force that does not count, N: a foot that just touches the ground, without a lateral force, sticks.
SMALLEST = 1e-15
# How soon a pad without a damper follows the ground on which it slides, s.
FOLLOWING = 1e-3


@dataclass
class Contact:
    """A one-sided support at a state: Jacobian of its elongation, energy, force on the crane, lost power, matrices for linearisation.

    `pull` is minus the generalized force at rest, `stiffness` its derivative where the foot sticks, `at_rest` the damping there; a foot that slides is
    free sideways. `grip` has N, the lateral force up to which it sticks, and |F|. The last two are for implicit steps.
    """

    jacobian: ca.SX
    energy: ca.SX
    force: ca.SX
    lost: ca.SX
    pull: ca.SX
    stiffness: ca.SX
    at_rest: ca.SX
    grip: ca.SX
    step_stiffness: ca.SX
    step_damping: ca.SX


def vertical(support, e, rate):
    """The forces of spring and damper along z of a foot that presses."""
    return -support.stiffness[2] * e[2], -support.damping[2] * rate[2]


def pressing(support, e, rate):
    """N: the spring, and of the damper no more than the spring has."""
    spring, damper = vertical(support, e, rate)
    # A foot that just touches has no slope yet.
    spring = ca.if_else(spring > 0, spring, 0)
    pushed = ca.if_else(damper > -spring, damper, -spring)
    return spring + ca.if_else(pushed < spring, pushed, spring)


def lateral(support, e, rate, slid):
    """F of a pad that has slid to a place, its size, and the share of F that friction holds."""
    wanted = support.stiffness[:2] * (e[:2] - slid) + support.damping[:2] * rate[:2]
    size = ca.sqrt(ca.sumsqr(wanted) + SMALLEST**2)
    share = (support.friction * pressing(support, e, rate) + SMALLEST) / size
    return wanted, size, (e[2] <= 0) * ca.if_else(share < 1, share, 1)


def sliding(support, rate_of, slid):
    """What a pad that has slid adds to the force of one that has not, along x and y, and how fast it slides."""
    e, rate = support.elongation, rate_of(support.elongation)
    unmoved, _, held = lateral(support, e, rate, ca.SX.zeros(2))
    wanted, _, share = lateral(support, e, rate, slid)
    # A pad without spring and damper along an axis has no force there, and does not slide.
    following = ca.fmax(ca.fmax(support.damping[:2], FOLLOWING * support.stiffness[:2]), 1e-300)
    return held * unmoved - share * wanted, (1 - share) * wanted / following


def contact(support, q, v):
    """The law of a one-sided support that has not slid."""
    e, rate = ca.SX.sym("e", 3), ca.SX.sym("rate", 3)
    resting = lambda expression: ca.substitute(expression, rate, ca.SX.zeros(3))
    touches = e[2] <= 0
    normal = pressing(support, e, rate)
    wanted, size, share = lateral(support, e, rate, ca.SX.zeros(2))
    force = ca.vertcat(-share * wanted, normal)
    energy = touches * ca.dot(support.stiffness, e**2) / 2
    lost = -ca.dot(force, rate) - ca.jtimes(energy, e, rate)
    # Slopes of a pad whose friction holds; one that slides is free sideways, one in the air altogether.
    sticks = touches * resting(size <= support.friction * normal + SMALLEST)
    holds = ca.vertcat(sticks, sticks, touches)
    stiffness, at_rest = (holds * ca.diag(resting(ca.jacobian(ca.vertcat(wanted, -sum(vertical(support, e, rate))), of))) for of in (e, rate))
    holding = ca.vertcat(share, share, touches * (normal > 0))
    jacobian = ca.jacobian(support.elongation, q)
    here = lambda expression: ca.substitute(expression, ca.vertcat(e, rate), ca.vertcat(support.elongation, jacobian @ v))
    over_q = lambda diagonal: jacobian.T @ ca.diag(here(diagonal)) @ jacobian
    pull = ca.SX.sym("pull", 3)
    at_pose = here(resting(-force))
    geometric = ca.substitute(ca.jacobian(jacobian.T @ pull, q), pull, at_pose)
    return Contact(
        jacobian,
        here(energy),
        here(force),
        here(lost),
        jacobian.T @ at_pose,
        over_q(stiffness) + geometric,
        over_q(at_rest),
        here(ca.vertcat(normal, support.friction * normal, size)),
        over_q(holding * support.stiffness) + geometric,
        over_q(holding * support.damping),
    )
