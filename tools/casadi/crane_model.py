"""A crane as CasADi expressions: links become bodies with T(p) = T(λ(p)) T̃(p), λ(p) the body that carries p [Urbaś 2016, Eq. (3)]."""

import math
from dataclasses import dataclass, field

import casadi as ca

from beams import DIRECTIONS, Beam, read_beam
from crane_spec import CraneSpec, constant
from cuts import Cut
from cylinders import Cylinder, pin_of_rocker, turning_axis
from inertias import read_pseudo_inertia
from loop_joints import LoopJoint, read_loop_joint, read_pin
from profiles import read_motion, read_profile
from sections import add_sections
from telescopes import length_of, read_pads, slide
from transforms import classic_dh, modified_dh, place, rotate, rotate_by_vector, translate, translate_along

ROTATIONS = {"psi": "z", "theta": "y", "phi": "x"}
TRANSLATIONS = {"x": "x", "y": "y", "z": "z"}
ROTATION_NAMES = {axis: name for name, axis in ROTATIONS.items()}
# Two positions along a beam coincide if they differ by less than this fraction of its length: rounding of decimals.
SAME_PLACE = 1e-12
# What is attached to a beam this near to its end, as a fraction of its length, is attached to its tip.
AT_THE_TIP = 1e-9
FREE = ["x", "y", "z", "psi", "theta", "phi"]


@dataclass
class Coordinate:
    """A generalized coordinate: its name, its symbols, and what it belongs to."""

    name: str
    q: ca.SX
    v: ca.SX
    is_rotation: bool
    is_element: bool
    is_base: bool
    is_in_vector: bool = False
    is_held: bool = False


@dataclass
class Body:
    """A body: its pose in the world, the indices of the coordinates that move it, its pseudo-inertia (zero for a massless frame).

    `parent` is the index of the body that carries it, `at` the distance along that body, None at its end.
    """

    name: str
    transform: ca.SX
    moved_by: list
    pseudo_inertia: ca.SX
    parent: object = None
    at: object = None
    along: float = math.inf
    length: object = 0

    @property
    def degrees_of_freedom(self):
        """How many coordinates move it."""
        return len(self.moved_by)


@dataclass
class Spring:
    """Spring and damper on one coordinate: of an element or, with a motion, of a drive. A rigid drive has neither; a drive by oil
    has its spring at rest only. A drive may have an effort besides."""

    coordinate: Coordinate
    stiffness: object
    damping: object
    motion: object = 0
    moves_within: tuple = (0.0, 0.0)
    is_rigid: bool = False
    max_effort: object = None
    max_rate: object = None
    max_power: object = None
    effort: object = 0
    by_oil: bool = False
    opening: object = 0

    @property
    def holds(self):
        """Whether its motion says where the joint is at rest: not with an effort alone."""
        return self.is_rigid or isinstance(self.effort, int) or self.has_spring

    @property
    def has_spring(self):
        """Whether there is a spring: its stiffness is not the number 0."""
        return not (isinstance(self.stiffness, float) and self.stiffness == 0)


@dataclass
class Stop:
    """An end stop: the joint is beyond it where `sign * (q - at)` is positive."""

    coordinate: Coordinate
    at: object
    sign: int
    stiffness: object
    damping: object


@dataclass
class Friction:
    """Friction of a joint; `breakaway` equals `coulomb` unless given, `bristle` is stiffness and damping of bristles."""

    coordinate: Coordinate
    coulomb: object
    breakaway: object
    stribeck: object
    width: object
    viscous: object
    bristle: object = None


@dataclass
class Load:
    """An applied load: index of its body, distance along it (as written, and with default parameters), point of action, that body's rotation; force and moment along the world's axes."""

    body: int
    at: object
    along: float
    position: ca.SX
    rotation: ca.SX
    force: ca.SX
    moment: ca.SX


