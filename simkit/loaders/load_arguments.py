"""Checks of the arguments of `simkit.load`, `check` and `describe`, before any file is read."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Final

from simkit.argument_checks import (
    check_folders,
    check_function,
    check_kind,
    check_list,
    check_paths,
    check_table,
    checked_seed,
    wrong_value,
)
from simkit.loaders.spawned_models import SpawnedModel
from simkit.run_spec import RENDERERS

_BASES: Final = ("auto", "fixed", "floating")
_PATH: Final = (str, os.PathLike)
_FLAG: Final = (bool, int)


def check_source_arguments(
    source: object, *, resource_paths: object, xacro_args: object, package_paths: object, base: object
) -> None:
    """Check the arguments that every function with a source has.

    Raises:
        ArgumentTypeError: an argument has another kind than expected.
        ArgumentValueError: the base is unknown.
    """
    check_source(source)
    check_paths(resource_paths, "resource_paths")
    _check_named_texts(xacro_args, (str, int, float), "xacro_args", "texts NAME:=VALUE")
    if isinstance(package_paths, Mapping) or package_paths is None:
        check_table(package_paths, _PATH, "package_paths", "paths")
    else:
        check_paths(package_paths, "package_paths")
    check_kind(base, str, "base", "a text")
    if base not in _BASES:
        raise wrong_value("base", "'auto', 'fixed' or 'floating'", base)


def check_source(source: object) -> None:
    """Raise ArgumentTypeError if a source is neither a path nor a text."""
    check_kind(source, _PATH, "source", "a path, a bare name or XML text")


def check_load_arguments(
    *,
    seed: object,
    plugin_paths: Sequence[str | os.PathLike[str]],
    plugins: object,
    strict: object,
    overrides: object,
    sleep: object,
    on_error: object,
    spawn: object,
    params_files: object,
    change_world: object,
    model_world: object,
    interfaces: object,
    renderer: object,
    remap: object,
    start_controllers: object,
    hold_joints: object,
    realism: object,
) -> int:
    """Check the other arguments of `simkit.load`, and return the seed.

    Raises:
        ArgumentTypeError: an argument has another kind than expected.
        ArgumentValueError: the seed is not a whole number, or `on_error` or `renderer` is unknown.
    """
    check_folders(plugin_paths, "plugin_paths")
    check_paths(interfaces, "interfaces")
    check_list(plugins, object, "plugins", "plugins")
    check_kind(strict, _FLAG, "strict", "True or False")
    check_list(overrides, str, "overrides", "texts PATH=VALUE")
    check_kind(sleep, _FLAG, "sleep", "True or False")
    check_kind(start_controllers, _FLAG, "start_controllers", "True or False")
    check_kind(hold_joints, _FLAG, "hold_joints", "True or False")
    check_kind(realism, (*_PATH, type(None)), "realism", "'ideal', 'datasheet', the name of a set, or a path")
    check_kind(on_error, (str, type(None)), "on_error", "'stop' or 'disable'")
    if on_error not in (None, "stop", "disable"):
        raise wrong_value("on_error", "'stop' or 'disable'", on_error)
    check_kind(renderer, (str, type(None)), "renderer", "'auto', 'gl' or 'software'")
    if renderer not in (None, *RENDERERS):
        raise wrong_value("renderer", "'auto', 'gl' or 'software'", renderer)
    _check_named_texts(remap, str, "remap", "texts OLD:=NEW")
    check_list(spawn, (str, SpawnedModel, Mapping), "spawn", "texts MODEL:x,y,yaw[:name[:namespace]]")
    if not isinstance(params_files, _PATH) and not _is_model_and_file(params_files):
        check_list(params_files, (*_PATH, tuple), "params_files", "paths")
    check_kind(model_world, str, "model_world", "'ground', 'none', a path or a bare name")
    if change_world is not None:
        check_function(change_world, "change_world")
    return checked_seed(seed)


def _check_named_texts(value: object, kinds: type | tuple[type, ...], name: str, texts: str) -> None:
    """Check values by name: a mapping, or texts `NAME:=VALUE`."""
    if value is None or isinstance(value, Mapping):
        check_table(value, kinds, name, "texts")
    elif not isinstance(value, str):
        check_list(value, str, name, texts)


def _is_model_and_file(value: object) -> bool:
    """Check for a pair of a model's name and a file."""
    return isinstance(value, tuple) and len(value) == 2 and isinstance(value[1], _PATH)
