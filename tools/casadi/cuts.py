"""Cuts through a crane."""

import math
from dataclasses import dataclass

import casadi as ca


@dataclass
class Cut:
    """A cut through the crane: the pose of its frame in the world, and the index of the body that it separates, with all beyond, from the rest.

    Within an element of a beam: the pseudo-inertia of the part of the element beyond, about the element's frame, and the distance along the element
    beyond which forces act, and other links begin, beyond the cut.
    """

    frame: ca.SX
    body: int
    portion: object = None
    distance: float = math.inf

    def has_beyond(self, bodies, body, along=0.0):
        """Whether what acts on a body, at a distance along it, acts beyond the cut."""
        while body is not None and body != self.body:
            body, along = bodies[body].parent, bodies[body].along
        return body is not None and (self.portion is None or along > self.distance)
