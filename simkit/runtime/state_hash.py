"""A hash of the physics state, equal for two runs that did the same."""

from __future__ import annotations

import hashlib
from typing import Any


def state_hash(sim: Any) -> str:
    """SHA-256 of positions and velocities, as bits, in hexadecimal."""
    digest = hashlib.sha256()
    digest.update(sim.mj_data.qpos.tobytes())
    digest.update(sim.mj_data.qvel.tobytes())
    return digest.hexdigest()
