"""Functions for substitutions and items of launch descriptions."""

from __future__ import annotations

import inspect
import os
from asyncio import Future
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from simkit_launch.launch_modules.launch.launch_description_entity import LaunchDescriptionEntity
from simkit_launch.launch_modules.launch.substitution import Substitution, TextSubstitution

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_entities_type import SomeEntitiesType
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = [
    "ensure_argument_type",
    "is_a",
    "is_a_subclass",
    "isclassinstance",
    "normalize_to_list_of_entities",
    "normalize_to_list_of_substitutions",
    "perform_substitutions",
    "visit_all_entities_and_collect_futures",
]


def normalize_to_list_of_substitutions(subs: SomeSubstitutionsType) -> list[Substitution]:
    """Return a list of substitutions for a text, a substitution or a sequence of them."""
    if isinstance(subs, (str, os.PathLike, Substitution)):
        return [_one_substitution(subs)]
    if isinstance(subs, Iterable):
        return [_one_substitution(each) for each in subs]
    raise TypeError(
        f"Failed to normalize given item of type '{type(subs)}', when only "
        "'str', 'launch.Substitution' or an iterable of them were expected."
    )


def _one_substitution(value: object) -> Substitution:
    if isinstance(value, Substitution):
        return value
    if isinstance(value, (str, os.PathLike)):
        return TextSubstitution(text=os.fspath(value))
    raise TypeError(
        f"Failed to normalize given item of type '{type(value)}', when only 'str' or 'launch.Substitution' were "
        "expected."
    )


def perform_substitutions(context: LaunchContext, subs: Iterable[Substitution]) -> str:
    """Return the joined texts of substitutions."""
    return "".join([context.perform_substitution(sub) for sub in subs])


def normalize_to_list_of_entities(entities: SomeEntitiesType) -> list[LaunchDescriptionEntity]:
    """Return a list of items for one item or nested sequences of them."""
    if isinstance(entities, LaunchDescriptionEntity):
        return [entities]
    return [item for each in entities for item in normalize_to_list_of_entities(each)]


def visit_all_entities_and_collect_futures(entity: Any, context: LaunchContext) -> list[tuple[Any, Future[Any]]]:
    """Execute an item, and everything that it returns."""
    for each in entity.visit(context) or ():
        visit_all_entities_and_collect_futures(each, context)
    return []


def ensure_argument_type(
    argument: object, types: type | Sequence[Any], argument_name: str, caller: str | None = None
) -> None:
    """Check the type of an argument.

    Raises:
        TypeError: it has none of the types.
    """
    allowed = tuple(types) if isinstance(types, (tuple, list)) else (types,)
    if not isinstance(argument, allowed):
        names = ", ".join(str(each) for each in allowed)
        start = f"{caller}: " if caller else ""
        raise TypeError(f"{start}expected '{argument_name}' to be one of '{names}' but got '{type(argument)}'")


def isclassinstance(obj: object) -> bool:
    """Return whether an object is an instance of a class, and no class itself."""
    return not inspect.isclass(obj)


def is_a(obj: object, entity_type: type) -> bool:
    """Return whether an object is an instance of exactly this class."""
    return isclassinstance(obj) and isinstance(obj, entity_type)


def is_a_subclass(obj: object, entity_type: type) -> bool:
    """Return whether an object is an instance or a subclass of a class."""
    return isinstance(obj, entity_type) or (inspect.isclass(obj) and issubclass(obj, entity_type))
