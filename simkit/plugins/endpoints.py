"""Declarations of a plugin's topics, services and actions, which `simkit plugin info` shows.

A plugin class declares each endpoint whose name is not a literal in `load`. Names may contain placeholders such as
`{model}` and `{world}`, which a run replaces; `~` is the plugin's own name.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True)
class Endpoint:
    """Topic, service or action of a plugin.

    Attributes:
        role: what the plugin does with the endpoint.
        name: default name.
        types: ROS types; the list of topics shows the first of them.
        named_by: elements of the file that change the name.
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
    """Declare a service that the plugin offers."""
    return Endpoint("offers", name, (type_name,), named_by)


def offers_all(package: str, *types: str, below: str = "") -> tuple[Endpoint, ...]:
    """Declare services that are named after their types, such as `get_model_properties` of `GetModelProperties`.

    Args:
        package: ROS package of the service types.
        types: names of the service types, without package.
        below: prefix of the service names.
    """
    names = {kind: re.sub(r"(?<=[a-z])(?=[A-Z])", "_", kind).lower() for kind in types}
    return tuple(offers(f"{below}{name}", f"{package}/srv/{kind}") for kind, name in names.items())


def acts(name: str, type_name: str, *, named_by: tuple[str, ...] = ()) -> Endpoint:
    """Declare an action that the plugin offers."""
    return Endpoint("acts", name, (type_name,), named_by)