@dataclass
class Connector:
    """An element whose force follows from its length; if it is between points, the indices of the bodies that it pulls, the points in order, and
    their distances along the bodies (as written, and with default parameters). The last part of a rope counts once for every fall."""

    bodies: list
    points: list
    at: list
    along: list
    strain: ca.SX
    is_rope: bool
    stiffness: object
    damping: object
    length: object
    push: object
    progression: object = 0
    falls: int = 1
    clearance: object = 0
    centring: object = 0
    pad: object = None
    pin: object = None
    is_contact: bool = False

    def pulls(self, within=False):
        """Forces on the points at a tension of 1 N: minus the slopes of the length, `within`: of the parts between two bodies."""
        moved = [ca.SX.sym("point", 3) for _ in self.points]
        chosen = [None not in ends or not within for ends in zip(self.bodies, self.bodies[1:])]
        slopes = ca.gradient(length_over(moved, self.falls, chosen), ca.vertcat(*moved))
        forces = -ca.densify(ca.substitute(slopes, ca.vertcat(*moved), ca.vertcat(*self.points)))
        return ca.vertsplit(forces, 3)

    def wrenches(self, within=False):
        """What acts on bodies at a tension of 1: the body, the distance along it, force, moment about the world's origin."""
        if self.pad is not None:
            yield from self.pad.actions()
        elif self.pin is not None:
            yield from self.pin.wrenches(within)
        elif self.is_contact:
            up = ca.SX([0, 0, 1])
            if not within:
                yield self.bodies[0], self.along[0], up, ca.cross(self.points[0], up)
        elif self.points:
            for body, point, along, pull in zip(self.bodies, self.points, self.along, self.pulls(within)):
                yield body, along, pull, ca.cross(point, pull)


def length_over(points, falls, chosen=None):
    """Length of a rope over points, the last distance counted `falls` times; of the chosen parts, if some are chosen."""
    counts = [1] * (len(points) - 2) + [falls]
    parts = zip(counts, points, points[1:], chosen or [True] * len(counts))
    return sum((count * ca.norm_2(end - start) for count, start, end, is_chosen in parts if is_chosen), ca.SX(0))


@dataclass
class Support:
    """Springs and dampers along the world's axes; one entry each for x, y, z. `friction` is None if the support also pulls.

    `at` is the place in the frame of the base, `position` that in the world.
    """

    name: str
    at: ca.SX
    position: ca.SX
    elongation: ca.SX
    stiffness: ca.SX
    damping: ca.SX
    friction: object = None


@dataclass
class Span:
    """A link as bodies in a row, and where each begins along the undeformed link; the pose of its tip, the length of its last body, and the ends of
    a beam's sections."""

    bodies: list
    starts: list
    tip: object = None
    last: object = 0.0
    borders: list = None


@dataclass
class Place:
    """Where a link begins: the pose there, the body that carries it, and the distance along that, None at its end."""

    transform: ca.SX
    parent: object = None
    at: object = None


@dataclass
class Crane:
    """Everything a spec says, as expressions over t, q, v and the parameters."""

    spec: CraneSpec
    name: str
    time: ca.SX
    gravity: ca.SX
    coordinates: list = field(default_factory=list)
    bodies: list = field(default_factory=list)
    cuts: list = field(default_factory=list)
    rope_dampers: list = field(default_factory=list)
    supports: list = field(default_factory=list)
    elements: list = field(default_factory=list)
    beams: list = field(default_factory=list)
    drives: list = field(default_factory=list)
    joint_dampers: list = field(default_factory=list)
    rotors: list = field(default_factory=list)
    stops: list = field(default_factory=list)
    frictions: list = field(default_factory=list)
    loads: list = field(default_factory=list)
    cylinders: list = field(default_factory=list)
    connectors: list = field(default_factory=list)
    loop_joints: list = field(default_factory=list)
    points: dict = field(default_factory=dict)
    guess: list = field(default_factory=list)

    @property
    def q(self):
        """Positions, m and rad."""
        return ca.vertcat(*[coordinate.q for coordinate in self.coordinates])

    @property
    def v(self):
        """Velocities, m/s and rad/s."""
        return ca.vertcat(*[coordinate.v for coordinate in self.coordinates])

    @property
    def has_rotation_vectors(self):
        """Whether elements turn by rotation vectors, which a chain of hinges cannot represent."""
        return any(coordinate.is_in_vector for coordinate in self.coordinates)

    @property
    def parameters(self):
        """Live parameters in the order of the spec."""
        return ca.vertcat(*self.spec.parameters.values())

    @property
    def rigid_drives(self):
        """Rigid drives by the index of the coordinate that they prescribe."""
        places = {coordinate.name: place for place, coordinate in enumerate(self.coordinates)}
        return {places[drive.coordinate.name]: drive for drive in self.drives if drive.is_rigid}

    def coordinate(self, name):
        """The coordinate of that name."""
        return next(coordinate for coordinate in self.coordinates if coordinate.name == name)

    def move(self, link, symbol, is_element=False, is_base=False):
        """Adds the coordinate `<link>_<symbol>` and returns its elementary motion."""
        name = f"{link}_{symbol}"
        is_rotation = symbol in ROTATIONS
        coordinate = Coordinate(name, ca.SX.sym(name), ca.SX.sym(f"{name}_rate"), is_rotation, is_element, is_base)
        self.coordinates.append(coordinate)
        if is_rotation:
            return rotate(ROTATIONS[symbol], coordinate.q)
        return translate_along(TRANSLATIONS[symbol], coordinate.q)

    def add_body(self, name, transform, pseudo_inertia, place, length=0):
        """Adds a body that begins at a place; the coordinates added since the last body are those of its joint."""
        self.cuts.append(Cut(transform, len(self.bodies)))
        known = {index for body in self.bodies for index in body.moved_by}
        own = [index for index in range(len(self.coordinates)) if index not in known]
        before = [] if place.parent is None else self.bodies[place.parent].moved_by
        along = math.inf if place.at is None else self.spec.default(place.at)
        self.bodies.append(Body(name, transform, before + own, pseudo_inertia, place.parent, place.at, along, length))
        return self.bodies[-1]


