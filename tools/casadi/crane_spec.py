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
        return constant(written)

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


# What a unit is in SI.
UNITS = {
    "1": 1, "%": 1e-2, "m": 1, "mm": 1e-3, "cm": 1e-2, "dm": 1e-1, "km": 1e3, "l": 1e-3, "kg": 1, "g": 1e-3, "t": 1e3, "s": 1, "ms": 1e-3,
    "min": 60, "h": 3600, "rad": 1, "mrad": 1e-3, "deg": math.pi / 180, "°": math.pi / 180, "rpm": math.pi / 30, "Hz": 1, "N": 1, "kN": 1e3,
    "MN": 1e6, "Pa": 1, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "bar": 1e5, "J": 1, "kJ": 1e3, "W": 1, "kW": 1e3,
}
QUANTITY = re.compile(r"(?P<number>[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(?P<unit>.*)")
FACTOR = re.compile(r"(?P<symbol>[A-Za-z]+|%|°|1)\^?(?P<power>[234²³⁴]?)")


def constant(written):
    """A number of a spec, not a parameter, in SI units."""
    return parse_quantity(written) if isinstance(written, str) else float(written)


def parse_quantity(written):
    """A number, or one with a unit, `320 bar` or `4 kN/mm`, in SI: products of symbols with powers; all behind a `/` divides."""
    match = QUANTITY.fullmatch(written.strip())
    if not match:
        raise ValueError(f"not a number: {written!r}")
    value, sign = float(match["number"]), 1
    for part in match["unit"].split("/"):
        for factor in FACTOR.finditer(part):
            power = {"²": 2, "³": 3, "⁴": 4}.get(factor["power"]) or int(factor["power"] or 1)
            value *= UNITS[factor["symbol"]] ** (sign * power)
        sign = -1
    return value


def parse_angle(written):
    """`90 deg`, `7/18 pi`, `-pi`, `1.5 pi` or a plain number, in rad."""
    if not isinstance(written, str):
        return float(written)
    match = ANGLE.fullmatch(written.strip())
    if not match:
        return parse_quantity(written)
    turn = math.pi if match["unit"] == "pi" else math.pi / 180
    value = turn * float(match["numerator"] or 1) / float(match["denominator"] or 1)
    return -value if match["sign"] == "-" else value
