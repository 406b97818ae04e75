"""Types of what stands for a text: a text, a substitution, or a sequence of them that is joined."""

from __future__ import annotations

import collections.abc
import os
from collections.abc import Iterable
from typing import Final

from simkit_launch.launch_modules.launch.substitution import Substitution

__all__ = ["SomeSubstitutionsType", "SomeSubstitutionsType_types_tuple"]

SomeSubstitutionsType = str | os.PathLike[str] | Substitution | Iterable[str | os.PathLike[str] | Substitution]

SomeSubstitutionsType_types_tuple: Final[tuple[type, ...]] = (str, Substitution, collections.abc.Iterable)
