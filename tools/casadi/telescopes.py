"""Telescopes: the axis of a beam as a quadratic B-spline by de Casteljau's algorithm, section by section, and pads on which beams slide."""

from dataclasses import dataclass

import casadi as ca

from transforms import translate

# What holds a stage in addition to its joint.
HELD = ["y", "z", "psi", "theta", "phi"]
DIRECTIONS = ["y", "z", "twist"]
# The least of a section's compliance against twist that counts beside an exact pad.
LEAST_BESIDE = 0.02
# Within its clearance, a pad centres the beam with this fraction of its stiffness.
CENTRING = 1e-3


@dataclass
class Station:
    """A point of a body: the index of the body, the distance along it as written and with default parameters, the point's frame in the world."""

    body: int
    at: object
    along: float
    frame: ca.SX

    def moved(self, shift):
        """Its frame after a small displacement: a translation of its body, then a rotation about the world's origin."""
        rotation = ca.SX.eye(4)
        rotation[:3, :3] += ca.skew(shift[3:])
        return translate(shift[0], shift[1], shift[2]) @ rotation @ self.frame


@dataclass
class Pad:
    """A pad, the stations of the beam that slides on it, and what is measured there."""

    stations: list
    borders: list
    s: ca.SX
    direction: str
    springs: list

    @property
    def length(self):
        """Length of the beam."""
        return self.borders[-1]

    @property
    def sections(self):
        """Number of sections: springs, each in the middle of one."""
        return len(self.stations) // 2 - 1

    def within(self, k):
        """How much of section k is before s."""
        return (self.s - self.borders[k]) / (self.borders[k + 1] - self.borders[k])

    def strain(self, frames):
        """How far the axis of the beam is from the pad along y or z of the pad's body, or the sine of the twist."""
        pad, *beam = frames
        if self.direction == "twist":
            return ca.dot(pad[:3, 2], self.across(beam))
        axis = pad[:3, "xyz".index(self.direction)]
        return ca.dot(axis, self.axis(beam) - pad[:3, 3])

    def axis(self, frames):
        """P(s); straight beyond both ends."""
        middles, joints = frames[: self.sections + 1], frames[self.sections + 1 :]
        start, end, s = middles[0], middles[-1], self.s
        if self.sections == 0:
            return start[:3, 3] + s * start[:3, 0]
        curve = end[:3, 3] + (s - self.length) * end[:3, 0]
        for k in reversed(range(self.sections)):
            tau = self.within(k)
            first, joint, last = (frame[:3, 3] for frame in (middles[k], joints[k], middles[k + 1]))
            before, after = first + tau * (joint - first), joint + tau * (last - joint)
            curve = ca.if_else(s < self.borders[k + 1], before + tau * (after - before), curve)
        return ca.if_else(s < 0, start[:3, 3] + s * start[:3, 0], curve)

    def across(self, frames):
        """y of the beam at s, evenly from element to element."""
        middles, s = frames[: self.sections + 1], self.s
        turned = middles[-1][:3, 1]
        for k in reversed(range(self.sections)):
            tau = self.within(k)
            turned = ca.if_else(s < self.borders[k + 1], (1 - tau) * middles[k][:3, 1] + tau * middles[k + 1][:3, 1], turned)
        return ca.if_else(s < 0, middles[0][:3, 1], turned)

    def softness(self):
        """How much further than the curve a torque of 1 at the pad turns the beam there, and that times the damping over the stiffness of sections."""
        shares = [ca.fmin(ca.fmax(self.within(k), 0), 1) for k in range(self.sections)]
        soft = [share * (1 - share) / spring.stiffness for share, spring in zip(shares, self.springs)]
        return sum(soft, ca.SX(0)), sum((c * spring.damping / spring.stiffness for c, spring in zip(soft, self.springs)), ca.SX(0))

    def held_by(self, stiffness, damping, clearance):
        """Stiffness, damping, clearance and centring of a pad and what is soft beside it, one after the other."""
        soft, viscous = self.softness()
        pad, centred = 1 / stiffness, 1 / (CENTRING * stiffness)
        whole = 1 / (pad + soft)
        damping = whole**2 * (damping * pad**2 + viscous)
        return whole, damping, clearance * (1 + soft / centred), (pad + soft) / (centred + soft)

    def held_exactly(self, spec):
        """The same of an exact pad, which gives way by what is beside it, or by a little."""
        stiffest = max(self.springs, key=lambda spring: spec.default(spring.stiffness))
        soft, viscous = self.softness()
        least = LEAST_BESIDE / stiffest.stiffness
        soft, viscous = ca.fmax(soft, least), ca.fmax(viscous, least * stiffest.damping / stiffest.stiffness)
        return 1 / soft, viscous / soft**2, ca.SX(0), ca.SX(CENTRING)

    def value(self):
        """The strain at the present pose."""
        return self.strain([station.frame for station in self.stations])

    def wrenches(self):
        """Force and moment about the world's origin on the body of each station, for a tension of 1: minus the slopes over its displacement."""
        shifts = [ca.SX.sym("shift", 6) for _ in self.stations]
        strain = self.strain([station.moved(shift) for station, shift in zip(self.stations, shifts)])
        every = ca.vertcat(*shifts)
        slopes = ca.densify(ca.substitute(-ca.gradient(strain, every), every, ca.DM.zeros(every.shape)))
        return [slopes[6 * k : 6 * k + 6] for k in range(len(shifts))]

    def on_elements(self):
        """Of each element of the beam: its body, the distance of the pad from its beginning, and 1 if the pad is on it, else 0."""
        begins = [0, *((self.borders[k] + self.borders[k + 1]) / 2 for k in range(self.sections))]
        begun = [1, *(ca.if_else(self.s > begin, 1, 0) for begin in begins[1:]), 0]
        for k, begin in enumerate(begins):
            s = ca.fmin(ca.fmax(self.s, 0), self.length)
            yield self.stations[1 + k].body, s - begin, begun[k] - begun[k + 1]

    def actions(self):
        """What a tension of 1 exerts: body, where along it, force and moment about the world's origin. The beam receives the opposite of the pad."""
        own = self.wrenches()[0]
        yield self.stations[0].body, self.stations[0].along, own[:3], own[3:]
        for body, distance, here in self.on_elements():
            yield body, distance, -here * own[:3], -here * own[3:]


