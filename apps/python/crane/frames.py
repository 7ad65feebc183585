"""Frames on links, chosen at the call: poses, Jacobians, velocities, accelerations."""

from __future__ import annotations

import difflib
import warnings
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from ._native import real_array
from .arguments import names_of
from .results import Array

if TYPE_CHECKING:
    from .model import Crane

# A link or a frame that the spec names, and a place in it, m: the origin unless given.
Place: TypeAlias = str | tuple[str, ArrayLike]

# Points of a frame, in its axes, m: two axes have the third, and on a beam they stay with the rigid element of the first.
_OFFSETS = ((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class Frames:
    """Frames fixed to links of a crane: see `Crane.frames`. The functions take batches, as those of `Crane`.

    names: of the frames, in the order of all results. Twists have the velocity of the origin (m/s), then the angular velocity (rad/s), both in the axes of
    the world; so have Jacobians and accelerations.
    """

    def __init__(self, crane: Crane, frames: str | Sequence[str] | Mapping[str, Place]) -> None:
        if not isinstance(frames, Mapping):
            frames = {name: name for name in names_of(frames)}
        self.names = tuple(frames)
        known = crane.info["frames"]
        named = {frame["name"]: index for index, frame in enumerate(known)}
        links = list(dict.fromkeys(body["link"] for body in crane.info["bodies"]))
        points = []
        # By index, the corners of frames in the world, (..., 3, 3).
        self._standing: dict[int, Array] = {}
        for index, (name, place) in enumerate(frames.items()):
            link, at = (place, (0.0, 0.0, 0.0)) if isinstance(place, str) else place
            if link not in named and link not in links:
                similar = difflib.get_close_matches(str(link), [*named, *links], n=1)
                meant = f"did you mean {similar[0]}? " if similar else ""
                raise ValueError(f"frame {name!r}: there is no link or frame {link!r}: {meant}write one of {', '.join([*named, *links])}")
            at = real_array(f"frame {name!r}", at)
            if at.shape != (3,) or not np.isfinite(at).all():
                raise ValueError(f"frame {name!r}: write (link, [x, y, z]), finite numbers of m in the axes of the link; the place is {at.tolist()}")
            if link in named and known[named[link]]["link"] is None:
                pose = crane._frame_poses()[..., named[link], :3, :]
                self._standing[index] = (at + np.array(_OFFSETS)) @ np.swapaxes(pose[..., :3], -1, -2) + pose[..., None, :, 3]
                continue
            on = "frame" if link in named else "link"
            for corner, offset in enumerate(_OFFSETS):
                points.append({"name": f"frame_{index}_{corner}", on: link, "at": [float(x) for x in at + offset]})
        removed = [{"name": point, "remove": True} for point in crane.info["points"]]
        self._crane = _with(crane, {"points": removed + points})

    def __repr__(self) -> str:
        return f"Frames({', '.join(self.names)})"

    def _corners(self, numbers: Array, axis: int, of_places: bool = False) -> tuple[Array, Array, Array]:
        """Origin, and differences of both other points from it, of numbers whose axis `axis` is that of the points. `of_places`: whether they are places;
        other numbers are zero for what does not move."""
        numbers = np.moveaxis(numbers, axis, 0)
        every = np.zeros((len(self.names), len(_OFFSETS), *numbers.shape[1:]))
        moving = [index for index in range(len(self.names)) if index not in self._standing]
        every[moving] = numbers.reshape(len(moving), *every.shape[1:])
        if of_places:
            for index, corners in self._standing.items():
                every[index] = np.moveaxis(np.broadcast_to(corners, (*every.shape[2:-1], *corners.shape[-2:])), -2, 0)
        origin, one, other = (np.moveaxis(every[:, corner], 0, axis) for corner in range(len(_OFFSETS)))
        return origin, one - origin, other - origin

    def poses(self, q: ArrayLike) -> Array:
        """(..., frames, 4, 4): transformations to the world; m."""
        origin, y, z = self._corners(self._crane.points(q), -2, of_places=True)
        pose = np.zeros((*origin.shape[:-1], 4, 4))
        for column, of in enumerate((np.cross(y, z), y, z, origin)):
            pose[..., :3, column] = of
        pose[..., 3, 3] = 1.0
        return pose

    def jacobians(self, q: ArrayLike) -> Array:
        """(..., frames, 6, n): J of the twists, `twist = J q̇`."""
        rotation = self.poses(q)[..., :3, :3]
        origin, y, z = self._corners(self._crane.point_jacobians(q), -3)
        return np.concatenate([origin, _turning(rotation, y, z)], axis=-2)

    def velocities(self, q: ArrayLike, v: ArrayLike) -> Array:
        """(..., frames, 6): twists."""
        rotation = self.poses(q)[..., :3, :3]
        origin, y, z = self._corners(self._crane.point_velocities(q, v), -2)
        return np.concatenate([origin, _turning(rotation, y[..., None], z[..., None])[..., 0]], axis=-1)

    def accelerations(self, q: ArrayLike, v: ArrayLike, a: ArrayLike | None = None) -> Array:
        """(..., frames, 6): accelerations of origins (m/s²) and angular accelerations (rad/s²), `J q̈ + J̇ q̇`; J̇ q̇ without a."""
        a = np.zeros(self._crane.n) if a is None else a
        rotation = self.poses(q)[..., :3, :3]
        omega = np.einsum("...ki,...k->...i", rotation, self.velocities(q, v)[..., 3:])
        origin, y, z = self._corners(self._crane.point_accelerations(q, v, a), -2)
        # In the axes of the frame, ë = α × e + ω × (ω × e) for e = e_y and e_z.
        alpha = np.einsum("...ki,...k->...i", rotation, _turning(rotation, y[..., None], z[..., None])[..., 0])
        x, y, z = np.moveaxis(omega, -1, 0)
        alpha = alpha + np.stack([-y * z, -z * x, x * y], axis=-1)
        return np.concatenate([origin, np.einsum("...ik,...k->...i", rotation, alpha)], axis=-1)

    def regressor(self, q: ArrayLike, v: ArrayLike, a: ArrayLike) -> Array:
        """(..., n, 10 frames): Y of `A q̈ − e = Y π` for masses that are fixed to the frames, in N and N m per parameter; π has for each frame its mass m,
        m c of its centre, and the moments about the origin (not the centre) Ixx, Ixy, Ixz, Iyy, Iyz, Izz, in its axes; kg, kg m, kg m².

        With frames of all rigid links, `Y π` is `Crane.inverse_dynamics` of a crane without beams. C. G. Atkeson, C. H. An, J. M. Hollerbach, Estimation
        of inertial parameters of manipulator loads and links, Int. J. Robotics Research 5(3), 1986.
        """
        into = np.swapaxes(self.poses(q)[..., :3, :3], -1, -2)
        twists, accelerations = self.velocities(q, v), self.accelerations(q, v, a)
        b = np.einsum("...ik,...k->...i", into, accelerations[..., :3] - self._gravity[..., None, :])
        omega, alpha = (np.einsum("...ik,...k->...i", into, of[..., 3:]) for of in (twists, accelerations))
        # Newton and Euler about the origin, in the axes of the frame: m b + α × m c + ω × (ω × m c), and m c × b + I α + ω × I ω.
        wrenches = np.zeros((*b.shape[:-1], 6, 10))
        wrenches[..., :3, 0] = b
        wrenches[..., :3, 1:4] = _cross(alpha) + _cross(omega) @ _cross(omega)
        wrenches[..., 3:, 1:4] = -_cross(b)
        wrenches[..., 3:, 4:] = _moments(alpha) + _cross(omega) @ _moments(omega)
        jacobians = self.jacobians(q)
        own = np.concatenate([into @ jacobians[..., :3, :], into @ jacobians[..., 3:, :]], axis=-2)
        matrices = np.moveaxis(np.swapaxes(own, -1, -2) @ wrenches, -3, -2)
        return matrices.reshape(*matrices.shape[:-2], -1)

    @cached_property
    def _gravity(self) -> Array:
        """(..., 3): acceleration of gravity, m/s², which may follow live parameters: that with which masses slide along the axes of the last link."""
        masses = [{"name": f"along_{axis}", "joint": {"prismatic": {"axis": axis}}, "mass": 1, "com": [0, 0, 0]} for axis in "xyz"]
        with warnings.catch_warnings():
            # Masses that are light for a crane.
            warnings.simplefilter("ignore")
            crane = _with(self._crane, {"links": masses})
        axes = crane.transforms(crane.guess)[..., -1, :3, :3]
        moved = np.diagonal(crane.mass_matrix(crane.guess), axis1=-2, axis2=-1)
        sliding = crane.bias(crane.guess, np.zeros(crane.n)) / moved
        gravity: Array = np.einsum("...ik,...k->...i", axes, sliding[..., -3:])
        return gravity


def _with(crane: Crane, changes: dict[str, Any]) -> Crane:
    """The crane with a change of its spec."""
    return type(crane)(crane.source, text=crane._changed(changes), parameters=crane.parameters, invalid="raise", inputs=crane.inputs)


def _cross(vectors: Array) -> Array:
    """(..., 3, 3): the matrix of w ↦ vector × w."""
    return np.swapaxes(np.cross(vectors[..., None, :], np.eye(3)), -1, -2)


def _moments(vectors: Array) -> Array:
    """(..., 3, 6): I w as a matrix times Ixx, Ixy, Ixz, Iyy, Iyz, Izz."""
    found = np.zeros((*vectors.shape, 6))
    for row, places in enumerate(((0, 1, 2), (1, 3, 4), (2, 4, 5))):
        found[..., row, places] = vectors
    return found


def _turning(rotation: Array, y: Array, z: Array) -> Array:
    """ω in the world's axes, (..., 3, m), of which the rates of two axes of a frame are ω × e_y and ω × e_z, (..., 3, m)."""
    along = np.einsum("...ki,...km->...im", rotation, y), np.einsum("...ki,...km->...im", rotation, z)
    omega = np.stack([along[0][..., 2, :], along[1][..., 0, :], -along[0][..., 0, :]], axis=-2)
    return np.einsum("...ik,...km->...im", rotation, omega)
