"""Prescribed motions of drives, `q_dr(t)`: constant before they begin and after they end."""

import math

import casadi as ca
import numpy as np
from crane_spec import constant
from scipy.interpolate import PchipInterpolator


def clamp(time, begin, duration):
    """The elapsed fraction of a motion, 0…1."""
    return ca.fmin(ca.fmax((time - begin) / duration, 0), 1)


def quintic(tau):
    """At rest with zero acceleration at both ends."""
    return 10 * tau**3 - 15 * tau**4 + 6 * tau**5


def cubic(tau):
    """At rest at both ends."""
    return 3 * tau**2 - 2 * tau**3


def cycloid(tau):
    """Sinusoidal acceleration."""
    return tau - ca.sin(2 * math.pi * tau) / (2 * math.pi)


def trapezoid(tau, blend):
    """The integral of a velocity that rises over the first `blend` of the time, stays constant, and falls over the last.

    The area of a trapezoid of height v is `v (1 - blend) = 1`.
    """
    speed = 1 / (1 - blend)
    rising = speed * tau**2 / (2 * blend)
    steady = speed * (tau - blend / 2)
    falling = 1 - speed * (1 - tau) ** 2 / (2 * blend)
    return ca.if_else(tau < blend, rising, ca.if_else(tau < 1 - blend, steady, falling))


def speed(time, rate, begin, ramp):
    """The distance at a constant speed that is reached over `ramp` seconds, `rate (3τ² - 2τ³)`; without a ramp, at once."""
    if ramp is None:
        return ca.if_else(time < begin, 0, rate * (time - begin))
    tau = (time - begin) / ramp
    reaching = rate * ramp * (tau**3 - tau**4 / 2)
    reached = rate * ramp / 2 + rate * (time - begin - ramp)
    return ca.if_else(time < begin, 0, ca.if_else(time < begin + ramp, reaching, reached))


def spline(time, times, values):
    """Cubic spline through the values with zero slope at both ends, continuous to the second derivative.

    Solved for the slopes m at the knots: `m₀ = mₙ = 0`, and between them equal second derivatives of the Hermite
    pieces on both sides, `m₋/h₋ + 2 (1/h₋ + 1/h₊) m + m₊/h₊ = 3 (Δ₋/h₋² + Δ₊/h₊²)`.
    """
    times, values = np.asarray(times), np.asarray(values)
    h, delta = np.diff(times), np.diff(values)
    system, right = np.eye(len(times)), np.zeros(len(times))
    for k in range(1, len(times) - 1):
        system[k, k - 1 : k + 2] = 1 / h[k - 1], 2 / h[k - 1] + 2 / h[k], 1 / h[k]
        right[k] = 3 * (delta[k - 1] / h[k - 1] ** 2 + delta[k] / h[k] ** 2)
    return hermite(time, times, values, np.linalg.solve(system, right))


def monotone(time, times, values):
    """Cubic pieces whose slopes between two rises of one sign are those of SciPy's `pchip`; zero at both ends."""
    slopes = PchipInterpolator(times, values).derivative()(times) if len(times) > 2 else np.zeros(2)
    slopes[[0, -1]] = 0
    return hermite(time, np.asarray(times), np.asarray(values), slopes)


def linear(time, times, values):
    """Straight pieces."""
    position = ca.SX(values[-1])
    for k in reversed(range(len(times) - 1)):
        piece = values[k] + (values[k + 1] - values[k]) * (time - times[k]) / (times[k + 1] - times[k])
        position = ca.if_else(time < times[k + 1], piece, position)
    return ca.if_else(time < times[0], values[0], position)


def hermite(time, times, values, slopes):
    """Cubic pieces through values with slopes; constant before and after."""
    h = np.diff(times)
    position = ca.SX(values[-1])
    for k in reversed(range(len(h))):
        u = (time - times[k]) / h[k]
        piece = (
            (1 + 2 * u) * (1 - u) ** 2 * values[k]
            + u * (1 - u) ** 2 * h[k] * slopes[k]
            + u**2 * (3 - 2 * u) * values[k + 1]
            + u**2 * (u - 1) * h[k] * slopes[k + 1]
        )
        position = ca.if_else(time < times[k + 1], piece, position)
    return ca.if_else(time < times[0], values[0], position)


def read_motion(spec, part, is_rotation, time):
    """The same of a drive or a rope, with its emergency stop: the motion's own time has the rate 1, falls evenly to 0, and stays there."""
    motion = part.get("motion", {"hold": 0})
    if "halt" not in part:
        return read_profile(spec, motion, is_rotation, time)
    at, within = (spec.number(part["halt"][key]) for key in ("at", "within"))
    slowing = time - at
    own = ca.if_else(time < at, time, ca.if_else(slowing < within, at + slowing - slowing**2 / (2 * within), at + within / 2))
    position, _ = read_profile(spec, motion, is_rotation, own)
    return position, (spec.default(at), spec.default(at + within))


def read_profile(spec, motion, is_rotation, time):
    """`q_dr(t)` and the interval in which it moves, from a drive's `motion:`."""
    ((kind, written),) = motion.items()
    if kind == "input":
        # The default of an input: a value or a motion.
        unless_set = spec.get("inputs", {})[written]
        return read_profile(spec, unless_set.get("motion", {"hold": unless_set.get("value", 0)}), is_rotation, time)
    if kind == "hold":
        return ca.SX(spec.position(written, is_rotation)), (0.0, 0.0)
    if kind == "table":
        times = [constant(t) for t in written["times"]]
        values = [spec.position(value, is_rotation) for value in written["values"]]
        shape = {"monotone": monotone, "spline": spline, "linear": linear}[written.get("shape", "monotone")]
        return shape(time, times, values), (times[0], times[-1])

    if kind == "speed":
        start, rate = (spec.position(written.get(key, 0), is_rotation) for key in ("from", "rate"))
        begin, ramp = spec.number(written.get("begin", 0)), written.get("ramp")
        ramp = None if ramp is None else spec.number(ramp)
        reached = spec.default(begin + (ramp or 0))
        return start + speed(time, rate, begin, ramp), (spec.default(begin), reached + 1.0)

    start, end = (spec.position(written[key], is_rotation) for key in ("from", "to"))
    begin, duration = spec.number(written.get("begin", 0)), spec.number(written["duration"])
    tau = clamp(time, begin, duration)
    shapes = {
        "quintic": quintic,
        "cubic": cubic,
        "cycloid": cycloid,
        "trapezoid": lambda tau: trapezoid(tau, constant(written.get("blend", 0.25))),
    }
    share = shapes[kind](tau)
    return start + (end - start) * share, (spec.default(begin), spec.default(begin + duration))
