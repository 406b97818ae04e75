"""Parameters of the nodes that make maps: slam_toolbox, and gmapping and cartographer by its names."""

import math
from dataclasses import fields

from node_support import warn

from simkit_navigation.plugins.maps.correlation_matcher import SearchRules
from simkit_navigation.plugins.maps.scan_mapper import MapperSettings
from simkit_navigation.plugins.navigation.node_values import shortened
from simkit_nodes.host import current_host

SETTINGS = {f.name: f.default for kind in (MapperSettings, SearchRules) for f in fields(kind) if f.name != "rules"}
"""Parameters of the mapper."""
DEFAULTS = SETTINGS | {
    "odom_frame": "odom",
    "map_frame": "map",
    "base_frame": "base_footprint",
    "scan_topic": "/scan",
    "mode": "mapping",
    "map_name": "/map",
    "map_file_name": "",
    "map_start_pose": [],
    "map_start_at_dock": False,
    "begin_at_true_pose": False,
    "use_map_saver": True,
    "use_lifecycle_manager": False,
    "throttle_scans": 1,
    "scan_queue_size": 1,
    "minimum_time_interval": 0.5,
    "minimum_travel_distance": 0.5,
    "minimum_travel_heading": 0.5,
    "map_update_interval": 10.0,
    "transform_publish_period": 0.05,
    "transform_timeout": 0.5,
    "tf_buffer_duration": 30.0,
    "position_covariance_scale": 1.0,
    "yaw_covariance_scale": 1.0,
    "enable_interactive_mode": False,
    "paused_new_measurements": False,
    "localization_on_configure": False,
}
"""Parameters of slam_toolbox that have an effect, with the defaults of its sources; begin_at_true_pose is simkit's."""
SILENT = {
    "use_sim_time",
    "solver_plugin",
    "ceres_linear_solver",
    "ceres_preconditioner",
    "ceres_trust_strategy",
    "ceres_dogleg_type",
    "ceres_loss_function",
    "debug_logging",
    "stack_size_to_use",
    "bond_disable_heartbeat_timeout",
    "start_type_description_service",
    "qos_overrides",
}
"""Parameters without an effect that change nothing here: the solver of Ceres, the stack, the heartbeat."""
ABOVE_ZERO = {
    "resolution",
    "max_laser_range",
    "scan_buffer_size",
    "correlation_search_space_dimension",
    "correlation_search_space_resolution",
    "correlation_search_space_smear_deviation",
    "loop_search_space_dimension",
    "loop_search_space_resolution",
    "loop_search_space_smear_deviation",
    "distance_variance_penalty",
    "angle_variance_penalty",
    "fine_search_angle_offset",
    "coarse_search_angle_offset",
    "coarse_angle_resolution",
    "throttle_scans",
    "scan_queue_size",
    "map_update_interval",
    "tf_buffer_duration",
}
"""Parameters that must be above zero; other numbers must not be below it."""
SEARCHES = (
    ("correlation_search_space_dimension", "correlation_search_space_resolution"),
    ("loop_search_space_dimension", "loop_search_space_resolution"),
    ("correlation_search_space_smear_deviation", "correlation_search_space_resolution"),
    ("loop_search_space_smear_deviation", "loop_search_space_resolution"),
    ("coarse_search_angle_offset", "coarse_angle_resolution"),
    ("coarse_angle_resolution", "fine_search_angle_offset"),
)
"""Sizes of searches and their steps."""
MOST_STEPS = 1000.0
LEAST_RESOLUTION = 0.005  # [m]

