"""Start of the bridge process: `python -P bridge_main.py PROGRAM`, with a module.

The settings are a line of JSON on standard input, because other users can read the command line of a process.

The Python of ROS need not have simkit installed; the package is imported from the folder of this file.
"""

from __future__ import annotations

import importlib.util
import json
import sys
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parents[1]
_OLDEST = (3, 11)


def _import_simkit() -> None:
    """Import the package that this file belongs to, whichever simkit this Python has."""
    found = importlib.util.spec_from_file_location(
        "simkit", _PACKAGE / "__init__.py", submodule_search_locations=[str(_PACKAGE)]
    )
    assert found is not None and found.loader is not None
    sys.modules["simkit"] = module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)


if __name__ == "__main__":
    if sys.version_info < _OLDEST:
        sys.exit(f"Python {sys.version.split()[0]} is too old for the bridge, which needs 3.11 or newer")
    _import_simkit()
    sys.exit(importlib.import_module(sys.argv[1]).main(json.loads(sys.stdin.readline())))
