"""Beams as rigid elements joined by springs and dampers [Urbaś 2016, Eqs. (10)-(15)]."""

import math
from dataclasses import dataclass

import casadi as ca
import numpy as np

from inertias import pseudo_inertia, read_pseudo_inertia

DIRECTIONS = ("psi", "theta", "phi")
# ζ(5)·31/32: the sum of 1/n⁵ over odd n, the limit of the torsion series for a thin rectangle.
ODD_RECIPROCAL_FIFTH_POWERS = 31 / 32 * 1.0369277551433699263313654865


@dataclass
class Section:
    """Cross-section: area m²; second moments about its y and z axes, torsion constant, m⁴."""

    area: object
    Jy: object
    Jz: object
    Jo: object
    moduli: list = None


@dataclass
class Plates:
    """A closed box of two flanges and two webs, (length, thickness) each, the webs between the flanges."""

    flange: tuple
    web: tuple

    def second_moments(self):
        """Jy, Jz: own moment of each plate, and Steiner's term of those beside the axis."""
        (b, t), (h, s) = self.flange, self.web
        jy = 2 * (t * b**3 / 12 + h * s**3 / 12 + h * s * ((b - s) / 2) ** 2)
        jz = 2 * (s * h**3 / 12 + b * t**3 / 12 + b * t * ((h + t) / 2) ** 2)
        return jy, jz

    def section(self):
        """Area and second moments."""
        (b, t), (h, s) = self.flange, self.web
        circulation = 2 * (b - s) / t + 2 * (h + t) / s  # ∮ ds/t along the middle of the walls
        return Section(2 * (b * t + h * s), *self.second_moments(), 4 * ((b - s) * (h + t)) ** 2 / circulation)

    def moduli(self):
        """A, Wy, Wz, Wt, Ay, Az."""
        (b, t), (h, s) = self.flange, self.web
        jy, jz = self.second_moments()
        first_z = b * t * (h + t) / 2 + s * h**2 / 4
        first_y = h * s * (b - s) / 2 + t * b**2 / 4
        torsion = 2 * (b - s) * (h + t) * ca.fmin(t, s)
        return [2 * (b * t + h * s), jy / (b / 2), jz / (h / 2 + t), torsion, jz * 2 * s / first_z, jy * 2 * t / first_y]


def plates_of(size):
    """The plates of a welded box."""
    return Plates((size["width"], size["flange"]), (size["height"] - 2 * size["flange"], size["web"]))


def section_moduli(shape, size, section):
    """A, Wy, Wz, Wt, Ay, Az of a shape, and 1 if it has corners: maximum stresses are N/A, M/W and Q/A.

    Bending: J over the distance to the outermost fibre. Shear: Q S/(J t) at the neutral axis, S the first moment of half
    of the section, t the width there. Torsion: Bredt for the box, J over the radius for the round ones, Saint-Venant's series for
    the rectangle.
    """
    if shape == "numbers":
        if "moduli" not in size:
            return None
        given = size["moduli"]
        return [section.area, given["Wy"], given["Wz"], given["Wt"], given["Ay"], given["Az"], 1]
    if shape == "welded_box":
        return [*plates_of(size).moduli(), 1]
    if shape in ("box", "solid"):
        h, b = size["height"], size["width"]
        wall = size.get("thickness")
        first = [b * h * h / 8, h * b * b / 8]
        width = [b, h]
        if shape == "box":
            hi, bi = h - 2 * wall, b - 2 * wall
            first = [first[0] - bi * hi * hi / 8, first[1] - hi * bi * bi / 8]
            width = [2 * wall, 2 * wall]
            torsion = section.Jo * (h + b - 2 * wall) / ((h - wall) * (b - wall))
        else:
            long, short = ca.fmax(h, b), ca.fmin(h, b)
            series = sum(1 / (n * n * ca.cosh(n * math.pi * long / (2 * short))) for n in range(1, 40, 2))
            torsion = section.Jo / (short * (1 - 8 / math.pi**2 * series))
        shear = [J * t / S for J, t, S in zip((section.Jz, section.Jy), width, first)]
        return [section.area, section.Jy / (b / 2), section.Jz / (h / 2), torsion, *shear, 1]
    outer = size["diameter"] / 2
    inner = outer - size["thickness"] if shape == "tube" else 0
    shear = section.Jz * 2 * (outer - inner) / (2 / 3 * (outer**3 - inner**3))
    return [section.area, section.Jy / outer, section.Jz / outer, section.Jo / outer, shear, shear, 0]


