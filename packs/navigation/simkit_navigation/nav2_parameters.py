"""Parameters of Nav2's nodes and of `robot_localization` as parameters of simkit's plugins.

A node of a launch file has a flat table of parameters, such as `FollowPath.max_vel_x`. A plugin gets those that it
reads. The nearest class of simkit replaces a class that simkit does not have, and a warning says so.
"""

from __future__ import annotations

import html
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

from simkit import Params, Plugin
from simkit.diagnostic_record import TEXT_SOURCE
from simkit.diagnostics import NOWHERE, Diagnostic, Diagnostics, Where
from simkit.plugins.ros_names import WITHOUT_RUN_FILES
from simkit.plugins.unread_parameters import names_read
from simkit_navigation.plugins.controllers.controller_parameters import controller_parameters
from simkit_navigation.plugins.controllers.controller_server import ControllerServer
from simkit_navigation.plugins.costmaps.costmap_2d import Costmap2D
from simkit_navigation.plugins.costmaps.costmap_parameters import costmap_parameters
from simkit_navigation.plugins.localisation.amcl import Amcl
from simkit_navigation.plugins.localisation.robot_localization import EkfNode
from simkit_navigation.plugins.navigators.behavior_server import BehaviorServer
from simkit_navigation.plugins.navigators.bt_navigator import BtNavigator
from simkit_navigation.plugins.navigators.waypoint_follower import WaypointFollower
from simkit_navigation.plugins.planners.planner_server import PlannerServer
from simkit_navigation.plugins.planners.smoother_server import SmootherServer

Values = dict[str, object]
"""Values of parameters; blocks are dictionaries."""
Places = Mapping[str, Where]
"""Places of values in files by their names, such as `FollowPath.max_vel_x`."""

_ELEMENT: Final = re.compile(r"[A-Za-z_][\w.-]*")
_EKF_INPUT: Final = re.compile(
    r"(odom|pose|twist|imu)\d+(_config|_differential|_relative|_queue_size|_nodelay|_remove_gravitational_acceleration"
    r"|(_pose|_twist|_linear_acceleration)?_rejection_threshold)?"
)
_TUTORIAL_CLASSES: Final = frozenset(
    (
        "nav2_gradient_costmap_plugin::GradientLayer",
        "nav2_pure_pursuit_controller::PurePursuitController",
        "nav2_straightline_planner::StraightLine",
    )
)
"""Classes of Nav2's tutorials, which a user often replaces by a class of his own with other parameters."""
_PREFIXES_OF_NAV2: Final = ("nav2_", "dwb_", "opennav_")
_MOTION_MODELS: Final = {
    "differential": "nav2_amcl::DifferentialMotionModel",
    "omnidirectional": "nav2_amcl::OmniMotionModel",
}
_OF_ALL_NODES: Final = frozenset(
    (
        *("use_sim_time", "qos_overrides", "bond_heartbeat_period", "use_realtime_priority"),
        *(
            "introspection_mode",
            "service_introspection_mode",
            "allow_parameter_qos_overrides",
            "action_server_result_timeout",
        ),
        *("enable_groot_monitoring", "groot_zmq_publisher_port", "groot_zmq_server_port"),
    )
)
"""Parameters of nodes that change nothing here and need no warning."""
_OF_OTHER_MODELS: Final = ("z_max", "z_short", "lambda_short", "save_pose_rate", "always_reset_initial_pose")
"""Parameters of AMCL's beam model, and of a file for the next start of the node."""
_OF_BEAM_SKIPPING: Final = ("do_beamskip", "beam_skip_distance", "beam_skip_threshold", "beam_skip_error_threshold")


@dataclass
class PluginOfNode:
    """Plugin that does the work of a node, with its parameters.

    Attributes:
        kind: class of the plugin.
        name: name of the plugin.
        values: parameters; blocks are dictionaries.
        blocks: names of blocks that the user has chosen, such as `FollowPath`.
        told: sentences about what differs from the node's parameters.
    """

    kind: type[Plugin]
    name: str
    values: Values
    blocks: list[str] = field(default_factory=list)
    told: list[str] = field(default_factory=list)

    def params(self, places: Places, unused: list[str], diagnostics: Diagnostics | None = None) -> Params:
        """Return the parameters of the plugin as elements.

        Args:
            places: places of the values by their names in the files.
            unused: list to which the names of parameters without an effect are added.
            diagnostics: collector of the problems with the values.
        """
        names = {part for name in names_read(self.kind) for part in name.split(".")} | set(self.blocks)
        root = Params("plugin", diagnostics=diagnostics)
        root.where = next(iter(places.values()), NOWHERE)
        _add_elements(root, self.values, names, "", unused, places)
        return root


