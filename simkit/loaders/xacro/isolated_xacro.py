"""Private copies of the `xacro` package, one per expansion, because xacro keeps its state in module variables.

The copy expands macros, conditions and properties. Its functions that read files, evaluate expressions or print are
replaced.
"""

from __future__ import annotations

import importlib.util
import itertools
import re
import sys
import threading
from importlib.machinery import PathFinder
from typing import Any
from xml.dom import minidom

XacroModule = Any
"""The module `xacro`, in which this package replaces functions."""

_LOCK = threading.Lock()
_COUNT = itertools.count()
# a quote between quotes, as in ''', which the original pattern finds by trying all endings
_QUOTED_QUOTE = r"[^\s'\"]*'.*?'(?=\s|$)|[^\s'\"]*\".*?\"(?=\s|$)"
_DEFAULT = r"\$\{.*?\}|\$\(.*?\)|(?:'[^']*'|\"[^\"]*\"|[^\s'\"])+|" + _QUOTED_QUOTE + "|"
MACRO_ARGUMENT = re.compile(r"^\s*([^\s:=]+?)\s*:?=\s*(\^\|?)?(" + _DEFAULT + r")(?:\s+|$)(.*)", re.DOTALL)
"""Pattern of a macro's parameter with its default. The original pattern in xacro can take exponential time."""


def import_private_xacro() -> XacroModule:
    """Import a new copy of xacro that no other code uses.

    Raises:
        ImportError: xacro (or PyYAML, which xacro needs) is not installed.
    """
    module_spec = PathFinder.find_spec("xacro")  # a program that runs now may have another module of that name
    if module_spec is None or module_spec.origin is None:
        raise ImportError("xacro")
    name = f"_simkit_xacro_{next(_COUNT)}"
    spec = importlib.util.spec_from_file_location(
        name, module_spec.origin, submodule_search_locations=list(module_spec.submodule_search_locations or ())
    )
    if spec is None or spec.loader is None:
        raise ImportError("xacro")
    module = importlib.util.module_from_spec(spec)
    with _LOCK:
        write = minidom.Element.writexml  # xacro replaces this method when it is imported
        sys.modules[name] = module
        try:
            spec.loader.exec_module(module)
        finally:
            minidom.Element.writexml = write  # type: ignore[method-assign]
            for loaded in [m for m in sys.modules if m == name or m.startswith(name + ".")]:
                del sys.modules[loaded]
    return module
