"""A hash of a compiled model that does not depend on where its files lie."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Any

import numpy as np


def model_hash(model: Any, originals: Mapping[str, Any]) -> str:
    """SHA-256 of all arrays of an `MjModel` and of its options but gravity.

    Args:
        originals: arrays as they were compiled, of those that were changed since.
    """
    digest = hashlib.sha256()
    for name in sorted(dir(model)):
        if name.startswith("_") or name == "paths" or name.endswith("pathadr"):
            continue
        value = originals.get(name)
        value = getattr(model, name) if value is None else value
        if isinstance(value, np.ndarray):
            digest.update(name.encode())
            digest.update(np.ascontiguousarray(value).tobytes())
    digest.update(bytes(model.names))
    for name in ("timestep", "integrator", "solver", "iterations", "cone", "disableflags", "enableflags"):
        digest.update(repr(getattr(model.opt, name)).encode())
    return digest.hexdigest()
