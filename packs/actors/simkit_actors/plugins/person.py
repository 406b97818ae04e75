"""Built-in person, drawn if the skin of an actor cannot be used: shapes, and poses for walking, standing and sitting.

All dimensions are for a person of 1.75 m and are scaled for other heights. The x axis points forward and the z axis up;
the feet are at z = 0.
"""

from __future__ import annotations

import math
import zlib
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit import Pose
from simkit.elementary_functions import arcsin
from simkit.extend import Cylinder, Sphere
from simkit.pose import IDENTITY
from simkit.scene import Capsule, Ellipsoid, Geometry, PersonLook

Floats = npt.NDArray[np.float64]
Rgb = tuple[float, float, float]

HEIGHT: Final = 1.75
STRIDE: Final = 1.40
"""Length of two steps at a height of 1.75 m [m]."""

HIP: Final = (0.0, 0.09, 0.93)
KNEE: Final = 0.43
SOLE: Final = 0.50
SHOULDER: Final = (0.0, 0.205, 1.42)
ELBOW: Final = 0.29

_BRISK = 0.6  # [m/s], above this speed legs and arms swing with full amplitude

LIMBS: Final = (
    "thigh_left", "thigh_right", "shin_left", "shin_right",
    "upper_arm_left", "upper_arm_right", "forearm_left", "forearm_right",
)  # fmt: skip
PARTS: Final = ("torso", *LIMBS)


@dataclass(frozen=True, slots=True)
class Piece:
    """Shape of one part of a person."""

    part: str
    name: str
    geometry: Geometry
    pose: Pose
    look: str


@dataclass(frozen=True, slots=True)
class Appearance:
    """Height [m] and colours of a person."""

    height: float
    colours: dict[str, Rgb]


_SHIRTS: Final = ((0.20, 0.36, 0.60), (0.62, 0.22, 0.22), (0.25, 0.45, 0.33), (0.80, 0.66, 0.30), (0.42, 0.34, 0.52))
_TROUSERS: Final = ((0.16, 0.18, 0.24), (0.30, 0.27, 0.24), (0.22, 0.28, 0.38))
_SKINS: Final = ((0.89, 0.72, 0.60), (0.76, 0.57, 0.44), (0.55, 0.38, 0.28), (0.94, 0.80, 0.70))
_HAIRS: Final = ((0.15, 0.11, 0.09), (0.35, 0.22, 0.13), (0.62, 0.50, 0.30), (0.45, 0.45, 0.46))


def appearance_of(name: str, look_in_file: PersonLook | None = None) -> Appearance:
    """Return the height and colours of a person: those in the file, or values computed from the name."""
    number = zlib.crc32(name.encode())
    colours = {}
    for look, choice in (("shirt", _SHIRTS), ("trousers", _TROUSERS), ("skin", _SKINS), ("hair", _HAIRS)):
        number, index = divmod(number, len(choice))
        colours[look] = choice[index]
    colours |= {"shoes": (0.10, 0.09, 0.09), "eyes": (0.06, 0.05, 0.05)}
    height = round(1.62 + 0.02 * (number % 13), 2)
    if look_in_file is not None:
        colours |= look_in_file.colours
        height = look_in_file.height or height
    return Appearance(height, colours)


def _offset_along_x(x: float, y: float, z: float) -> Pose:
    return Pose((x, y, z))


def _across(y: float, z: float) -> Pose:
    return Pose.from_rpy(0.0, y, z, math.pi / 2, 0.0, 0.0)


def _figure() -> tuple[Piece, ...]:
    pieces = [
        Piece("torso", "pelvis", Ellipsoid((0.125, 0.170, 0.13)), _offset_along_x(0.0, 0.0, 0.965), "trousers"),
        Piece("torso", "belly", Ellipsoid((0.120, 0.162, 0.22)), _offset_along_x(0.0, 0.0, 1.14), "shirt"),
        Piece("torso", "chest", Ellipsoid((0.122, 0.190, 0.17)), _offset_along_x(0.0, 0.0, 1.305), "shirt"),
        Piece("torso", "shoulders", Capsule(0.068, 0.29), _across(0.0, 1.415), "shirt"),
        Piece("torso", "neck", Cylinder(0.052, 0.12), _offset_along_x(0.0, 0.0, 1.50), "skin"),
        Piece("torso", "head", Ellipsoid((0.094, 0.076, 0.118)), _offset_along_x(0.012, 0.0, 1.627), "skin"),
        Piece("torso", "hair", Ellipsoid((0.094, 0.083, 0.092)), _offset_along_x(-0.016, 0.0, 1.664), "hair"),
        Piece("torso", "nose", Ellipsoid((0.020, 0.014, 0.022)), _offset_along_x(0.104, 0.0, 1.618), "skin"),
    ]
    for side, sign in (("left", 1.0), ("right", -1.0)):
        eye = Piece("torso", f"eye_{side}", Sphere(0.011), _offset_along_x(0.094, sign * 0.031, 1.648), "eyes")
        ear = Ellipsoid((0.018, 0.010, 0.028))
        pieces += [
            eye,
            Piece("torso", f"ear_{side}", ear, _offset_along_x(0.0, sign * 0.080, 1.628), "skin"),
            Piece(f"thigh_{side}", "thigh", Capsule(0.078, 0.33), _offset_along_x(0.0, 0.0, -0.205), "trousers"),
            Piece(f"shin_{side}", "shin", Capsule(0.056, 0.36), _offset_along_x(0.0, 0.0, -0.205), "trousers"),
            Piece(
                f"shin_{side}", "shoe", Ellipsoid((0.135, 0.050, 0.052)), _offset_along_x(0.055, 0.0, -0.448), "shoes"
            ),
            Piece(f"upper_arm_{side}", "upper_arm", Capsule(0.048, 0.24), _offset_along_x(0.0, 0.0, -0.145), "shirt"),
            Piece(f"forearm_{side}", "forearm", Capsule(0.037, 0.20), _offset_along_x(0.0, 0.0, -0.125), "skin"),
            Piece(f"forearm_{side}", "hand", Ellipsoid((0.042, 0.022, 0.075)), _offset_along_x(0, 0, -0.300), "skin"),
        ]
    return tuple(pieces)


