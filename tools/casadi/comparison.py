"""How far two arrays of a quantity are apart, and whether that is too far."""

from dataclasses import asdict, dataclass

import numpy as np

# What the project asks of its derivatives.
TOLERANCE = 1e-10
# Accelerations and other solutions are derived by dense factors of A, which lose cond(A) ε: some 3e-10 on random cranes.
# The recursions themselves are held to 1e-13, against numbers of 192 bits (tests/tests/accuracy.rs).
TOLERANCE_OF_SOLUTION = 1e-9

# An entry is measured by the largest value it takes in any state, so that a small moment is not hidden by a large one
# in the same array. But a small entry may be nothing but round-off of large terms (cos 90° = 6e-17 times one of them),
# so below a share of the array's largest value it is measured by that share.
# The last bit of the largest entry, 2e-16, then counts as 2e-11. That much is lost where composite inertias are taken
# about the world's origin: the torsional inertia of a slender element is 1e-3 kg m² beside 1e2 of the whole beam.
NEGLIGIBLE_ENTRY = 1e-5
# Entries of T, T', T'' are direction cosines and lengths, alike in size, and sums along the whole chain.
NEGLIGIBLE_ENTRY_OF_TRANSFORM = 1e-4
# A solve with the dense A spreads cond(A) ε, 5e-11 of the largest acceleration, over all.
NEGLIGIBLE_ENTRY_OF_ACCELERATION = 0.1

# An array may vanish in a state (the power of a drive that comes to rest as (1 - τ)², weight in a hanging pose) and is
# then the round-off of terms that cancel: below this share of the largest that it is in any state, the share measures.
VANISHING_STATE = 1e-3


@dataclass
class Comparison:
    """The worst relative errors of one quantity, and the entry and state of the larger."""

    quantity: str
    entries: int
    by_state: float
    by_entry: float
    entry: int
    state: int
    tolerance: float = TOLERANCE

    @property
    def passed(self):
        """Both measures within the tolerance; NaN is not."""
        return self.by_state <= self.tolerance and self.by_entry <= self.tolerance

    def row(self):
        """A row of the table."""
        verdict = "ok" if self.passed else f"FAILED at entry {self.entry}, state {self.state}"
        errors = f"{self.by_state:10.1e} {self.by_entry:10.1e} {self.tolerance:10.0e}"
        return f"  {self.quantity:30} {self.entries:6} {errors}  {verdict}"

    def summary(self):
        """For the JSON file, which has no infinity and no NaN: null."""
        errors = {key: value if np.isfinite(value) else None for key, value in asdict(self).items() if key[:3] == "by_"}
        return asdict(self) | errors | {"passed": self.passed}


HEADER = f"  {'quantity':30} {'size':>6} {'by state':>10} {'by entry':>10} {'tolerance':>10}  verdict"


def compare(quantity, derived, generated, groups, tolerance=None):
    """Compares what was derived independently with what was generated: arrays with a row a state.

    By state: the largest error of the array over its largest value in that state.
    By entry: the largest error of an entry over its largest value in any state.
    `groups`: slices of states that are alike in size, each measured by its own largest values.
    """
    if tolerance is None:
        tolerance = TOLERANCE_OF_SOLUTION if is_solution(quantity) else TOLERANCE
    entries = derived.shape[1]
    if derived.shape != generated.shape:
        return Comparison(quantity, entries, np.inf, np.inf, 0, 0, tolerance)
    if derived.size == 0:
        return Comparison(quantity, entries, 0.0, 0.0, 0, 0, tolerance)
    # Far from the guess a linkage may not reach: both values are then NaN.
    neither = np.isnan(derived) & np.isnan(generated)
    derived, generated = np.where(neither, 0.0, derived), np.where(neither, 0.0, generated)
    by_state, by_entry = [], []
    for group in groups:
        error, size = np.abs(generated[group] - derived[group]), np.abs(derived[group])
        largest = size.max()
        state_size = np.maximum(size.max(axis=1), VANISHING_STATE * largest)
        entry_size = np.maximum(size.max(axis=0), negligible_entry(quantity) * largest)
        by_state.append(ratio(error.max(axis=1), state_size))
        by_entry.append(ratio(error.max(axis=0), entry_size))
    by_state, by_entry = np.concatenate(by_state), np.max(by_entry, axis=0)
    return Comparison(
        quantity,
        entries,
        float(by_state.max()),
        float(by_entry.max()),
        int(np.argmax(by_entry)),
        int(np.argmax(by_state)),
        tolerance,
    )


def negligible_entry(quantity):
    """The share of an array's largest value below which an entry has no size of its own."""
    if is_solution(quantity):
        return NEGLIGIBLE_ENTRY_OF_ACCELERATION
    return NEGLIGIBLE_ENTRY_OF_TRANSFORM if quantity.startswith("transform") else NEGLIGIBLE_ENTRY


def is_solution(quantity):
    """Whether a quantity is the solution of a linear system with A."""
    return quantity.endswith(("forward_dynamics", "_solution"))


def ratio(error, size):
    """Error over size; no error is zero whatever the size, an error over a size of zero is infinite."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(error == 0, 0.0, error / size)
