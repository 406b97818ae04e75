"""The functions of the language, by name."""

from __future__ import annotations

from typing import Final

from simkit.conditions.contact_functions import CONTACT_FUNCTIONS
from simkit.conditions.function import Function
from simkit.conditions.list_functions import LIST_FUNCTIONS
from simkit.conditions.number_functions import NUMBER_FUNCTIONS
from simkit.conditions.world_functions import WORLD_FUNCTIONS

FUNCTIONS: Final[dict[str, Function]] = {
    **WORLD_FUNCTIONS,
    **CONTACT_FUNCTIONS,
    **LIST_FUNCTIONS,
    **NUMBER_FUNCTIONS,
}
