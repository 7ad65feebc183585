"""Classes whose attributes cannot be set: what nobody reads would be ignored in silence."""

from typing import Any, ClassVar


class Closed:
    """Refuses attributes that are set from outside, and says what to write instead."""

    _instead: ClassVar[str]

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_"):
            raise AttributeError(self._instead.replace("NAME", name))
        object.__setattr__(self, name, value)
