"""`simkit check`: every problem of a file."""

from __future__ import annotations

import json
from collections import Counter

from simkit.cli.console import guarded, out, print_diagnostics
from simkit.cli.options import File, Json, PluginPaths, ResourcePaths, Strict


@guarded
def check(
    file: File,
    json_: Json = False,
    strict: Strict = False,
    resource_path: ResourcePaths = [],
    plugin_path: PluginPaths = [],
) -> int:
    """Prints every problem of a file, not only the first; runs nothing."""
    from simkit.build import check as check_file

    found = list(check_file(file, resource_paths=resource_path, plugin_paths=plugin_path))
    if json_:
        out().file.write(json.dumps([d.as_dict() for d in found], indent=2) + "\n")
    else:
        print_diagnostics(found, verbose=True, console=out())
        counts = Counter(d.severity for d in found)
        out().print(", ".join(f"{counts[s]} {s}{'' if counts[s] == 1 else 's'}" for s in ("error", "warning", "note")))
    bad = {"error", "warning"} if strict else {"error"}
    return 2 if any(d.severity in bad for d in found) else 0
