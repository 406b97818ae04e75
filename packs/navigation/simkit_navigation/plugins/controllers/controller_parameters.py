"""Parameters of Nav2's node `controller_server` as parameters of `ControllerServer`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from simkit_navigation.plugins.controllers.dwb_critics import CRITICS as DWB_CRITICS
from simkit_navigation.plugins.controllers.goal_checkers import GOAL_CHECKERS
from simkit_navigation.plugins.controllers.mppi_critics import CRITICS as MPPI_CRITICS
from simkit_navigation.plugins.controllers.progress_checkers import PROGRESS_CHECKERS
from simkit_navigation.plugins.controllers.rotation_shim import CONTROLLERS, RotationShimOptions
from simkit_navigation.plugins.navigation.node_values import NodeValues, Values, block_of, is_class_of_user, names_of

_PURSUIT: Final = "nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController"
_SHIM: Final = "nav2_rotation_shim_controller::RotationShimController"
_MPPI: Final = "nav2_mppi_controller::MPPIController"
_DWB: Final = "dwb_core::DWBLocalPlanner"
_OTHERS: Final = frozenset(
    ("teb_local_planner::TebLocalPlannerROS", "vector_pursuit_controller::VectorPursuitController")
)
"""Controllers of other packages that pure pursuit replaces."""
_SPEEDS: Final = ("desired_linear_vel", "max_vel_x", "vx_max", "max_linear_vel", "v_linear_max")
_TURNING_RATES: Final = (
    "rotate_to_heading_angular_vel", "max_vel_theta", "wz_max", "max_angular_vel", "v_angular_max"
)  # fmt: skip
_CHECKERS: Final = (
    ("goal_checker", GOAL_CHECKERS, "nav2_controller::SimpleGoalChecker"),
    ("progress_checker", PROGRESS_CHECKERS, "nav2_controller::SimpleProgressChecker"),
)
_OF_PATH_HANDLERS: Final = (
    "prune_distance",
    "max_robot_pose_search_dist",
    "enforce_path_inversion",
    "inversion_xy_tolerance",
    "inversion_yaw_tolerance",
)
_OF_THE_SHIM: Final = frozenset(RotationShimOptions.element_names())
_OF_THE_COSTMAP: Final = ("robot_radius", "footprint", "track_unknown_space")


def controller_parameters(values: Values, costmap: Values) -> NodeValues:
    """Return the parameters of the plugin.

    Args:
        values: parameters of the node `controller_server`.
        costmap: parameters of its costmap.
    """
    own: Values = {"robot_base_frame": costmap.get("robot_base_frame", "base_link")}
    own.update({name: costmap[name] for name in _OF_THE_COSTMAP if name in costmap})
    own["inflation_layer"] = _inflation(costmap)
    result = NodeValues({**own, **values})
    of_path = _path_handling(result)
    for name in names_of(values.get("controller_plugins")):
        result.blocks.append(name)
        result.values[name] = _controller(name, block_of(values, name), result, of_path)
    for what, known, default in _CHECKERS:
        _add_checkers(what, known, default, result)
    return result


def _path_handling(result: NodeValues) -> Values:
    """Return the parameters of Rolling's path handler, which belong to the controllers in Humble and Jazzy."""
    values: Values = {}
    for name in names_of(result.values.pop("path_handler_plugins", None)):
        block = block_of(result.values, name)
        result.values.pop(name, None)
        values = {key: block[key] for key in _OF_PATH_HANDLERS if key in block}
        for key in ("enforce_path_rotation", "reject_unit_path"):
            if block.get(key) is True:
                result.told.append(f"{name}: {key} has no effect")
    return values


