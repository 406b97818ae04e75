"""Conditions under which the contact law corrects contacts: limits of speed and depth, and the rebound."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    import mujoco

ARRAY_THRESHOLD: Final = 64
"""From this number of contacts on arrays are faster than plain numbers; the results have the same bits."""

EXIT_SPEED: Final = 0.05
"""Speed [m/s] at which a contact lets go, or overlapping bodies part, at most: a hop of 0.13 mm."""

DEEP_PENETRATION: Final = 1e-3
"""Penetration [m] from which the way out is watched even before it begins; a contact at rest has some micrometres."""

OPENING_SPEED: Final = 0.2 * EXIT_SPEED
"""Speed [m/s] from which a contact counts as opening."""

CLOSING_SPEED: Final = -EXIT_SPEED
"""Speed [m/s] of a contact below which it closes fast."""

CLOSING_ACCURACY: Final = 2e-4
"""Share of the acceleration asked of a contact that closes fast, up to which it may be missed."""

NO_FORCE: Final = -1e9
"""Acceleration [m/s²] asked of a contact that shall not push."""

MIN_PENETRATION: Final = 1e-4
"""Penetration [m] from which the impedance of a contact is considered."""

LIFT_FACTOR: Final = 10.0
"""Lift that a contact bears, in units of the tolerance times (1 - d) / d of its impedance d."""

_RESTING_FACTOR: Final = 4.0
"""Speed, in units of what gravity gives in a step, below which a contact rests and does not rebound."""


@dataclass(slots=True)
class ContactConditions:
    """Quantities besides the state that the correction of contacts depends on.

    Attributes:
        step: [s].
        gravity: [m/s²].
        tolerance: of normal references [m/s²].
        closing: speed [m/s] that is left to each geom when its contact is stopped, where contacts are speculative.
        inner: numbers of contacts that get no force.
        softest: longest time constant [s] of a rigid contact; a softer one, by a `<kp>`, closes and opens as it is.
    """

    step: float
    gravity: list[float]
    tolerance: float
    closing: list[float] | None
    inner: frozenset[int] = frozenset()
    softest: float = math.inf


def rebound(data: mujoco.MjData, number: int, speed: float, around: ContactConditions) -> tuple[float, float]:
    """Return the acceleration with which a contact that closes leaves, and what is left of its tangents' references.

    A bouncing contact has the damping d (1 + e) / dt (`simkit.compiler.contact_friction.bounce_solref`), which reverses
    the speed within a step. The step in which a hit is noticed begins below the surface, by up to a step's way. The
    energy that the integrator keeps in flight, u² / 2 + q u - g depth with q = g dt / 2, becomes e² of it as seen from
    the surface.
    Friction has the same damping: without a share of 1 / (1 + e) of it, a hit would reverse the slip as well.

    Returns:
        The acceleration [m/s²], NaN for a contact that is too slow to rebound, and the share.
    """
    contact, gravity, step = data.contact, around.gravity, around.step
    weight = math.sqrt(gravity[0] * gravity[0] + gravity[1] * gravity[1] + gravity[2] * gravity[2])
    if speed > -_RESTING_FACTOR * weight * step:
        return math.nan, 1.0
    restitution = -contact.solref.item(number, 1) * step / contact.solimp.item(number, 1) - 1.0
    if restitution < 0.0:  # stiffness and damping that an MJCF file gives
        return math.nan, 1.0
    x, y, z = contact.frame[number, :3].tolist()
    along = abs(x * gravity[0] + y * gravity[1] + z * gravity[2])
    depth = 0.0 if around.closing is not None else max(0.0, -contact.dist.item(number))
    u, q = -speed, along * step / 2.0
    arrives = max(0.0, u * u + 2.0 * q * u - 2.0 * along * depth)
    leaves = -q + math.sqrt(q * q + restitution * restitution * arrives + 2.0 * along * depth)
    return (leaves - speed) / step, 1.0 / (1.0 + restitution)
