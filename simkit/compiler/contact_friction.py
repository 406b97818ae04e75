"""Contact properties of a surface: friction by priority, softness, bounce, masks.

Gazebo's engines use the smaller friction coefficient of two surfaces. MuJoCo uses the larger coefficient if both
surfaces have the same `priority`, else the coefficient of the higher priority. Therefore simkit gives a surface a
higher priority if its coefficient is smaller. The priority depends only on the coefficient, so that a spawned model
does not change the contacts of other models.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from simkit.compiler.engine_options import CONTACT_SOLIMP, SOFT_SOLIMP, contact_time_constant, rigid_time_constant
from simkit.diagnostics import Diagnostics
from simkit.scene import Surface

MU_MOST: Final = 2.0
"""Largest friction coefficient; larger values in files (often 100000 for "never slips") are reduced to this value.

With a pyramidal cone a larger coefficient couples into the normal force: wheels bounce and slip (slip of 2.7 % with a
coefficient of 10, of 0.04 % with 2).
"""

STIFF_KP: Final = 1e5
"""Stiffness [N/m] from which a contact counts as rigid and uses the world-wide softness."""

BOUNCE_SOLIMP: Final = (0.9995, 0.9995, 0.001, 0.5, 2.0)
"""Impedance of a contact that rebounds. It loses 0.05 % of the velocity change; an impedance of 0.95 loses 5 %."""

_ALL_BITS: Final = 0xFFFF
_DECIDING_IMPEDANCE: Final = 1e6  # weight in the engine's mean of the impedances of two surfaces
_TORSION, _ROLL, _LEAST = 0.005, 0.0001, 1e-5


class ContactProperties(NamedTuple):
    """Contact properties of a MuJoCo geom."""

    friction: tuple[float, float, float]
    condim: int
    priority: int
    solref: tuple[float, float]
    solimp: tuple[float, float, float, float, float]
    solmix: float
    contype: int
    conaffinity: int


@lru_cache(maxsize=1024)
def friction_priority(mu: float) -> int:
    """Return a priority that rises strictly as `mu` falls from `MU_MOST` to 0; a larger `mu` counts as `MU_MOST`.

    The priority is computed from the bits of `mu` as float32: read as integers, they have the same order as the
    numbers.
    """
    return int(np.float32(MU_MOST).view(np.int32)) - int(np.float32(max(0.0, min(mu, MU_MOST))).view(np.int32))


def contact_properties(surface: Surface, timestep: float, mass: float, diagnostics: Diagnostics) -> ContactProperties:
    """Return MuJoCo's contact properties of one collision.

    Args:
        surface: surface of the collision.
        timestep: length of a step [s].
        mass: mass of the kinematic tree that contains the collision [kg]; 0 for a static collision.
        diagnostics: collection for a note about each property that MuJoCo does not support.
    """
    mu = _sliding_friction(surface, diagnostics)
    solref = _softness(surface, timestep, mass, diagnostics)
    solimp, solmix = _impedance(surface.restitution, solref, timestep)
    contype, conaffinity = contact_masks(surface)
    if surface.collide_without_contact:
        message = "collide_without_contact: the collision makes no contacts"
        diagnostics.warning("SK-PHYS-014", message, surface.where)
        contype = conaffinity = 0
    torsion, roll = _turning_friction(surface, diagnostics) if mu > 0.0 else (0.0, 0.0)
    return ContactProperties(
        friction=(mu, torsion or _TORSION, roll or _ROLL),
        condim=1 if mu == 0.0 else 6 if roll > 0.0 else 4 if torsion > 0.0 else 3,
        priority=friction_priority(mu),
        solref=solref,
        solimp=solimp,
        solmix=solmix,
        contype=contype,
        conaffinity=conaffinity,
    )


def contact_masks(surface: Surface) -> tuple[int, int]:
    """Return contype and conaffinity: two surfaces touch if their bit masks share a bit."""
    collide = _int32(surface.collide_bitmask)
    if surface.category_bitmask == _ALL_BITS:
        return collide, collide
    return _int32(surface.category_bitmask), collide


def _int32(bits: int) -> int:
    bits &= 0xFFFFFFFF
    return bits - (1 << 32) if bits >= 1 << 31 else bits


def has_directional_friction(surface: Surface) -> bool:
    """Check whether friction or slip of a surface differ along and across its direction."""
    along, across = directional_friction(surface, has_one=True)
    return any(surface.fdir1) and (along != across or surface.slip1 != surface.slip2)


def directional_friction(surface: Surface, *, has_one: bool | None = None) -> tuple[float, float]:
    """Return the friction along and across the direction, within the engine's limits.

    Without a direction both are the smaller coefficient.
    """
    mu, mu2 = (min(max(0.0, m), MU_MOST) if math.isfinite(m) else MU_MOST for m in (surface.mu, surface.mu2))
    if has_one is None:
        has_one = has_directional_friction(surface)
    return (mu, mu2) if has_one else (min(mu, mu2), min(mu, mu2))


def directional_slip(surface: Surface) -> tuple[float, float]:
    """Return the slip of a surface per force [m/s/N], along and across its direction.

    If the two values differ, but the surface has no direction, both are ignored and the slip is zero.
    """
    slips = max(0.0, surface.slip1), max(0.0, surface.slip2)
    return slips if slips[0] == slips[1] or any(surface.fdir1) else (0.0, 0.0)


def _sliding_friction(surface: Surface, diagnostics: Diagnostics) -> float:
    """Return the sliding friction of a surface.

    If the friction has a direction, the result is the larger coefficient. The runtime then sets both coefficients at
    each contact.
    """
    most = max((m if math.isfinite(m) else MU_MOST for m in (surface.mu, surface.mu2)), default=0.0)
    if most > MU_MOST:
        diagnostics.note("SK-PHYS-002", f"friction coefficient {most:g} is reduced to {MU_MOST:g}", surface.where)
    mu, mu2 = directional_friction(surface, has_one=True)
    if has_directional_friction(surface):
        return max(mu, mu2)
    if mu != mu2:
        message = f"friction differs along (mu {mu:g}) and across (mu2 {mu2:g}): the smaller one is used for both"
        diagnostics.warning("SK-PHYS-005", message, surface.where)
    if surface.slip1 != surface.slip2:
        message = "slip1 and slip2 differ without <fdir1>: they are ignored"
        diagnostics.warning("SK-PHYS-006", message, surface.where)
    return min(mu, mu2)


def _turning_friction(surface: Surface, diagnostics: Diagnostics) -> tuple[float, float]:
    """Return torsional and rolling friction as torque per normal force [m]; 0 if the file has no such friction.

    A patch of radius a under Hertz pressure resists spinning with 3π/16 · a · coefficient · N, as in Gazebo.
    """
    roll = max(0.0, surface.rolling or 0.0)
    torsion = 0.0
    if surface.torsional_slip:
        diagnostics.note("SK-PHYS-007", "the slip of torsional friction is ignored", surface.where)
    if surface.torsional:
        if surface.use_patch_radius:
            torsion = 3.0 * math.pi / 16.0 * max(0.0, surface.patch_radius) * surface.torsional
        elif surface.surface_radius > 0.0:
            message = (
                "torsional friction of a patch that grows with the depth (surface_radius) is ignored; only a fixed "
                "patch_radius is supported"
            )
            diagnostics.note("SK-PHYS-007", message, surface.where)
    if roll > 0.0 and torsion == 0.0:
        torsion = _LEAST
    return torsion, roll


def _impedance(
    restitution: float, solref: tuple[float, float], timestep: float
) -> tuple[tuple[float, float, float, float, float], float]:
    """Return the impedance and its weight. A surface that rebounds or is soft has a dominant weight in a contact."""
    if restitution > 0.0:
        return BOUNCE_SOLIMP, _DECIDING_IMPEDANCE
    if solref[0] > rigid_time_constant(timestep):
        return SOFT_SOLIMP, _DECIDING_IMPEDANCE
    return CONTACT_SOLIMP, 1.0


def _softness(surface: Surface, timestep: float, mass: float, diagnostics: Diagnostics) -> tuple[float, float]:
    world = contact_time_constant(timestep)
    if surface.restitution > 0.0:
        text = f"restitution {surface.restitution:g} holds at any speed: <threshold> is not used"
        diagnostics.note("SK-PHYS-003", text, surface.where)
        return bounce_solref(surface.restitution, timestep)
    if surface.kp is None or surface.kp >= STIFF_KP or surface.kp <= 0.0:
        if surface.kp is not None and surface.kp != 1e12:
            text = (
                f"contact stiffness {surface.kp:g} N/m is simulated as rigid: "
                f"time constant {world * 1e3:g} ms, critical damping"
            )
            diagnostics.note("SK-PHYS-004", text, surface.where)
        return rigid_time_constant(timestep), 1.0
    if mass <= 0.0:
        text = (
            f"contact stiffness {surface.kp:g} N/m of a static surface is ignored; "
            "the stiffness of the other surface is used"
        )
        diagnostics.note("SK-PHYS-004", text, surface.where)
        return rigid_time_constant(timestep), 1.0
    omega = math.sqrt(surface.kp / mass)
    damping = max(1.0, (surface.kd or 0.0) / (2.0 * mass * omega))
    constant = max(1.0 / (damping * omega), world)
    text = f"contact stiffness {surface.kp:g} N/m under {mass:g} kg has a time constant of {constant * 1e3:.3g} ms"
    diagnostics.note("SK-PHYS-004", text, surface.where)
    return constant, damping


def bounce_solref(restitution: float, timestep: float) -> tuple[float, float]:
    """Return direct stiffness and damping (negative solref) of a contact that rebounds within one step.

    MuJoCo drives a contact with penetration r and velocity v towards the acceleration −b v − k r. With b = (1 + e) /
    dt, the velocity v at the beginning of a step becomes −e v in that step, at any speed, mass and number of contact
    points. MuJoCo divides b by the impedance, which removes some energy in every rebound. The stiffness k is needed
    only for a body at rest. In one rebound it adds at most a quarter of the removed energy. The energy of a single
    contact therefore never rises.
    """
    impedance = BOUNCE_SOLIMP[1]
    rate = (1.0 + min(restitution, 1.0)) / timestep
    return -(1.0 - impedance) * rate / (4.0 * timestep), -impedance * rate
