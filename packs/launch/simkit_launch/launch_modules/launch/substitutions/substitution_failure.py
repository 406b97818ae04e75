"""Exception of a substitution."""

from __future__ import annotations

__all__ = ["SubstitutionFailure"]


class SubstitutionFailure(RuntimeError):
    """A substitution has no text."""
