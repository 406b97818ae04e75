"""Descriptions of nodes for containers, and of parameters."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from simkit_launch.action_places import calling_place
from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions
from simkit_launch.launch_modules.launch_ros.parameter_descriptions import Parameter, ParameterFile, ParameterValue
from simkit_launch.launch_modules.launch_ros.utilities import normalize_parameters, normalize_remap_rules

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.condition import Condition
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = ["ComposableNode", "Parameter", "ParameterFile", "ParameterValue"]


class ComposableNode:
    """Node that is loaded into a container.

    Args:
        package: package of the node.
        plugin: class of the node, such as `image_proc::RectifyNode`.
        name: name of the node.
        namespace: namespace of the node.
        parameters: values and files of parameters.
        remappings: pairs of an old and a new name.
        extra_arguments: arguments of the container, such as `{'use_intra_process_comms': True}`.
        condition: condition without which the node is left out.

    Attributes:
        where: line of the launch file that made the description.
    """

    def __init__(
        self,
        *,
        package: SomeSubstitutionsType,
        plugin: SomeSubstitutionsType,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        parameters: Sequence[Any] | None = None,
        remappings: Iterable[tuple[Any, Any]] | None = None,
        extra_arguments: Sequence[Any] | None = None,
        condition: Condition | None = None,
    ) -> None:
        self.where = calling_place()
        self._package = normalize_to_list_of_substitutions(package)
        self._plugin = normalize_to_list_of_substitutions(plugin)
        self._name = None if name is None else normalize_to_list_of_substitutions(name)
        self._namespace = None if namespace is None else normalize_to_list_of_substitutions(namespace)
        self._parameters = None if parameters is None else normalize_parameters(parameters)
        self._remappings = None if remappings is None else normalize_remap_rules(remappings)
        self._extra_arguments = None if extra_arguments is None else normalize_parameters(extra_arguments)
        self._condition = condition

    @property
    def package(self) -> list[Substitution]:
        """Package of the node."""
        return self._package

    @property
    def node_plugin(self) -> list[Substitution]:
        """Class of the node."""
        return self._plugin

    @property
    def node_name(self) -> list[Substitution] | None:
        """Name of the node."""
        return self._name

    @property
    def node_namespace(self) -> list[Substitution] | None:
        """Namespace of the node."""
        return self._namespace

    @property
    def parameters(self) -> tuple[Any, ...] | None:
        """Values and files of parameters."""
        return self._parameters

    @property
    def remappings(self) -> list[tuple[tuple[Substitution, ...], tuple[Substitution, ...]]] | None:
        """Pairs of an old and a new name."""
        return self._remappings

    @property
    def extra_arguments(self) -> tuple[Any, ...] | None:
        """Arguments of the container."""
        return self._extra_arguments

    def condition(self) -> Condition | None:
        """Return the condition without which the node is left out."""
        return self._condition
