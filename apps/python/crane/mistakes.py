"""Exceptions and warnings."""


class SpecError(ValueError):
    """The mistakes of a spec, shown with their locations and remedies."""

    __module__ = "crane"
    codes: list[str]


class ParameterError(ValueError):
    """Live parameters whose values break a rule of the spec language."""

    __module__ = "crane"


class NoEquilibrium(ArithmeticError):
    """Statics found no stable equilibrium."""

    __module__ = "crane"


class SpecWarning(UserWarning):
    """Implausible numbers of a spec, shown with their locations and remedies."""

    __module__ = "crane"


class InvalidRowWarning(UserWarning):
    """Rows of a batch whose results are NaN, with the reasons."""

    __module__ = "crane"