@dataclass
class Beam:
    """n + 1 rigid elements along x; spring k joins elements k and k + 1, each with its three directions.

    sections: moduli of all sections where forces are known, or None; those where the elements begin, until others are added. bend: angles
    between neighbours at rest, about z and y. borders: ends of the sections, unless elements are given one by one. `portion(a, b)`: H of the beam between two places, about the first, and `moduli_beside(x)`:
    those just before and just after a place, with `steps` where they jump; None if elements are given one by one.
    """

    lengths: list
    pseudo_inertias: list
    stiffness: list
    damping: list
    sections: list
    allowable_stress: object = 0
    bend: list = None
    borders: list = None
    portion: object = None
    moduli_beside: object = None
    steps: tuple = ()


def rectangle_torsion(one_side, other_side):
    """Saint-Venant's torsion constant of a solid rectangle a ≥ b, from the exact series.

    `J = a b³ (1/3 - 64/π⁵ b/a Σ tanh(nπa/2b)/n⁵)`, n odd. As tanh x = 1 - 2/(e²ˣ + 1), the remainder after the sum
    of 1/n⁵ decreases by at least e^(-2π) per term: ten terms exceed double precision.
    """
    a, b = ca.fmax(one_side, other_side), ca.fmin(one_side, other_side)
    rest = sum(2 / (ca.exp(n * math.pi * a / b) + 1) / n**5 for n in range(1, 20, 2))
    series = ODD_RECIPROCAL_FIFTH_POWERS - rest
    return a * b**3 * (1 / 3 - 64 / math.pi**5 * b / a * series)


def read_section(spec, section):
    """A section from its shape; height is along y, width along z."""
    shape, size = read_size(spec, section)
    return section_of(shape, size)


def read_size(spec, section):
    """Name of a shape, and its numbers."""
    ((shape, written),) = section.items()
    size = {
        key: {name: spec.number(number) for name, number in value.items()} if key == "moduli" else spec.number(value)
        for key, value in written.items()
    }
    return shape, size


def section_of(shape, size):
    """A section of these dimensions."""
    section = read_shape(shape, size)
    section.moduli = section_moduli(shape, size, section)
    return section


def read_shape(shape, size):
    """Area and second moments of a shape."""
    if shape == "numbers":
        return Section(size["area"], size["Jy"], size["Jz"], size["Jo"])
    if shape == "box":
        h, b, t = size["height"], size["width"], size["thickness"]
        hi, bi = h - 2 * t, b - 2 * t
        bredt = 4 * ((h - t) * (b - t)) ** 2 * t / (2 * (h - t) + 2 * (b - t))  # 4 A_m² t / perimeter
        return Section(h * b - hi * bi, (h * b**3 - hi * bi**3) / 12, (b * h**3 - bi * hi**3) / 12, bredt)
    if shape == "welded_box":
        return plates_of(size).section()
    if shape == "solid":
        h, b = size["height"], size["width"]
        return Section(h * b, h * b**3 / 12, b * h**3 / 12, rectangle_torsion(h, b))
    if shape in ("tube", "circle"):
        outer = size["diameter"] / 2
        inner = outer - size["thickness"] if shape == "tube" else 0
        bending = math.pi / 4 * (outer**4 - inner**4)
        return Section(math.pi * (outer**2 - inner**2), bending, bending, 2 * bending)
    raise ValueError(f"unknown section {shape!r}")


# Places of a beam closer to each other, or to an end, than this share of an equal section are one.
NEAR = 0.1


def acting(keys, link):
    """Where along a link something acts, as written: other links, loads, contacts, pins of cylinders with a valve, connectors, loop joints."""
    points = [other["on"] for other in keys["links"] if isinstance(other.get("on"), dict) and isinstance(other["on"].get("at"), list)]
    points += [other for other in [*keys.get("loads", []), *keys.get("contacts", [])] if "at" in other]
    for cylinder in keys.get("cylinders", []):
        if "valve" in cylinder:
            points += [cylinder["foot"], cylinder["head"]]
            if "linkage" in cylinder:
                points.append({"link": cylinder["foot"]["link"], "at": cylinder["linkage"]["pivot"]})
    for joined in [*keys.get("connectors", []), *keys.get("loop_joints", [])]:
        points += [joined["from"], joined["to"], *joined.get("over", [])]
    return [point["at"][0] for point in points if point.get("link") == link]