def read_gravity(spec):
    """Gravity in the axes of the ground. A slope is turned back: first about z until it falls along x, then about y."""
    gravity = spec.vector(spec.get("gravity", [0, 0, -9.81]))
    slope = spec.get("slope", None)
    if slope is None:
        return gravity
    angle, towards = (spec.position(slope.get(key, 0), True) for key in ("angle", "towards"))
    inclined = ca.vertcat(-gravity[2] * ca.sin(angle), 0, gravity[2] * ca.cos(angle))
    return ca.mtimes(rotate("z", towards)[:3, :3], inclined)


def read_crane(path):
    """The crane of a YAML file."""
    spec = CraneSpec(path)
    time = ca.SX.sym("t")
    crane = Crane(spec, spec.keys["name"], time, read_gravity(spec))
    spans = read_links(crane)
    base = crane.bodies[0]
    for written in spec.get("supports", []):
        crane.supports.append(read_support(crane, written, base))
    for written in spec.get("drives", []):
        crane.drives.append(read_drive(crane, written))
        crane.rotors.append((crane.drives[-1].coordinate, spec.number(written.get("armature", 0))))
    for name, damping in spec.get("damping", {}).items():
        crane.joint_dampers.append(Spring(crane.coordinate(name), 0, spec.number(damping)))
    # A joint's own entry replaces the damping that the rope gives all its joints.
    crane.joint_dampers += [damper for damper in crane.rope_dampers if damper.coordinate.name not in spec.get("damping", {})]
    for name, armature in spec.get("armature", {}).items():
        crane.rotors.append((crane.coordinate(name), spec.number(armature)))
    for name, written in spec.get("stops", {}).items():
        crane.stops.extend(read_stops(spec, written, crane.coordinate(name)))
    for name, written in spec.get("friction", {}).items():
        crane.frictions.append(read_friction(spec, written, crane.coordinate(name)))
    for written in spec.get("loads", []):
        crane.loads.append(read_load(crane, written, spans[written["link"]]))
    for written in spec.get("cylinders", []):
        crane.cylinders.append(read_cylinder(crane, written, spans))
        for drive in crane.drives:
            if "valve" in written and drive.coordinate.name == written["coordinate"]:
                drive.by_oil = True
                drive.opening = read_opening(crane, written["valve"])
    for written in spec.get("connectors", []):
        crane.connectors.append(read_connector(crane, written, spans))
    for written in spec.get("contacts", []):
        crane.connectors.append(read_contact(crane, written, spans))
    for written in spec.get("couplings", []):
        if not written.get("rigid"):
            crane.connectors.append(read_coupling(crane, written))
    exact = []
    for link in spec.keys["links"]:
        if "slides_in" in link.get("beam", {}):
            for pad, law in read_pads(crane, link, spans, index_of):
                if law is None:
                    exact.append(LoopJoint(link["name"], [pad.value()], [], pad))
                    continue
                stiffness, damping, clearance, centring = law
                law = (False, stiffness, damping, 0, 0)
                crane.connectors.append(Connector([], [], [], [], pad.value(), *law, clearance=clearance, centring=centring, pad=pad))
    for written in spec.get("loop_joints", []):
        crane.loop_joints.append(read_loop_joint(crane, written, spans, carrier, read_guess(crane)))
        if "friction" in written or "damping" in written:
            crane.connectors.append(read_friction_of_pin(crane, written, spans))
    crane.loop_joints += exact
    for written in spec.get("couplings", []):
        if written.get("rigid"):
            crane.loop_joints.append(read_rigid_coupling(crane, written))
    for written in spec.get("points", []):
        crane.points[written["name"]] = read_point(spec, written, spans)
    add_sections(crane, [spans[link["name"]] for link in spec.keys["links"] if "beam" in link or "rope" in link])
    crane.guess = read_guess(crane)
    return crane