OF_GMAPPING = {
    "base_frame": "base_frame",
    "odom_frame": "odom_frame",
    "map_frame": "map_frame",
    "delta": "resolution",
    "maxUrange": "max_laser_range",
    "linearUpdate": "minimum_travel_distance",
    "angularUpdate": "minimum_travel_heading",
    "map_update_interval": "map_update_interval",
    "throttle_scans": "throttle_scans",
    "transform_publish_period": "transform_publish_period",
}
"""Parameters of slam_toolbox by those of gmapping."""
DEFAULTS_OF_OTHERS = {
    "gmapping/slam_gmapping": {
        "base_frame": "base_link",
        "scan_topic": "scan",
        "minimum_travel_distance": 1.0,
        "map_update_interval": 5.0,
    },
    "cartographer_ros/cartographer_node": {
        "scan_topic": "scan",
        "minimum_travel_distance": 0.2,
        "minimum_travel_heading": 0.2,
        "map_update_interval": 1.0,
    },
}
"""Defaults that differ from those of slam_toolbox."""
MISSING_OF_OTHERS = {
    "gmapping/slam_gmapping": "entropy is not published, and the parameters of its particles have no effect",
    "cartographer_ros/cartographer_node": (
        "submap_list, submap_query, trajectories and landmarks are not available, and files in Lua are not read"
    ),
}


def values_of(node, executable):
    """Declare the parameters of a node and return their values, each valid; tell those that are not used."""
    values = DEFAULTS | DEFAULTS_OF_OTHERS.get(executable, {})
    if executable.startswith("gmapping/"):
        values |= _of_ros1(node)
    given = set(node.get_parameters_by_prefix(""))
    for name, default in values.items():
        if not node.has_parameter(name):
            node.declare_parameter(name, default)
    valid = {name: _valid(node, name, default, node.get_parameter(name).value) for name, default in values.items()}
    for size, step in SEARCHES:
        if valid[size] > MOST_STEPS * valid[step]:
            _replaced(node, size, valid[size], f"at most {MOST_STEPS:g} times {step}", DEFAULTS[size])
            valid[size], valid[step] = DEFAULTS[size], DEFAULTS[step]
    if valid["resolution"] < LEAST_RESOLUTION:
        default = DEFAULTS["resolution"]
        valid["resolution"] = _replaced(
            node, "resolution", valid["resolution"], f"at least {LEAST_RESOLUTION}", default
        )
    known = set(values) | SILENT | set(OF_GMAPPING if executable.startswith("gmapping/") else ())
    unused = sorted(name for name in given if name.partition(".")[0] not in known)
    if unused:
        warn(node, "SK-NAV-002", f"no effect here: {shortened(unused)}")
    return valid


def settings_of(values):
    """Return the settings of the mapper."""
    rules = SearchRules(**{f.name: values[f.name] for f in fields(SearchRules)})
    return MapperSettings(**{f.name: values[f.name] for f in fields(MapperSettings) if f.name != "rules"}, rules=rules)


def _of_ros1(node):
    """Return the private parameters of a node of ROS 1 with the names of slam_toolbox."""
    server = current_host().graph.shared.get("ROS 1 parameters")
    name = node.get_fully_qualified_name()
    values = server.get(name) if server is not None and server.has(name) else {}
    values |= {name: node.get_parameter(name).value for name in OF_GMAPPING if node.has_parameter(name)}
    return {OF_GMAPPING[name]: value for name, value in values.items() if name in OF_GMAPPING}


def _valid(node, name, default, value):
    """Return a value, or the default in place of an invalid one, which is told."""
    if name == "map_start_pose":
        value = [] if value is None else list(value)
        if len(value) in (0, 3) and all(math.isfinite(number) for number in value):
            return [float(number) for number in value]
        return _replaced(node, name, value, "three finite numbers: x, y [m] and yaw [rad]", default)
    if isinstance(default, bool):
        return value if isinstance(value, bool) else _replaced(node, name, value, "true or false", default)
    if isinstance(default, str):
        is_valid = isinstance(value, str) and (bool(value) or not default)
        return value if is_valid else _replaced(node, name, value, "a text", default)
    least = "above 0" if name in ABOVE_ZERO else "0 or more"
    is_number = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    if not is_number or value < 0 or (value == 0 and name in ABOVE_ZERO):
        return _replaced(node, name, value, f"a number {least}", default)
    return int(value) if isinstance(default, int) else float(value)


def _replaced(node, name, value, expected, default):
    warn(node, "SK-SLAM-001", f"{name} is {value!r}; expected {expected}; the default {default!r} is used")
    return default
