"""Error for parts of an environment that cannot be computed as arrays."""

from __future__ import annotations


class CannotBatchError(Exception):
    """Reason why a part of an environment cannot be computed as arrays."""
