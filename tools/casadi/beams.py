"""Beams as rigid elements joined by springs and dampers [Urbaś 2016, Eqs. (10)-(15)]."""

import math
from dataclasses import dataclass

import casadi as ca

from inertias import pseudo_inertia, read_pseudo_inertia

DIRECTIONS = ("psi", "theta", "phi")
# ζ(5)·31/32: the sum of 1/n⁵ over odd n, to which the torsion series of a rectangle tends for a thin one.
ODD_RECIPROCAL_FIFTH_POWERS = 31 / 32 * 1.0369277551433699263313654865


@dataclass
class Section:
    """Cross-section: area m²; second moments about its y and z axes, torsion constant, m⁴."""

    area: object
    Jy: object
    Jz: object
    Jo: object
    moduli: list = None


def section_moduli(shape, size, section):
    """A, Wy, Wz, Wt, Ay, Az of a shape, and 1 if it has corners: stresses are N/A, M/W and Q/A where they are greatest.

    Bending: J over the distance of the outermost fibre. Shear: Q S/(J t) at the neutral axis, S the first moment of half
    of the section, t the width there. Torsion: Bredt for the box, J over the radius for the round ones, Saint-Venant's series for
    the rectangle.
    """
    if shape == "numbers":
        if "moduli" not in size:
            return None
        given = size["moduli"]
        return [section.area, given["Wy"], given["Wz"], given["Wt"], given["Ay"], given["Az"], 1]
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
    """n + 1 rigid elements along x; spring k joins elements k and k + 1, each with its three directions."""

    lengths: list
    pseudo_inertias: list
    stiffness: list
    damping: list
    moduli: list = None
    allowable_stress: object = 0


def rectangle_torsion(one_side, other_side):
    """Saint-Venant's torsion constant of a solid rectangle a ≥ b, from the exact series.

    `J = a b³ (1/3 - 64/π⁵ b/a Σ tanh(nπa/2b)/n⁵)`, n odd. As tanh x = 1 - 2/(e²ˣ + 1), what is left after the sum
    of 1/n⁵ falls by e^(-2π) a term: ten terms are beyond double precision.
    """
    a, b = ca.fmax(one_side, other_side), ca.fmin(one_side, other_side)
    rest = sum(2 / (ca.exp(n * math.pi * a / b) + 1) / n**5 for n in range(1, 20, 2))
    series = ODD_RECIPROCAL_FIFTH_POWERS - rest
    return a * b**3 * (1 / 3 - 64 / math.pi**5 * b / a * series)


def read_section(spec, section):
    """A section from its shape; height is along y, width along z."""
    ((shape, written),) = section.items()
    size = {
        key: {name: spec.number(number) for name, number in value.items()} if key == "moduli" else spec.number(value)
        for key, value in written.items()
    }
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
    if shape == "solid":
        h, b = size["height"], size["width"]
        return Section(h * b, h * b**3 / 12, b * h**3 / 12, rectangle_torsion(h, b))
    if shape in ("tube", "circle"):
        outer = size["diameter"] / 2
        inner = outer - size["thickness"] if shape == "tube" else 0
        bending = math.pi / 4 * (outer**4 - inner**4)
        return Section(math.pi * (outer**2 - inner**2), bending, bending, 2 * bending)
    raise ValueError(f"unknown section {shape!r}")


def read_beam(spec, beam):
    """A beam from sections, material and shape, or from its elements one by one."""
    if "elements" in beam:
        return read_elements(spec, beam)
    length = spec.number(beam["length"])
    material = beam["material"]
    if isinstance(material, str):
        material = spec.keys["materials"][material]
    section = read_section(spec, beam["section"])
    E, G, density = (spec.number(material[key]) for key in ("E", "G", "density"))
    distributed_mass = density * section.area + spec.number(beam.get("extra_mass", 0))

    rigid = beam["sections"] == "rigid"
    sections = 0 if rigid else int(beam["sections"])
    part = length if rigid else length / sections
    lengths = [length] if rigid else [part / 2] + [part] * (sections - 1) + [part / 2]
    stiffness = dict(zip(DIRECTIONS, (E * section.Jz / part, E * section.Jy / part, G * section.Jo / part)))
    return Beam(
        lengths=lengths,
        pseudo_inertias=[prism(distributed_mass * l, l, section) for l in lengths],
        stiffness=[stiffness] * sections,
        damping=[read_damping(spec, beam.get("damping") or {}, stiffness)] * sections,
        moduli=section.moduli,
        allowable_stress=spec.number(material.get("yield_stress", 0)) / spec.number(beam.get("safety_factor", 1.5)),
    )


def prism(mass, length, section):
    """H of a prismatic element along x whose mass is spread like its section."""
    slender = length**2 / 12
    tensor = ca.diag(
        ca.vertcat(
            mass * (section.Jy + section.Jz) / section.area,
            mass * (slender + section.Jy / section.area),
            mass * (slender + section.Jz / section.area),
        )
    )
    return pseudo_inertia(mass, ca.vertcat(length / 2, 0, 0), tensor)


def read_damping(spec, damping, stiffness):
    """Damping per direction: `beta` times the stiffness, or `coefficients`."""
    if "beta" in damping:
        beta = damping["beta"]
        beta = beta if isinstance(beta, dict) else dict.fromkeys(DIRECTIONS, beta)
        return {direction: spec.number(beta.get(direction, 0)) * stiffness[direction] for direction in DIRECTIONS}
    return read_directions(spec, damping.get("coefficients", {}))


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
    )