def _add_elements(
    element: Params,
    values: Mapping[str, object],
    names: Collection[str] | None,
    prefix: str,
    unused: list[str],
    places: Places,
) -> None:
    """Add the values that have an effect to an element; a value without a place has that of its block.

    Without `names`, all values are added: a class of a user reads them.
    """
    for key, value in values.items():
        is_known = _ELEMENT.fullmatch(key) is not None and (
            names is None or key in names or _EKF_INPUT.fullmatch(key) is not None
        )
        if not is_known:
            if prefix or key not in _OF_ALL_NODES:
                unused.append(f"{prefix}{key}")
            continue
        where = places.get(f"{prefix}{key}", element.where)
        text = "" if isinstance(value, Mapping) else _text(value)
        child = Params(key, text, where=where, diagnostics=element.diagnostics)
        if isinstance(value, Mapping):
            inner = None if is_class_of_user(value.get("plugin")) else names
            _add_elements(child, value, inner, f"{prefix}{key}.", unused, places)
        element.children.append(child)


def is_class_of_user(kind: object) -> bool:
    """Check whether the class of a block may be one that a user has written: its parameters are not known here."""
    name = str(kind or "").replace("/", "::")
    return name in _TUTORIAL_CLASSES or (bool(name) and not name.startswith(_PREFIXES_OF_NAV2))


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return " ".join(map(_text, value)) if isinstance(value, (list, tuple)) else str(value)


def nested(values: Mapping[str, object]) -> Values:
    """Return parameters with dots in their names as blocks."""
    tree: Values = {}
    for name, value in values.items():
        *blocks, last = name.split(".")
        at = tree
        for block in blocks:
            below = at.setdefault(block, {})
            if not isinstance(below, dict):
                below = at[block] = {}
            at = below
        at[last] = value
    return tree