def borders_of(spec, link, count, length):
    """Ends of all sections: at the beginning, wherever something acts, at the end, and evenly between them. At least `count` sections."""
    if count == 0:
        return [0, length]
    whole, marks = spec.default(length), [(0.0, 0)]
    for x, place in sorted(((spec.default(x), x) for x in map(spec.number, acting(spec.keys, link))), key=lambda both: both[0]):
        if min(abs(x - marks[-1][0]), abs(x - whole)) > NEAR * whole / count and 0 <= x < whole:
            marks.append((x, place))
    marks.append((whole, length))
    counts = [max(1, math.floor(count * (marks[k + 1][0] - marks[k][0]) / whole + 0.5)) for k in range(len(marks) - 1)]
    while sum(counts) < count:
        sizes = [(marks[k + 1][0] - marks[k][0]) / counts[k] for k in range(len(counts))]
        counts[next(k for k, size in enumerate(sizes) if size >= max(sizes) * (1 - 1e-9))] += 1
    borders = []
    for (_, begin), (_, end), parts in zip(marks, marks[1:], counts):
        borders += [begin + (end - begin) / parts * k for k in range(parts)]
    return [*borders, length]


def read_beam(spec, beam, link):
    """A beam from sections, material and shape, or from its elements one by one."""
    if "elements" in beam:
        return read_elements(spec, beam)
    length = spec.number(beam["length"])
    material = beam["material"]
    if isinstance(material, str):
        material = spec.keys["materials"][material]
    E, G, density = (spec.number(material[key]) for key in ("E", "G", "density"))
    extra = spec.number(beam.get("extra_mass", 0))

    sections = written = 0 if beam["sections"] == "rigid" else int(beam["sections"])
    borders = borders_of(spec, link, sections, length)
    parts_of = [end - begin for begin, end in zip(borders, borders[1:])]
    sections = len(parts_of) if sections else 0
    lengths = [(one + other) / 2 for one, other in zip([0, *parts_of], [*parts_of, 0])] if sections else [length]
    if "parts" in beam:
        parts = Parts(spec, beam["parts"])
        begins = [sum(lengths[:k], 0.0) for k in range(sections + 1)]
        masses = [parts.inertia(begin, begin + l, density, extra) for begin, l in zip(begins, lengths)]
        stiffness = [parts.stiffness(*map(spec.default, borders[k : k + 2]), E, G) for k in range(sections)]
        moduli = [parts.section(begin).moduli for begin in begins]
        portion = lambda begin, end: parts.inertia(spec.default(begin), spec.default(end), density, extra)
        beside = lambda x: [parts.section(x, part).moduli for part in (parts.part_before(x), parts.part(x))]
        steps = tuple(end for _, end, _, _ in parts.parts[:-1])
    else:
        section = read_section(spec, beam["section"])
        masses = [prism((density * section.area + extra) * l, l, section) for l in lengths]
        stiffness = [
            dict(zip(DIRECTIONS, (E * section.Jz / part, E * section.Jy / part, G * section.Jo / part))) for part in parts_of[:sections]
        ]
        moduli = [section.moduli] * (sections + 1)
        portion = lambda begin, end: prism((density * section.area + extra) * (end - begin), end - begin, section)
        beside, steps = (lambda x: [section.moduli] * 2), ()
    bend = beam.get("bend") or {}
    return Beam(
        lengths=lengths,
        pseudo_inertias=masses,
        stiffness=stiffness,
        damping=[
            read_damping(spec, beam.get("damping") or {}, each, length / written / part)
            for each, part in zip(stiffness, parts_of)
        ],
        sections=moduli,
        portion=portion,
        moduli_beside=beside,
        steps=steps,
        allowable_stress=spec.number(material.get("yield_stress", 0)) / spec.number(beam.get("safety_factor", 1.5)),
        bend=[tuple(spec.angle(bend.get(key, 0)) * part / length for key in ("psi", "theta")) for part in parts_of],
        borders=borders,
    )


