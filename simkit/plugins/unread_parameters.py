"""Warnings about elements and attributes of a file that a plugin has not read."""

from __future__ import annotations

import ast
import functools
import inspect
import sys
from collections.abc import Iterator
from types import ModuleType

from simkit.diagnostics import did_you_mean
from simkit.params import Params
from simkit.plugins.options import option_types_of

_READERS = frozenset(
    ("all", "attribute", "block", "boolean", "child", "choice", "declare", "each", "has", "integer", "number")  # noqa: RUF005
    + ("pose", "text", "vector", "vector3")
    + ("find_element", "has_element")  # methods of gz systems; their methods `get_…` are recognised by the prefix
)


def names_read(cls: type[object]) -> frozenset[str]:
    """Return the names of the elements and attributes that the modules of a class and its base classes can read.

    The source is parsed, not executed.
    """
    own = (c for c in cls.__mro__ if c.__module__ != "simkit.plugins.base")
    modules = dict.fromkeys(c.__module__ for c in own if c is not object)
    declared = (name for options in option_types_of(cls) for name in options.element_names())
    return frozenset(declared).union(*map(_names_in_module, modules))


def _names_in_module(module: str) -> frozenset[str]:
    try:
        return _names_in_source(inspect.getsource(sys.modules[module]))
    except (KeyError, OSError, TypeError, SyntaxError, ValueError):
        return frozenset()  # the module has no source, so its names are unknown


@functools.lru_cache(maxsize=256)
def _names_in_source(source: str) -> frozenset[str]:
    return frozenset(_names_in_tree(ast.parse(source)))


def _names_in_tree(tree: ast.Module) -> Iterator[str]:
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute):
            continue
        if node.func.attr in _READERS or node.func.attr.startswith("get_"):
            for value in (*node.args[:1], *(k.value for k in node.keywords if k.arg in ("name", "element"))):
                if isinstance(value, ast.Constant) and isinstance(value.value, str):
                    yield value.value


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
        else:
            hint = did_you_mean(element.name, _known_names(reader)) or suggestion
        params.diagnostics.warning("SK-PARAM-003", text, element.where, hint)
    for element, attribute in params.unread_attributes():
        text = f"{owner}: attribute {attribute!r} of <{element.name}> is not used"
        attributes_read = element.attributes_asked
        hint = did_you_mean(attribute, (*attributes_read, *_known_names(reader))) if attributes_read else ""
        params.diagnostics.warning("SK-PARAM-007", text, element.where, hint)


def _known_names(reader: object) -> frozenset[str]:
    return _names_in_module(reader.__name__) if isinstance(reader, ModuleType) else names_read(type(reader))
