"""How far two arrays of a quantity are apart, and whether that is too far."""

from dataclasses import asdict, dataclass

import numpy as np

# Required accuracy of the derivatives.
TOLERANCE = 1e-10
# Accelerations and other solutions are derived with dense factors of A, which lose cond(A) ε: some 1e-9 for random cranes, whose beams have short
# elements where much acts on them. So do the efforts of rigid drives, which follow from accelerations.
# The recursions themselves are checked to 1e-13, against numbers of 192 bits (tests/tests/accuracy.rs).
TOLERANCE_OF_SOLUTION = 2e-9
# Pads of 2e8 N/m on long booms turn the rounding of their places, 1e-15 m, into 1e-10 of what they carry.
TOLERANCES = {"connector_forces": 2e-10}

# The error of an entry is relative to its largest value in any state, so that a small moment is not hidden by a large one
# in the same array. But a small entry may be only round-off of large terms (cos 90° = 6e-17 times one of them),
# so the error is relative to at least this fraction of the array's largest value.
# The last bit of the largest entry, 2e-16, then counts as 2e-11. That much is lost where composite inertias are taken
# about the world's origin: the torsional inertia of a slender element is 1e-3 kg m², that of the whole beam 1e2.
NEGLIGIBLE_ENTRY = 1e-5
# Entries of T, T', T'' are direction cosines and lengths, similar in size, and sums along the whole chain.
NEGLIGIBLE_ENTRY_OF_TRANSFORM = 1e-4
# Where rocker and link of a cylinder are almost in line, some derivatives of its length grow, and the rounding of all others with them.
# The forces of a pair cancel, up to rounding, at cuts beyond which are both of its points.
NEGLIGIBLE_ENTRY_OF_PAIR = 1e-3
# A solve with the dense A spreads an error of cond(A) ε, 5e-11 of the largest acceleration, over all entries.
NEGLIGIBLE_ENTRY_OF_ACCELERATION = 0.1

# An array may vanish in a state (the power of a drive that comes to rest as (1 - τ)², weight in a hanging pose) and is
# then only round-off of terms that cancel: its error is relative to at least this fraction of its largest value in any state.
VANISHING_STATE = 1e-3
VANISHING_STATES = {
    # Near the guess, springs of 1e8 N/m along cylinders are stretched by less than a millimetre: the difference of two lengths of metres.
    "drive_forces_at_rest": 1e-1,
    # What drives put in and take out cancels, and efforts of rigid drives are solutions with A.
    "drive_power": 1e-2,
}
# Or in all states of a group: friction of joints that slide fast does not damp, and 1 - tanh² is 0 or 1e-138.
VANISHING_GROUP = 1e-12

OF_PAIRS = [
    "connector_wrenches",
    "cylinder_jacobians",
    "cylinder_wrenches",
    "drive_forces_at_rest",
]


@dataclass
class Comparison:
    """The worst relative errors of one quantity, and the entry and the state in which they occur."""

    quantity: str
    entries: int
    by_state: float
    by_entry: float
    entry: int
    state: int
    tolerance: float = TOLERANCE

    @property
    def passed(self):
        """Whether both errors are within the tolerance; NaN is not."""
        return self.by_state <= self.tolerance and self.by_entry <= self.tolerance

    def row(self):
        """A row of the table."""
        verdict = "ok" if self.passed else f"FAILED at entry {self.entry}, state {self.state}"
        errors = f"{self.by_state:10.1e} {self.by_entry:10.1e} {self.tolerance:10.0e}"
        return f"  {self.quantity:30} {self.entries:6} {errors}  {verdict}"

    def summary(self):
        """For the JSON file, in which infinity and NaN become null."""
        errors = {key: value if np.isfinite(value) else None for key, value in asdict(self).items() if key[:3] == "by_"}
        return asdict(self) | errors | {"passed": self.passed}


HEADER = f"  {'quantity':30} {'size':>6} {'by state':>10} {'by entry':>10} {'tolerance':>10}  verdict"


def compare(quantity, derived, generated, groups, tolerance=None):
    """Compares what was derived independently with what was generated: arrays with one row per state.

    By state: the largest error of the array over its largest value in that state.
    By entry: the largest error of an entry over its largest value in any state.
    `groups`: slices of states of similar size; errors are relative to the largest values within each.
    """
    if tolerance is None:
        tolerance = TOLERANCE_OF_SOLUTION if is_solution(quantity) else TOLERANCES.get(quantity, TOLERANCE)
    entries = derived.shape[1]
    if derived.shape != generated.shape:
        return Comparison(quantity, entries, np.inf, np.inf, 0, 0, tolerance)
    if derived.size == 0:
        return Comparison(quantity, entries, 0.0, 0.0, 0, 0, tolerance)
    # Far from the guess, a linkage may not close: both values are then NaN.
    neither = np.isnan(derived) & np.isnan(generated)
    derived, generated = np.where(neither, 0.0, derived), np.where(neither, 0.0, generated)
    by_state, by_entry = [], []
    largest_of_all = np.nan_to_num(np.abs(derived)).max()
    for group in groups:
        error, size = np.abs(generated[group] - derived[group]), np.abs(derived[group])
        largest = max(size.max(), VANISHING_GROUP * largest_of_all)
        state_size = np.maximum(size.max(axis=1), vanishing_state(quantity) * largest)
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
    """The fraction of an array's largest value to which errors of its small entries are relative."""
    if is_solution(quantity):
        return NEGLIGIBLE_ENTRY_OF_ACCELERATION
    if quantity in OF_PAIRS:
        return NEGLIGIBLE_ENTRY_OF_PAIR
    return NEGLIGIBLE_ENTRY_OF_TRANSFORM if quantity.startswith("transform") else NEGLIGIBLE_ENTRY


def vanishing_state(quantity):
    """The fraction of an array's largest value in any state to which its errors in one state are relative."""
    return VANISHING_STATES.get(quantity, VANISHING_STATE)


def is_solution(quantity):
    """Whether a quantity is the solution of a linear system with A."""
    return quantity.endswith(("forward_dynamics", "_solution", "solve_mass", "loop_dynamics", "inverse_mass_matrix", "drive_forces", "drive_power"))


def ratio(error, size):
    """Error over size: zero without an error, whatever the size; infinite for an error over a size of zero."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(error == 0, 0.0, error / size)
