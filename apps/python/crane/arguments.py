"""Arguments that are names, or values by name."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any


def names_of(given: str | Iterable[str]) -> list[str]:
    """A list of names; one name alone is a list of it."""
    return [given] if isinstance(given, str) else list(given)


def by_name(argument: str, given: Any, example: str) -> Mapping[str, Any]:
    """Values by name; TypeError shows how to write them."""
    if not isinstance(given, Mapping):
        raise TypeError(f"{argument} has values by name, as {argument}={example}: it is not {type(given).__name__}")
    return given