def slide(crane, name):
    """The motions of a stage in the frame of the outer beam's beginning: that of its joint, and what the pads hold."""
    motion = crane.move(name, "x")
    for symbol in HELD:
        motion = motion @ crane.move(name, symbol)
        crane.coordinates[-1].is_held = True
    return motion


def length_of(span):
    """Length of a beam."""
    return span.starts[-1] + span.last


def stations_of(crane, span, index_of):
    """Where the curve touches the elements (the first at its beginning, the last at its end), then the joints between them, at the ends of the first ones."""
    n = len(span.bodies) - 1
    half = [(end - begin) / 2 for begin, end in zip(span.borders, span.borders[1:])]
    middles, joints = [], []

    def station(element, at, x):
        body = span.bodies[element]
        return Station(index_of(crane, body), at, crane.spec.default(at), body.transform @ translate(x=x))

    for element in range(n + 1):
        x = 0 if element == 0 else half[element - 1]
        middles.append(station(element, x, x))
        if element < n:
            end = x + half[element]
            joints.append(station(element, end, end))
    return middles + joints


def read_pads(crane, link, spans, index_of):
    """The pads of a stage, front and rear, each with stiffness, damping, clearance and centring, or None in place of these of an exact one."""
    written = link["beam"]["slides_in"]
    spec = crane.spec
    outer, inner = spans[written["beam"]], spans[link["name"]]
    overlap, q = spec.number(written["overlap"]), crane.coordinate(f"{link['name']}_x").q
    end = length_of(outer) - outer.starts[-1]
    last, first = index_of(crane, outer.bodies[-1]), index_of(crane, inner.bodies[0])
    front = Station(last, end, spec.default(end), outer.bodies[-1].transform @ translate(x=end))
    rear = Station(first, 0, 0.0, inner.bodies[0].transform)
    sides = [
        (written["pads"]["front"], front, inner, overlap - q, link["name"]),
        (written["pads"]["rear"], rear, outer, length_of(outer) - overlap + q, written["beam"]),
    ]
    for keys, pad, beam, s, name in sides:
        stations = [pad, *stations_of(crane, beam, index_of)]
        springs = [twist_spring(crane, f"{name}_{k}_phi") for k in range(1, len(beam.bodies))]
        vectors = [spec.vector(keys.get(key, [0, 0, 0])) for key in ("stiffness", "damping", "clearance")]
        for number, direction in enumerate(DIRECTIONS):
            pad_there = Pad(stations, beam.borders, s, direction, springs if direction == "twist" else [])
            if direction in keys.get("exact", []):
                yield pad_there, pad_there.held_exactly(spec) if pad_there.springs else None
            elif spec.default(vectors[0][number]) != 0 or not vectors[0][number].is_constant():
                law = [v[number] for v in vectors]
                yield pad_there, pad_there.held_by(*law) if pad_there.springs else [*law, CENTRING]


def twist_spring(crane, name):
    """The spring of a coordinate of a beam."""
    return next(spring for spring in crane.elements if spring.coordinate.name == name)
