"""The `xacro` package, a copy for every expansion: its state is in its modules, and here it belongs to one file alone.

The copy expands macros, conditions and properties. What reads files, evaluates expressions or prints is replaced.
"""

from __future__ import annotations

import importlib.util
import itertools
import re
import sys
import threading
from typing import Any
from xml.dom import minidom

XacroModule = Any
"""The module `xacro` with what this package replaces in it."""

_LOCK = threading.Lock()
_COUNT = itertools.count()
_DEFAULT = r"\$\{.*?\}|\$\(.*?\)|(?:'[^']*'|\"[^\"]*\"|[^\s'\"])+|"
MACRO_ARGUMENT = re.compile(r"^\s*([^\s:=]+?)\s*:?=\s*(\^\|?)?(" + _DEFAULT + r")(?:\s+|$)(.*)", re.DOTALL)
"""A macro's parameter with its default: xacro's own pattern, which takes exponential time on some texts, mended."""


def import_private_xacro() -> XacroModule:
    """A fresh copy of xacro that nobody else sees.

    Raises:
        ImportError: xacro (or PyYAML, which it needs) is not installed.
    """
    found = importlib.util.find_spec("xacro")
    if found is None or found.origin is None:
        raise ImportError("xacro")
    name = f"_simkit_xacro_{next(_COUNT)}"
    spec = importlib.util.spec_from_file_location(
        name, found.origin, submodule_search_locations=list(found.submodule_search_locations or ())
    )
    if spec is None or spec.loader is None:
        raise ImportError("xacro")
    module = importlib.util.module_from_spec(spec)
    with _LOCK:
        write = minidom.Element.writexml  # xacro puts its own in its place when it is imported
        sys.modules[name] = module
        try:
            spec.loader.exec_module(module)
        finally:
            minidom.Element.writexml = write  # type: ignore[method-assign]
            for loaded in [m for m in sys.modules if m == name or m.startswith(name + ".")]:
                del sys.modules[loaded]
    return module
