"""Parameter files of a run (`--params-file`), for robots whose ROS launch file configures the controllers."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.diagnostics import Diagnostics, Where, did_you_mean, file_hint
from simkit.plugins.ros_parameter_files import ParameterFile, node_matches, read_parameter_file
from simkit.run_files import is_there, model_and_file
from simkit.run_nodes import NODES_READ_FILES

if TYPE_CHECKING:
    from simkit.params import Params
    from simkit.runtime.engine.entity_structure import AttachedPlugin
    from simkit.scene import SceneModel, SceneWorld

_PLUGIN_EXAMPLE: Final = (
    '<gazebo><plugin filename="gz_ros2_control-system" name="gz_ros2_control::GazeboSimROS2ControlPlugin">'
    "<parameters>FILE.yaml</parameters></plugin></gazebo>"
)
ParameterFileArgument = str | os.PathLike[str] | tuple[str, str | os.PathLike[str]]
"""Path of a file, text `MODEL=FILE`, or a pair of model name and path."""


@dataclass(frozen=True, slots=True)
class RunParameterFile:
    """Parameter file of a run.

    Attributes:
        model: name of the model whose control plugins read the file; empty for all models.
        file: contents of the file.
    """

    model: str
    file: ParameterFile

    def is_for(self, model: SceneModel) -> bool:
        """Check whether plugins of a model read the file: for all models, for this model or for an outer model."""
        return self.model == model.name or self.is_for_plugin(model.scoped)

    def is_for_plugin(self, scoped: str) -> bool:
        """Check whether a plugin of a model reads the file, by the scoped name of the model; empty for the world."""
        return not self.model or f"{scoped}::".startswith(f"{self.model}::")

    def names_node(self, full_name: str) -> bool:
        """Check whether the file has parameters of a node: under its name, not under a pattern for all nodes."""
        if self.file.root is not None:
            return False
        patterns = (pattern for pattern, _ in self.file.nodes if pattern.strip("/*"))
        return any(node_matches(pattern, full_name) for pattern in patterns)


def read_run_parameter_files(
    named: ParameterFileArgument | Sequence[ParameterFileArgument],
    find: Callable[[str], Path | None],
    diagnostics: Diagnostics,
) -> tuple[RunParameterFile, ...]:
    """Read the parameter files of a run; a missing or invalid file is an error and is left out.

    Args:
        named: value of `params_files` or `--params-file`.
        find: function that finds the file of a `package://` URI or a path; None if there is no such file.
        diagnostics: collector of the problems.
    """
    if isinstance(named, (str, os.PathLike)):
        named = [named]
    read: dict[Path, ParameterFile | None] = {}
    parameter_files = []
    for argument in named:
        model, text = model_and_file(argument)
        path = _find_file(text, find)
        if path is None:
            message = f"cannot find the parameter file {text[:200]}"
            diagnostics.error(
                "SK-CONTROL-015",
                message,
                hint=file_hint(text, (".yaml", ".yml")) or "--params-file takes FILE or MODEL=FILE",
            )
            continue
        if path not in read:
            read[path] = read_parameter_file(path, diagnostics)
        file = read[path]
        if file is not None:
            parameter_files.append(RunParameterFile(model, file))
    return tuple(parameter_files)


def _find_file(text: str, find: Callable[[str], Path | None]) -> Path | None:
    if text and is_there(Path(text)):
        return Path(text)
    try:
        file = find(text) if text else None
        return file if file is not None and file.is_file() else None
    except (OSError, ValueError):  # the text is not a valid file name
        return None


def report_unused_control(
    parameter_files: Iterable[RunParameterFile],
    plugins: Sequence[AttachedPlugin],
    world: SceneWorld,
    diagnostics: Diagnostics,
) -> None:
    """Warn about parameter files of a run that no plugin reads, and about `<ros2_control>` without a control plugin.

    Args:
        parameter_files: parameter files of the run.
        plugins: all plugins of the world.
        world: world with its models.
        diagnostics: collector of the warnings.
    """
    _report_unloaded_controllers(plugins, world, diagnostics)
    models = [model for top in world.models for model in top.all_models()]
    with_hosts = {plugin.scoped for plugin in plugins if plugin.reads_parameter_files}
    hosts = [model for model in models if model.scoped in with_hosts]
    for file in parameter_files:
        if NODES_READ_FILES.get() and not file.model and file.file.root is None:
            continue
        if any(file.is_for(model) for model in hosts) or _is_read(file, plugins):
            continue
        name, where = file.file.path.name, Where(str(file.file.path), 1)
        if file.model and not any(file.is_for(model) for model in models):
            message = f"{name} is for the model {file.model!r}, which does not exist; a model spawned later reads it"
            hint = did_you_mean(file.model, [m.name for m in models])
        else:
            owner = f"model {file.model!r}" if file.model else "no model"
            message = f"no plugin reads {name}: {owner} has {'no' if file.model else 'a'} control plugin"
            hint = "add libgazebo_ros_control.so, libgazebo_ros2_control.so or gz_ros2_control to the robot"
            if file.file.root is not None:
                hint += "; a file for nodes has the form NODE: {ros__parameters: {NAME: VALUE}}"
        diagnostics.warning("SK-CONTROL-060", message, where, hint)


def _is_read(file: RunParameterFile, plugins: Iterable[AttachedPlugin]) -> bool:
    """Check whether a parameter file has a block for the node of one of the plugins."""
    names = (name for plugin in plugins if file.is_for_plugin(plugin.scoped) for name in plugin.node_names)
    return any(map(file.names_node, names))


def _report_unloaded_controllers(
    plugins: Iterable[AttachedPlugin], world: SceneWorld, diagnostics: Diagnostics
) -> None:
    """Warn about each model with joints in `<ros2_control>` and without a plugin that drives joints."""
    driven = {plugin.scoped.partition("::")[0] for plugin in plugins if plugin.drives}
    for top in world.models:
        blocks = [block for model in top.all_models() for block in model.controls if _has_commands(block)]
        if blocks and top.name not in driven:
            message = f"model {top.name!r} has <ros2_control>, but no plugin that runs a controller manager"
            message = f"{message}: no controller is loaded, and nothing drives the joints"
            diagnostics.warning("SK-CONTROL-061", message, blocks[0].where, f"add {_PLUGIN_EXAMPLE}")


def _has_commands(block: Params) -> bool:
    """Check whether a joint of `<ros2_control>` has a command interface."""
    return any(element.name == "command_interface" for joint in block.children for element in joint.children)
