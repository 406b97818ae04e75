"""xacro: files with macros and expressions, expanded before any other loader sees them."""

from simkit.loaders.xacro.expand import expand, needs_expansion

__all__ = ["expand", "needs_expansion"]
