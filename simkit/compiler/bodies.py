"""Bodies of links: frame, mass, inertia."""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np

from simkit.compiler.refused_inertias import LEAST_MASS, BodyInertia
from simkit.pose import Pose
from simkit.scene import Inertial, SceneLink

LEAST_INERTIA: Final = 1e-12


KINEMATIC_ARMATURE: Final = 1e9
"""Armature [kg and kg·m²] of a free kinematic link; it adds to the inertia, not to the weight."""

SPLIT_MASS_SHARE: Final = 0.1
"""Fraction of a link's mass that its twin receives if a joint closes a loop.

A lighter twin makes the loop softer: under a load the weld yields in proportion to 1 / mass.
"""


def add_body(
    parent: mujoco.MjsBody, link: SceneLink, pose: Pose, written: BodyInertia | None, *, needs_mass: bool = True
) -> mujoco.MjsBody:
    """Add a body whose frame is the link frame, at `pose` in the parent body's frame; return MuJoCo's handle.

    Args:
        parent: parent body.
        link: link of the file.
        pose: pose of the link in the parent body's frame.
        written: mass and inertia (`simkit.compiler.refused_inertias.plan_inertials`); None for a link without mass.
        needs_mass: True if a link without mass gets the least mass, because the link can move relative to other links.
    """
    body = parent.add_body(name=link.scoped, pos=pose.position, quat=pose.quaternion)
    body.explicitinertial = True
    if written is None:
        least = needs_mass
        body.mass, body.inertia = (LEAST_MASS, (LEAST_INERTIA,) * 3) if least else (0.0, (0.0, 0.0, 0.0))
        return body
    body.mass, body.ipos = written.mass, written.com
    if written.exact is not None:
        body.simple = 0  # the inertia axes are rotated after the compile, which is invalid for a body marked as simple
    if any(written.inertia):
        body.fullinertia = written.inertia
    else:
        body.inertia = (0.0, 0.0, 0.0)
    if not link.gravity or link.kinematic:
        body.gravcomp = 1.0
    return body


def is_massless(inertial: Inertial) -> bool:
    """Check whether a link is only a frame: without mass and without inertia."""
    return inertial.mass == 0.0 and not any(inertial.inertia)


def add_split_body(
    spec: mujoco.MjSpec, name: str, body: str, under: str, pose: Pose, has_motion: bool
) -> mujoco.MjsBody:
    """Add a twin of a link's body as a child of another body; the twin receives a fraction of the link's mass.

    Args:
        spec: MuJoCo's specification.
        name: name of the twin.
        body: MuJoCo body of the link.
        under: parent body of the twin.
        pose: pose of the link's body in the frame of `under`.
        has_motion: True if joints move the twin; a twin that is fixed to `under` needs no mass.
    """
    twin = spec.body(under).add_body(name=name, pos=pose.position, quat=pose.quaternion)
    twin.explicitinertial = True
    source = spec.body(body)
    twin.gravcomp = source.gravcomp
    if not has_motion:
        twin.mass, twin.inertia = 0.0, (0.0, 0.0, 0.0)
        return twin
    twin.ipos = source.ipos
    is_full = bool(np.isfinite(source.fullinertia[0]))
    twin.mass = max(LEAST_MASS, SPLIT_MASS_SHARE * source.mass)
    if is_full:
        twin.fullinertia = SPLIT_MASS_SHARE * np.array(source.fullinertia)
    else:
        twin.iquat = source.iquat
        twin.inertia = np.maximum(LEAST_INERTIA, SPLIT_MASS_SHARE * np.array(source.inertia))
    _scale(source, 1.0 - SPLIT_MASS_SHARE)
    return twin


def remove_split_body(spec: mujoco.MjSpec, name: str, body: str) -> None:
    """Remove a twin and return its mass to the link, if the link still exists."""
    twin = spec.body(name)
    has_motion = twin is not None and len(twin.joints) > 0
    if twin is not None:
        spec.delete(twin)
    source = spec.body(body)
    if source is not None and has_motion:
        _scale(source, 1.0 / (1.0 - SPLIT_MASS_SHARE))


def _scale(body: mujoco.MjsBody, factor: float) -> None:
    body.mass *= factor
    if np.isfinite(body.fullinertia[0]):
        body.fullinertia = factor * np.array(body.fullinertia)
    else:
        body.inertia = factor * np.array(body.inertia)
