"""What was put into the physics from outside."""

from __future__ import annotations

from typing import Any


def forces_of(physics: Any) -> tuple[Any, Any]:
    """Forces on joints, shape (nv,), and on bodies, shape (nbody, 6), of the last step [N, N m].

    Those that hold for one step are gone from the state by then, and remembered.
    """
    applied, pushed = physics.data.qfrc_applied, physics.data.xfrc_applied
    if physics.shows_applied:
        return physics.last_applied + applied, physics.last_pushed + pushed
    return applied, pushed
