"""Differences between the inputs of two runs, value by value, with the entity that each value belongs to."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass
from functools import lru_cache

import numpy as np

from simkit.run_spec import RunSpec
from simkit.testing.golden.compare.difference import CauseKind
from simkit.testing.run_record.record import RunRecord
from simkit.testing.run_record.world_values import split_path
from simkit.testing.scenarios.code_permission import permit_code

_ENTITY_FIELDS = frozenset(
    ("models", "links", "joints", "collisions", "visuals", "sensors", "lights", "frames", "plugins", "actors", "files")
)


class _Absent:
    """Type of ABSENT, which replaces the value of a path that one of two worlds does not have."""

    def __repr__(self) -> str:
        return "nothing"

    def __reduce__(self) -> str:
        return "ABSENT"


ABSENT = _Absent()


@lru_cache(maxsize=65536)
def split_entity_path(path: str) -> tuple[str, str]:
    """Split a path into the path of an entity and the attribute of that entity."""
    at = 0
    while True:
        end = _entity_step_end(path, at)
        if end == at:
            break
        at = end
    return path[:at].rstrip("."), path[at:]


def _entity_step_end(path: str, at: int) -> int:
    """Return the index after a path step that names an entity; `at` if the step names no entity."""
    opened = path.find("[", at)
    if opened < 0 or path[at:opened] not in _ENTITY_FIELDS:
        return at
    closed = path.find("]", opened)
    if closed < 0:
        return at
    return closed + 2 if path[closed + 1 : closed + 2] == "." else closed + 1


@lru_cache(maxsize=65536)
def scoped_name(owner: str) -> str:
    """Return the scoped name of the entity at a path; empty for the world."""
    return "::".join(key for _, key in split_path(owner))


def entity_kind(owner: str) -> str:
    """Return the kind of an entity: model, link, …; "world" for the world."""
    steps = split_path(owner)
    return steps[-1][0].removesuffix("s") if steps else "world"


def parent_path(owner: str) -> str:
    """Return the path of the entity's parent; empty for the world."""
    closed = owner.rfind("].")
    return owner[: closed + 1] if closed >= 0 else ""


def is_within(owner: str, outer: str) -> bool:
    """Check whether an entity is `outer` or a descendant of `outer`."""
    return not outer or owner == outer or owner.startswith(outer + ".")


_REPORT_FIELDS = frozenset(
    (
        "folder",
        "file",
        "name",
        "test",
        "topics",
        "skip",
        "tolerances",
        "state",
        "model",
        "picture",
        "bits",
        "diagnostics",
    )
)
"""Fields of a scenario that select outputs or name files, and therefore do not change the run."""


@dataclass(frozen=True)
class Edit:
    """Value of the world or scenario that differs.

    Attributes:
        kind: Kind of change.
        path: Path of the value, or the name of a file or version.
        golden, run: Values in both runs; ABSENT if missing.
        where: `file:line` in the files of the new run; empty if unknown.
    """

    kind: CauseKind
    path: str
    golden: object
    run: object
    where: str = ""

    @property
    def entity(self) -> str:
        """Scoped name of the entity."""
        return scoped_name(self.owner)

    @property
    def owner(self) -> str:
        """Path of the entity."""
        return split_entity_path(self.path)[0]

    @property
    def attribute(self) -> str:
        """Attribute of the entity."""
        return split_entity_path(self.path)[1]


def model_edits(golden: Mapping[str, object], run: Mapping[str, object], places: Mapping[str, str]) -> list[Edit]:
    """Return the values of the world that differ, in the order of the new run."""
    return [Edit("model", path, old, new, places.get(path, "")) for path, old, new in _unequal(golden, run)]


def other_edits(golden: RunRecord, run: RunRecord) -> list[Edit]:
    """Return the differences outside the world: scenario, files, code and versions."""
    edits = [Edit("scenario", name, a, b) for name, (a, b) in _scenario(golden.scenario, run.scenario).items()]
    code = (".py", ".so", ".pyc")
    for name, a, b in _unequal(golden.sources, run.sources):
        edits.append(Edit("code" if name.split(" ")[0].endswith(code) else "file", name, a, b))
    return edits + [Edit("version", name, a, b) for name, a, b in _unequal(golden.fingerprint, run.fingerprint)]


def field_edits(golden: RunRecord, run: RunRecord) -> list[Edit]:
    """Return the fields of the compiled model that differ."""
    edits = []
    for name, a, b in _pairs(golden.fields, run.fields):
        if a is ABSENT or b is ABSENT:
            edits.append(Edit("model", name, a, b))
        elif np.asarray(a).shape != np.asarray(b).shape or not _is_equal(a, b):
            edits.append(Edit("model", name, np.asarray(a).tolist(), np.asarray(b).tolist()))
    return edits


def is_same_value(a: object, b: object) -> bool:
    """Check whether two values are equal; NaN equals NaN."""
    if a is b:
        return True
    if a is ABSENT or b is ABSENT:
        return False
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(is_same_value(x, y) for x, y in zip(a, b, strict=True))
    if isinstance(a, bool) != isinstance(b, bool):
        return False
    return bool(a == b) or (a != a and b != b)


def _is_equal(a: object, b: object) -> bool:
    x, y = np.asarray(a), np.asarray(b)
    if x.dtype.kind in "fc" and y.dtype.kind in "fc":
        return bool(np.array_equal(x, y, equal_nan=True))
    return bool(np.array_equal(x, y))


def _scenario(golden: RunSpec, run: RunSpec) -> dict[str, tuple[object, object]]:
    unequal: dict[str, tuple[object, object]] = {}
    golden, run = permit_code(golden, allow_code=True), permit_code(run, allow_code=True)  # only compared, not run
    for attribute in fields(RunSpec):
        if attribute.name in _REPORT_FIELDS:
            continue
        a, b = getattr(golden, attribute.name), getattr(run, attribute.name)
        if attribute.name == "plugins":
            a, b = tuple(_class_of(p) for p in a), tuple(_class_of(p) for p in b)
        if attribute.name == "world":
            a, b = _world_name(a), _world_name(b)
        if _plain(a) != _plain(b):
            unequal[attribute.name] = (a, b)
    return unequal


def _class_of(plugin: object) -> str:
    target = plugin[-1] if isinstance(plugin, tuple) else plugin
    return target if isinstance(target, str) else getattr(target, "__name__", type(target).__name__)


def _world_name(world: str) -> str:
    """Return the name of a world without its folder; XML text unchanged."""
    return world if "<" in world else world.replace("\\", "/").rstrip("/").rpartition("/")[2]


def _plain(value: object) -> object:
    """Convert a value to plain data, so that values from files and from Python compare equal."""
    if isinstance(value, Mapping):
        return {str(k): _plain(v) for k, v in value.items() if k != "where"}
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    if is_dataclass(value) and not isinstance(value, type):
        return {f.name: _plain(getattr(value, f.name)) for f in fields(value) if f.name != "where"}
    return value if isinstance(value, (int, float, str, bool, type(None))) else str(value)


def _pairs(golden: Mapping[str, object], run: Mapping[str, object]) -> Iterator[tuple[str, object, object]]:
    """Iterate over (name, golden value, run value) in the order of the run; a missing value is ABSENT."""
    for name in [*run, *(name for name in golden if name not in run)]:
        yield name, golden.get(name, ABSENT), run.get(name, ABSENT)


def _unequal(golden: Mapping[str, object], run: Mapping[str, object]) -> Iterator[tuple[str, object, object]]:
    return (pair for pair in _pairs(golden, run) if not is_same_value(pair[1], pair[2]))
