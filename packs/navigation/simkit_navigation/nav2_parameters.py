"""Parameters of Nav2's nodes and of `robot_localization` as parameters of simkit's plugins.

A node of a launch file has a flat table of parameters, such as `FollowPath.max_vel_x`. A plugin gets those that it
reads. The nearest class of simkit replaces a class that simkit does not have, and a warning says so.
"""

from __future__ import annotations

import html
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Final

from simkit import Diagnostic, Params, Plugin
from simkit.diagnostic_record import TEXT_SOURCE
from simkit.extend import Where
from simkit.plugins.ros_names import WITHOUT_RUN_FILES
from simkit_navigation.plugins.controllers.controller_server import ControllerServer
from simkit_navigation.plugins.costmaps.costmap_2d import Costmap2D
from simkit_navigation.plugins.localisation.amcl import Amcl
from simkit_navigation.plugins.localisation.robot_localization import EkfNode
from simkit_navigation.plugins.navigation.node_parameters import NodeParameters
from simkit_navigation.plugins.navigation.node_values import NodeValues, Places, Values
from simkit_navigation.plugins.navigators.behavior_server import BehaviorServer
from simkit_navigation.plugins.navigators.bt_navigator import BtNavigator
from simkit_navigation.plugins.navigators.waypoint_follower import WaypointFollower
from simkit_navigation.plugins.planners.planner_server import PlannerServer
from simkit_navigation.plugins.planners.smoother_server import SmootherServer

_MOTION_MODELS: Final = {
    "differential": "nav2_amcl::DifferentialMotionModel",
    "omnidirectional": "nav2_amcl::OmniMotionModel",
}
_OF_OTHER_MODELS: Final = ("z_max", "z_short", "lambda_short", "save_pose_rate", "always_reset_initial_pose")
"""Parameters of AMCL's beam model, and of a file for the next start of the node."""
_OF_BEAM_SKIPPING: Final = ("do_beamskip", "beam_skip_distance", "beam_skip_threshold", "beam_skip_error_threshold")


@dataclass
class PluginOfNode:
    """Plugin that does the work of a node, with its parameters.

    Attributes:
        kind: class of the plugin.
        name: name of the plugin.
        parameters: parameters of the plugin.
    """

    kind: type[Plugin]
    name: str
    parameters: NodeValues


class ModelOfPlugins:
    """Static model without a shape whose plugins do the work of a node.

    Args:
        name: name of the model.
        ros: content of the blocks `<ros>` of its plugins.

    Attributes:
        unused: names of parameters without an effect.
    """

    def __init__(self, name: str, ros: str) -> None:
        self._name, self._ros = name, ros
        self._lines = ["", ""]  # the lines of the model begin after those
        self._places: dict[int, Where] = {}
        self.unused: list[str] = []

    def add(self, plugin: PluginOfNode, places: Places) -> None:
        """Add a plugin.

        Args:
            plugin: plugin.
            places: places of its values by their names in the files.
        """
        params = plugin.parameters.elements(plugin.kind, places, self.unused)
        ros = f"<ros><{WITHOUT_RUN_FILES}>true</{WITHOUT_RUN_FILES}>{self._ros}</ros>"
        start = f'<plugin filename="{plugin.kind.filenames[0]}" name="{plugin.name}">{ros}'
        self._add_line(start, params.where)
        self._add_children(params)
        self._add_line("</plugin>", params.where)

    def _add_children(self, element: Params) -> None:
        for child in element.children:
            self._add_line(f"<{child.name}>{html.escape(child.value)}", child.where)
            self._add_children(child)
            self._lines[-1] += f"</{child.name}>"

    def _add_line(self, text: str, where: Where) -> None:
        self._lines.append(text)
        self._places[len(self._lines)] = where

    @property
    def text(self) -> str:
        """Text of the model, with a line for each element."""
        first = f'<sdf version="1.9"><model name="{self._name}">', '<static>true</static><link name="link"/>'
        return "\n".join((*first, *self._lines[2:], "</model></sdf>"))

    def placed(self, item: Diagnostic) -> Diagnostic:
        """Return a diagnostic of the text with the place of the value in its file; another one is unchanged."""
        where = self._places.get(item.line or 0) if item.file == TEXT_SOURCE else None
        return item if where is None or not where.file else replace(item, file=where.file, line=where.line)


# ---------------------------------------------------------------------- tables of the nodes


