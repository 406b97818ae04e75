"""Base class of substitutions."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext

__all__ = ["Substitution"]


class Substitution:
    """Text that is known only while the launch file is executed."""

    def describe(self) -> str:
        """Return a description of the substitution."""
        return type(self).__name__

    def perform(self, context: LaunchContext) -> str:
        """Return the text."""
        raise NotImplementedError(f"{type(self).__name__} has no method 'perform'")


class TextSubstitution(Substitution):
    """Fixed text.

    Args:
        text: text.
    """

    def __init__(self, *, text: str) -> None:
        if not isinstance(text, str):
            raise TypeError(f"TextSubstitution expected Text object got '{type(text)}' instead.")
        self._text = text

    @property
    def text(self) -> str:
        """Text."""
        return self._text

    def describe(self) -> str:
        """Return a description of the substitution."""
        return f"'{self.text}'"

    def perform(self, context: LaunchContext) -> str:
        """Return the text."""
        return self.text