def read_links(crane):
    """Adds the bodies of all links and returns the span of each."""
    spans = {}
    crane.cuts.append(Cut(ca.SX.eye(4), 0))
    place = Place(ca.SX.eye(4))
    for index, link in enumerate(crane.spec.keys["links"]):
        name = link["name"]
        if "on" in link:
            place = read_place(crane, link["on"], spans)
        if "slides_in" in link.get("beam", {}):
            outer = spans[link["beam"]["slides_in"]["beam"]]
            place = Place(outer.bodies[0].transform, index_of(crane, outer.bodies[0]), 0.0)
            behind = length_of(outer) - crane.spec.number(link["beam"]["slides_in"]["overlap"])
            joint = frame = translate(x=behind) @ slide(crane, name)
        else:
            joint, frame = read_joint(crane, link, is_base=index == 0)
        if "rope" in link:
            joint = frame = frame @ swing(crane, f"{name}_1")
        crane.cuts.append(Cut(place.transform @ joint, len(crane.bodies)))
        transform = place.transform @ frame
        if "beam" in link:
            spans[name] = read_beam_bodies(crane, name, transform, link["beam"], place)
        elif "rope" in link:
            spans[name] = read_rope_bodies(crane, name, transform, link["rope"], place)
        else:
            body = crane.add_body(name, transform, read_link_inertia(crane.spec, link), place)
            spans[name] = Span([body], [0.0], transform)
        place = at_tip(crane, spans[name])
    return spans


def index_of(crane, body):
    """The index of a body."""
    return next(i for i, other in enumerate(crane.bodies) if other is body)


def at_tip(crane, span):
    """The place at the tip of a link."""
    return Place(span.tip, index_of(crane, span.bodies[-1]))


def read_place(crane, written, spans):
    """Where a link begins that is attached to an earlier one."""
    written = {"link": written} if isinstance(written, str) else written
    span, at = spans[written["link"]], written.get("at", "tip")
    if at == "tip":
        return at_tip(crane, span)
    if at == "start":
        return Place(span.bodies[0].transform, index_of(crane, span.bodies[0]), 0.0)
    at = crane.spec.vector(at)
    whole = crane.spec.default(span.starts[-1] + span.last)
    if whole > 0 and abs(crane.spec.default(at[0]) - whole) <= AT_THE_TIP * whole:
        return Place(span.tip @ translate(0, at[1], at[2]), index_of(crane, span.bodies[-1]))
    body, local = carrier(crane.spec, at, span)
    return Place(body.transform @ translate(local[0], local[1], local[2]), index_of(crane, body), local[0])


def read_link_inertia(spec, link):
    """H of a rigid link: of its only body, of all its bodies together, or zero."""
    written = link.get("bodies") or ([link] if "mass" in link else [])
    return sum((read_pseudo_inertia(spec, body) for body in written), ca.SX(4, 4))


