"""Node of Nav2 or robot_localization whose work a plugin of simkit does: amcl, planner, controller, navigator, filter.

The plugin is a part of a static model without a shape, which is added to the world when the node becomes active.
"""

import sys

import rclpy
from node_support import ServerNode, run, warn
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.node import Node

from simkit.errors import SimkitError
from simkit_navigation.nav2_parameters import ModelOfPlugins, server_node
from simkit_navigation.plugins.navigation.node_values import nested, shortened
from simkit_nodes.host import current_host, current_program
from simkit_nodes.parameter_overrides import parameter_overrides, parameter_places

TRANSFORMS = ("/tf", "/tf_static")


class PluginHost:
    """Adds the plugins of a node to the world, and removes them.

    Args:
        node: node.
        server: row of the node in the table.
    """

    def __init__(self, node, server):
        self._node, self._server, self._sim = node, server, current_host().simulation
        self._model = node.get_fully_qualified_name().strip("/").replace("/", "_")
        self._is_added = self._has_told = False

    def add(self):
        """Add the plugins; return False if their parameters have errors, which are logged."""
        program, node = current_program(), self._node
        arguments, params = node.context.arguments, program.options.params
        name, space = node.get_fully_qualified_name(), node.get_namespace().rstrip("/")
        values = nested(parameter_overrides(name, arguments, params))
        costmap = self._server.costmap
        name_of_costmap = f"{space}/{costmap}/{costmap}"
        of_costmap = parameter_overrides(name_of_costmap, arguments, params) if costmap else {}
        plugins = self._server.plugins(values, nested(of_costmap))
        plugins[-1].name = node.get_name()
        model = ModelOfPlugins(self._model, self._names(arguments, space))
        for plugin in plugins:
            is_costmap = bool(costmap) and plugin is not plugins[-1]
            model.add(plugin, parameter_places(name_of_costmap if is_costmap else name, arguments))
        missing = self._spawned(model, [plugin.name for plugin in plugins])
        for line in missing:
            node.get_logger().error(line)
        if missing:
            self.remove()
            return False
        self._tell([sentence for plugin in plugins for sentence in plugin.parameters.told], model.unused)
        return True

    def _spawned(self, model, names):
        """Add the model to the world; return the reasons why one of its plugins is not there."""
        reports = self._sim.engine.reports
        before = set(reports)
        try:
            self._sim.spawn(model.text)
        except SimkitError as error:
            reported = [model.placed(item) for item in getattr(error, "diagnostics", ())]
            return [str(item) for item in reported if item.severity == "error"] or str(error).splitlines()
        self._is_added = True
        reported = [item for item in reports if item not in before]
        reports.drop(reported)
        placed = [model.placed(item) for item in reported]
        reports.extend(placed)
        missing = [name for name in names if f"{self._model}::{name}" not in self._sim.plugins]
        codes = ("SK-PARAM", "SK-PLUGIN", "SK-BT", "SK-XML")
        return [str(item) for item in placed if item.code.startswith(codes)] if missing else []

    def _names(self, arguments, space):
        """Return namespace and remappings of the node as elements; transforms have one topic for all."""
        texts = [f"<namespace>{space}</namespace>"] if space else []
        for rule in arguments.rules:
            is_name = rule.kind in ("any", "topic", "service") and rule.node in ("", self._node.get_name())
            if is_name and rule.old not in TRANSFORMS:
                texts.append(f"<remapping>{rule.old}:={rule.new}</remapping>")
        return "".join(texts)

    def _tell(self, sentences, unused):
        """Warn once about what differs from the node."""
        if self._has_told:
            return
        self._has_told = True
        for sentence in sentences:
            warn(self._node, "SK-NAV-001", sentence)
        if unused:
            warn(self._node, "SK-NAV-002", f"no effect here: {shortened(unused)}")

    def remove(self):
        """Remove the plugins."""
        if self._is_added and self._model in self._sim.models:
            self._sim.remove(self._model)
        self._is_added = False


class ServerLifecycleNode(ServerNode):
    """Node that works while it is active."""

    def __init__(self, server):
        options = {"automatically_declare_parameters_from_overrides": True, "allow_undeclared_parameters": True}
        super().__init__(server.node, start_parameter_services=not server.has_live_parameters, **options)
        self._plugins = PluginHost(self, server)

    def on_activate(self, state):
        """Add the plugins."""
        super().on_activate(state)
        return TransitionCallbackReturn.SUCCESS if self._plugins.add() else TransitionCallbackReturn.FAILURE

    def on_deactivate(self, state):
        """Remove the plugins."""
        super().on_deactivate(state)
        self._plugins.remove()
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state):
        """Remove the plugins."""
        super().on_shutdown(state)
        self._plugins.remove()
        return TransitionCallbackReturn.SUCCESS


def main():
    """Run the node."""
    rclpy.init()
    server = server_node(sys.argv[0].rpartition("/")[2])
    if current_host().simulation is None:
        sys.exit(f"{sys.argv[0]} runs only in the process of a simulation: start it with simkit launch or simkit run")
    if server.is_lifecycle:
        node = ServerLifecycleNode(server)
    else:
        node = Node(server.node, automatically_declare_parameters_from_overrides=True)
        if not PluginHost(node, server).add():
            sys.exit(1)
    run(node)


if __name__ == "__main__":
    main()
