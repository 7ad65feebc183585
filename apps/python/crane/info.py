"""What `Crane.info` contains: names, units and numbers of the parts of a crane."""

from typing import TypedDict


class Coordinate(TypedDict):
    """A coordinate: its unit (m or rad), that of its force (N or N m), and its role, such as "joint" or "element"."""

    name: str
    unit: str
    force_unit: str
    role: str


class Body(TypedDict):
    """A rigid body or a rigid element of a beam: mass, kg, and length, m; the index of the body that carries it, and those of the
    coordinates that move it."""

    name: str
    link: str
    mass: float
    length: float
    degrees_of_freedom: int
    parent: int | None
    coordinates: list[int]


class Drive(TypedDict):
    """A drive: its coordinate, the unit of its effort, and its position at t = 0, m or rad."""

    coordinate: str
    index: int
    unit: str
    start: float


class Support(TypedDict):
    """A support: its position on the base, m, and whether it is a foot that can lift."""

    name: str
    position: list[float]
    one_sided: bool


class Cylinder(TypedDict):
    """A cylinder: its joint's coordinate, areas on the sides of piston and rod, m², length when retracted and stroke, m."""

    name: str
    coordinate: str
    areas: list[float]
    retracted: float
    stroke: float


class Connector(TypedDict):
    """A spring, rope or coupling: whether it only pulls, and the unit of its length."""

    name: str
    rope: bool
    unit: str


class Parameter(TypedDict):
    """A live parameter."""

    name: str
    unit: str
    about: str
    default: float


class Input(TypedDict):
    """An input; `moves`: until it is set it follows a motion of the spec."""

    name: str
    unit: str
    about: str
    default: float
    moves: bool


class Cut(TypedDict):
    """A cut of `internal_forces`: "ground", "joint", "link" or "section", of a link, at x along a beam, m; `place` as of a section."""

    kind: str
    link: str | None
    x: float | None
    place: str | None


class Section(TypedDict):
    """A section of a beam at x, m; `place`: its side and what is there, such as `before the head of lift`, or nothing."""

    beam: str
    x: float
    place: str


class Frame(TypedDict):
    """A frame that the spec names, and its link; `None` for the world."""

    name: str
    link: str | None


class NamedJoint(TypedDict):
    """A joint that the spec names, and its coordinate; `None` if it does not move. It is at the coordinate plus `at`, m or rad."""

    name: str
    coordinate: str | None
    at: float


class Info(TypedDict):
    """A crane. `run`: duration, step of rk4 and interval of results that the spec asks for, s."""

    coordinates: list[Coordinate]
    bodies: list[Body]
    drives: list[Drive]
    supports: list[Support]
    cylinders: list[Cylinder]
    connectors: list[Connector]
    parameters: list[Parameter]
    inputs: list[Input]
    cuts: list[Cut]
    sections: list[Section]
    frames: list[Frame]
    joints: list[NamedJoint]
    points: list[str]
    run: tuple[float, float, float]