def read_beam_bodies(crane, name, transform, written, place):
    """Adds the elements of a beam; returns its span."""
    beam = read_beam(crane.spec, written, name)
    crane.beams.append(beam)
    span, start = Span([], [], borders=beam.borders), 0.0
    for index, (length, pseudo_inertia) in enumerate(zip(beam.lengths, beam.pseudo_inertias)):
        element = f"{name}_{index}"
        if index > 0:
            motions = [crane.move(element, symbol, is_element=True) for symbol in DIRECTIONS]
            rotations = crane.coordinates[-3:]
            # A curved beam turns by half the angle of a section before its spring and by half after it.
            about_z, about_y = beam.bend[index - 1] if beam.bend else (0, 0)
            half_bend = rotate_by_vector(ca.vertcat(0, about_y / 2, about_z / 2))
            transform = transform @ half_bend
            if written.get("section_joint", "symmetric") == "paper":
                for motion in motions:
                    transform = transform @ motion
            else:
                for coordinate in rotations:
                    coordinate.is_in_vector = True
                transform = transform @ rotate_by_vector(ca.vertcat(*[c.q for c in reversed(rotations)]))
            transform = transform @ half_bend
            for coordinate, symbol in zip(rotations, DIRECTIONS):
                stiffness, damping = beam.stiffness[index - 1][symbol], beam.damping[index - 1][symbol]
                crane.elements.append(Spring(coordinate, stiffness, damping))
        body_name = name if written.get("sections") == "rigid" else element
        span.bodies.append(crane.add_body(body_name, transform, pseudo_inertia, place, length))
        span.starts.append(start)
        transform = transform @ translate(x=length)
        start = start + length
        place = Place(transform, len(crane.bodies) - 1)
    span.tip, span.last = transform, length
    return span


def swing(crane, name):
    """The universal joint at the beginning of a link of a rope: about z, then about y."""
    return crane.move(name, "psi") @ crane.move(name, "theta")


def read_rope_bodies(crane, name, transform, written, place):
    """Adds the links of a rope, whose first joint is in `transform`; returns its span."""
    count = int(written["links"])
    length = crane.spec.number(written["length"]) / count
    mass = crane.spec.number(written["mass_per_length"]) * length
    # A slender rod along x, about its beginning.
    pseudo_inertia = ca.SX(4, 4)
    pseudo_inertia[0, 0] = mass * length**2 / 3
    pseudo_inertia[0, 3] = pseudo_inertia[3, 0] = mass * length / 2
    pseudo_inertia[3, 3] = mass
    crane.beams.append(Beam([length] * count, [pseudo_inertia] * count, [], [], sections=[None] * count))
    span = Span([], [])
    for number in range(1, count + 1):
        if number > 1:
            transform = transform @ translate(x=length) @ swing(crane, f"{name}_{number}")
        for coordinate in crane.coordinates[-2:]:
            crane.rope_dampers.append(Spring(coordinate, 0, crane.spec.number(written.get("damping", 0))))
        span.bodies.append(crane.add_body(f"{name}_{number}", transform, pseudo_inertia, place, length))
        span.starts.append((number - 1) * length)
        place = Place(transform, len(crane.bodies) - 1)
    span.tip, span.last = transform @ translate(x=length), length
    return span


def read_joint(crane, link, is_base):
    """Poses of a link's joint and of the link after the joint's motions, in the frame that the link is attached to."""
    joint = link.get("joint", "fixed")
    kind, written = next(iter(joint.items())) if isinstance(joint, dict) else (joint, None)
    placement = link.get("placement") or {"transform": {}}
    ((convention, row),) = placement.items()

    if kind in ("fixed", "free"):
        constant = read_placement(crane.spec, convention, row or {})
        written = FREE if written is None else written
        for symbol in [symbol for symbol in FREE if kind == "free" and symbol in written]:
            constant = constant @ crane.move(link["name"], symbol, is_base=is_base)
        return constant, constant

    axis = (written or {}).get("axis", "z")
    symbol = {"revolute": ROTATION_NAMES[axis], "prismatic": axis}[kind]
    motion = crane.move(link["name"], symbol, is_base=is_base)
    if convention == "transform":
        transform = read_placement(crane.spec, convention, row or {}) @ motion
        return transform, transform
    offset = {"revolute": "theta", "prismatic": "d"}[kind]
    placement = read_placement(crane.spec, convention, row or {}, {offset: crane.coordinates[-1].q})
    if convention == "modified_dh":
        return placement, placement
    # In a classic D-H row, the motion comes before the offset to the link.
    return rotate("z", crane.spec.angle((row or {}).get("theta", 0))) @ motion, placement


