"""Topics, services and actions of a plugin, as its class declares them for `simkit plugin info`.

A class declares them where the names that it opens cannot be read literally in its `load`. `{model}`, `{world}` and
the like stand for names that a run fills in, `~` for the plugin's own name.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True)
class Endpoint:
    """A topic, service or action.

    Attributes:
        role: what the plugin does with it.
        name: its name where the file gives no other.
        types: ROS types; the first is the listed one.
        named_by: elements that change the name.
    """

    role: Literal["publishes", "listens", "offers", "acts"]
    name: str
    types: tuple[str, ...]
    named_by: tuple[str, ...] = ()


def publishes(name: str, *types: str, named_by: tuple[str, ...] = ()) -> Endpoint:
    """A topic that goes out."""
    return Endpoint("publishes", name, types, named_by)


def listens(name: str, *types: str, named_by: tuple[str, ...] = ()) -> Endpoint:
    """A topic that is listened to."""
    return Endpoint("listens", name, types, named_by)


def offers(name: str, type_name: str, *, named_by: tuple[str, ...] = ()) -> Endpoint:
    """A service."""
    return Endpoint("offers", name, (type_name,), named_by)


def offers_all(package: str, *types: str, below: str = "") -> tuple[Endpoint, ...]:
    """Services named after their types: `GetModelProperties` is `get_model_properties`."""
    names = {kind: re.sub(r"(?<=[a-z])(?=[A-Z])", "_", kind).lower() for kind in types}
    return tuple(offers(f"{below}{name}", f"{package}/srv/{kind}") for kind, name in names.items())


def acts(name: str, type_name: str, *, named_by: tuple[str, ...] = ()) -> Endpoint:
    """An action."""
    return Endpoint("acts", name, (type_name,), named_by)
