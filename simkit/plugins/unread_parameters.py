"""Warnings about elements and attributes of a file that a plugin has not read."""

from __future__ import annotations

import functools
import inspect
import re
import sys
import tomllib
from pathlib import Path
from types import ModuleType
from typing import Final

from simkit.diagnostics import did_you_mean
from simkit.params import Params
from simkit.plugins.options import option_types_of
from simkit.plugins.plugin_names import normalise

_GAZEBO_ROS: Final = Path(__file__).parent / "classic" / "gazebo_ros_parameters.toml"

# Calls that read a name, as in `params.number("gain")`. The methods from `find_element` on are those of gz systems.
_READ_NAME = re.compile(
    r"""
    \.(?:all|attribute|block|boolean|child|choice|declare|each|has|integer|number|pose|text|vector3?
        |find_element|has_element|get_\w+)
    \((?:\s|\#[^\n]*\n)*(?:(?:[\w.]+\s*=\s*[\w.+-]+\s*,\s*)*(?:name|element)\s*=\s*)?(?:"([^"\n]+)"|'([^'\n]+)')
    """,
    re.VERBOSE,
)


def names_read(cls: type[object]) -> frozenset[str]:
    """Return the names of the elements and attributes that the modules of a class and its base classes can read.

    The text of the source is searched, not executed; to parse it takes 5 ms for a plugin with many parameters.
    """
    plugin_classes = (c for c in cls.__mro__ if c.__module__ != "simkit.plugins.base")
    modules = dict.fromkeys(c.__module__ for c in plugin_classes if c is not object)
    declared = (name for options in option_types_of(cls) for name in options.element_names())
    return frozenset(declared).union(*map(_names_in_module, modules))


def _names_in_module(module: str) -> frozenset[str]:
    try:
        return _names_in_source(inspect.getsource(sys.modules[module]))
    except (KeyError, OSError, TypeError):
        return frozenset()  # the module has no source, so its names are unknown


@functools.lru_cache(maxsize=256)
def _names_in_source(source: str) -> frozenset[str]:
    calls = _READ_NAME.finditer(source)
    return frozenset(call[1] or call[2] for call in calls if not _is_in_comment(source, call.start()))


def _is_in_comment(source: str, at: int) -> bool:
    """Check whether the line of a position is a comment, such as a call that a user has commented out."""
    return source[source.rfind("\n", 0, at) + 1 : at].lstrip().startswith("#")


def report_unread(params: Params, owner: str, reader: object) -> None:
    """Warn about each element and attribute that has not been read.

    Args:
        params: parameters of the plugin.
        owner: description of the plugin for messages, such as `plugin 'arm'`.
        reader: plugin, gz system or module; names in its source are suggested for misspelt names.
    """
    for element, suggestion in params.unread():
        text = f"{owner}: <{element.name}> is not used"
        if suggestion.endswith(" is"):  # the element is a duplicate; only the first one is read
            hint = suggestion
        elif element.name in _known_names(reader):
            hint = f"the plugin reads <{element.name}> only with other options, or later"
        elif _is_of_another_plugin(element.name, reader):
            text += ": it belongs to other plugins of gazebo_ros, and Gazebo's plugin does not read it either"
            params.diagnostics.note(
                "SK-PARAM-003", text, element.where, did_you_mean(element.name, _known_names(reader))
            )
            continue
        else:
            hint = did_you_mean(element.name, _known_names(reader)) or suggestion
        params.diagnostics.warning("SK-PARAM-003", text, element.where, hint)
    for element, attribute in params.unread_attributes():
        text = f"{owner}: attribute {attribute!r} of <{element.name}> is not used"
        attributes_read = element.attributes_asked
        hint = did_you_mean(attribute, (*attributes_read, *_known_names(reader))) if attributes_read else ""
        params.diagnostics.warning("SK-PARAM-007", text, element.where, hint)


def _is_of_another_plugin(name: str, reader: object) -> bool:
    """Check whether other plugins of gazebo_ros read an element, but not the plugin of the reader's library.

    Files often copy such elements from a plugin of another library, such as `<body_name>` of an IMU.
    """
    source = getattr(reader, "source", None)
    table = gazebo_ros_parameters()
    own = table.get(normalise(getattr(source, "filename", "")))
    return own is not None and name not in own and any(name in names for names in table.values())


@functools.cache
def gazebo_ros_parameters() -> dict[str, frozenset[str]]:
    """Return the names of the elements that each plugin of gazebo_ros_pkgs reads, in ROS 2 or ROS 1, by library."""
    table = tomllib.loads(_GAZEBO_ROS.read_text(encoding="utf-8"))
    return {library: frozenset(" ".join(texts.values()).split()) for library, texts in table.items()}


def _known_names(reader: object) -> frozenset[str]:
    return _names_in_module(reader.__name__) if isinstance(reader, ModuleType) else names_read(type(reader))
