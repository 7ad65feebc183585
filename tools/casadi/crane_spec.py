"""A crane's YAML as plain data, with numbers that are live parameters or constants, and angles."""

import math
import re

import casadi as ca
from overlay import read_whole

ANGLE = re.compile(
    r"(?P<sign>[+-]?)\s*(?P<numerator>\d+\.?\d*(?:[eE][+-]?\d+)?)?\s*"
    r"(?:/\s*(?P<denominator>\d+\.?\d*))?\s*(?P<unit>pi|deg)"
)


class CraneSpec:
    """The top-level keys of a spec, and how to read its numbers.

    `parameters`: name -> CasADi symbol; `defaults`: name -> value.
    """

    def __init__(self, path):
        self.keys = read_whole(path)
        if self.keys.get("format") != 1:
            raise ValueError(f"{path}: format 1 expected")
        self.defaults = {name: parse_angle(entry["value"]) for name, entry in self.get("parameters", {}).items()}
        self.parameters = {name: ca.SX.sym(name) for name in self.defaults}

    def get(self, key, default):
        """A top-level key, or its default if it is absent or empty."""
        value = self.keys.get(key)
        return default if value is None else value

    def number(self, written):
        """A number in SI units, or the symbol of the parameter that replaces it."""
        if isinstance(written, str) and written in self.parameters:
            return self.parameters[written]
        return float(written)

    def angle(self, written):
        """An angle in rad: a number, a multiple of pi or of a degree, or a parameter."""
        if isinstance(written, str) and written in self.parameters:
            return self.parameters[written]
        return parse_angle(written)

    def vector(self, written):
        """Numbers as a column."""
        return ca.vertcat(*[self.number(number) for number in written])

    def position(self, written, is_rotation):
        """A position of a coordinate: an angle if it turns, a length if it slides."""
        return self.angle(written) if is_rotation else self.number(written)

    def default(self, expression):
        """The value of an expression over the parameters at their defaults."""
        function = ca.Function("default", list(self.parameters.values()), [ca.SX(expression)])
        return float(function.call(list(self.defaults.values()))[0])


def parse_angle(written):
    """`90 deg`, `7/18 pi`, `-pi`, `1.5 pi` or a plain number, in rad."""
    if not isinstance(written, str):
        return float(written)
    match = ANGLE.fullmatch(written.strip())
    if not match:
        raise ValueError(f"not an angle: {written!r}")
    turn = math.pi if match["unit"] == "pi" else math.pi / 180
    value = turn * float(match["numerator"] or 1) / float(match["denominator"] or 1)
    return -value if match["sign"] == "-" else value
