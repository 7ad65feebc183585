"""Random states of a crane, near its working pose and far from it."""

from dataclasses import dataclass

import numpy as np


@dataclass
class States:
    """Times (n), positions and velocities (n, N), parameters (n, P)."""

    time: np.ndarray
    q: np.ndarray
    v: np.ndarray
    parameters: np.ndarray

    @property
    def groups(self):
        """The states near the guess, and those far from it."""
        half = len(self.time) // 2
        return [group for group in (slice(0, half), slice(half, None)) if len(self.time[group])]

    def records(self):
        """Rows (t, q, v, parameters)."""
        return np.hstack([self.time[:, None], self.q, self.v, self.parameters])


def random_states(crane, count, seed):
    """Half of the states near the guess, half far from it with other parameters; the first is the guess itself at rest.

    Times reach from before the first drive moves to after the last has stopped.
    """
    rng = np.random.default_rng(seed)
    size = len(crane.coordinates)
    far = np.arange(count) >= count // 2
    guess = np.array(crane.guess)
    defaults = np.array(list(crane.spec.defaults.values()))

    q = guess + np.where(far[:, None], reach(crane, far=True), reach(crane, far=False)) * signed(rng, count, size)
    v = np.where(far[:, None], 2.0, 0.1) * signed(rng, count, size)
    # A parameter whose default is 0 has no scale: up to half a unit, never negative.
    vary = np.where(defaults == 0, 0.5, 0.5 * defaults) * signed(rng, count, defaults.size)
    vary[:, defaults == 0] = np.abs(vary[:, defaults == 0])
    parameters = defaults + np.where(far[:, None], vary, 0)
    begin = min((drive.moves_within[0] for drive in crane.drives), default=0.0)
    end = max((drive.moves_within[1] for drive in crane.drives), default=1.0)
    time = rng.uniform(begin - 1, end + 1, count)
    if count:
        # Just after the start, where accelerations of motions jump and either value is correct.
        time[0], q[0], v[0], parameters[0] = 1e-9, guess, 0, defaults
    return States(time, q, v, parameters)


def reach(crane, far):
    """How far each coordinate strays from the guess, m and rad."""
    if not far:
        return np.array([5e-3 if c.is_element or not c.is_rotation else 2e-2 for c in crane.coordinates])
    # At ±0.5, an element is bent far beyond any practical case; θ of a base, or of a beam on pads, within ±1.2 stays clear of its singularity at π/2.
    return np.array(
        [
            0.5 if c.is_element
            else 1.2 if (c.is_base or c.is_held) and c.name.endswith("_theta")
            else np.pi if c.is_rotation
            else 1.0
            for c in crane.coordinates
        ]
    )


def signed(rng, *shape):
    """Uniform in ±1."""
    return rng.uniform(-1, 1, shape)
