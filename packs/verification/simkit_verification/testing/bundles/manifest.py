"""Manifest of a bundle (`bundle.json`): the run, its end and the files; every value is validated when it is read."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any, Final, TypeVar

from simkit import RunSpec
from simkit.errors import InputError, SimkitError
from simkit.json_reader import parse_json
from simkit.loaders.spawned_models import SpawnedModel
from simkit.run_fields import RunField
from simkit.run_spec import EMPTY_SPACE, JsonMapping, JsonObject, run_fields

if TYPE_CHECKING:
    from simkit.testing.conditions import CheckResult

_Value = TypeVar("_Value")
FORMAT: Final = 1
PAGE: Final = "bundle.json"
COMMANDS: Final = "commands.jsonl"
BAG: Final = "last_seconds.mcap"
CHECK: Final = "check"
"""Kind of failure of a run in which a check did not pass."""
_FOLDERS: Final = re.compile(r"(?<![\w:/.])(?:[A-Za-z]:)?(?:[/\\][^\s/\\:'\"()]+)*[/\\](?=[^\s/\\:'\"()]+\.\w)")
BROKEN, NEWER = "SK-BUNDLE-001", "SK-BUNDLE-002"


@dataclass(frozen=True)
class Failure:
    """Failure of a run.

    Attributes:
        kind: Class name of the exception; CHECK if a check did not pass.
        code: Diagnostic code of the error; empty if it has none.
        text: Message without folder names.
    """

    kind: str
    code: str
    text: str


def failure_from_error(error: BaseException) -> Failure:
    """Convert an exception to the failure that a bundle stores."""
    code = str(getattr(error, "code", "") or "") if isinstance(error, SimkitError) else ""
    return Failure(type(error).__name__, code, strip_folders(str(error))[:20_000])


def failure_from_checks(results: Iterable[CheckResult], *, was_given_up: bool = False) -> Failure | None:
    """Convert check results to the failure that a bundle stores.

    Args:
        results: Results of all checks.
        was_given_up: True if the run was stopped at its wall-clock limit.

    Returns:
        None if all checks passed and the run was not stopped early.
    """
    lines = [f"{result.check.title}: {result.message}" for result in results if not result.passed]
    if was_given_up and not lines:
        lines = ["the run was stopped because its wall-clock limit was reached"]
    return Failure(CHECK, "", strip_folders("\n".join(lines))[:20_000]) if lines else None


def strip_folders(text: str) -> str:
    """Remove the folders from all file names in a text, because they differ between machines."""
    return _FOLDERS.sub("", text)


@dataclass(frozen=True)
class RunEnd:
    """State of a run when its bundle was written.

    Attributes:
        steps: Steps made since loading.
        tick: Tick of the simulation clock.
        time_ns: Simulated time [ns].
        state: Hash of the physics state, as `simkit run` prints it.
        failure: Failure of the run; None if nothing failed.
    """

    steps: int
    tick: int
    time_ns: int
    state: str
    failure: Failure | None = None


@dataclass(frozen=True)
class Manifest:
    """Contents of `bundle.json`.

    Attributes:
        name: Name of the run.
        run: Specification with the seed, overrides and options of the run; its files are in the bundle.
        models: Models that were spawned during the run: requested source -> file in the bundle.
        code: Files of the user's plugins.
        missing: One sentence for everything that could not be packed.
        fingerprint: Properties of the machine that made the bundle.
        seconds: Length of the message window [s].
        topics: Patterns of image topics whose messages were recorded.
        first: Number of steps after which messages are included.
        end: State at the end of the run.
        streams: Topics of the last seconds: topic -> type, count, sha256.
        marks: Number of steps and state hash, once per simulated second.
        commands: Number of journal entries.
        files: File name -> size and sha256.
    """

    name: str
    run: RunSpec
    models: Mapping[str, str]
    code: tuple[str, ...]
    missing: tuple[str, ...]
    fingerprint: Mapping[str, str]
    end: RunEnd
    seconds: float = 0.0
    topics: tuple[str, ...] = ()
    first: int = 0
    streams: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    marks: tuple[tuple[int, str], ...] = ()
    commands: int = 0
    files: Mapping[str, JsonMapping] = field(default_factory=dict)

    @property
    def run_spec(self) -> RunSpec:
        """Specification of the run, with the name of the bundle."""
        return replace(self.run, name=self.name)

    def text(self) -> str:
        """Return the manifest as JSON; equal manifests give equal texts."""
        values = {
            attribute.name: getattr(self, attribute.name) for attribute in fields(self) if attribute.name != "run"
        }
        values |= {"end": asdict(self.end), "seconds": self.seconds if math.isfinite(self.seconds) else None}
        return json.dumps({"format": FORMAT, **values, **_run_keys(self.run)}, sort_keys=True, indent=1) + "\n"


def packed_fields() -> dict[str, RunField]:
    """Return the fields of a run that a bundle contains, by name."""
    return {name: described for name, described in run_fields().items() if described.packed != "never"}


def packed_folder(name: str) -> str:
    """Return the folder of a bundle that has the files of a field."""
    return "params" if name == "params_files" else name


def _run_keys(run: RunSpec) -> JsonObject:
    """Return the keys of a run: those of the first format, and under "run" those of later fields that are given."""
    keys: JsonObject = {"world": run.world}
    later: JsonObject = {}
    for name, described in packed_fields().items():
        value = run.value_of(described)
        if name == "spawn":
            keys[name] = [_spawned_keys(model) for model in value]
        elif described.packed == "first":
            keys[packed_folder(name)] = value
        elif value != described.default:
            later[name] = described.kind.plain(value)
    return {**keys, "run": later} if later else keys


def _spawned_keys(model: SpawnedModel) -> JsonObject:
    keys: JsonObject = {"file": model.source, "place": model.place, "name": model.name}
    return keys | ({"namespace": model.namespace} if model.namespace else {})


def read_manifest(data: bytes, path: str) -> Manifest:
    """Parse the content of `bundle.json`.

    Args:
        data: Content of the file.
        path: Path of the bundle, for messages.

    Raises:
        InputError: SK-BUNDLE-001 the content is not a manifest; SK-BUNDLE-002 a newer simkit wrote the bundle.
    """
    try:
        content = parse_json(data)
    except ValueError as error:
        raise InputError(BROKEN, f"{path}: {PAGE} is not JSON: {error!s:.80}") from None
    if not isinstance(content, dict) or not isinstance(content.get("format"), int):
        raise InputError(BROKEN, f"{path} is not a simkit bundle: {PAGE} has no 'format'")
    if content["format"] > FORMAT:
        problem = f"{path} has format {content['format']}; this version of simkit reads formats up to {FORMAT}"
        raise InputError(NEWER, problem, help="open the bundle with a newer version of simkit")
    try:
        return _parse_manifest(_ManifestReader(content))
    except (_InvalidValue, OverflowError) as error:
        raise InputError(BROKEN, f"{path}: {PAGE}: {error}") from None


class _InvalidValue(Exception):
    """Value of a wrong type or outside its range; the message names the value."""


class _ManifestReader:
    """Reader of typed values from a mapping."""

    def __init__(self, fields: Mapping[str, object], prefix: str = "") -> None:
        self._fields, self._prefix = fields, prefix

    def _value(self, name: str, kind: type[_Value], allowed: str) -> _Value:
        value = self._fields.get(name)
        if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
            raise _InvalidValue(f"{self._prefix}{name}: found {value!r:.60}, expected {allowed}")
        return value

    def has(self, name: str) -> bool:
        return self._fields.get(name) is not None

    def text(self, name: str, default: str = "") -> str:
        return self._value(name, str, "a string")

    def flag(self, name: str, default: bool = False) -> bool:
        return self._value(name, bool, "true or false")

    def whole(self, name: str, default: int, least: int) -> int:
        return self.count(name)

    def number(self, name: str, default: float | None, *, least: float, above: float) -> float | None:
        return (
            None
            if self._fields.get(name) is None
            else float(self._value(name, int if isinstance(self._fields[name], int) else float, "a number"))
        )

    def word(self, name: str, default: str, allowed: Sequence[str]) -> str:
        text = self.text(name)
        if text not in allowed:
            raise _InvalidValue(f"{self._prefix}{name}: found {text!r:.60}, expected one of {', '.join(allowed)}")
        return text

    def named(self, name: str) -> dict[str, str]:
        return self.text_mapping(name)

    def entries(self, name: str) -> tuple[str, ...]:
        raise _InvalidValue(f"{self._prefix}{name}: a bundle names no programs")

    def count(self, name: str) -> int:
        count = self._value(name, int, "an integer >= 0")
        if not 0 <= count < 1 << 62:
            raise _InvalidValue(f"{self._prefix}{name}: found {count!r:.60}, expected an integer >= 0")
        return count

    def time(self, name: str) -> float:
        if self._fields.get(name) is None:
            return math.inf
        kind = int if isinstance(self._fields[name], int) else float
        seconds = float(self._value(name, kind, "a number of seconds >= 0"))
        if not seconds >= 0:
            raise _InvalidValue(f"{self._prefix}{name}: found {seconds}, expected a number of seconds >= 0")
        return seconds

    def optional(self, name: str, take: Callable[[str], _Value]) -> _Value | None:
        return None if self._fields.get(name) is None else take(name)

    def items(self, name: str) -> list[Any]:
        return self._value(name, list, "a list")

    def mapping(self, name: str) -> JsonObject:
        return self._value(name, dict, "a mapping")

    def _require_all(self, name: str, values: Iterable[object], kind: type, allowed: str) -> None:
        if not all(isinstance(value, kind) for value in values):
            raise _InvalidValue(f"{self._prefix}{name}: expected {allowed}")

    def texts(self, name: str) -> tuple[str, ...]:
        items = self.items(name)
        self._require_all(name, items, str, "a list of strings")
        return tuple(items)

    def text_mapping(self, name: str) -> dict[str, str]:
        mapping = self.mapping(name)
        self._require_all(name, mapping.values(), str, "a mapping of strings")
        return mapping

    def reader(self, name: str) -> _ManifestReader:
        return _ManifestReader(self.mapping(name), f"{self._prefix}{name}.")

    def readers(self, name: str) -> list[_ManifestReader]:
        items = self.items(name)
        self._require_all(name, items, dict, "a list of mappings")
        return [_ManifestReader(item, f"{self._prefix}{name}[{number}].") for number, item in enumerate(items)]

    def each(self, name: str) -> dict[str, _ManifestReader]:
        mapping = self.mapping(name)
        self._require_all(name, mapping.values(), dict, "a mapping of mappings")
        return {key: _ManifestReader(item, f"{self._prefix}{name}.{key:.60}.") for key, item in mapping.items()}


def _parse_manifest(reader: _ManifestReader) -> Manifest:
    return Manifest(
        name=reader.text("name"),
        run=_parse_run(reader),
        models=reader.text_mapping("models"),
        code=reader.texts("code"),
        missing=reader.texts("missing"),
        fingerprint=reader.text_mapping("fingerprint"),
        seconds=reader.time("seconds"),
        topics=reader.texts("topics"),
        first=reader.count("first"),
        end=_parse_end(reader.reader("end")),
        streams={
            topic: {"type": stream.text("type"), "count": stream.count("count"), "sha256": stream.text("sha256")}
            for topic, stream in reader.each("streams").items()
        },
        marks=tuple(_parse_state_mark(mark) for mark in reader.items("marks")),
        commands=reader.count("commands"),
        files={
            name: {"size": file.count("size"), "sha256": file.text("sha256")}
            for name, file in reader.each("files").items()
        },
    )


def _parse_run(reader: _ManifestReader) -> RunSpec:
    later = reader.reader("run") if reader.has("run") else _ManifestReader({})
    values: JsonObject = {"model_world": EMPTY_SPACE}  # a bundle of an older version has no such key
    for name, described in packed_fields().items():
        key = packed_folder(name)
        if name == "spawn":
            values[name] = tuple(_parse_spawned(model) for model in reader.readers(key))
        elif name == "params_files":
            values |= {name: pairs} if (pairs := tuple(_parse_pair(pair) for pair in reader.items(key))) else {}
        elif described.packed == "changed":
            values |= {name: described.kind.read(later, name, described.default)} if later.has(name) else {}
        elif reader.has(key) or not (described.default is None or name in values):
            values[name] = described.kind.read(reader, key, described.default)
    return RunSpec(reader.text("world")).with_values(values)


def _parse_end(reader: _ManifestReader) -> RunEnd:
    fields = reader.optional("failure", reader.reader)
    failure = None if fields is None else Failure(fields.text("kind"), fields.text("code"), fields.text("text"))
    return RunEnd(reader.count("steps"), reader.count("tick"), reader.count("time_ns"), reader.text("state"), failure)


def _parse_spawned(reader: _ManifestReader) -> SpawnedModel:
    place = reader.optional("place", reader.items)
    if place is not None:
        numbers = all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in place)
        if not numbers or len(place) not in (3, 4, 6):
            raise _InvalidValue(f"place: found {place!r:.60}, expected 3, 4 or 6 numbers")
    numbers_of_place = None if place is None else tuple(map(float, place))
    name, namespace = (reader.optional(key, reader.text) for key in ("name", "namespace"))
    return SpawnedModel(reader.text("file"), numbers_of_place, name, namespace)


def _parse_pair(pair: object) -> tuple[str, str]:
    if not isinstance(pair, list) or len(pair) != 2 or not all(isinstance(part, str) for part in pair):
        raise _InvalidValue(f"params: found {pair!r:.60}, expected a model name and a file")
    return pair[0], pair[1]


def _parse_state_mark(mark: object) -> tuple[int, str]:
    if not isinstance(mark, list) or len(mark) != 2 or type(mark[0]) is not int or not isinstance(mark[1], str):
        raise _InvalidValue(f"marks: found {mark!r:.60}, expected a number of steps and a hash")
    return mark[0], mark[1]