def read_placement(spec, convention, row, variable=None):
    """A constant placement, or a D-H row with its variable added to the entry it belongs to."""
    if convention == "transform":
        transform = translate(*[spec.number(length) for length in row.get("translation", [0, 0, 0])])
        rotation = row.get("rotation", [])
        for step in rotation if isinstance(rotation, list) else [rotation]:
            ((axis, angle),) = step.items()
            transform = transform @ rotate(axis, spec.angle(angle))
        return transform
    entry = {key: spec.number(row.get(key, 0)) for key in ("a", "d")}
    entry |= {key: spec.angle(row.get(key, 0)) for key in ("alpha", "theta")}
    for key, coordinate in (variable or {}).items():
        entry[key] = entry[key] + coordinate
    return {"modified_dh": modified_dh, "classic_dh": classic_dh}[convention](**entry)


def read_support(crane, written, base):
    """A support: the displacement of its point from q̃(1) = 0, less the free play [Urbaś 2016, Eq. (16)].

    The linear support is the first-order expansion of the exact one in the base's coordinates; U is not written down.
    """
    spec = crane.spec
    coordinates = ca.vertcat(*[coordinate.q for coordinate in crane.coordinates if coordinate.is_base])
    at_rest = ca.DM.zeros(coordinates.shape)
    position = place(base.transform, spec.vector(written["at"]))
    displacement = position - ca.substitute(position, coordinates, at_rest)
    kinematics = written.get("kinematics", "linear")
    if kinematics == "linear":
        displacement = ca.substitute(ca.jacobian(position, coordinates), coordinates, at_rest) @ coordinates
    elif kinematics != "exact":
        raise ValueError(f"support kinematics {kinematics!r}: expected linear or exact")
    stiffness, damping, free_play = (
        spec.vector(written.get(key, [0, 0, 0])) for key in ("stiffness", "damping", "free_play")
    )
    friction = spec.number(written.get("friction_coefficient", 1000 if written.get("sticks", False) else 0.6))
    return Support(
        written["name"], spec.vector(written["at"]), position, displacement - free_play, stiffness, damping, friction if written.get("one_sided", False) else None
    )


def read_drive(crane, written):
    """A drive: spring and damper between a prescribed motion and its coordinate [Urbaś 2016, Eqs. (19)-(21)], or neither."""
    spec = crane.spec
    coordinate = crane.coordinate(written["coordinate"])
    motion, interval = read_motion(spec, written, coordinate.is_rotation, crane.time)
    effort = read_profile(spec, written["effort"], False, crane.time)[0] if "effort" in written else 0
    if "offset" in written:
        motion += read_profile(spec, {"input": written["offset"]}, coordinate.is_rotation, crane.time)[0]
    stiffness, damping = (spec.number(written.get(key, 0)) for key in ("stiffness", "damping"))
    limit = spec.number(written["max_effort"]) if "max_effort" in written else None
    most = [spec.number(written[key]) if key in written else None for key in ("max_rate", "max_power")]
    return Spring(coordinate, stiffness, damping, motion, interval, written.get("rigid", False), limit, *most, effort)


def read_opening(crane, valve):
    """The command of a valve over time; 0 where a servo commands it."""
    return read_profile(crane.spec, valve["opening"], False, crane.time)[0] if "opening" in valve else 0


def read_stops(spec, written, coordinate):
    """The stops at one end of a joint's range or at both."""
    stiffness, damping = spec.number(written["stiffness"]), spec.number(written.get("damping", 0))
    ends = [(key, sign) for key, sign in (("min", -1), ("max", 1)) if key in written]
    return [
        Stop(coordinate, spec.position(written[key], coordinate.is_rotation), sign, stiffness, damping)
        for key, sign in ends
    ]


def read_friction(spec, written, coordinate):
    """Friction of a joint."""
    coulomb = spec.number(written["coulomb"])
    breakaway = spec.number(written["breakaway"]) if "breakaway" in written else coulomb
    stribeck, width, viscous = (
        spec.number(written.get(key, default)) for key, default in (("stribeck", 1e-2), ("width", 1e-3), ("viscous", 0))
    )
    bristle = written.get("bristle")
    bristle = bristle and (constant(bristle["stiffness"]), constant(bristle["damping"]))
    return Friction(coordinate, coulomb, breakaway, stribeck, width, viscous, bristle)


