"""Parameters of the navigation nodes of ROS 1 as parameters of simkit's plugins: amcl, move_base, fake_localization."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from simkit_navigation.nav2_parameters import SERVER_NODES, PluginOfNode
from simkit_navigation.plugins.localisation.fake_localization import FakeLocalization
from simkit_navigation.plugins.navigation.node_values import NodeValues, Values, block_of

_OF_AMCL: Final = {
    **{f"odom_alpha{n}": f"alpha{n}" for n in range(1, 6)},
    "laser_max_beams": "max_beams",
    "laser_z_hit": "z_hit",
    "laser_z_rand": "z_rand",
    "laser_sigma_hit": "sigma_hit",
    "kld_err": "pf_err",
    "kld_z": "pf_z",
}
"""Names of Nav2 by those of ROS 1."""
_MODELS: Final = {"diff": "differential", "omni": "omnidirectional"}
_COSTMAPS: Final = ("global_costmap", "local_costmap")
_PLANNERS: Final = ("navfn/NavfnROS", "global_planner/GlobalPlanner")


def amcl_plugins(values: Values) -> list[PluginOfNode]:
    """Return the plugin of `amcl`, which starts at the pose (0, 0, 0) without other parameters."""
    result: Values = {"set_initial_pose": True, "base_frame_id": "base_link"}
    pose: Values = {}
    for name, value in values.items():
        if name in ("initial_pose_x", "initial_pose_y"):
            pose[name[-1]] = value
        elif name == "initial_pose_a":
            pose["yaw"] = value
        elif name == "odom_model_type":
            kind = str(value).removesuffix("-corrected")
            result["robot_model_type"] = _MODELS.get(kind, kind)
        else:
            result[_OF_AMCL.get(name, name)] = value
    if pose:
        result["initial_pose"] = pose
    return SERVER_NODES["amcl"].plugins(result, {})


def fake_localization_plugins(values: Values) -> list[PluginOfNode]:
    """Return the plugin of `fake_localization`."""
    names = {"global_frame_id": "global_frame_id", "odom_frame_id": "odom_frame_id", "base_frame_id": "base_frame_id"}
    frames = {new: values[old] for old, new in names.items() if old in values}
    return [PluginOfNode(FakeLocalization, "fake_localization", NodeValues({"base_frame_id": "base_link", **frames}))]


def ekf_plugins(values: Values) -> list[PluginOfNode]:
    """Return the plugin of `ekf_localization_node`."""
    return SERVER_NODES["ekf_node"].plugins(values, {})


def pose_ekf_plugins(values: Values) -> list[PluginOfNode]:
    """Return the plugin of `ekf_node` in place of `robot_pose_ekf`, with odometry and IMU."""
    false = [False] * 15
    result: Values = {
        "two_d_mode": True,
        "frequency": values.get("freq", 30.0),
        "odom_frame": values.get("output_frame", "odom_combined"),
        "base_link_frame": values.get("base_footprint_frame", "base_footprint"),
    }
    if values.get("odom_used", True):
        result |= {"odom0": "odom", "odom0_config": [*false[:6], True, True, False, False, False, True, *false[:3]]}
    if values.get("imu_used", True):
        result |= {"imu0": "imu_data", "imu0_config": [*false[:11], True, *false[:3]]}
    plugins = SERVER_NODES["ekf_node"].plugins(result, {})
    plugins[0].parameters.told.append(
        "the filter of ekf_node replaces that of robot_pose_ekf; visual odometry is not used"
    )
    return plugins


def move_base_plugins(values: Values) -> list[PluginOfNode]:
    """Return the plugins of `move_base`: both costmaps, planner, controller, behaviours and navigator."""
    costmaps = {name: _costmap(block_of(values, name)) for name in _COSTMAPS}
    told = []
    planner = str(values.get("base_global_planner", _PLANNERS[0]))
    if planner not in _PLANNERS:
        told.append(f"the planner {_PLANNERS[0]} replaces {planner}")
    settings = block_of(values, planner.rpartition("/")[2])
    grid_based: Values = {"plugin": "nav2_navfn_planner::NavfnPlanner"}
    _take(settings, ("default_tolerance",), grid_based, "tolerance")
    grid_based |= {name: settings[name] for name in ("allow_unknown",) if name in settings}
    if planner == _PLANNERS[1]:
        grid_based["use_astar"] = not settings.get("use_dijkstra", True)
    planners: Values = {"planner_plugins": ["GridBased"], "GridBased": grid_based}
    name = str(values.get("base_local_planner", "base_local_planner/TrajectoryPlannerROS"))
    told.append(f"the controller RegulatedPurePursuitController replaces {name}")
    local = block_of(values, name.rpartition("/")[2])
    pursuit: Values = {"plugin": "nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController"}
    _take(local, ("max_vel_x", "max_vel_trans"), pursuit, "desired_linear_vel")
    _take(local, ("max_vel_theta", "max_rot_vel", "max_rotational_vel"), pursuit, "rotate_to_heading_angular_vel")
    goal: Values = {"xy_goal_tolerance": 0.1, "yaw_goal_tolerance": 0.05}
    for tolerance in goal:
        _take(local, (tolerance,), goal, tolerance)
    server = SERVER_NODES
    controller: Values = {
        "controller_frequency": values.get("controller_frequency", 20.0),
        "controller_plugins": ["FollowPath"],
        "FollowPath": pursuit,
        "general_goal_checker": goal,
        "goal_checker_plugins": ["general_goal_checker"],
        "failure_tolerance": values.get("controller_patience", 15.0),
    }
    frames: Values = {
        "global_frame": costmaps["global_costmap"]["global_frame"],
        "robot_base_frame": costmaps["global_costmap"]["robot_base_frame"],
    }
    behaviors = {**frames, "global_frame": costmaps["local_costmap"]["global_frame"]}
    plugins = [
        *server["planner_server"].plugins(planners, costmaps["global_costmap"]),
        *server["controller_server"].plugins(controller, costmaps["local_costmap"]),
        *server["behavior_server"].plugins(behaviors, costmaps["local_costmap"]),
        *server["bt_navigator"].plugins(frames, {}),
    ]
    plugins[0].parameters.told += told
    return plugins


_OF_COSTMAP: Final = frozenset(
    ("global_frame", "robot_base_frame", "update_frequency", "publish_frequency", "rolling_window", "width", "height")
) | {"resolution", "origin_x", "origin_y", "robot_radius"}


def _costmap(values: Values) -> Values:
    """Return the parameters of a costmap of Nav2."""
    costmap: Values = {"robot_base_frame": "base_link", "global_frame": "map", "resolution": 0.05}
    costmap |= {name: value for name, value in values.items() if name in _OF_COSTMAP}
    for name in ("global_frame", "robot_base_frame"):
        costmap[name] = str(costmap[name]).lstrip("/")
    if costmap.get("publish_frequency", 0.0) in (0, 0.0):
        costmap["publish_frequency"] = 2.0  # the other servers receive the costmap from its topic
    outline = values.get("footprint")
    if outline and "robot_radius" not in costmap:
        costmap["footprint"] = outline if isinstance(outline, str) else str([list(point) for point in _points(outline)])
    listed = values.get("plugins")
    if isinstance(listed, list):
        layers = [(str(item["name"]), str(item["type"]).rpartition("::")[2]) for item in listed]
    else:  # as before Hydro
        layers = [("obstacle_layer", "ObstacleLayer"), ("inflation_layer", "InflationLayer")]
        if values.get("static_map", not values.get("rolling_window", False)):
            layers.insert(0, ("static_layer", "StaticLayer"))
    costmap["plugins"] = [name for name, _ in layers]
    for name, kind in layers:
        own = {**values, **block_of(values, name)}
        costmap[name] = {"plugin": f"nav2_costmap_2d::{kind}", **_LAYER_SETTINGS.get(kind, _no_settings)(own)}
    return costmap


def _points(outline: object) -> list[list[object]]:
    return [list(point) for point in outline] if isinstance(outline, list) else []


def _no_settings(_: Values) -> Values:
    return {}


def _static(values: Values) -> Values:
    return {"map_topic": values.get("map_topic", "/map")}


def _inflation(values: Values) -> Values:
    return {name: values[name] for name in ("inflation_radius", "cost_scaling_factor") if name in values}


_OF_SOURCE: Final = (
    *("topic", "data_type", "marking", "clearing", "inf_is_valid", "sensor_frame", "observation_persistence"),
    *("expected_update_rate", "min_obstacle_height", "max_obstacle_height"),
)
_OF_LAYER: Final = (
    *("origin_z", "z_resolution", "z_voxels", "unknown_threshold", "mark_threshold", "publish_voxel_map"),
    *("combination_method", "footprint_clearing_enabled", "max_obstacle_height"),
)


def _obstacles(values: Values) -> Values:
    """Return the settings of an obstacle layer: its sources, with the ranges of the layer."""
    sources = str(values.get("observation_sources", "")).split()
    layer: Values = {"observation_sources": sources, **{key: values[key] for key in _OF_LAYER if key in values}}
    for name in sources:
        source = block_of(values, name)
        settings: Values = {"max_obstacle_height": 2.0}  # default of ROS 1
        settings |= {key: source[key] for key in _OF_SOURCE if key in source}
        settings["obstacle_max_range"] = source.get("obstacle_range", values.get("obstacle_range", 2.5))
        settings["raytrace_max_range"] = source.get("raytrace_range", values.get("raytrace_range", 3.0))
        layer[name] = settings
    if not sources:
        layer["enabled"] = False
    return layer


_LAYER_SETTINGS: Final[Mapping[str, Callable[[Values], Values]]] = {
    "StaticLayer": _static,
    "ObstacleLayer": _obstacles,
    "VoxelLayer": _obstacles,
    "InflationLayer": _inflation,
}


def _take(values: Values, names: tuple[str, ...], target: Values, name: str) -> None:
    """Write the first value that there is to another table."""
    value = next((values[each] for each in names if each in values), None)
    if isinstance(value, (int, float)) and value > 0:
        target[name] = float(value)


ROS1_NODES: Final[Mapping[str, Callable[[Values], list[PluginOfNode]]]] = {
    "amcl": amcl_plugins,
    "fake_localization": fake_localization_plugins,
    "ekf_localization_node": ekf_plugins,
    "robot_pose_ekf": pose_ekf_plugins,
    "move_base": move_base_plugins,
}
"""Nodes of ROS 1 whose work plugins do, by the name of their executable."""
