"""What is other in what a run was made from, leaf by leaf."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from simkit.golden.cause.paths import parted, scoped
from simkit.golden.cause.putback import ABSENT
from simkit.golden.difference import CauseKind
from simkit.golden.record import Record
from simkit.scenario import Scenario

_OF_THE_REPORT = frozenset(
    ("folder", "file", "name", "test", "topics", "skip", "tolerances", "state", "model", "picture", "bits")
)
"""What a scenario says of what is looked at, which changes no run; and where it stands."""


@dataclass(frozen=True)
class Edit:
    """One leaf that is other.

    Attributes:
        kind: of what.
        path: of the leaf; of a file or a version its name.
        golden, run: its values; ABSENT where it is not there.
        where: `file:line` in the run's files; empty where there is none.
    """

    kind: CauseKind
    path: str
    golden: Any
    run: Any
    where: str = ""

    @property
    def entity(self) -> str:
        """Scoped name of the part of the world."""
        return scoped(self.owner)

    @property
    def owner(self) -> str:
        """Path of that part."""
        return parted(self.path)[0]

    @property
    def attribute(self) -> str:
        """What of that part."""
        return parted(self.path)[1]


def model_edits(golden: Mapping[str, Any], run: Mapping[str, Any], places: Mapping[str, str]) -> list[Edit]:
    """The leaves of the world that are other, in the run's order."""
    order = {path: n for n, path in enumerate([*run, *(p for p in golden if p not in run)])}
    found = []
    for path in order:
        old, new = golden.get(path, ABSENT), run.get(path, ABSENT)
        if not same(old, new):
            found.append(Edit("model", path, old, new, places.get(path, "")))
    return found


def other_edits(golden: Record, run: Record) -> list[Edit]:
    """What is other beside the world: the scenario, files, code and versions."""
    found = [Edit("scenario", name, a, b) for name, (a, b) in _scenario(golden.scenario, run.scenario).items()]
    code = (".py", ".so", ".pyc")
    for name, (a, b) in _mapping(golden.sources, run.sources).items():
        found.append(Edit("code" if name.split(" ")[0].endswith(code) else "file", name, a, b))
    found += [Edit("version", name, a, b) for name, (a, b) in _mapping(golden.fingerprint, run.fingerprint).items()]
    return found


def field_edits(golden: Record, run: Record) -> list[Edit]:
    """The compiled model's fields that are other."""
    found = []
    for name in [*run.fields, *(n for n in golden.fields if n not in run.fields)]:
        a, b = golden.fields.get(name), run.fields.get(name)
        if a is None or b is None:
            found.append(Edit("model", name, ABSENT if a is None else a, ABSENT if b is None else b))
        elif np.shape(a) != np.shape(b) or not _equal(a, b):
            found.append(Edit("model", name, np.asarray(a).tolist(), np.asarray(b).tolist()))
    return found


def same(a: Any, b: Any) -> bool:
    """Whether two leaves are equal; not a number is equal to itself."""
    if a is b:
        return True
    if a is ABSENT or b is ABSENT:
        return False
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b, strict=True))
    if isinstance(a, bool) != isinstance(b, bool):
        return False
    return bool(a == b) or (a != a and b != b)


def _equal(a: Any, b: Any) -> bool:
    x, y = np.asarray(a), np.asarray(b)
    if x.dtype.kind in "fc" and y.dtype.kind in "fc":
        return bool(np.array_equal(x, y, equal_nan=True))
    return bool(np.array_equal(x, y))


def _scenario(golden: Scenario, run: Scenario) -> dict[str, tuple[Any, Any]]:
    found: dict[str, tuple[Any, Any]] = {}
    for one in fields(Scenario):
        if one.name in _OF_THE_REPORT:
            continue
        a, b = getattr(golden, one.name), getattr(run, one.name)
        if one.name == "plugins":
            a, b = tuple(_class_of(p) for p in a), tuple(_class_of(p) for p in b)
        if one.name == "world":
            a, b = _last(a), _last(b)
        if _plain(a) != _plain(b):
            found[one.name] = (a, b)
    return found


def _class_of(plugin: Any) -> str:
    one = plugin[-1] if isinstance(plugin, tuple) else plugin
    return one if isinstance(one, str) else getattr(one, "__name__", type(one).__name__)


def _last(world: str) -> str:
    """What a world is called, wherever it lies; text in full."""
    return world if "<" in world else world.replace("\\", "/").rstrip("/").rpartition("/")[2]


def _plain(value: Any) -> Any:
    """Of the same form, whether it came from a file or not."""
    if isinstance(value, Mapping):
        return {str(k): _plain(v) for k, v in value.items() if k != "where"}
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    if hasattr(value, "__dataclass_fields__"):
        return {f.name: _plain(getattr(value, f.name)) for f in fields(value) if f.name != "where"}
    return value if isinstance(value, (int, float, str, bool, type(None))) else str(value)


def _mapping(a: Mapping[str, Any], b: Mapping[str, Any]) -> dict[str, tuple[Any, Any]]:
    return {
        name: (a.get(name, ABSENT), b.get(name, ABSENT))
        for name in [*b, *(n for n in a if n not in b)]
        if not same(a.get(name, ABSENT), b.get(name, ABSENT))
    }
