"""The first page of a bundle: what was run, how it ended, what is in it. Read as what a stranger wrote."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any, Final, TypeVar, cast

from simkit.errors import InputError, SimkitError
from simkit.run_spec import JsonMapping, JsonObject, LoadOptions, PluginErrorPolicy, RunSpec

if TYPE_CHECKING:
    from simkit.testing.conditions import CheckResult

_Value = TypeVar("_Value")
FORMAT: Final = 1
PAGE: Final = "bundle.json"
COMMANDS: Final = "commands.jsonl"
BAG: Final = "last_seconds.mcap"
CHECK: Final = "check"
"""Kind of the failure of a run in which something did not hold."""
_FOLDERS: Final = re.compile(r"(?<![\w:/.])(?:[A-Za-z]:)?(?:[/\\][^\s/\\:'\"()]+)*[/\\](?=[^\s/\\:'\"()]+\.\w)")
BROKEN, NEWER = "SK-BUNDLE-001", "SK-BUNDLE-002"


@dataclass(frozen=True)
class Failure:
    """What a run failed with.

    Attributes:
        kind: name of the exception's class; CHECK where a check did not hold.
        code: of the error.
        text: what was said, without folders.
    """

    kind: str
    code: str
    text: str


def failure_from_error(error: BaseException) -> Failure:
    """An error as a bundle has it."""
    code = str(getattr(error, "code", "") or "") if isinstance(error, SimkitError) else ""
    return Failure(type(error).__name__, code, strip_folders(str(error))[:20_000])


def failure_from_checks(results: Iterable[CheckResult], *, was_given_up: bool = False) -> Failure | None:
    """What did not hold as a bundle has it; None where all did, and the run was not given up for its wall time."""
    lines = [f"{result.check.title}: {result.message}" for result in results if not result.passed]
    if was_given_up and not lines:
        lines = ["the run was given up for its wall time"]
    return Failure(CHECK, "", strip_folders("\n".join(lines))[:20_000]) if lines else None


def strip_folders(text: str) -> str:
    """A text in which files stand without the folders that they are in, which are elsewhere on another machine."""
    return _FOLDERS.sub("", text)


@dataclass(frozen=True)
class RunEnd:
    """How a run stood when it was packed.

    Attributes:
        steps: made since it was loaded.
        tick: at which it stood.
        time_ns: simulated [ns].
        state: hash of the physics, as `simkit run` prints it.
        failure: None where nothing failed.
    """

    steps: int
    tick: int
    time_ns: int
    state: str
    failure: Failure | None = None


@dataclass(frozen=True)
class PackedModel:
    """A model that comes into the world as it is loaded."""

    file: str
    place: tuple[float, ...] | None = None
    name: str | None = None


@dataclass(frozen=True)
class Manifest:
    """What a bundle says of itself.

    Attributes:
        name: of the run.
        world: the file to open.
        base: of a bare model.
        seed, overrides, sleep, on_error: as of `simkit.load`.
        spawn: models put into the world.
        params: parameter files: model (empty for all) and file.
        models: what was spawned while it ran: as it was said -> file.
        code: files of the user's plugins.
        missing: what could not be packed, in words.
        fingerprint: of the machine that made it.
        seconds: how long messages were kept [s].
        topics: patterns of topics that were kept although they are pictures.
        first: steps since which messages are in it.
        end: how the run stood.
        streams: of the last seconds: topic -> type, count, sha256.
        marks: steps and hash of the state, once a simulated second.
        commands: how many entries the journal has.
        files: name -> size and sha256.
    """

    name: str
    world: str
    base: str
    seed: int
    overrides: tuple[str, ...]
    sleep: bool
    on_error: str | None
    spawn: tuple[PackedModel, ...]
    params: tuple[tuple[str, str], ...]
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
        """Seed, overrides and options of the run; its files are where the bundle is extracted."""
        options: LoadOptions = {"base": self.base, "sleep": self.sleep}
        if self.on_error in ("stop", "disable"):
            options["on_error"] = cast(PluginErrorPolicy, self.on_error)
        return RunSpec(self.world, seed=self.seed, name=self.name, overrides=self.overrides, options=options)

    def text(self) -> str:
        """As JSON; equal for equal ones."""
        words = {"format": FORMAT, **asdict(self)}
        words["seconds"] = self.seconds if math.isfinite(self.seconds) else None
        return json.dumps(words, sort_keys=True, indent=1) + "\n"


def read_manifest(data: bytes, path: str) -> Manifest:
    """The manifest in a bundle's first page.

    Raises:
        InputError: SK-BUNDLE-001 it is none, SK-BUNDLE-002 a later simkit wrote it.
    """
    try:
        words = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{BROKEN} {path}: {PAGE} is no JSON: {error!s:.80}", BROKEN) from None
    if not isinstance(words, dict) or not isinstance(words.get("format"), int):
        raise InputError(f"{BROKEN} {path} is no bundle of simkit: {PAGE} says no format", BROKEN)
    if words["format"] > FORMAT:
        said = f"{NEWER} {path} is of format {words['format']}, this simkit reads up to {FORMAT}"
        raise InputError(f"{said}\n    help: a newer simkit opens it", NEWER)
    try:
        return _parse_manifest(_ManifestReader(words))
    except (_InvalidValue, OverflowError) as error:
        raise InputError(f"{BROKEN} {path}: {PAGE}: {error}", BROKEN) from None


class _InvalidValue(Exception):
    """Something is of another kind than it has to be; says what."""


class _ManifestReader:
    """Takes values out of a mapping, each of the kind that it has to be."""

    def __init__(self, words: Mapping[str, object], at: str = "") -> None:
        self._words, self._at = words, at

    def _value(self, name: str, kind: type[_Value], allowed: str) -> _Value:
        value = self._words.get(name)
        if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
            raise _InvalidValue(f"{self._at}{name}: found {value!r:.60}, allowed is {allowed}")
        return value

    def text(self, name: str) -> str:
        return self._value(name, str, "a text")

    def flag(self, name: str) -> bool:
        return self._value(name, bool, "true or false")

    def count(self, name: str) -> int:
        found = self._value(name, int, "a whole number from 0 on")
        if not 0 <= found < 1 << 62:
            raise _InvalidValue(f"{self._at}{name}: found {found!r:.60}, allowed is a whole number from 0 on")
        return found

    def time(self, name: str) -> float:
        if self._words.get(name) is None:
            return math.inf
        kind = int if isinstance(self._words[name], int) else float
        found = float(self._value(name, kind, "a number of seconds"))
        if not found >= 0:
            raise _InvalidValue(f"{self._at}{name}: found {found}, allowed is a number of seconds")
        return found

    def either(self, name: str, take: Callable[[str], _Value]) -> _Value | None:
        return None if self._words.get(name) is None else take(name)

    def listed(self, name: str) -> list[Any]:
        return self._value(name, list, "a list")

    def mapping(self, name: str) -> JsonObject:
        return self._value(name, dict, "a mapping")

    def _require_all(self, name: str, values: Iterable[object], kind: type, allowed: str) -> None:
        if not all(isinstance(one, kind) for one in values):
            raise _InvalidValue(f"{self._at}{name}: allowed is {allowed}")

    def texts(self, name: str) -> tuple[str, ...]:
        found = self.listed(name)
        self._require_all(name, found, str, "a list of texts")
        return tuple(found)

    def of_texts(self, name: str) -> dict[str, str]:
        found = self.mapping(name)
        self._require_all(name, found.values(), str, "a mapping of texts")
        return found

    def reader(self, name: str) -> _ManifestReader:
        return _ManifestReader(self.mapping(name), f"{self._at}{name}.")

    def readers(self, name: str) -> list[_ManifestReader]:
        found = self.listed(name)
        self._require_all(name, found, dict, "a list of mappings")
        return [_ManifestReader(one, f"{self._at}{name}[{number}].") for number, one in enumerate(found)]

    def each(self, name: str) -> dict[str, _ManifestReader]:
        found = self.mapping(name)
        self._require_all(name, found.values(), dict, "a mapping of mappings")
        return {key: _ManifestReader(one, f"{self._at}{name}.{key:.60}.") for key, one in found.items()}


def _parse_manifest(said: _ManifestReader) -> Manifest:
    return Manifest(
        name=said.text("name"),
        world=said.text("world"),
        base=said.text("base"),
        seed=said.count("seed"),
        overrides=said.texts("overrides"),
        sleep=said.flag("sleep"),
        on_error=said.either("on_error", said.text),
        spawn=tuple(_parse_spawned(one) for one in said.readers("spawn")),
        params=tuple(_parse_pair(one) for one in said.listed("params")),
        models=said.of_texts("models"),
        code=said.texts("code"),
        missing=said.texts("missing"),
        fingerprint=said.of_texts("fingerprint"),
        seconds=said.time("seconds"),
        topics=said.texts("topics"),
        first=said.count("first"),
        end=_parse_end(said.reader("end")),
        streams={
            topic: {"type": one.text("type"), "count": one.count("count"), "sha256": one.text("sha256")}
            for topic, one in said.each("streams").items()
        },
        marks=tuple(_parse_state_mark(one) for one in said.listed("marks")),
        commands=said.count("commands"),
        files={
            name: {"size": one.count("size"), "sha256": one.text("sha256")} for name, one in said.each("files").items()
        },
    )


def _parse_end(said: _ManifestReader) -> RunEnd:
    one = said.either("failure", said.reader)
    failure = None if one is None else Failure(one.text("kind"), one.text("code"), one.text("text"))
    return RunEnd(said.count("steps"), said.count("tick"), said.count("time_ns"), said.text("state"), failure)


def _parse_spawned(said: _ManifestReader) -> PackedModel:
    place = said.either("place", said.listed)
    if place is not None:
        numbers = all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in place)
        if not numbers or len(place) not in (3, 4, 6):
            raise _InvalidValue(f"place: found {place!r:.60}, allowed are 3, 4 or 6 numbers")
    numbers_of_place = None if place is None else tuple(map(float, place))
    return PackedModel(said.text("file"), numbers_of_place, said.either("name", said.text))


def _parse_pair(one: object) -> tuple[str, str]:
    if not isinstance(one, list) or len(one) != 2 or not all(isinstance(part, str) for part in one):
        raise _InvalidValue(f"params: found {one!r:.60}, allowed is a model's name and a file")
    return one[0], one[1]


def _parse_state_mark(one: object) -> tuple[int, str]:
    if not isinstance(one, list) or len(one) != 2 or type(one[0]) is not int or not isinstance(one[1], str):
        raise _InvalidValue(f"marks: found {one!r:.60}, allowed are steps and a hash")
    return one[0], one[1]
