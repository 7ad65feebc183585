"""Errors introduced on purpose, to verify that the check can fail."""

import numpy as np

from comparison import compare, negligible_entry

# A hundred times the tolerance: a wrong eighth digit of one entry.
PERTURBATION = 1e-8


def perturb(quantity, values, rng, perturbation=PERTURBATION):
    """The values with one random entry, not a negligible one, perturbed in the state where it is largest.

    If all values are zero, one becomes the perturbation.
    """
    size = np.abs(values).max(axis=0)
    entry = rng.choice(np.flatnonzero(size >= negligible_entry(quantity) * size.max()))
    state = np.argmax(np.abs(values[:, entry]))
    wrong = values.copy()
    wrong[state, entry] += perturbation * (values[state, entry] or 1.0)
    return wrong


def unnoticed(derived, groups, trials=10, seed=1):
    """The quantities in which a perturbed entry passes."""
    rng = np.random.default_rng(seed)
    return [
        quantity
        for quantity, values in ((quantity, np.nan_to_num(values)) for quantity, values in derived.items())
        if values.size > 0
        and any(compare(quantity, values, perturb(quantity, values, rng), groups).passed for _ in range(trials))
    ]