def shortened(names: Sequence[str]) -> str:
    """Return a list of names as text; of a long list, the first twelve and the number of the others."""
    return ", ".join(names[:12]) + (f" and {len(names) - 12} others" if len(names) > 12 else "")


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
        params = plugin.params(places, self.unused)
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
        plugins: function from the parameters of the node, and of its costmap, to the plugins.
        node: name of the node, unless the launch file gives one.
        costmap: name of the node's costmap; empty without one.
        is_lifecycle: True if the node does its work only while it is active.
        has_live_parameters: True if the plugin serves the parameters of the node.
    """

    plugins: Callable[[Values, Values], list[PluginOfNode]]
    node: str
    costmap: str = ""
    is_lifecycle: bool = True
    has_live_parameters: bool = False


def _amcl(values: Values, _: Values) -> list[PluginOfNode]:
    plugin = PluginOfNode(Amcl, "amcl", dict(values))
    model = str(values.get("robot_model_type", ""))
    if model in _MOTION_MODELS:
        plugin.values["robot_model_type"] = _MOTION_MODELS[model]
    if values.get("laser_model_type") == "beam":
        plugin.values["laser_model_type"] = "likelihood_field"
        plugin.told.append("the laser model 'beam' is not available; 'likelihood_field' is used")
    if values.get("do_beamskip"):
        plugin.told.append("no beams are skipped (do_beamskip)")
    for name in (*_OF_OTHER_MODELS, *_OF_BEAM_SKIPPING):
        plugin.values.pop(name, None)
    pose = plugin.values.get("initial_pose")
    if isinstance(pose, dict):
        plugin.values["initial_pose"] = {name: value for name, value in pose.items() if name != "z"}
    return [plugin]


def _costmap(name: str, values: Values) -> PluginOfNode:
    return PluginOfNode(Costmap2D, name, *costmap_parameters(values))


def costmap_plugin(name: str, values: Values) -> PluginOfNode:
    """Return the plugin of a costmap with the parameters of its node."""
    return _costmap(name, values)


def _planner(values: Values, costmap: Values) -> list[PluginOfNode]:
    plugin = PluginOfNode(PlannerServer, "planner_server", {**_frame_of(costmap), **values})
    plugin.blocks += _names(values.get("planner_plugins"))
    return [_costmap("global_costmap", costmap), plugin]


def _smoother(values: Values, _: Values) -> list[PluginOfNode]:
    plugin = PluginOfNode(SmootherServer, "smoother_server", {"robot_base_frame": "base_link", **values})
    plugin.blocks += _names(values.get("smoother_plugins"))
    return [plugin]


def _controller(values: Values, costmap: Values) -> list[PluginOfNode]:
    found = controller_parameters(values, costmap, is_class_of_user)
    plugin = PluginOfNode(ControllerServer, "controller_server", found.values, found.blocks, found.told)
    return [_costmap("local_costmap", costmap), plugin]


def _behaviors(values: Values, costmap: Values) -> list[PluginOfNode]:
    renamed = {"global_frame": "local_frame", "local_costmap_topic": "costmap_topic"}
    own = {new: values[old] for old, new in renamed.items() if old in values and new not in values}
    rest = {name: value for name, value in values.items() if name not in renamed}
    outline = _outline_of(costmap)
    plugin = PluginOfNode(BehaviorServer, "behavior_server", {**outline, **own, **rest})
    listed = [name for key in ("behavior_plugins", "recovery_plugins") for name in _names(plugin.values.pop(key, None))]
    for name in listed:
        block = plugin.values.pop(name, None)
        kind = str(block.get("plugin", name) if isinstance(block, dict) else name)
        if re.split(r"::|/", kind)[-1].replace("_", "").lower() not in _BEHAVIORS:
            plugin.told.append(f"there is no behaviour {name} ({kind})")
    return [plugin]


_BEHAVIORS: Final = frozenset(("spin", "backup", "driveonheading", "wait", "assistedteleop"))


def _navigator(values: Values, _: Values) -> list[PluginOfNode]:
    plugin = PluginOfNode(BtNavigator, "bt_navigator", {"robot_base_frame": "base_link", **values})
    for name in _names(plugin.values.pop("navigators", None)):
        block = plugin.values.pop(name, None)
        kind = str(block.get("plugin", name) if isinstance(block, dict) else name)
        if re.split(r"::|/", kind)[-1] not in _NAVIGATORS and name not in _NAVIGATORS:
            plugin.told.append(f"there is no navigator {name} ({kind})")
    unknown = [
        name for name in _names(plugin.values.pop("plugin_lib_names", None)) if not _TREE_LIBRARY.fullmatch(name)
    ]
    if unknown:
        plugin.told.append(f"the nodes of the C++ libraries {', '.join(unknown)} are not available in behaviour trees")
    return [plugin]


_NAVIGATORS: Final = (
    "NavigateToPoseNavigator",
    "NavigateThroughPosesNavigator",
    "navigate_to_pose",
    "navigate_through_poses",
)
_TREE_LIBRARY: Final = re.compile(r"nav2_\w+_(bt_node|condition)")


def _waypoints(values: Values, _: Values) -> list[PluginOfNode]:
    task = str(values.get("waypoint_task_executor_plugin", "wait_at_waypoint"))
    return [PluginOfNode(WaypointFollower, "waypoint_follower", dict(values), [task])]


def _ekf(values: Values, _: Values) -> list[PluginOfNode]:
    return [PluginOfNode(EkfNode, "ekf_filter_node", dict(values), list(_COVARIANCES))]


_COVARIANCES: Final = ("process_noise_covariance", "initial_estimate_covariance")


def _ukf(values: Values, _: Values) -> list[PluginOfNode]:
    """Return the plugin of `ekf_node` in place of an unscented filter; the parameters alpha, beta and kappa are its."""
    own = {name: value for name, value in values.items() if name not in ("alpha", "beta", "kappa")}
    plugin = PluginOfNode(EkfNode, "ukf_filter_node", own, list(_COVARIANCES))
    plugin.told.append("the extended Kalman filter of ekf_node replaces the unscented one")
    return [plugin]


SERVER_NODES: Final[Mapping[str, ServerNode]] = {
    "amcl": ServerNode(_amcl, "amcl", has_live_parameters=True),
    "planner_server": ServerNode(_planner, "planner_server", "global_costmap"),
    "smoother_server": ServerNode(_smoother, "smoother_server"),
    "controller_server": ServerNode(_controller, "controller_server", "local_costmap"),
    "behavior_server": ServerNode(_behaviors, "behavior_server", "local_costmap"),
    "recoveries_server": ServerNode(_behaviors, "recoveries_server", "local_costmap"),
    "bt_navigator": ServerNode(_navigator, "bt_navigator"),
    "waypoint_follower": ServerNode(_waypoints, "waypoint_follower"),
    "ekf_node": ServerNode(_ekf, "ekf_filter_node", is_lifecycle=False),
    "ukf_node": ServerNode(_ukf, "ukf_filter_node", is_lifecycle=False),
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


def _frame_of(costmap: Values) -> Values:
    return {"robot_base_frame": costmap.get("robot_base_frame", "base_link")}


def _outline_of(costmap: Values) -> Values:
    return {name: value for name, value in costmap.items() if name in ("robot_radius", "footprint")}


def _names(value: object) -> list[str]:
    """Return the names in a list, or in a text with spaces."""
    if isinstance(value, (list, tuple)):
        return [str(item) for item in value if str(item)]
    return value.split() if isinstance(value, str) else []


def _block(values: Values, name: str) -> Values:
    """Return a block as a dictionary that may be changed."""
    block = values.get(name)
    values[name] = own = dict(block) if isinstance(block, dict) else {}
    return own
