"""Cylinders moved by oil: pressures of chambers and pump from volume balances, and positions of spools."""

import math

import casadi as ca
from crane_spec import constant

# Pressure difference below which the flow through an edge is laminar, Pa.
LAMINAR = 1e5
# Relief valves pass the nominal flow this fraction above their pressure; the pump delivers its maximum flow this far below its own.
BAND = 0.05
# Suction valves pass the nominal flow this far below the pressure of the tank, Pa.
SUCTION = 1e5
# An end stop yields by this much under the cylinder's maximum force, m; its damping, s/m.
STOP, STOP_DAMPING = 1e-3, 3.0


class Oil:
    """The oil of a crane: its states x, their scales, their rates, and the generalized forces of the cylinders.

    x holds pressure at the piston, pressure at the rod and opening for each cylinder with a valve, then the pressure of the pump.
    """

    def __init__(self, crane, rate):
        spec = crane.spec.keys
        self.names, self.scales, symbols, rates = [], [], [], []
        self.forces = ca.SX.zeros(crane.q.shape)
        moved = [pair for pair in zip(spec.get("cylinders", []), crane.cylinders) if "valve" in pair[0]]
        if not moved:
            self.x, self.rates = ca.SX(0, 1), ca.SX(0, 1)
            return
        supply = constant(spec["pump"]["pressure"])
        pump = ca.SX.sym("pump")
        taken = 0
        targets = wanted_motions(crane, moved, rate)
        for written, cylinder in moved:
            name = written["name"]
            piston, rod, spool = (ca.SX.sym(f"{name}_{what}") for what in ("piston", "rod", "spool"))
            symbols += [piston, rod, spool]
            self.names += [f"{name}_piston_pressure", f"{name}_rod_pressure", f"{name}_valve"]
            self.scales += [supply, supply, 1.0]
            own = Chambers(written, cylinder.length, rate(cylinder.length), (piston, rod), spool, pump)
            target = ca.substitute(own.lengths, ca.vertcat(crane.q, crane.v), ca.vertcat(*targets))
            rates += own.rates(target, opening_of(crane, cylinder))
            taken += ca.if_else(spool > 0, own.inflows[0], own.inflows[1])
            self.forces += ca.jacobian(cylinder.length, crane.q).T * own.force
        volume = constant(spec["pump"].get("volume", 5e-3))
        bulk_modulus = constant(moved[0][0]["bulk_modulus"])
        share = ca.fmax(0, ca.fmin(1, (supply - pump) / (BAND * supply)))
        self.x = ca.vertcat(*symbols, pump)
        self.rates = ca.vertcat(*rates, bulk_modulus / volume * (constant(spec["pump"]["max_flow"]) * share - taken))
        self.names.append("pump_pressure")
        self.scales.append(supply)


class Chambers:
    """The two chambers of a cylinder and the edges of its valve."""

    def __init__(self, written, length, speed, pressures, spool, pump):
        self.written, self.valve, self.spool, self.pump, self.pressures = written, written["valve"], spool, pump, pressures
        self.lengths = ca.vertcat(length, speed)
        bore, rod = constant(written["bore"]), constant(written["rod"])
        self.areas = math.pi / 4 * bore**2, math.pi / 4 * (bore**2 - rod**2)
        self.tank = constant(written.get("back_pressure", 0))
        self.limit = constant(written["max_pressure"])
        overlap = constant(self.valve.get("overlap", 0))
        self.gain = constant(self.valve["flow"]) / root(constant(self.valve["pressure_drop"]))
        opening = ca.fmax(0, (ca.fabs(spool) - overlap) / (1 - overlap)) * self.gain
        into = [opening * root(ca.fmax(0, pump - p)) for p in pressures]
        out = [opening * root(p - self.tank) for p in pressures]
        forwards = spool > 0
        self.inflows = into
        self.flows = ca.if_else(forwards, into[0], -out[0]), ca.if_else(forwards, -out[1], into[1])
        self.force = pressures[0] * self.areas[0] - pressures[1] * self.areas[1] - self.stop()

    def stop(self):
        """The force of the ends of the stroke, positive against extension."""
        extension, stroke = self.lengths[0] - constant(self.written["retracted"]), constant(self.written["stroke"])
        stiffness = self.areas[0] * self.limit / STOP
        ahead, behind = ca.fmax(0, extension - stroke), ca.fmax(0, -extension)
        damped = [ca.fmax(0, 1 + STOP_DAMPING * side * self.lengths[1]) for side in (1, -1)]
        return stiffness * (ahead * damped[0] - behind * damped[1])

    def rates(self, target, opening):
        """Rates of both pressures and of the spool; `target` is length and speed at the drive's motion, `opening` the command of a
        valve without a servo."""
        stroke = constant(self.written["stroke"])
        extension = ca.fmax(0, ca.fmin(stroke, self.lengths[0] - constant(self.written["retracted"])))
        leakage = constant(self.valve.get("leakage", 0)) * (self.pressures[0] - self.pressures[1])
        rates = []
        for side, way, sign in ((0, extension, 1), (1, stroke - extension, -1)):
            pressure, area = self.pressures[side], self.areas[side]
            volume = constant(self.written["hose_volumes"][side]) + area * way
            balance = self.flows[side] - sign * (area * self.lengths[1] + leakage) + self.guard(pressure)
            rates.append(constant(self.written["bulk_modulus"]) / volume * balance)
        wanted = opening if "opening" in self.valve else self.command(target)
        command = ca.fmax(-1, ca.fmin(1, wanted))
        return [*rates, (command - self.spool) / constant(self.valve["lag"])]

    def guard(self, pressure):
        """Flow into a chamber through relief and suction valves."""
        flow = constant(self.valve["flow"])
        relief = ca.fmax(0, pressure - self.limit) * flow / (BAND * self.limit)
        return ca.fmax(0, self.tank - pressure) * flow / SUCTION - relief

    def command(self, target):
        """The opening that the servo commands."""
        drop = constant(self.valve["pressure_drop"])
        ahead = target[1] > 0
        area, pressure = (ca.if_else(ahead, *pair) for pair in (self.areas, self.pressures))
        available = root(ca.fmax(self.pump - pressure, 0.1 * drop))
        share = constant(self.valve.get("feed_forward", 1))
        return constant(self.valve["gain"]) * (target[0] - self.lengths[0]) + share * area * target[1] / (self.gain * available)


def opening_of(crane, cylinder):
    """The command of a cylinder's valve over time."""
    return next(drive.opening for drive in crane.drives if drive.coordinate is cylinder.coordinate)


def root(difference):
    """A signed square root, linear near zero: laminar flow."""
    return difference / (difference**2 + LAMINAR**2) ** 0.25


def wanted_motions(crane, moved, rate):
    """Coordinates and rates with the joints that oil moves where their drives want them, and all others zero: beams are straight."""
    q, v = ca.SX.zeros(crane.q.shape), ca.SX.zeros(crane.v.shape)
    for _, cylinder in moved:
        motion = ca.SX(next(drive.motion for drive in crane.drives if drive.coordinate is cylinder.coordinate))
        place = crane.coordinates.index(cylinder.coordinate)
        q[place], v[place] = motion, rate(motion)
    return q, v
