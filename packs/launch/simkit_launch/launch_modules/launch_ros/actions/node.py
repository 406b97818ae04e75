"""Actions that start nodes, and nodes of containers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Final

from simkit_launch.launch_modules.launch.action import Action
from simkit_launch.launch_modules.launch.actions import ExecuteProcess
from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.utilities import (
    ensure_argument_type,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from simkit_launch.launch_modules.launch_ros.descriptions import ComposableNode
from simkit_launch.launch_modules.launch_ros.parameter_descriptions import Parameter
from simkit_launch.launch_modules.launch_ros.utilities import (
    evaluate_parameters,
    make_namespace_absolute,
    normalize_parameters,
    normalize_remap_rules,
    plain_value,
    prefix_namespace,
)

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = ["ComposableNodeContainer", "LoadComposableNodes", "Node"]


class Node(ExecuteProcess):
    """Start of a node.

    Args:
        executable: executable of the package, or path without a package.
        package: package.
        name: name of the node.
        namespace: namespace of the node, inside that of the group unless it begins with a slash.
        exec_name: name for messages.
        parameters: values and files of parameters, in the order of their effect.
        remappings: pairs of an old and a new name.
        ros_arguments: words of the command line after `--ros-args`.
        arguments: words of the command line.
        kwargs: arguments of `ExecuteProcess`.
    """

    UNSPECIFIED_NODE_NAME: ClassVar[str] = "<node_name_unspecified>"
    UNSPECIFIED_NODE_NAMESPACE: ClassVar[str] = "<node_namespace_unspecified>"

    def __init__(
        self,
        *,
        executable: SomeSubstitutionsType | None = None,
        package: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        exec_name: SomeSubstitutionsType | None = None,
        parameters: Sequence[Any] | None = None,
        remappings: Iterable[tuple[Any, Any]] | None = None,
        ros_arguments: Iterable[SomeSubstitutionsType] | None = None,
        arguments: Iterable[SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        executable, name, namespace = (
            kwargs.pop(old, None) if value is None else value
            for old, value in zip(_OLD_KEYWORDS, (executable, name, namespace), strict=True)
        )
        if executable is None:
            raise TypeError("Node.__init__() missing 1 required keyword-only argument: 'executable'")
        words: list[SomeSubstitutionsType] = [executable, *(arguments or ())]
        if ros_arguments is not None:
            words += ["--ros-args", *ros_arguments]
        if parameters is not None:
            ensure_argument_type(parameters, (list, tuple), "parameters", "Node")
        super().__init__(cmd=words, name=exec_name, **kwargs)
        self._package = None if package is None else normalize_to_list_of_substitutions(package)
        self._executable = normalize_to_list_of_substitutions(executable)
        self._node_name = None if name is None else normalize_to_list_of_substitutions(name)
        self._namespace = None if namespace is None else normalize_to_list_of_substitutions(namespace)
        self._parameters = normalize_parameters(parameters or [])
        self._remappings = normalize_remap_rules(remappings or ())
        self._final_name: str | None = None
        self._final_namespace: str | None = None
        self._fields: dict[str, Any] = {}

    @property
    def node_package(self) -> Any:
        """Package."""
        return self._package

    @property
    def node_executable(self) -> Any:
        """Executable of the package."""
        return self._executable

    @property
    def node_name(self) -> str:
        """Name of the node with its namespace, after the start."""
        if self._final_name is None:
            raise RuntimeError("cannot access 'node_name' before executing action")
        return self._final_name

    @property
    def expanded_node_namespace(self) -> str:
        """Namespace of the node, after the start."""
        return self._final_namespace or self.UNSPECIFIED_NODE_NAMESPACE

    @property
    def expanded_remapping_rules(self) -> list[tuple[str, str]]:
        """Pairs of an old and a new name, after the start."""
        return list(self._fields.get("remappings", ()))

    def is_node_name_fully_specified(self) -> bool:
        """Return whether the launch file gives the name and the namespace of the node."""
        return all(text not in self.node_name for text in (self.UNSPECIFIED_NODE_NAME, self.UNSPECIFIED_NODE_NAMESPACE))

    def prepare(self, context: LaunchContext) -> None:
        """Compute the command line, the names and the parameters."""
        super().prepare(context)
        name = "" if self._node_name is None else perform_substitutions(context, self._node_name)
        self._final_namespace = namespace_in(context, self._namespace)
        self._final_name = prefix_namespace(
            self._final_namespace or self.UNSPECIFIED_NODE_NAMESPACE, name or self.UNSPECIFIED_NODE_NAME
        )
        words = self.process_description.final_cmd or [""]
        package = "" if self._package is None else perform_substitutions(context, self._package)
        self._fields = {
            "kind": "node" if package else "command",
            "package": package,
            "executable": perform_substitutions(context, self._executable) if package else "",
            "name": name,
            "namespace": "" if self._final_namespace in (None, "/") else self._final_namespace,
            "parameters": (*global_parameters(context), *parameters_of(context, self._parameters, self)),
            "remappings": (*context.launch_configurations.get("ros_remaps", ()), *_pairs(context, self._remappings)),
            "arguments": tuple(words[1:] if package else words),
        }

    def process_fields(self, context: LaunchContext) -> dict[str, Any]:
        """Return the fields of the process in the plan."""
        return self._fields


_OLD_KEYWORDS: Final = ("node_executable", "node_name", "node_namespace")
"""Keywords of ROS 2 Foxy and older for the executable, the name and the namespace; they are accepted, too."""


def namespace_in(context: LaunchContext, namespace: Iterable[Substitution] | None) -> str | None:
    """Return an absolute namespace inside that of the group; None for none."""
    text = None if namespace is None else perform_substitutions(context, namespace)
    return make_namespace_absolute(prefix_namespace(context.launch_configurations.get("ros_namespace"), text or None))


def global_parameters(context: LaunchContext) -> list[Any]:
    """Return the parameters that `SetParameter` and `SetParametersFromFile` have set."""
    found: list[Any] = []
    for each in context.launch_configurations.get("global_params", ()):
        found.append({each[0]: plain_value(each[1])} if isinstance(each, tuple) else Path(each))
    return found


def parameters_of(context: LaunchContext, parameters: Iterable[Any], action: Any) -> list[Any]:
    """Return the parameters of a node; files that do not exist are reported and left out."""
    found: list[Any] = []
    for each in evaluate_parameters(context, parameters):
        if isinstance(each, Parameter):
            name, value = each.evaluate(context)
            found.append({name: plain_value(value)})
        elif isinstance(each, Mapping):
            found.append({name: plain_value(value) for name, value in each.items()})
        elif (file := context.planner.parameter_file(each, action.where)) is not None:
            found.append(file)
    return found


def _pairs(context: LaunchContext, rules: Iterable[tuple[Any, Any]]) -> list[tuple[str, str]]:
    return [(perform_substitutions(context, old), perform_substitutions(context, new)) for old, new in rules]


class ComposableNodeContainer(Node):
    """Start of a container of nodes.

    Args:
        name: name of the container.
        namespace: namespace of the container.
        composable_node_descriptions: nodes that are loaded.
        kwargs: arguments of `Node`.
    """

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType,
        namespace: SomeSubstitutionsType | None = None,
        composable_node_descriptions: Iterable[ComposableNode] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self._components = list(composable_node_descriptions or ())

    def execute(self, context: LaunchContext) -> list[Any] | None:
        """Add the container and its nodes to the plan."""
        super().execute(context)
        if not self._components:
            return None
        loader = LoadComposableNodes(composable_node_descriptions=self._components, target_container=self.node_name)
        return [loader]


class LoadComposableNodes(Action):
    """Start of nodes in a container.

    Args:
        composable_node_descriptions: nodes.
        target_container: container, or its name.
    """

    def __init__(
        self,
        *,
        composable_node_descriptions: Iterable[ComposableNode],
        target_container: SomeSubstitutionsType | ComposableNodeContainer,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._components = list(composable_node_descriptions)
        self._container = (
            target_container
            if isinstance(target_container, ComposableNodeContainer)
            else normalize_to_list_of_substitutions(target_container)
        )

    def execute(self, context: LaunchContext) -> None:
        """Add the nodes to the plan."""
        if isinstance(self._container, ComposableNodeContainer):
            container = self._container.node_name
        else:
            container = perform_substitutions(context, self._container)
        for each in self._components:
            condition = each.condition()
            if condition is None or condition.evaluate(context):
                context.planner.add(_component_fields(context, each, container), each.where)


def _component_fields(context: LaunchContext, node: ComposableNode, container: str) -> dict[str, Any]:
    namespace = namespace_in(context, node.node_namespace)
    return {
        "kind": "component",
        "package": perform_substitutions(context, node.package),
        "executable": perform_substitutions(context, node.node_plugin),
        "name": "" if node.node_name is None else perform_substitutions(context, node.node_name),
        "namespace": "" if namespace in (None, "/") else namespace,
        "parameters": (*global_parameters(context), *parameters_of(context, node.parameters or (), node)),
        "remappings": (
            *context.launch_configurations.get("ros_remaps", ()),
            *_pairs(context, node.remappings or ()),
        ),
        "container": container,
    }
