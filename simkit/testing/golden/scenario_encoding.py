"""A scenario as plain data, with its places relative to the folder of its golden run; and back."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Mapping
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any, Final, cast

from simkit.run_spec import Check, JsonMapping, JsonObject, LoadOptions, RunSpec, Tolerance

_PATH_OPTIONS: Final = ("resource_paths", "plugin_paths", "params_files")
_LONG_TEXT: Final = 2000
_PLAIN: Final = (
    "duration", "seed", "name", "overrides", "topics", "skip", "state", "model", "picture", "until", "timeout",
    "wall_timeout", "test", "play_topics", "bits",
)  # fmt: skip


def encode_scenario(scenario: RunSpec, folder: Path) -> dict[str, object]:
    """A scenario as JSON holds it.

    Args:
        scenario: what is written.
        folder: that files are named relative to; so that it does not matter where a checkout lies.
    """

    def place(path: Any) -> str:
        return relative_path(Path(scenario.folder, path), folder)

    found: dict[str, object] = {"world": relative_world(scenario, folder)}
    if is_long_text(scenario.world):
        text = scenario.world.encode("utf-8", "surrogatepass")
        found["world"] = {"sha256": hashlib.sha256(text).hexdigest(), "bytes": len(text)}
    defaults = RunSpec("")
    for name in _PLAIN:
        value = getattr(scenario, name)
        if value != getattr(defaults, name):
            found[name] = list(value) if isinstance(value, tuple) else value
    if scenario.spawn:
        found["spawn"] = [_move_spawn(str(text), lambda p: place(p) if Path(scenario.folder, p).exists() else p)
                          for text in scenario.spawn]  # fmt: skip
    if scenario.commands:
        found["commands"] = [{k: _plain_value(v) for k, v in one.items() if k != "where"} for one in scenario.commands]
    if scenario.play:
        found["play"] = place(scenario.play)
    if scenario.tolerances:
        found["tolerances"] = [_non_default_fields(one, Tolerance("")) for one in scenario.tolerances]
    if scenario.checks:
        found["checks"] = [_non_default_fields(one, Check("goal")) | {"kind": one.kind} for one in scenario.checks]
    if scenario.plugins:
        found["plugins"] = [_class_name(one) for one in scenario.plugins]
    options = {name: _encode_option(name, value, place) for name, value in sorted(scenario.options.items())}
    if options:
        found["options"] = options
    if scenario.file is not None:
        found["file"] = relative_path(scenario.file, folder)
    return found


def decode_scenario(plain: JsonMapping, folder: Path) -> RunSpec:
    """The scenario that plain data stands for; of plugins that were made in Python it has the names of their classes.

    Args:
        plain: as `encode_scenario` gives it; a world that is a long text is not in it, and is empty.
        folder: of the golden run.

    Raises:
        ValueError, TypeError, KeyError: it is none.
    """

    def place(text: object) -> str:
        return str(folder / str(text))

    given: JsonObject = {name: plain[name] for name in _PLAIN if name in plain}
    for name in ("overrides", "topics", "skip", "play_topics"):
        given[name] = tuple(map(str, given.get(name, ())))
    for name in ("duration", "seed", "picture"):
        if not isinstance(given.get(name, 0), (int, float)):
            raise TypeError(f"{name} is no number")
    given["spawn"] = tuple(
        _move_spawn(str(text), lambda p: place(p) if Path(place(p)).exists() else p) for text in plain.get("spawn", ())
    )
    given["play"] = str(plain.get("play", ""))
    given["commands"] = tuple({**one, "where": "commands"} for one in plain.get("commands", ()))
    given["tolerances"] = tuple(Tolerance(**_known_fields(one, Tolerance)) for one in plain.get("tolerances", ()))
    checks = (_known_fields(one, Check) for one in plain.get("checks", ()))
    given["checks"] = tuple(Check(**{**one, "models": tuple(one.get("models", ()))}) for one in checks)
    options: dict[str, object] = {}
    for name, value in dict(plain.get("options", {})).items():
        if name in _PATH_OPTIONS:
            options[name] = tuple(_move_params_file(str(one), place) for one in value)
        elif name == "package_paths":
            options[name] = {key: place(one) for key, one in value.items()}
        else:
            options[name] = value
    given["plugins"] = tuple(map(str, plain.get("plugins", ())))
    file = Path(place(plain["file"])) if plain.get("file") else None
    world = "" if isinstance(plain["world"], Mapping) else str(plain["world"])
    return RunSpec(world, options=cast(LoadOptions, options), folder=folder, file=file, **given)


def is_long_text(world: str) -> bool:
    """Whether a world is XML too long to be read beside the rest."""
    return "<" in world and len(world) > _LONG_TEXT


def relative_world(scenario: RunSpec, folder: Path) -> str:
    """The world's name: a file relative to `folder`; a bare name or XML text as it is."""
    if "<" in scenario.world:
        return scenario.world
    return scenario.world if scenario.beside is None else relative_path(scenario.beside, folder)


def relative_path(path: Path, folder: Path) -> str:
    """A path as seen from a folder, with slashes; the whole one where they are on different drives."""
    try:
        return Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()
    except ValueError:
        return path.resolve().as_posix()


def _move_spawn(text: str, place: Callable[[str], str]) -> str:
    """`MODEL:x,y,yaw[:name]` with another place of the model."""
    model, colon, rest = text.partition(":")
    return place(model) + colon + rest


def _encode_option(name: str, value: Any, place: Callable[[object], str]) -> object:
    if name in _PATH_OPTIONS:
        several = [value] if isinstance(value, (str, os.PathLike)) else list(value)
        return [_move_params_file(str(one), place) for one in several]
    if name == "package_paths":
        return {key: place(one) for key, one in dict(value).items()}
    return _plain_value(value)


def _move_params_file(text: str, place: Callable[[object], str]) -> str:
    """`[MODEL=]FILE` with another place of the file."""
    model, equals, file = text.rpartition("=")
    return f"{model}{equals}{place(file)}"


def _plain_value(value: Any) -> object:
    if isinstance(value, Mapping):
        return {str(key): _plain_value(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)) or hasattr(value, "tolist"):
        return [_plain_value(one) for one in value] if not hasattr(value, "tolist") else value.tolist()
    return value if isinstance(value, (bool, int, float, str)) or value is None else str(value)


def _non_default_fields(value: Any, default: Any) -> dict[str, object]:
    """The fields that are other than the default's, without places."""
    usual = asdict(default)
    return {name: _plain_value(one) for name, one in asdict(value).items() if name != "where" and one != usual[name]}


def _known_fields(plain: Mapping[str, object], kind: type) -> JsonObject:
    names = {field.name for field in fields(kind)}
    return {str(name): value for name, value in plain.items() if name in names}


def _class_name(plugin: object) -> str:
    one = plugin[1] if isinstance(plugin, tuple) and len(plugin) == 2 else plugin
    kind = one if isinstance(one, type) or hasattr(one, "__file__") else type(one)
    return str(getattr(kind, "__qualname__", getattr(kind, "__name__", kind)))
