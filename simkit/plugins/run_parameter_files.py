"""Parameter files that a run is given, for robots whose controllers a launch file of ROS fills in: `--params-file`."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.plugins.ros_parameter_files import ParameterFile, read_parameter_file

if TYPE_CHECKING:
    from simkit.runtime.engine.entity_structure import AttachedPlugin
    from simkit.scene import SceneModel, SceneWorld

ParameterFileArgument = str | os.PathLike[str] | tuple[str, str | os.PathLike[str]]
"""A file, the text `MODEL=FILE`, or the pair of both."""


@dataclass(frozen=True, slots=True)
class RunParameterFile:
    """One file as read.

    Attributes:
        model: whose control plugins read it; empty for those of every model.
        file: what it says.
    """

    model: str
    file: ParameterFile

    def is_for(self, model: SceneModel) -> bool:
        """Check whether the plugins of that model read it: it has the name, or is inside the one that has."""
        scoped = f"{model.scoped}::"
        return not self.model or self.model == model.name or scoped.startswith(f"{self.model}::")


def read_run_parameter_files(
    named: ParameterFileArgument | Sequence[ParameterFileArgument],
    find: Callable[[str], Path | None],
    diagnostics: Diagnostics,
) -> tuple[RunParameterFile, ...]:
    """Reads files; each that is missing or broken is an error, and left out.

    Args:
        named: what `params_files` or `--params-file` say.
        find: the file of a `package://` URI or a path; None where there is none.
        diagnostics: gets the problems.
    """
    if isinstance(named, (str, os.PathLike)):
        named = [named]
    read: dict[Path, ParameterFile | None] = {}
    found = []
    for one in named:
        model, text = _model_and_file(one)
        path = _find_file(text, find)
        if path is None:
            message = f"the parameter file {text[:200]} is not found"
            diagnostics.error(
                "SK-CONTROL-015", message, hint=_closest_file_name(text) or "--params-file takes FILE or MODEL=FILE"
            )
            continue
        if path not in read:
            read[path] = read_parameter_file(path, diagnostics)
        file = read[path]
        if file is not None:
            found.append(RunParameterFile(model, file))
    return tuple(found)


def _model_and_file(named: ParameterFileArgument) -> tuple[str, str]:
    """The model, empty for all of them, and the file."""
    if isinstance(named, tuple):
        return str(named[0]), os.fspath(named[1])
    text = os.fspath(named)
    model, equals, file = text.partition("=")
    if not equals or not model.strip() or "/" in model or _exists(Path(text)):
        return "", text
    return model.strip(), file


def _find_file(text: str, find: Callable[[str], Path | None]) -> Path | None:
    if text and _exists(Path(text)):
        return Path(text)
    try:
        found = find(text) if text else None
        return found if found is not None and found.is_file() else None
    except (OSError, ValueError):  # a name that no file can have
        return None


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


def _closest_file_name(text: str) -> str:
    """A file of nearly that name in its folder."""
    try:
        folder = Path(text).parent
        return did_you_mean(Path(text).name, [p.name for p in folder.iterdir() if p.suffix in (".yaml", ".yml")])
    except (OSError, ValueError):
        return ""


def report_unused_parameter_files(
    given: Iterable[RunParameterFile], plugins: Iterable[AttachedPlugin], world: SceneWorld, diagnostics: Diagnostics
) -> None:
    """Warn about parameter files of a run that no plugin reads.

    Args:
        given: the files.
        plugins: all plugins of the world.
        world: the world with its models.
        diagnostics: gets the warnings.
    """
    models = [model for top in world.models for model in top.all_models()]
    with_hosts = {plugin.scoped for plugin in plugins if plugin.reads_parameter_files}
    hosts = [model for model in models if model.scoped in with_hosts]
    for one in given:
        if any(one.is_for(model) for model in hosts):
            continue
        name, where = one.file.path.name, Where(str(one.file.path), 1)
        if one.model and not any(one.is_for(model) for model in models):
            message = f"{name} is for the model {one.model!r}, which is not there; a model spawned later reads it"
            hint = did_you_mean(one.model, [m.name for m in models])
        else:
            owner = f"model {one.model!r}" if one.model else "no model"
            message = f"{name} has nobody who reads it: {owner} has {'no' if one.model else 'a'} control plugin"
            hint = "a robot needs libgazebo_ros_control.so, libgazebo_ros2_control.so or gz_ros2_control"
        diagnostics.warning("SK-CONTROL-060", message, where, hint)
