"""Topics, services and actions that a plugin class declares for `simkit plugin info`.

A class declares an endpoint if its name is not a literal in `load`. A run replaces `{model}`, `{world}` and similar
placeholders; `~` is the plugin's own name.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True)
class Endpoint:
    """Topic, service or action of a plugin.

    Attributes:
        role: use that the plugin makes of the endpoint.
        name: default name.
        types: ROS types; the first is the type that is listed.
        named_by: elements that change the name.
    """

    role: Literal["publishes", "listens", "offers", "acts"]
    name: str
    types: tuple[str, ...]
    named_by: tuple[str, ...] = ()


def publishes(name: str, *types: str, named_by: tuple[str, ...] = ()) -> Endpoint:
    """Declare a topic that the plugin publishes."""
    return Endpoint("publishes", name, types, named_by)


def listens(name: str, *types: str, named_by: tuple[str, ...] = ()) -> Endpoint:
    """Declare a topic that the plugin subscribes to."""
    return Endpoint("listens", name, types, named_by)


def offers(name: str, type_name: str, *, named_by: tuple[str, ...] = ()) -> Endpoint:
    """Declare a service."""
    return Endpoint("offers", name, (type_name,), named_by)


def offers_all(package: str, *types: str, below: str = "") -> tuple[Endpoint, ...]:
    """Declare services named after their types: `GetModelProperties` is `get_model_properties`."""
    names = {kind: re.sub(r"(?<=[a-z])(?=[A-Z])", "_", kind).lower() for kind in types}
    return tuple(offers(f"{below}{name}", f"{package}/srv/{kind}") for kind, name in names.items())


def acts(name: str, type_name: str, *, named_by: tuple[str, ...] = ()) -> Endpoint:
    """Declare an action."""
    return Endpoint("acts", name, (type_name,), named_by)