@dataclass(frozen=True)
class ServerNode:
    """Node whose work a plugin does.

    Attributes:
        kind: class of the plugin.
        node: name of the node, unless the launch file gives one.
        translate: function from the parameters of the node, and of its costmap, to those of the plugin.
        costmap: name of the costmap whose parameters the plugin needs; empty without one.
        makes_costmap: True if this costmap is a part of the node.
        is_lifecycle: True if the node does its work only while it is active.
        has_live_parameters: True if the plugin serves the parameters of the node.
    """

    kind: type[Plugin]
    node: str
    translate: Callable[[Values, Values], NodeValues]
    costmap: str = ""
    makes_costmap: bool = False
    is_lifecycle: bool = True
    has_live_parameters: bool = False

    def plugins(self, values: Values, costmap: Values) -> list[PluginOfNode]:
        """Return the plugins that do the work of the node: its costmap, if it makes one, and then its own plugin.

        Args:
            values: parameters of the node; blocks are dictionaries.
            costmap: parameters of its costmap.
        """
        plugins = [PluginOfNode(self.kind, self.node, self.translate(values, costmap))]
        if self.makes_costmap:
            plugins.insert(0, PluginOfNode(Costmap2D, self.costmap, Costmap2D.translate_parameters(costmap, {})))
        return plugins


def _server(kind: type[NodeParameters], node: str, *, makes_costmap: bool = False) -> ServerNode:
    return ServerNode(kind, node, kind.translate_parameters, kind.costmap, makes_costmap)


def _amcl(values: Values, _: Values) -> NodeValues:
    result = NodeValues(dict(values))
    model = str(values.get("robot_model_type", ""))
    if model in _MOTION_MODELS:
        result.values["robot_model_type"] = _MOTION_MODELS[model]
    if values.get("laser_model_type") == "beam":
        result.values["laser_model_type"] = "likelihood_field"
        result.told.append("the laser model 'beam' is not available; 'likelihood_field' is used")
    if values.get("do_beamskip"):
        result.told.append("no beams are skipped (do_beamskip)")
    for name in (*_OF_OTHER_MODELS, *_OF_BEAM_SKIPPING):
        result.values.pop(name, None)
    pose = result.values.get("initial_pose")
    if isinstance(pose, dict):
        result.values["initial_pose"] = {name: value for name, value in pose.items() if name != "z"}
    return result


def _ekf(values: Values, _: Values) -> NodeValues:
    return NodeValues(dict(values), list(_COVARIANCES))


_COVARIANCES: Final = ("process_noise_covariance", "initial_estimate_covariance")


def _ukf(values: Values, _: Values) -> NodeValues:
    """Return the parameters of `ekf_node` in place of an unscented filter, which has also alpha, beta and kappa."""
    own = {name: value for name, value in values.items() if name not in ("alpha", "beta", "kappa")}
    told = ["the extended Kalman filter of ekf_node replaces the unscented one"]
    return NodeValues(own, list(_COVARIANCES), told)


SERVER_NODES: Final[Mapping[str, ServerNode]] = {
    "amcl": ServerNode(Amcl, "amcl", _amcl, has_live_parameters=True),
    "planner_server": _server(PlannerServer, "planner_server", makes_costmap=True),
    "smoother_server": _server(SmootherServer, "smoother_server"),
    "controller_server": _server(ControllerServer, "controller_server", makes_costmap=True),
    "behavior_server": _server(BehaviorServer, "behavior_server"),
    "recoveries_server": _server(BehaviorServer, "recoveries_server"),
    "bt_navigator": _server(BtNavigator, "bt_navigator"),
    "waypoint_follower": _server(WaypointFollower, "waypoint_follower"),
    "ekf_node": ServerNode(EkfNode, "ekf_filter_node", _ekf, is_lifecycle=False),
    "ukf_node": ServerNode(EkfNode, "ukf_filter_node", _ukf, is_lifecycle=False),
}
"""Nodes whose work plugins do, by the name of their executable."""


def server_node(executable: str) -> ServerNode:
    """Return the row of an executable such as `amcl`, or of a component such as `nav2_amcl::AmclNode`."""
    name = executable.rpartition("::")[2].removesuffix("Node").removeprefix("Robot")
    words = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower()
    return SERVER_NODES.get(executable) or SERVER_NODES.get(words) or SERVER_NODES[_COMPONENTS[executable]]


_COMPONENTS: Final = {
    "robot_localization::EkfFilterNode": "ekf_node",
    "robot_localization::UkfFilterNode": "ukf_node",
}
