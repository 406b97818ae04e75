"""Start of the bridge process: `python -P bridge_main.py PROGRAM FOLDER`, with a module and the folder of its package.

The settings are a line of JSON on standard input, because other users can read the command line of a process.

The Python of ROS need not have simkit installed; simkit is imported from the folder of this file, and the pack of the
program from its own folder.
"""

from __future__ import annotations

import importlib.util
import json
import sys
from pathlib import Path

_OLDEST = (3, 11)


def _import_package(name: str, folder: Path) -> None:
    """Import a package from a folder, whichever package of this name this Python has."""
    spec = importlib.util.spec_from_file_location(
        name, folder / "__init__.py", submodule_search_locations=[str(folder)]
    )
    assert spec is not None and spec.loader is not None
    sys.modules[name] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)


if __name__ == "__main__":
    if sys.version_info < _OLDEST:
        sys.exit(f"Python {sys.version.split()[0]} is too old for the bridge, which needs 3.11 or newer")
    program, package_folder = sys.argv[1:]
    _import_package("simkit", Path(__file__).resolve().parents[1])
    package = program.partition(".")[0]
    if package != "simkit":
        _import_package(package, Path(package_folder))
    sys.exit(importlib.import_module(program).main(json.loads(sys.stdin.readline())))
