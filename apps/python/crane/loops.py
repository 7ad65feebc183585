"""States on the loops and rigid couplings of a crane, by Newton's method."""

from collections.abc import Collection
from typing import TYPE_CHECKING

import numpy as np

from .results import Array

if TYPE_CHECKING:
    from .model import Crane

# Iterations that close loops, and gaps up to which they are closed, m and rad.
_NEWTON = 20
CLOSED = 1e-12


def closed(crane: "Crane", q: Array, v: Array, given: Collection[str]) -> tuple[Array, Array, Array]:
    """Poses and rates (..., n), with those that are not given moved onto loops and rigid couplings, and the gaps that are left, (..., loop_equations).

    given: names of coordinates, and of rates, `<coordinate>_rate`, that stay as they are, as do prescribed ones.
    """
    q, v = q.copy(), v.copy()
    prescribed = [info["name"] for info in crane.info["coordinates"] if info["role"] == "prescribed"]
    kept = {*given, *prescribed, *(f"{name}_rate" for name in prescribed)}
    free, free_rates = ([i for i, name in enumerate(crane.coordinates) if f"{name}{ending}" not in kept] for ending in ("", "_rate"))
    gaps: Array = crane.loop_states(q, v)[..., 0]
    for _ in range(_NEWTON if gaps.size else 0):
        if np.abs(gaps).max() < CLOSED:
            break
        q[..., free] -= (np.linalg.pinv(crane.loop_jacobians(q)[..., free]) @ gaps[..., None])[..., 0]
        gaps = crane.loop_states(q, v)[..., 0]
    if gaps.size:
        jacobians = crane.loop_jacobians(q)
        v[..., free_rates] -= (np.linalg.pinv(jacobians[..., free_rates]) @ (jacobians @ v[..., None]))[..., 0]
    return q, v, gaps