class Parts:
    """Parts of a beam end to end, each with a section that may change linearly along it; integrals by slices."""

    def __init__(self, spec, written):
        self.parts, end = [], 0.0
        for part in written:
            begin, end = end, end + float(spec.number(part["length"]))
            self.parts.append((begin, end, read_size(spec, part["section"]), read_size(spec, part.get("to", part["section"]))))

    def part(self, x):
        """The part that begins at x or contains it; the last one at the tip."""
        return next((part for part in self.parts if x < part[1] - 1e-9), self.parts[-1])

    def part_before(self, x):
        """The part that ends at x or contains it; the first one at the beginning."""
        return next((part for part in self.parts if x <= part[1] + 1e-9), self.parts[-1])

    def section(self, x, part=None):
        """The section at x."""
        begin, end, (shape, first), (_, last) = part or self.part(x)
        if shape == "numbers":
            return section_of(shape, first)
        share = (x - begin) / (end - begin)
        return section_of(shape, {key: (1 - share) * first[key] + share * last[key] for key in first})

    def slices(self, begin, end):
        """Positions, lengths and sections of thin slices between two positions: Gauss-Legendre quadrature, 24 points per part."""
        places, weights = np.polynomial.legendre.leggauss(24)
        for part in self.parts:
            low, high = max(begin, part[0]), min(end, part[1])
            if high - low > 1e-9:
                for place, weight in zip(places, weights):
                    x = (low + high) / 2 + (high - low) / 2 * place
                    yield x, (high - low) / 2 * weight, self.section(x, part)

    def inertia(self, begin, end, density, extra):
        """H of the beam between two positions, about the first."""
        total = ca.SX(4, 4)
        for x, length, section in self.slices(begin, end):
            mass = (density * section.area + extra) * length
            slice_ = prism(mass, 0.0, section)
            shift = ca.SX.eye(4)
            shift[0, 3] = x - begin
            total += shift @ slice_ @ shift.T
        return total

    def stiffness(self, begin, end, E, G):
        """Stiffness of a section: its slices are springs in series, each turning by M dx/(E J)."""
        compliance = {direction: 0 for direction in DIRECTIONS}
        for _, length, section in self.slices(begin, end):
            for direction, rigidity in zip(DIRECTIONS, (E * section.Jz, E * section.Jy, G * section.Jo)):
                compliance[direction] += length / rigidity
        return {direction: 1 / value for direction, value in compliance.items()}


def prism(mass, length, section):
    """H of a prismatic element along x whose mass is distributed like its section."""
    slender = length**2 / 12
    tensor = ca.diag(
        ca.vertcat(
            mass * (section.Jy + section.Jz) / section.area,
            mass * (slender + section.Jy / section.area),
            mass * (slender + section.Jz / section.area),
        )
    )
    return pseudo_inertia(mass, ca.vertcat(length / 2, 0, 0), tensor)


def read_damping(spec, damping, stiffness, shorter):
    """Damping per direction: `beta` times the stiffness, or `coefficients`, which are those of equal sections; this one is shorter by a factor."""
    if "beta" in damping:
        beta = damping["beta"]
        beta = beta if isinstance(beta, dict) else dict.fromkeys(DIRECTIONS, beta)
        return {direction: spec.number(beta.get(direction, 0)) * stiffness[direction] for direction in DIRECTIONS}
    given = read_directions(spec, damping.get("coefficients", {}))
    return {direction: number * shorter for direction, number in given.items()}


def read_directions(spec, written):
    """A number for each of psi, theta, phi; 0 where none is given."""
    return {direction: spec.number((written or {}).get(direction, 0)) for direction in DIRECTIONS}


def read_elements(spec, beam):
    """A beam whose elements and springs are given one by one."""
    return Beam(
        lengths=[spec.number(element["length"]) for element in beam["elements"]],
        pseudo_inertias=[read_pseudo_inertia(spec, element) for element in beam["elements"]],
        stiffness=[read_directions(spec, spring["stiffness"]) for spring in beam["springs"]],
        damping=[read_directions(spec, spring.get("damping")) for spring in beam["springs"]],
        sections=[None] * len(beam["elements"]),
    )