FIGURE: Final = _figure()


def scale_shape(shape: Geometry, scale: float) -> Geometry:
    """Return a shape of the person, scaled by a factor."""
    if isinstance(shape, Ellipsoid):
        x, y, z = shape.radii
        return Ellipsoid((x * scale, y * scale, z * scale))
    if isinstance(shape, Sphere):
        return Sphere(shape.radius * scale)
    assert isinstance(shape, Capsule | Cylinder)
    return type(shape)(shape.radius * scale, shape.length * scale)


def walking_angles(distance: Floats, speed: Floats) -> Floats:
    """Return the angles of the limbs of a walking person.

    The angles depend on the distance walked, so that the feet do not slide on the ground.

    Args:
        distance: distance walked, scaled to a height of 1.75 m [m], shape (n,).
        speed: walking speed [m/s], shape (n,). The limbs swing less below 0.6 m/s, and hang down at rest.

    Returns:
        Angles in the order of `LIMBS` [rad], positive if the limb is turned forward, shape (n, 8). The angle of a shin
        is relative to the thigh, and the angle of a forearm is relative to the upper arm.
    """
    amplitude = np.clip(speed / _BRISK, 0.0, 1.0)
    angles = np.empty((len(distance), 8))
    for side, ahead in ((0, 0.0), (1, 0.5)):
        part = np.mod(distance / STRIDE + 0.25 + ahead, 1.0)
        stands = part < 0.5
        since = 2.0 * (part - 0.5)  # fraction of the half cycle in which the foot is in the air, 0 to 1
        # relative to the hips, a foot on the ground moves back at walking speed, so that it does not slide
        foot = STRIDE * np.where(stands, 0.25 - part, -0.25 * np.cos(math.pi * since))
        lift = np.abs(np.sin(math.pi * since))
        bend = np.where(stands, 0.0, 0.95 * lift * np.sqrt(lift))
        thigh = arcsin(np.clip(foot / (KNEE + SOLE), -1.0, 1.0)) + 0.5 * bend
        angles[:, side] = amplitude * thigh
        angles[:, 2 + side] = -0.02 - amplitude * bend
        swing = np.cos(2.0 * math.pi * part)
        angles[:, 4 + side] = -0.40 * amplitude * swing
        angles[:, 6 + side] = 0.14 + amplitude * (0.22 - 0.14 * swing)
    return angles


SITTING: Final = (1.45, 1.45, -1.45, -1.45, 0.55, 0.55, 1.05, 1.05)
"""Angles of the limbs of a person who sits at a desk, in the order of `LIMBS` [rad]."""


def figure_poses(angles: Floats) -> tuple[Floats, Floats]:
    """Return the poses of the body parts of a person of 1.75 m; the lower foot is on the ground.

    Args:
        angles: angles of the limbs as in `walking_angles` [rad], shape (n, 8).

    Returns:
        Positions [m], shape (n, 9, 3), and quaternions, shape (n, 9, 4), of `PARTS` in the person's frame.
    """
    count = len(angles)
    places, turns = np.zeros((count, 9, 3)), np.zeros((count, 9, 4))
    total = angles.copy()
    total[:, 2:4] += total[:, 0:2]
    total[:, 6:8] += total[:, 4:6]
    turns[:, 0, 0] = 1.0
    turns[:, 1:, 0], turns[:, 1:, 2] = np.cos(total / 2), -np.sin(total / 2)
    x, down = np.sin(total), -np.cos(total)
    for side, sign in ((0, 1.0), (1, -1.0)):
        for first, (joint, upper) in ((1, (HIP, KNEE)), (5, (SHOULDER, ELBOW))):
            above, below = first + side, first + 2 + side
            places[:, above] = joint[0], sign * joint[1], joint[2]
            places[:, below] = places[:, above]
            places[:, below, 0] += upper * x[:, above - 1]
            places[:, below, 2] += upper * down[:, above - 1]
    soles = places[:, 3:5, 2] + SOLE * down[:, 2:4]
    places[:, :, 2] -= soles.min(axis=1)[:, None]
    return places, turns


def resting_poses(sits: bool) -> dict[str, Pose]:
    """Return the poses of the body parts of a standing or sitting person of 1.75 m."""
    angles = np.array([SITTING]) if sits else walking_angles(np.zeros(1), np.zeros(1))
    places, turns = figure_poses(angles)
    return {part: Pose(places[0, i], turns[0, i]) for i, part in enumerate(PARTS)} | {"": IDENTITY}