def read_load(crane, written, span):
    """A load; if it acts along the link's axes, it turns with the element that carries it."""
    spec = crane.spec
    at, force, moment = (spec.vector(written.get(key, [0, 0, 0])) for key in ("at", "force", "moment"))
    if "wind" in written:
        wind = written["wind"]
        pressure = spec.number(wind["pressure"]) if "pressure" in wind else 0.5 * 1.25 * spec.number(wind["speed"]) ** 2
        towards = spec.vector(wind["direction"])
        force = pressure * spec.number(wind["area"]) * spec.number(wind["shape_factor"]) * towards / ca.norm_2(towards)
    body, local = carrier(spec, at, span)
    rotation = body.transform[:3, :3]
    scale = read_profile(spec, written["scale"], False, crane.time)[0] if "scale" in written else 1
    axes = rotation if written.get("axes", "world") == "link" else ca.SX.eye(3)
    index = next(i for i, other in enumerate(crane.bodies) if other is body)
    return Load(index, local[0], spec.default(local[0]), place(body.transform, local), rotation, scale * (axes @ force), scale * (axes @ moment))


def read_cylinder(crane, written, spans):
    """A cylinder, with its length as a function of the coordinates."""
    spec = crane.spec
    coordinate = crane.coordinate(written["coordinate"])
    foot, head = (carrier(spec, spec.vector(written[key]["at"]), spans[written[key]["link"]]) for key in ("foot", "head"))
    start, end = place(foot[0].transform, foot[1]), place(head[0].transform, head[1])
    of_foot, of_head = (next(i for i, other in enumerate(crane.bodies) if other is pin[0]) for pin in (foot, head))
    carried = [(start, of_foot, spec.default(foot[1][0]), False), (end, of_head, spec.default(head[1][0]), False)]
    pins = [(of_foot, foot[1][0]), (of_head, head[1][0])] if "valve" in written else []
    linkage = written.get("linkage")
    if linkage is None:
        length_of = lambda start, end: ca.norm_2(end - start)
    else:
        # The pivot is on the link of the foot: on a beam, on the element there.
        pin_of_pivot = carrier(spec, spec.vector(linkage["pivot"]), spans[written["foot"]["link"]])
        pivot = place(pin_of_pivot[0].transform, pin_of_pivot[1])
        of_pivot = next(i for i, other in enumerate(crane.bodies) if other is pin_of_pivot[0])
        of_joint = crane.coordinates.index(coordinate)
        moved = next(i for i, body in enumerate(crane.bodies) if of_joint in body.moved_by)
        axis = turning_axis(crane.bodies[moved].transform[:3, :3], coordinate.q)
        # Beside the joint, on the side of the foot.
        before = crane.bodies[moved].parent, crane.bodies[moved].along
        carrier_of_axis, along = before if of_joint in head[0].moved_by else (moved, 0.0)
        carried += [(pivot, of_pivot, spec.default(pin_of_pivot[1][0]), False), (axis, carrier_of_axis, along, True)]
        pins += [(of_pivot, pin_of_pivot[1][0])] if "valve" in written else []
        lengths = [spec.number(linkage[key]) for key in ("rocker", "link")]
        length_of = lambda start, end, pivot, axis: ca.norm_2(
            pin_of_rocker(pivot, end, axis, lengths, linkage["side"]) - start
        )
    return Cylinder(coordinate, length_of(*(vector for vector, *_ in carried)), carried, length_of, pins)


def read_connector(crane, written, spans):
    """An element between two points: a spring, a gas spring, which pushes, a progressive spring, or a rope, which pulls, perhaps over sheaves."""
    spec = crane.spec
    bodies, points, along = [], [], []
    for end in (written["from"], *written.get("over", []), written["to"]):
        at = spec.vector(end["at"])
        if "link" in end:
            body, at = carrier(spec, at, spans[end["link"]])
            bodies.append(next(i for i, other in enumerate(crane.bodies) if other is body))
            points.append(place(body.transform, at))
        else:
            bodies.append(None)
            points.append(at)
        along.append(at[0])
    ((kind, law),) = written["law"].items()
    length = read_motion(spec, {"motion": {"hold": law.get("length")}, **law}, False, crane.time)[0]
    stiffness, damping, push, progression = (spec.number(law.get(key, 0)) for key in ("stiffness", "damping", "force", "progression"))
    if "axial_stiffness" in law:
        stiffness = spec.number(law["axial_stiffness"]) / length
    falls = int(written.get("falls", 1))
    strain, defaults = length_over(points, falls), [spec.default(at) for at in along]
    return Connector(bodies, points, along, defaults, strain, kind == "rope", stiffness, damping, length, push, progression, falls)


