"""Actions that set parameters, remappings and the namespace of all nodes that follow."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from simkit_launch.launch_modules.launch.action import Action
from simkit_launch.launch_modules.launch.actions import TimerAction
from simkit_launch.launch_modules.launch.actions.named_action import NamedAction
from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from simkit_launch.launch_modules.launch_ros.parameter_descriptions import ParameterFile
from simkit_launch.launch_modules.launch_ros.utilities import (
    evaluate_parameter_dict,
    make_namespace_absolute,
    normalize_parameter_dict,
    prefix_namespace,
)

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = [
    "PushROSNamespace",
    "PushRosNamespace",
    "ROSTimer",
    "RosTimer",
    "SetParameter",
    "SetParametersFromFile",
    "SetROSLogDir",
    "SetRemap",
    "SetUseSimTime",
]


def _extend(context: LaunchContext, name: str, values: list[Any]) -> None:
    """Add to a list among the launch configurations; a new list, because groups restore the old one."""
    context.launch_configurations[name] = [*context.launch_configurations.get(name, []), *values]


class SetParameter(NamedAction):
    """Parameter of all nodes that follow in the group.

    Args:
        name: name.
        value: value.
    """

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(name, **kwargs)
        self._values = normalize_parameter_dict({tuple(self.name): value})

    @property
    def value(self) -> Any:
        """Value."""
        return next(iter(self._values.values()))

    def execute(self, context: LaunchContext) -> None:
        """Set the parameter."""
        _extend(context, "global_params", list(evaluate_parameter_dict(context, self._values).items()))


class SetUseSimTime(Action):
    """Parameter `use_sim_time` of all nodes that follow in the group.

    Args:
        value: value.
    """

    def __init__(self, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._parameter = SetParameter("use_sim_time", value)

    @property
    def value(self) -> Any:
        """Value."""
        return self._parameter.value

    def execute(self, context: LaunchContext) -> None:
        """Set the parameter."""
        self._parameter.execute(context)


class SetParametersFromFile(Action):
    """File of parameters of all nodes that follow in the group.

    Args:
        filename: path.
    """

    def __init__(self, filename: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._file = filename if isinstance(filename, ParameterFile) else ParameterFile(filename)

    def execute(self, context: LaunchContext) -> None:
        """Add the file."""
        path = context.planner.parameter_file(self._file.evaluate(context), self.where)
        if path is not None:
            _extend(context, "global_params", [str(path)])


class SetRemap(Action):
    """Remapping of all nodes that follow in the group.

    Args:
        src: old name.
        dst: new name.
    """

    def __init__(self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._src, self._dst = normalize_to_list_of_substitutions(src), normalize_to_list_of_substitutions(dst)

    @property
    def src(self) -> list[Substitution]:
        """Old name."""
        return self._src

    @property
    def dst(self) -> list[Substitution]:
        """New name."""
        return self._dst

    def execute(self, context: LaunchContext) -> None:
        """Add the remapping."""
        pair = perform_substitutions(context, self.src), perform_substitutions(context, self.dst)
        _extend(context, "ros_remaps", [pair])


class PushROSNamespace(Action):
    """Namespace of all nodes that follow in the group.

    Args:
        namespace: namespace, inside the present one unless it begins with a slash.
    """

    def __init__(self, namespace: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._namespace = normalize_to_list_of_substitutions(namespace)

    @property
    def namespace(self) -> list[Substitution]:
        """Namespace."""
        return self._namespace

    def execute(self, context: LaunchContext) -> None:
        """Set the namespace."""
        pushed = perform_substitutions(context, self.namespace)
        previous = context.launch_configurations.get("ros_namespace")
        namespace = make_namespace_absolute(prefix_namespace(previous, pushed))
        if namespace:
            context.launch_configurations["ros_namespace"] = namespace


PushRosNamespace = PushROSNamespace


class ROSTimer(TimerAction):
    """Actions that are executed after a simulated time.

    Args:
        period: time [s].
        actions: actions.
    """


RosTimer = ROSTimer


class SetROSLogDir(Action):
    """Folder of the logs, which has no effect here.

    Args:
        new_log_dir: path.
    """

    def __init__(self, new_log_dir: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._folder = normalize_to_list_of_substitutions(new_log_dir)

    @property
    def log_dir(self) -> list[Substitution]:
        """Path."""
        return self._folder
