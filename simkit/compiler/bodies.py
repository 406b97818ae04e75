"""Links as bodies: frame, mass, inertia."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from simkit.diagnostics import Diagnostics
from simkit.pose import Pose
from simkit.scene import Inertial, SceneLink

LEAST_MASS: Final = 1e-9
LEAST_INERTIA: Final = 1e-12


def add_body(parent: Any, link: SceneLink, pose: Pose, diagnostics: Diagnostics) -> Any:
    """A body whose frame is the link frame, `pose` in the parent body's frame; returns MuJoCo's handle."""
    body = parent.add_body(name=link.scoped, pos=pose.position, quat=pose.quaternion)
    body.explicitinertial = True
    inertial = mended(link.inertial, link, diagnostics)
    body.mass = inertial.mass
    body.ipos = inertial.com
    body.fullinertia = inertial.inertia
    if not link.gravity or link.kinematic:
        body.gravcomp = 1.0
    if link.kinematic:
        diagnostics.warning(
            "SK-PHYS-012",
            f"kinematic: link {link.scoped} is not pulled by gravity, but contacts still push it",
            link.where,
        )
    return body


def mended(inertial: Inertial, link: SceneLink, diagnostics: Diagnostics) -> Inertial:
    """The inertial with the smallest change that makes it one of a real body (A + B >= C, all positive)."""
    ixx, iyy, izz, ixy, ixz, iyz = inertial.inertia
    matrix = np.array(((ixx, ixy, ixz), (ixy, iyy, iyz), (ixz, iyz, izz)))
    mass = inertial.mass
    if not (np.isfinite(matrix).all() and np.isfinite(mass) and np.isfinite(inertial.com).all()):
        diagnostics.error(
            "SK-PHYS-018", f"link {link.scoped}: mass, centre of mass or inertia is not finite", link.where
        )
        return Inertial()
    values, axes = np.linalg.eigh(matrix)
    moments = np.maximum(values, LEAST_INERTIA)
    lack = moments[2] - (moments[0] + moments[1])
    if lack > 1e-9 * moments[2]:
        moments[:2] += (0.5 + 1e-9) * lack
    is_same = bool((abs(moments - values) <= 1e-9 * abs(values)).all()) and mass >= LEAST_MASS
    if is_same:
        return inertial
    diagnostics.note(
        "SK-PHYS-011",
        f"link {link.scoped}: mass {mass:g} kg with principal moments {_text(values)} kg m² is that of no body; "
        f"{max(mass, LEAST_MASS):g} kg with {_text(moments)} is used",
        link.where,
    )
    m = (axes * moments) @ axes.T
    full = tuple(float(v) for v in (m[0, 0], m[1, 1], m[2, 2], m[0, 1], m[0, 2], m[1, 2]))
    return Inertial(
        max(mass, LEAST_MASS), inertial.com, (full[0], full[1], full[2], full[3], full[4], full[5]), inertial.given
    )


def _text(values: Any) -> str:
    return "(" + ", ".join(f"{v:.3g}" for v in values) + ")"
