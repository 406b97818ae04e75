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

RECOVERY_ACCURACY: Final = 0.02
"""Accuracy of the correction of a contact whose separation speed is limited, in units of `EXIT_SPEED`."""

OPENING_SPEED: Final = 0.2 * EXIT_SPEED
"""Speed along the normal [m/s] above which a contact counts as opening."""

CLOSING_SPEED: Final = -EXIT_SPEED
"""Speed along the normal [m/s] below which a contact counts as closing fast."""

EXACTLY: Final = 0
"""Kind of a requested acceleration: the contact gets it exactly, in a rebound."""

AT_LEAST: Final = 1
"""Kind of a requested acceleration: a closing contact gets at least this, so that it stops."""

AT_MOST: Final = -1
"""Kind of a requested acceleration: an opening contact gets at most this."""

HIT_ACCURACY: Final = 0.002
"""Accuracy of the correction, in units of the largest acceleration along a normal of the island.

It applies during a hit and in the step after it. A hit at 1 m/s then leaves at most 2 mm/s along the normal, which
lifts a body by 0.2 µm.
"""

CREEP_LIMIT: Final = 50.0
"""Acceleration that would stop a slip, in units of the tolerance, above which a contact slides and does not creep."""

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
        least_damping: damping [1/s] of the time constant `softest`; the friction of a softer contact stays as it is.
        deep: penetration [m] from which the separation speed is limited in advance; see `deep_penetration`.
    """

    step: float
    gravity: list[float]
    tolerance: float
    closing: list[float] | None
    inner: frozenset[int] = frozenset()
    softest: float = math.inf
    least_damping: float = 0.0
    deep: float = math.inf


def deep_penetration(constant: float, step: float) -> float:
    """Return the penetration [m] from which MuJoCo would separate two bodies at rest faster than `EXIT_SPEED`.

    The contact is a critically damped oscillator. From the penetration r it reaches r / (e constant), or r step /
    constant² after one step if that is more. A contact at rest has some micrometres.

    Args:
        constant: time constant of the contact [s].
        step: length of a step [s].
    """
    return EXIT_SPEED * constant * min(math.e, constant / step)


def rebound(data: mujoco.MjData, number: int, speed: float, around: ContactConditions) -> float:
    """Return the rebound acceleration of a closing contact [m/s²]; NaN if the contact is too slow to rebound.

    A bouncing contact has the damping d (1 + e) / dt (`simkit.compiler.contact_friction.bounce_solref`), which reverses
    the speed within a step. The step that detects a hit begins below the surface, by up to the travel of one step. The
    integrator keeps the energy u² / 2 + q u - g depth in flight, with q = g dt / 2. After the hit, this energy is e²
    times its value at the surface.
    """
    contact, gravity, step = data.contact, around.gravity, around.step
    weight = math.sqrt(gravity[0] * gravity[0] + gravity[1] * gravity[1] + gravity[2] * gravity[2])
    if speed > -_RESTING_FACTOR * weight * step:
        return math.nan
    restitution = -contact.solref.item(number, 1) * step / contact.solimp.item(number, 1) - 1.0
    if restitution < 0.0:  # stiffness and damping from an MJCF file
        return math.nan
    x, y, z = contact.frame[number, :3].tolist()
    along = abs(x * gravity[0] + y * gravity[1] + z * gravity[2])
    depth = 0.0 if around.closing is not None else max(0.0, -contact.dist.item(number))
    u, q = -speed, along * step / 2.0
    arrives = max(0.0, u * u + 2.0 * q * u - 2.0 * along * depth)
    leaves = -q + math.sqrt(q * q + restitution * restitution * arrives + 2.0 * along * depth)
    acceleration: float = (leaves - speed) / step
    return acceleration


def raise_tolerances(tolerances: list[float], islands: list[int], accelerations: list[float]) -> list[float]:
    """Return the tolerances of contacts, at least `HIT_ACCURACY` times the largest acceleration of their island.

    Args:
        tolerances: tolerance of each contact [m/s²].
        islands: number of the island of each contact.
        accelerations: acceleration of each contact along its normal [m/s²].
    """
    largest: dict[int, float] = {}
    for island, acceleration in zip(islands, accelerations, strict=True):
        if acceleration > largest.get(island, 0.0):
            largest[island] = acceleration
    return [
        max(tolerance, HIT_ACCURACY * largest.get(island, 0.0))
        for tolerance, island in zip(tolerances, islands, strict=True)
    ]


def islands_of(data: mujoco.MjData, rows: list[int]) -> list[int]:
    """Return the number of the island of each row; all numbers are 0 if the engine forms no islands."""
    if data.nisland < 2:
        return [0] * len(rows)
    islands: list[int] = data.efc_island[rows].tolist()
    return islands


def hit_islands(islands: list[int], speeds: list[float]) -> set[int]:
    """Return the islands in which a contact closes fast.

    Args:
        islands: number of the island of each contact.
        speeds: speed of each contact along its normal [m/s].
    """
    return {island for island, speed in zip(islands, speeds, strict=True) if speed < CLOSING_SPEED}


def relaxation(islands: list[int], goals: list[float], mus: list[float]) -> list[float]:
    """Return the factor of over-relaxation of each contact.

    An error e of the correction s changes the normal acceleration by e / (1 + g). g is mu² times the ratio of the
    inverse masses along the slip and along the normal. It is about mu² for bodies whose inverse masses are equal. In a
    hit, a lever can reverse the sign of g; therefore islands with a hit have the factor 1.

    Args:
        islands: number of the island of each contact.
        goals: requested accelerations [m/s²] or NaN.
        mus: friction coefficient along the first tangent; 0 for contacts that do not slide.
    """
    hit = {island for island, goal in zip(islands, goals, strict=True) if goal > 0.0}
    return [1.0 if island in hit else 1.0 + min(mu * mu, 1.0) for island, mu in zip(islands, mus, strict=True)]
