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
    distance: object = math.inf

    def parts(self):
        """Cuts of which one is meant, with numbers that are 1 for that one."""
        return [(1, self)]

    def beyond(self, bodies, body, along=0.0):
        """1 if what acts on a body, at a distance along it, acts beyond the cut, else 0."""
        while body is not None and body != self.body:
            body, along = bodies[body].parent, bodies[body].along
        if body is None or self.portion is None:
            return int(body is not None)
        if isinstance(along, ca.SX) or isinstance(self.distance, ca.SX):
            return ca.if_else(along > self.distance, 1, 0)
        return int(along > self.distance)


@dataclass
class CutAtPad:
    """A cut of a beam at a pad on which it slides: the cuts within its elements, with numbers that are 1 for the element on which the pad is."""

    within: list

    @property
    def body(self):
        """The last element."""
        return self.within[-1][1].body

    def parts(self):
        """See `Cut.parts`."""
        return self.within
