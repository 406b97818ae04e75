"""Encoding of a scenario and its record as the text of `golden.json` and a block of data, and decoding."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, fields, replace
from pathlib import Path
from typing import Final, TypeVar, cast

import numpy as np

from simkit.code_requests import CodeRequest, folder_request, node_requests
from simkit.diagnostic_record import NOWHERE, Where
from simkit.run_fields import LOAD_FIELDS, RunField
from simkit.run_files import FileName, relative_path
from simkit.run_spec import (
    EMPTY_SPACE,
    Check,
    JsonMapping,
    JsonObject,
    LoadOptions,
    RunSpec,
    Tolerance,
    run_fields,
)
from simkit.testing.golden.array_packing import Packer, PackingError, Unpacker, pack_words, unpack_words
from simkit.testing.golden.compare.tolerances import storage_step
from simkit.testing.run_record.noise_statistics import NoiseStatistics
from simkit.testing.run_record.record import Array, Column, Pictures, RunRecord, States, Stream
from simkit.testing.run_record.run_recorder import ENVIRONMENT_VARIABLES
from simkit.testing.run_record.state_recorder import ModelFields

_LONG_TEXT: Final = 2000


def encode_scenario(scenario: RunSpec, folder: Path) -> dict[str, object]:
    """Encode a scenario as JSON data.

    Args:
        scenario: Scenario.
        folder: Folder to which file names are made relative, so that the result is the same in every checkout.
    """
    encoded: dict[str, object] = {"world": scenario.relative_world(folder)}
    if is_long_text(scenario.world):
        text = scenario.world.encode("utf-8", "surrogatepass")
        encoded["world"] = {"sha256": hashlib.sha256(text).hexdigest(), "bytes": len(text)}
    moved, options = scenario.with_relative_files(folder), {}
    for name, described in sorted(run_fields().items(), key=lambda named: named[1].kind.has_files):
        value = moved.value_of(described)
        if described.is_load_option and name in moved.options:
            options[name] = _plain_value(described.kind.plain(value))
        elif described.is_stored and not described.is_load_option and value != _unstored_value(described):
            encoded[name] = _plain_value(described.kind.plain(value))
    if scenario.commands:
        encoded["commands"] = [
            {k: _plain_value(v) for k, v in item.items() if k != "where"} for item in scenario.commands
        ]
    if scenario.tolerances:
        encoded["tolerances"] = [_non_default_fields(item, Tolerance("")) for item in scenario.tolerances]
    if scenario.checks:
        encoded["checks"] = [_non_default_fields(item, Check("goal")) | {"kind": item.kind} for item in scenario.checks]
    if scenario.plugins:
        encoded["plugins"] = [_class_name(item) for item in scenario.plugins]
    if options:
        encoded["options"] = dict(sorted(options.items()))
    if scenario.file is not None:
        encoded["file"] = relative_path(scenario.file, folder)
    return encoded


def _unstored_value(described: RunField) -> object:
    """Return the value of a field that a golden run does not contain: models of older versions are in empty space."""
    return EMPTY_SPACE if described.name == "model_world" else described.default


def decode_scenario(plain: JsonMapping, folder: Path, where: Callable[[str], Where] = lambda _: NOWHERE) -> RunSpec:
    """Decode a scenario; plugins created in Python are represented by the names of their classes.

    Args:
        plain: Data from `encode_scenario`. A world that is a long XML text is not included; the decoded world is then
            empty.
        folder: Folder of the golden run.
        where: Function that returns the position of a key in the file.

    Raises:
        ValueError, TypeError, KeyError: The data are not a scenario.
    """

    def place(name: FileName) -> str:
        path = name.path_in(folder)
        return name.text if path is None or name.role == "bag" else str(path)

    arguments: JsonObject = {"model_world": EMPTY_SPACE}
    reader = _StoredValues(plain)
    for name, described in run_fields().items():
        if name in plain and described.is_stored and not described.is_load_option:
            arguments[name] = described.kind.read(reader, name, described.default)
    arguments["commands"] = tuple({**item, "where": "commands"} for item in plain.get("commands", ()))
    arguments["tolerances"] = tuple(Tolerance(**_known_fields(item, Tolerance)) for item in plain.get("tolerances", ()))
    checks = (_known_fields(item, Check) for item in plain.get("checks", ()))
    arguments["checks"] = tuple(Check(**{**item, "models": tuple(item.get("models", ()))}) for item in checks)
    arguments["plugins"] = tuple(map(str, plain.get("plugins", ())))
    arguments["options"] = {str(name): item for name, item in plain.get("options", {}).items() if name in LOAD_FIELDS}
    file = folder / str(plain["file"]) if plain.get("file") else None
    world = "" if isinstance(plain["world"], Mapping) else str(plain["world"])
    spec = RunSpec(world, folder=folder, file=file, **arguments).with_files(place)
    options = dict(spec.options)
    folders = map(str, cast(Iterable[object], options.pop("plugin_paths", ())))
    requests = [folder_request(os.path.relpath(item, folder), Path(item), where("plugin_paths")) for item in folders]
    requests += node_requests(spec.nodes, folder, lambda _: where("nodes"))
    if file is not None and file.suffix.lower() == ".py":  # reading the file runs it
        requests.append(CodeRequest(f"the golden run names the scenario {file.name!r:.200}", file, where("file")))
    return replace(spec, options=cast(LoadOptions, options), code_requests=tuple(requests))


def is_long_text(world: str) -> bool:
    """Check whether a world is XML text that is too long for `golden.json`."""
    return "<" in world and len(world) > _LONG_TEXT


T = TypeVar("T")


class _StoredValues:
    """Reader of the values of `golden.json`; it raises TypeError for a value of a wrong type."""

    def __init__(self, fields: JsonMapping) -> None:
        self._fields = fields

    def _value(self, key: str, *kinds: type[T]) -> T:
        value = self._fields[key]
        if not isinstance(value, kinds):
            raise TypeError(f"{key} has a value of a wrong type")
        return value

    def text(self, key: str, default: str) -> str:
        return str(self._value(key, str))

    def flag(self, key: str, default: bool) -> bool:
        return bool(self._value(key, bool, int))

    def whole(self, key: str, default: int, least: int) -> int:
        return self._value(key, int)

    def number(self, key: str, default: float | None, *, least: float, above: float) -> float | None:
        return self._value(key, float, int, type(None))

    def texts(self, key: str) -> tuple[str, ...]:
        return tuple(map(str, self._value(key, list, tuple)))

    def word(self, key: str, default: str, allowed: Sequence[str]) -> str:
        return self.text(key, default)

    def named(self, key: str) -> dict[str, str] | tuple[str, ...]:
        value = self._value(key, dict, list)
        return value if isinstance(value, dict) else tuple(map(str, value))

    def mapping(self, key: str) -> JsonObject:
        value: JsonObject = self._value(key, dict)
        return value

    def entries(self, key: str) -> tuple[str | JsonMapping, ...]:
        return tuple(item if isinstance(item, dict) else str(item) for item in self._value(key, list))


def _plain_value(value: object) -> object:
    if isinstance(value, Mapping):
        return {str(key): _plain_value(item) for key, item in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, list | tuple):
        return [_plain_value(item) for item in value]
    return value if isinstance(value, (bool, int, float, str)) or value is None else str(value)


def _non_default_fields(value: Check | Tolerance, default: Check | Tolerance) -> dict[str, object]:
    """Return the fields that differ from the default, without source positions."""
    usual = asdict(default)
    return {name: _plain_value(item) for name, item in asdict(value).items() if name != "where" and item != usual[name]}


def _known_fields(plain: Mapping[str, object], kind: type[Check | Tolerance]) -> JsonObject:
    names = {field.name for field in fields(kind)}
    return {str(name): value for name, value in plain.items() if name in names}


def _class_name(plugin: object) -> str:
    target = plugin[1] if isinstance(plugin, tuple) and len(plugin) == 2 else plugin
    kind = target if isinstance(target, type) or hasattr(target, "__file__") else type(target)
    return str(getattr(kind, "__qualname__", getattr(kind, "__name__", kind)))


_MAX_FIELDS: Final = 400_000  # values in the compiled model; the fields of a larger model are not stored
_DEPTH_STEP: Final = 2.0**-10  # [m], rounding step for depths in small pictures
_STATISTICS: Final = ("mean", "deviation", "quantiles", "taus", "allan", "independent", "kurtosis")


def encode_record(record: RunRecord) -> tuple[JsonObject, bytes]:
    """Return the readable part of a record and the block with its data."""
    packer = Packer()
    inner: JsonObject = {
        "streams": {topic: _pack_stream(packer, s, record.scenario) for topic, s in sorted(record.streams.items())},
        "states": _pack_states(packer, record.states),
        # the values are in file order, so that a restored element gets its old position
        "leaves": dict(record.leaves),
        "fields": _pack_fields(packer, record.fields),
    }
    if is_long_text(record.scenario.world):
        inner["world"] = record.scenario.world
    about = {
        "fingerprint": record.fingerprint,
        **({"environment": dict(record.environment)} if record.environment else {}),
        "end": record.end,
        "state": record.states.digest,
        "named_state": record.states.named_digest,
        "topics": {
            topic: {"type": s.type_name, "messages": len(s.times_ns), "sha256": s.digest}
            for topic, s in sorted(record.streams.items())
        },
        "sources": dict(record.sources),
        "diagnostics": dict(record.diagnostics),
        **({} if record.left_out is None else {"left_out": dict(record.left_out)}),
    }
    return about, packer.block(inner)


def decode_record(stored: JsonMapping, data: bytes, scenario: RunSpec) -> RunRecord:
    """Decode a record.

    Args:
        stored: Content of `golden.json`.
        data: Block of data.
        scenario: Scenario decoded from `golden.json`.

    Raises:
        PackingError, ValueError, TypeError, KeyError: The data are damaged.
    """
    environment = {str(k): str(v) for k, v in stored.get("environment", {}).items() if k in ENVIRONMENT_VARIABLES}
    if not all(map(str.isprintable, environment.values())):  # no variable can have a zero byte
        raise PackingError("an environment variable has an invalid character")
    left_out = stored.get("left_out")
    unpacker = Unpacker(data)
    inner = unpacker.about
    if not scenario.world:
        scenario = replace(scenario, world=str(inner["world"]))
    return RunRecord(
        scenario,
        {str(k): str(v) for k, v in stored["fingerprint"].items()},
        {str(topic): _unpack_stream(unpacker, str(topic), packed) for topic, packed in inner["streams"].items()},
        _unpack_states(unpacker, inner["states"]),
        _validate_values(inner["leaves"]),
        {},
        _unpack_fields(unpacker, inner["fields"]),
        {str(k): str(v) for k, v in stored["sources"].items()},
        {str(k): int(v) for k, v in stored["diagnostics"].items()},
        str(stored["end"]),
        environment=environment,
        left_out=None if left_out is None else {str(k): int(v) for k, v in left_out.items()},
    )


# ---------------------------------------------------------------------- streams


def _pack_stream(packer: Packer, stream: Stream, scenario: RunSpec) -> dict[str, object]:
    columns = {}
    for path, column in stream.columns.items():
        step = column.step or storage_step(stream.type_name, path, scenario, stream.topic)
        entry = {"values": packer.add(column.values, step), "step": step if column.values.dtype.kind == "f" else 0.0}
        if column.lengths is not None:
            entry["lengths"] = packer.add(column.lengths)
        columns[path] = entry
    packed: dict[str, object] = {
        "type": stream.type_name,
        "times": packer.add(stream.times_ns),
        "columns": columns,
        "words": {path: pack_words(packer, texts) for path, texts in stream.words.items()},
        "statistics": {path: _pack_statistics(packer, statistics) for path, statistics in stream.statistics.items()},
        "chunks": list(stream.chunks),
        "digest": stream.digest,
    }
    if stream.pictures is not None:
        pictures = stream.pictures
        packed["pictures"] = {
            "small": packer.add(pictures.small, _DEPTH_STEP if pictures.small.dtype.kind == "f" else 0.0),
            "shape": list(pictures.shape),
            "encoding": pictures.encoding,
            "tiles": packer.add(pictures.tiles),
            "kept": None if pictures.kept is None else packer.add(pictures.kept),
            "hashes": None if pictures.hashes is None else packer.add(pictures.hashes),
        }
    return packed


def _unpack_stream(unpacker: Unpacker, topic: str, stored: JsonMapping) -> Stream:
    times = unpacker.array(stored["times"])
    if times.ndim != 1 or times.dtype != np.int64:
        raise PackingError("the time stamps have a wrong type")
    stream, count = Stream(topic, str(stored["type"]), times), len(times)
    for path, packed in stored["columns"].items():
        lengths = unpacker.array(packed["lengths"]) if "lengths" in packed else None
        column = Column(unpacker.array(packed["values"]), lengths, float(packed["step"]))
        rows = len(column.values) if lengths is None else len(lengths)
        if rows != count or (
            lengths is not None and (lengths.min(initial=0) < 0 or lengths.sum() != len(column.values))
        ):
            raise PackingError(f"{topic}.{path} has values of {rows} messages, but the topic has {count}")
        stream.columns[str(path)] = column
    stream.words = {str(path): unpack_words(unpacker, packed, count) for path, packed in stored["words"].items()}
    stream.statistics = {
        str(path): NoiseStatistics(int(packed["count"]), *(unpacker.array(packed[name]) for name in _STATISTICS))
        for path, packed in stored["statistics"].items()
    }
    stream.chunks, stream.digest = [str(chunk) for chunk in stored["chunks"]], str(stored["digest"])
    if "pictures" in stored:
        stream.pictures = _unpack_pictures(unpacker, stored["pictures"], count)
    return stream


def _unpack_pictures(unpacker: Unpacker, stored: JsonMapping, count: int) -> Pictures:
    small, tiles = unpacker.array(stored["small"]), unpacker.array(stored["tiles"])
    message_numbers, hashes = (
        None if stored[name] is None else unpacker.array(stored[name]) for name in ("kept", "hashes")
    )
    expected = count if message_numbers is None else len(message_numbers)
    if small.ndim != 4 or tiles.ndim != 3 or len(small) != expected or len(tiles) != expected:
        raise PackingError("the pictures have a wrong shape")
    if (
        message_numbers is not None
        and len(message_numbers)
        and (message_numbers.min() < 0 or message_numbers.max() >= count)
    ):
        raise PackingError("the pictures refer to messages that do not exist")
    height, width = (int(size) for size in stored["shape"])
    return Pictures(small, (height, width), str(stored["encoding"]), tiles, message_numbers, hashes)


def _pack_statistics(packer: Packer, statistics: NoiseStatistics) -> dict[str, object]:
    packed: dict[str, object] = {"count": int(statistics.count)}
    return packed | {name: packer.add(np.asarray(getattr(statistics, name), np.float64)) for name in _STATISTICS}


# ---------------------------------------------------------------------- states and model


def _pack_states(packer: Packer, states: States) -> dict[str, object]:
    arrays = ("marks", "inputs", "ticks", "values", "input_values")
    packed: dict[str, object] = {name: packer.add(getattr(states, name)) for name in arrays}
    texts = {"names": states.names, "input_names": states.input_names, "timestep": states.timestep}
    return packed | texts | {"digest": states.digest, "named_digest": states.named_digest}


def _unpack_states(unpacker: Unpacker, stored: JsonMapping) -> States:
    marks, inputs, ticks = (unpacker.array(stored[name]) for name in ("marks", "inputs", "ticks"))
    values, input_values = unpacker.array(stored["values"]), unpacker.array(stored["input_values"])
    names, given_names = [str(n) for n in stored["names"]], [str(n) for n in stored["input_names"]]
    timestep = float(stored["timestep"])
    if marks.ndim != 1 or inputs.shape != marks.shape or not 0 < timestep < 1e6:
        raise PackingError("the state hashes have a wrong shape")
    if values.shape != (len(ticks), len(names)) or input_values.shape != (len(ticks), len(given_names)):
        raise PackingError("the states have a wrong shape")
    return States(
        timestep, marks, inputs, ticks, names, values, given_names, input_values,
        str(stored["digest"]), str(stored["named_digest"]),
    )  # fmt: skip


def _pack_fields(packer: Packer, fields: Mapping[str, Array]) -> dict[str, object]:
    if not isinstance(fields, ModelFields):
        return {}
    if sum(array.size for _, table in fields.tables.values() for array in table.values()) > _MAX_FIELDS:
        return {}
    return {
        kind: {"names": names, "table": {name: packer.add(array) for name, array in sorted(table.items())}}
        for kind, (names, table) in sorted(fields.tables.items())
    }


def _unpack_fields(unpacker: Unpacker, stored: JsonMapping) -> ModelFields:
    tables: dict[str, tuple[list[str], dict[str, Array]]] = {}
    for kind, packed in stored.items():
        names = [str(name) for name in packed["names"]]
        table = {str(name): unpacker.array(number) for name, number in packed["table"].items()}
        if any(len(array) != len(names) for array in table.values()):
            raise PackingError(f"the fields of {kind} have a wrong length")
        tables[str(kind)] = (names, table)
    return ModelFields(tables)


def _validate_values(leaves: object) -> dict[str, object]:
    """Validate the world's values: numbers, texts, and lists of them."""

    def is_plain(value: object) -> bool:
        return isinstance(value, (bool, int, float, str)) or (isinstance(value, list) and all(map(is_plain, value)))

    if not isinstance(leaves, dict) or not all(map(is_plain, leaves.values())):
        raise PackingError("the world's values have a wrong type")
    return leaves
