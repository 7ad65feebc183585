"""Cuts through a crane."""

import math
from dataclasses import dataclass

import casadi as ca


@dataclass
class Cut:
    """A cut through the chain: the pose of its frame in the world, and the index of the first body beyond it.

    Within an element of a beam: the index of the first body that is wholly beyond, the pseudo-inertia of the part of the element beyond,
    about the element's frame, and the distance along the element beyond which forces act beyond the cut.
    """

    frame: ca.SX
    beyond: int
    portion: object = None
    distance: float = math.inf

    def has_beyond(self, body, along):
        """Whether what acts on a body, at a distance along it, acts beyond the cut."""
        return body >= self.beyond or (body == self.beyond - 1 and along > self.distance)
