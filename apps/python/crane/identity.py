"""What identifies a function: its code, and the values that it refers to."""

import functools
import hashlib
import pickle
import types
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from .model import Crane


def identity(function: Callable) -> str:
    """A hash that changes when the function would compute something else: with its code, its defaults, what it encloses, and the functions
    and constants of its own module that it uses.

    Raises TypeError if it refers to something that cannot be identified.
    """
    digest = hashlib.sha256()
    for piece in _pieces(function, []):
        digest.update(piece.encode() if isinstance(piece, str) else piece)
        digest.update(b"\0")
    return digest.hexdigest()


def _pieces(value: Any, seen: list[Any]) -> Iterator[str | bytes]:
    """Texts and bytes that tell a value from others. seen: what is being told already."""
    yield type(value).__qualname__
    if value is None or isinstance(value, (bool, int, float, complex, str, bytes)) or value is Ellipsis:
        yield repr(value)
        return
    if any(value is known for known in seen):
        yield "again"
        return
    seen = [*seen, value]
    if isinstance(value, (np.ndarray, np.generic)) and value.dtype != object:
        array = np.asarray(value)
        yield f"{array.dtype.str} {array.shape}"
        yield array.tobytes()
    elif isinstance(value, (tuple, list)):
        for item in value:
            yield from _pieces(item, seen)
    elif isinstance(value, (set, frozenset)):
        yield from sorted(repr(list(_pieces(item, seen))) for item in value)
    elif isinstance(value, dict):
        for key, item in value.items():
            yield from _pieces(key, seen)
            yield from _pieces(item, seen)
    elif isinstance(value, Crane):
        yield from _pieces([value.spec_hash, value.parameters, value.inputs], seen)
    elif isinstance(value, types.CodeType):
        yield value.co_code
        yield from _pieces([value.co_consts, value.co_names, value.co_varnames, value.co_freevars], seen)
    elif isinstance(value, types.FunctionType):
        yield from _of_function(value, seen)
    elif isinstance(value, types.MethodType):
        yield from _pieces([value.__func__, value.__self__], seen)
    elif isinstance(value, functools.partial):
        yield from _pieces([value.func, value.args, value.keywords], seen)
    elif isinstance(value, (type, types.ModuleType, types.BuiltinFunctionType, np.ufunc)):
        yield f"{getattr(value, '__module__', '')}.{getattr(value, '__qualname__', value.__name__)}"
    elif callable(value) and hasattr(value, "__dict__"):
        yield from _pieces([type(value).__call__, vars(value)], seen)
    else:
        yield _pickled(value)


def _of_function(function: types.FunctionType, seen: list[Any]) -> Iterator[str | bytes]:
    yield f"{function.__module__}.{function.__qualname__}"
    enclosed = [cell.cell_contents for cell in function.__closure__ or ()]
    yield from _pieces([function.__code__, function.__defaults__, function.__kwdefaults__, enclosed], seen)
    for name in _names(function.__code__):
        used = function.__globals__.get(name)
        own = isinstance(used, types.FunctionType) and used.__module__ == function.__module__
        if own or isinstance(used, (bool, int, float, complex, str, bytes, tuple, list, dict, np.ndarray, np.generic, Crane)):
            yield name
            yield from _pieces(used, seen)


def _names(code: types.CodeType) -> list[str]:
    """Names that a function and those inside of it look up."""
    inside = [name for constant in code.co_consts if isinstance(constant, types.CodeType) for name in _names(constant)]
    return sorted({*code.co_names, *inside})


def _pickled(value: Any) -> bytes:
    try:
        return pickle.dumps(value, protocol=4)
    except Exception as error:
        kind = type(value).__qualname__
        raise TypeError(f"the function refers to a {kind}, which cannot be identified ({error}): let it use numbers, arrays and functions") from None
