"""Topic names as in a ROS node: namespace, remapping, `~/private` names."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.plugins.ros_arguments import RosArguments

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.plugins.ros_parameter_block import ParameterBlock


WITHOUT_RUN_FILES = "without_run_files"
"""Element of `<ros>` in the plugin of a node, which has read the parameter files of the run itself."""


def is_ros_1(params: Params, names: Iterable[str]) -> bool:
    """Check whether a plugin's parameters are those of ROS 1: one of `names` occurs, and there is no `<ros>` block."""
    return not params.has("ros") and any(params.has(name) for name in names)


class RosNames(SharedByCopies):
    """Names of a ROS node.

    Args:
        node: name of the node; `~/x` becomes `<namespace>/<node>/x`.
        namespace: namespace such as `tb3` or `/tb3`; may be empty.
        remappings: target name by source name; all names are expanded before they are compared.
        params: parameters of the plugin; invalid names are reported at their line.

    Attributes:
        arguments: arguments of the node, as after `--ros-args`.
        scoped: scoped name of the model with the plugin; empty for a plugin of the world.
        has_run_files: False if the parameter files of the run do not concern the plugin.
    """

    def __init__(
        self,
        node: str,
        namespace: str = "",
        remappings: Mapping[str, str] = MappingProxyType({}),
        params: Params | None = None,
    ) -> None:
        self.node, self._original_node = node, node  # rules for a node use its name without remapping
        self._params, self._remappings = params, remappings
        self.arguments, self.scoped, self.has_run_files = RosArguments(None), "", True
        self._set_namespace(namespace)

    def _set_namespace(self, namespace: str) -> None:
        self.namespace = "/" + namespace.strip("/") if namespace.strip("/") else ""
        rules = [*self.arguments.remappings_of(self._original_node), *self._remappings.items()]
        self._rules = {self._expand(source): self._expand(target) for source, target in reversed(rules)}

    @classmethod
    def from_params(cls, params: Params, node: str) -> RosNames:
        """Read the `<ros>` block of ROS 2 plugins, or `<robotNamespace>` of ROS 1 plugins."""
        namespace = params.text("robotNamespace", "")
        ros = params.child("ros")
        if ros is not None:
            namespace = ros.text("namespace", namespace)
        names = cls(node, namespace, params=params)
        names.arguments = RosArguments(ros)
        names.has_run_files = ros is None or not ros.boolean(WITHOUT_RUN_FILES, False)
        special = names.arguments.special_names(node)
        names.node = special.get("__node", special.get("__name", node))
        names._set_namespace(special.get("__ns", namespace))
        return names

    def in_namespace(self, namespace: str) -> RosNames:
        """Return the names of the same node, with the same arguments, in another namespace."""
        names = RosNames(self.node, namespace, self._remappings, self._params)
        names.arguments, names.scoped, names.has_run_files = self.arguments, self.scoped, self.has_run_files
        names._set_namespace(namespace)
        return names

    def values_with(self, name: str | None, builder: SpecBuilder) -> ParameterBlock | None:
        """Return the parameters of the node in the files of the run and in the arguments, whose values come last.

        None if there is no value for the parameter `name`. Without a name, one parameter of any name is enough.
        """
        if self._params is None:
            return None
        return self.values_of_node(f"{self.namespace}/{self.node}", name, builder)

    def values_of_node(self, full_name: str, name: str | None, builder: SpecBuilder) -> ParameterBlock | None:
        """Return the parameters of a node by its full name, which may be another one than that of the plugin.

        Args:
            full_name: full name of the node, such as `/global_costmap/global_costmap`.
            name: parameter that must be there; None for one of any name.
            builder: finds the files, and has those of the run (`--params-file`).
        """
        assert self._params is not None
        file = self._params.where.file
        folder = Path(file).resolve().parent if file else None

        def find(uri: str) -> Path | None:
            try:
                path = builder.find_file(uri, folder)
            except (OSError, ValueError):  # the URI is not a valid file name
                return None
            builder.files_read += [path] if path is not None and path.is_file() else []
            return path if path is not None and path.is_file() else None

        files = builder.parameter_files if self.has_run_files else ()
        of_run = [item.file for item in files if item.is_for_plugin(self.scoped)]
        return self.arguments.values_of(full_name, name, find, self._params.diagnostics, of_run)

    def topic_of_node(self, name: str, node: str, own_rules: Iterable[tuple[str, str]] = ()) -> str:
        """Return the name of a topic in another node of the plugin, such as a controller: `~/x` becomes `node/x`.

        Rules with a private source (`~/x:=y`) and rules for this node (`node:x:=y`) apply to the node. All other rules
        apply when the result is given to `topic`.

        Args:
            name: name of the topic.
            node: plain name of the node.
            own_rules: source and target of further rules for the node, which come first.
        """
        full = self._expand(name, node)
        for source, target in (*own_rules, *self.arguments.remappings_of(node, only_own=True)):
            if self._expand(source, node) == full:
                return self._expand(target, node)
        return f"{node}/{name[2:]}" if name.startswith("~/") else name

    def topic(self, name: str) -> str:
        """Return the absolute, remapped topic of `name` (`odom`, `/odom` or `~/odom`) without invalid characters."""
        full = self._expand(name)
        full = self._rules.get(full, full)
        clean = valid_topic(full)
        if clean.strip("/") == full.strip("/"):
            return full
        if self._params is not None:
            allowed = "expected letters, digits and _ / . : -"
            message = f"plugin {self.node!r}: found a topic {full!r}, {allowed}; {clean!r} is used instead"
            self._params.diagnostics.warning("SK-PLUGIN-012", message, self._params.where)
        return clean

    def _expand(self, name: str, node: str = "") -> str:
        if name == "~" or name.startswith("~/"):
            return f"{self.namespace}/{node or self.node}{name[1:]}"
        return name if name.startswith("/") else f"{self.namespace}/{name}"