def read_contact(crane, written, spans):
    """A point and the ground below it, which carries it as far as it is deeper than its height."""
    spec = crane.spec
    body, at = carrier(spec, spec.vector(written.get("at", [0, 0, 0])), spans[written["link"]])
    point = place(body.transform, at)
    stiffness, damping, height = (spec.number(written.get(key, 0)) for key in ("stiffness", "damping", "height"))
    index = next(i for i, other in enumerate(crane.bodies) if other is body)
    law = (True, stiffness, damping, 0, 0)
    return Connector([index], [point], [at[0]], [spec.default(at[0])], height - point[2], *law, is_contact=True)


def read_slip(crane, written):
    """How far a coordinate is from one that it follows in proportion, and how far it is to be."""
    spec = crane.spec
    own, leader = (crane.coordinate(written[key]) for key in ("coordinate", "follows"))
    return own.q - spec.number(written["ratio"]) * leader.q, spec.position(written.get("offset", 0), own.is_rotation)


def read_coupling(crane, written):
    """A coordinate that follows another one through a spring and a damper."""
    stiffness, damping = (crane.spec.number(written.get(key, 0)) for key in ("stiffness", "damping"))
    strain, offset = read_slip(crane, written)
    return Connector([], [], [], [], strain, False, stiffness, damping, offset, 0)


def read_rigid_coupling(crane, written):
    """A coordinate that follows another one exactly: an equation between them, which holds no link."""
    slip, offset = read_slip(crane, written)
    return LoopJoint(written["name"], [slip - offset], [])


def read_friction_of_pin(crane, written, spans):
    """Friction and damping of a pin that closes a loop: a force without a spring on the angle by which it has turned."""
    friction = read_friction(crane.spec, written.get("friction", {"coulomb": 0}), None)
    friction.viscous += crane.spec.number(written.get("damping", 0))
    pin = read_pin(crane, written, spans, carrier, read_guess(crane), friction)
    return Connector([], [], [], [], pin.angle, False, 0, friction.viscous, 0, 0, pin=pin)


def read_point(spec, written, spans):
    """Where a point of a link or a frame is in the world; on a beam, the element that contains its x, or the frame's, carries it.

    At a spring, that is the element that begins there, up to rounding of the lengths.
    """
    at = spec.vector(written.get("at", [0, 0, 0]))
    if "frame" not in written:
        body, local = carrier(spec, at, spans[written["link"]])
        return place(body.transform, local)
    (frame,) = (frame for frame in spec.keys["frames"] if frame["name"] == written["frame"])
    transform = read_placement(spec, "transform", frame.get("transform") or {})
    body, origin = carrier(spec, transform[:3, 3], spans[frame["link"]])
    return place(body.transform @ translate(origin[0], origin[1], origin[2]), transform[:3, :3] @ at)


def carrier(spec, at, span):
    """The body of a link that carries one of its points, and the point in that body's frame."""
    starts = [spec.default(start) for start in span.starts]
    reach = spec.default(at[0]) + SAME_PLACE * starts[-1]
    index = max((i for i, start in enumerate(starts) if start <= reach), default=0)
    return span.bodies[index], at - ca.vertcat(span.starts[index], 0, 0)


def read_guess(crane):
    """Where the static solution starts: as written, else at the drive's position at t = 0, else where a coupling has it, else 0."""
    spec, written = crane.spec, crane.spec.get("guess", {})
    holding = [drive for drive in crane.drives if drive.holds]
    known = {drive.coordinate.name: spec.default(ca.substitute(drive.motion, crane.time, 0)) for drive in holding}
    known |= {c.name: spec.position(written[c.name], c.is_rotation) for c in crane.coordinates if c.name in written}
    couplings = spec.get("couplings", [])
    # A coordinate that follows one that follows another is known one pass later.
    for coupling in couplings * len(couplings):
        name, leader = coupling["coordinate"], coupling["follows"]
        if name not in known and leader in known:
            offset = spec.position(coupling.get("offset", 0), crane.coordinate(name).is_rotation)
            known[name] = spec.default(offset + spec.number(coupling["ratio"]) * known[leader])
    return [known.get(c.name, 0.0) for c in crane.coordinates]