def _set_motion_model(settings: Values) -> None:
    """Translate the motion model of Rolling, a block with a class, to the word of Humble and Jazzy."""
    name = str(settings.get("motion_model", ""))
    block = block_of(settings, name)
    if block:
        kind = str(block.get("plugin", "")).replace("/", "::").rpartition("::")[2]
        settings["motion_model"] = kind.removesuffix("MotionModel")
        settings.pop(name)
        if "min_turning_r" in block:
            settings["AckermannConstraints"] = {"min_turning_r": block["min_turning_r"]}


def _inflation(costmap: Values) -> Values:
    """Return the parameters of the costmap's inflation layer that the controllers need."""
    for name in names_of(costmap.get("plugins")):
        layer = block_of(costmap, name)
        if str(layer.get("plugin", "")).endswith("InflationLayer"):
            return {key: layer[key] for key in ("cost_scaling_factor", "inflation_radius") if key in layer}
    return {}


def _is_known(kind: str) -> bool:
    return kind in CONTROLLERS or (is_class_of_user(kind) and kind not in _OTHERS)


def _controller(name: str, settings: Values, result: NodeValues, of_path: Values) -> Values:
    """Return the block of a controller; the nearest class replaces one that simkit does not have."""
    kind = str(settings.get("plugin", "")).replace("/", "::")
    if kind == _SHIM:
        primary = str(settings.get("primary_controller", "")).replace("/", "::")
        if not _is_known(primary):
            result.told.append(f"{name}: the primary controller {_PURSUIT} replaces {primary}")
            own = {key: value for key, value in settings.items() if key in _OF_THE_SHIM}
            return {**own, **_pursuit_settings(settings), "plugin": _SHIM, "primary_controller": _PURSUIT}
        kind = primary
    elif kind and not _is_known(kind):
        result.told.append(f"{name}: the controller {_PURSUIT} replaces {kind}")
        return _pursuit_settings(settings)
    if kind == _MPPI:
        settings.update({key: value for key, value in of_path.items() if key not in settings})
        _set_motion_model(settings)
    if kind in (_MPPI, _DWB):
        settings["critics"] = _critics(name, kind, settings, result)
    return settings


def _critics(name: str, kind: str, settings: Values, result: NodeValues) -> list[str]:
    """Return the critics that simkit has."""
    kept = []
    for critic in names_of(settings.get("critics")):
        wanted = str(block_of(settings, critic).get("class", critic)).replace("/", "::").rpartition("::")[2]
        wanted += "Critic" if kind == _DWB and "Critic" not in wanted else ""
        if wanted in (DWB_CRITICS if kind == _DWB else MPPI_CRITICS):
            kept.append(critic)
            result.blocks.append(critic)
        else:
            result.told.append(f"{name}: the critic {critic} is left out")
            settings.pop(critic, None)
    return kept


def _add_checkers(what: str, known: Mapping[str, object], default: str, result: NodeValues) -> None:
    """Set the list and the blocks of the checkers; before Iron, one name was in a parameter without an s."""
    values = result.values
    lists = [names_of(values.pop(key, None)) for key in (f"{what}_plugins", f"{what}_plugin")]
    names = lists[0] or lists[1] or [what]
    for name in names:
        settings = block_of(values, name)
        kind = str(settings.get("plugin", default)).replace("/", "::")
        if kind not in known:
            result.told.append(f"{name}: the checker {default} replaces {kind}")
            kind = default
        values[name] = {**settings, "plugin": kind}
    values[f"{what}_plugins"] = names
    result.blocks += names


def _pursuit_settings(settings: Values) -> Values:
    """Return the settings of pure pursuit with the speeds of another controller."""
    speed = next((settings[name] for name in _SPEEDS if name in settings), None)
    rate = next((settings[name] for name in _TURNING_RATES if name in settings), None)
    pursuit: Values = {"plugin": _PURSUIT}
    if isinstance(speed, (int, float)) and speed > 0:
        pursuit["desired_linear_vel"] = speed
    if isinstance(rate, (int, float)) and rate > 0:
        pursuit["rotate_to_heading_angular_vel"] = rate
    return pursuit
