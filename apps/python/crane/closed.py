"""What cannot be set: what nobody reads would be ignored in silence."""

from typing import Any, ClassVar, NoReturn


class Closed:
    """Refuses attributes that are set from outside, and says what to write instead."""

    _instead: ClassVar[str]

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_"):
            raise AttributeError(self._instead.replace("NAME", name))
        object.__setattr__(self, name, value)


class Fixed(dict[str, Any]):
    """Values of a crane by name, which cannot be set; a copy can."""

    def _refuse(self, *_: Any, **__: Any) -> NoReturn:
        raise TypeError(
            "a crane never changes: `c.replace(NAME=...)` makes one with another value of a live parameter, `c.replace(inputs={'NAME': ...})` of an input"
        )

    __setitem__ = __delitem__ = __ior__ = update = setdefault = pop = popitem = clear = _refuse  # type: ignore[assignment]

    def __reduce__(self) -> tuple[type, tuple[dict[str, Any]]]:
        return dict, (dict(self),)
