"""Conditions under which the contact law corrects contacts: limits of speed and depth, and the rebound."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    import mujoco

ARRAY_THRESHOLD: Final = 64
"""Least number of contacts for which arrays are faster than plain numbers; the results have the same bits."""

EXIT_SPEED: Final = 0.05
"""Largest speed [m/s] at which a contact opens and overlapping bodies separate; at this speed, a body hops 0.13 mm."""

DEEP_PENETRATION: Final = 1e-3
"""Penetration [m] from which the separation speed is limited in advance; a contact at rest has some micrometres."""

OPENING_SPEED: Final = 0.2 * EXIT_SPEED
"""Speed along the normal [m/s] above which a contact counts as opening."""

CLOSING_SPEED: Final = -EXIT_SPEED
"""Speed along the normal [m/s] below which a contact counts as closing fast."""

CLOSING_ACCURACY: Final = 2e-4
"""Allowed relative error of the requested acceleration of a contact that closes fast."""

NO_FORCE: Final = -1e9
"""Requested acceleration [m/s²] that leaves a contact without force."""

MIN_PENETRATION: Final = 1e-4
"""Penetration [m] from which the tolerance of a contact depends on its impedance."""

LIFT_FACTOR: Final = 10.0
"""Allowed lift of a contact, in units of the tolerance times (1 - d) / d of its impedance d."""

_RESTING_FACTOR: Final = 4.0
"""Speed, in units of the velocity change by gravity in a step, below which a contact rests and does not rebound."""


@dataclass(slots=True)
class ContactConditions:
    """Quantities that determine the correction of contacts, in addition to the state.

    Attributes:
        step: length of a step [s].
        gravity: gravity [m/s²].
        tolerance: tolerance of normal references [m/s²].
        closing: remaining approach speed [m/s] of each geom after its contact is stopped; None without speculative
            contacts.
        inner: numbers of contacts without force.
        softest: largest time constant [s] of a rigid contact. A softer contact, set by a `<kp>`, opens and closes
            without a correction.
    """

    step: float
    gravity: list[float]
    tolerance: float
    closing: list[float] | None
    inner: frozenset[int] = frozenset()
    softest: float = math.inf


def rebound(data: mujoco.MjData, number: int, speed: float, around: ContactConditions) -> tuple[float, float]:
    """Return the rebound acceleration of a closing contact, and the remaining fraction of its tangents' references.

    A bouncing contact has the damping d (1 + e) / dt (`simkit.compiler.contact_friction.bounce_solref`), which reverses
    the speed within a step. The step that detects a hit begins below the surface, by up to the travel of one step. The
    integrator keeps the energy u² / 2 + q u - g depth in flight, with q = g dt / 2. After the hit, this energy is e²
    times its value at the surface. Friction has the same damping. Its references are multiplied by 1 / (1 + e), because
    otherwise a hit would reverse the slip as well.

    Returns:
        Acceleration [m/s²] and fraction; the acceleration is NaN for a contact that is too slow to rebound.
    """
    contact, gravity, step = data.contact, around.gravity, around.step
    weight = math.sqrt(gravity[0] * gravity[0] + gravity[1] * gravity[1] + gravity[2] * gravity[2])
    if speed > -_RESTING_FACTOR * weight * step:
        return math.nan, 1.0
    restitution = -contact.solref.item(number, 1) * step / contact.solimp.item(number, 1) - 1.0
    if restitution < 0.0:  # stiffness and damping from an MJCF file
        return math.nan, 1.0
    x, y, z = contact.frame[number, :3].tolist()
    along = abs(x * gravity[0] + y * gravity[1] + z * gravity[2])
    depth = 0.0 if around.closing is not None else max(0.0, -contact.dist.item(number))
    u, q = -speed, along * step / 2.0
    arrives = max(0.0, u * u + 2.0 * q * u - 2.0 * along * depth)
    leaves = -q + math.sqrt(q * q + restitution * restitution * arrives + 2.0 * along * depth)
    return (leaves - speed) / step, 1.0 / (1.0 + restitution)
