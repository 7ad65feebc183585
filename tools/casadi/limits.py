"""Drives whose effort has a limit: linear up to 95 % of it, the limit from 105 % on, and a parabola between; and efforts besides."""

import casadi as ca

# Where the parabola begins below the limit and ends above it, as a share of the limit.
CORNER = 0.05


def saturated(effort, limit):
    """The effort that a drive delivers, piece by piece."""
    size = ca.fabs(effort)
    low, high = (1 - CORNER) * limit, (1 + CORNER) * limit
    parabola = limit - (high - size) ** 2 / (4 * CORNER * limit)
    return ca.if_else(size < low, effort, ca.sign(effort) * ca.if_else(size < high, parabola, limit))


def stored(stiffness, stretch, limit):
    """Energy of the spring with a limit, the integral of its force over the stretch, piece by piece."""
    size = ca.fabs(stiffness * stretch)
    low, high, width = (1 - CORNER) * limit, (1 + CORNER) * limit, 4 * CORNER * limit

    def of_parabola(upto):
        return limit * (upto - low) + ((high - upto) ** 3 - (high - low) ** 3) / (3 * width)

    within = low**2 / 2 + of_parabola(size)
    beyond = low**2 / 2 + of_parabola(high) + limit * (size - high)
    return ca.if_else(size < low, size**2 / 2, ca.if_else(size < high, within, beyond)) / stiffness


def delivered(drive, effort, speed):
    """What a drive delivers of an effort at a speed of its joint: while driving, no more than its maximum power and rate allow."""
    driving = effort
    if drive.max_power is not None:
        driving = saturated(driving, drive.max_power / ca.fmax(ca.fabs(speed), drive.max_power / (2 * drive.max_effort)))
    if drive.max_rate is not None:
        left = ca.fmax(0, ca.fmin(1, 10 * (1 - ca.fabs(speed) / drive.max_rate)))
        driving *= left**2 * (3 - 2 * left)
    return ca.if_else(effort * speed > 0, driving, effort)


def limited_drive(drive, rate):
    """Effort, energy, lost power of a drive with a limit or an effort besides, and what its power input is beyond that of its motion with
    the delivered effort; `rate` takes the time derivative of its motion."""
    coordinate = drive.coordinate
    stretch, speed = drive.motion - coordinate.q, rate(ca.SX(drive.motion)) - coordinate.v
    passive = drive.stiffness * stretch + drive.damping * speed
    if drive.max_effort is None:
        # Spring and damper have no limit: they are among the linear ones. The effort acts on the joint, not on the motion.
        return drive.effort, 0, 0, -drive.effort * speed
    spring, passive, effort = (
        saturated(part, drive.max_effort) for part in (drive.stiffness * stretch, passive, passive + drive.effort)
    )
    own = delivered(drive, effort, coordinate.v)
    energy = stored(drive.stiffness, stretch, drive.max_effort) if drive.has_spring else 0
    # The far end of the transmission feels the whole effort of spring and damper, the joint what is delivered.
    return own, energy, (passive - spring) * speed, (passive - own) * speed


def energy_at_rest(drive):
    """Potential of the force of such a drive at rest."""
    stretch = drive.motion - drive.coordinate.q
    if drive.max_effort is None:
        return -drive.effort * drive.coordinate.q
    if not drive.has_spring:
        return -saturated(ca.SX(drive.effort), drive.max_effort) * drive.coordinate.q
    # The effort shifts the spring.
    return stored(drive.stiffness, stretch + drive.effort / drive.stiffness, drive.max_effort)


def slope_at_rest(drive):
    """The fraction of an increase in effort that a drive at rest delivers, from 1 down to 0."""
    effort = ca.SX.sym("effort")
    slope = ca.jacobian(saturated(effort, drive.max_effort), effort)
    return ca.substitute(slope, effort, drive.stiffness * (drive.motion - drive.coordinate.q) + drive.effort)
