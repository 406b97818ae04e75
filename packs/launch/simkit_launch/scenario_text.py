"""Text of a run as a scenario file, which can be saved and run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import yaml

from simkit.run_spec import RunSpec, run_fields


class _Dumper(yaml.SafeDumper):
    """Writer that keeps long texts, such as robot descriptions, in blocks."""


def _write_text(dumper: yaml.SafeDumper, text: str) -> yaml.ScalarNode:
    return dumper.represent_scalar("tag:yaml.org,2002:str", text, style="|" if "\n" in text else None)


_Dumper.add_representer(str, _write_text)


def scenario_text(spec: RunSpec) -> str:
    """Return the YAML text of a scenario file with the world, the nodes and all other values of a run.

    Args:
        spec: run, without plugins made in Python.
    """
    values: dict[str, Any] = {"world": spec.world}
    for described in run_fields().values():
        value = spec.value_of(described)
        is_default = value == described.default or (isinstance(value, float) and math.isinf(value))
        if described.key is not None and not is_default:
            values[described.key] = _plain(described.kind.plain(value))
    return yaml.dump(values, Dumper=_Dumper, sort_keys=False, allow_unicode=True, width=110)


def _plain(value: Any) -> Any:
    """Return a value of lists, mappings, texts and numbers."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value if isinstance(value, (bool, int, float)) or value is None else str(value)
