"""Parameters of Nav2's node `controller_server` as parameters of `ControllerServer`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Final

from simkit_navigation.plugins.controllers.controller_server import CONTROLLERS
from simkit_navigation.plugins.controllers.dwb_critics import CRITICS as DWB_CRITICS
from simkit_navigation.plugins.controllers.goal_checkers import GOAL_CHECKERS
from simkit_navigation.plugins.controllers.mppi_critics import CRITICS as MPPI_CRITICS
from simkit_navigation.plugins.controllers.progress_checkers import PROGRESS_CHECKERS
from simkit_navigation.plugins.controllers.rotation_shim import RotationShimOptions

Values = dict[str, object]

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


@dataclass
class ControllerParameters:
    """Parameters of the plugin.

    Attributes:
        values: parameters; blocks are dictionaries.
        blocks: names of blocks that the user has chosen, such as `FollowPath`.
        told: sentences about what differs from the node's parameters.
    """

    values: Values
    blocks: list[str] = field(default_factory=list)
    told: list[str] = field(default_factory=list)


def controller_parameters(
    values: Values, costmap: Values, is_class_of_user: Callable[[object], bool]
) -> ControllerParameters:
    """Return the parameters of the plugin.

    Args:
        values: parameters of the node `controller_server`.
        costmap: parameters of its costmap.
        is_class_of_user: function that checks whether the name of a class may be one of a user.
    """

    def is_known(kind: str) -> bool:
        return kind in CONTROLLERS or (is_class_of_user(kind) and kind not in _OTHERS)

    own: Values = {"robot_base_frame": costmap.get("robot_base_frame", "base_link")}
    own.update({name: costmap[name] for name in _OF_THE_COSTMAP if name in costmap})
    own["inflation_layer"] = _inflation(costmap)
    found = ControllerParameters({**own, **values})
    of_path = _path_handling(found)
    for name in _names(values.get("controller_plugins")):
        found.blocks.append(name)
        found.values[name] = _controller(name, _block(values, name), found, is_known, of_path)
    for what, known, default in _CHECKERS:
        _add_checkers(what, known, default, found)
    return found


def _path_handling(found: ControllerParameters) -> Values:
    """Return the parameters of Rolling's path handler, which belong to the controllers in Humble and Jazzy."""
    values: Values = {}
    for name in _names(found.values.pop("path_handler_plugins", None)):
        block = _block(found.values, name)
        found.values.pop(name, None)
        values = {key: block[key] for key in _OF_PATH_HANDLERS if key in block}
        for key in ("enforce_path_rotation", "reject_unit_path"):
            if block.get(key) is True:
                found.told.append(f"{name}: {key} has no effect")
    return values


def _set_motion_model(settings: Values) -> None:
    """Translate the motion model of Rolling, a block with a class, to the word of Humble and Jazzy."""
    name = str(settings.get("motion_model", ""))
    block = _block(settings, name)
    if block:
        kind = str(block.get("plugin", "")).replace("/", "::").rpartition("::")[2]
        settings["motion_model"] = kind.removesuffix("MotionModel")
        settings.pop(name)
        if "min_turning_r" in block:
            settings["AckermannConstraints"] = {"min_turning_r": block["min_turning_r"]}


def _inflation(costmap: Values) -> Values:
    """Return the parameters of the costmap's inflation layer that the controllers need."""
    for name in _names(costmap.get("plugins")):
        layer = _block(costmap, name)
        if str(layer.get("plugin", "")).endswith("InflationLayer"):
            return {key: layer[key] for key in ("cost_scaling_factor", "inflation_radius") if key in layer}
    return {}


def _controller(
    name: str, settings: Values, found: ControllerParameters, is_known: Callable[[str], bool], of_path: Values
) -> Values:
    """Return the block of a controller; the nearest class replaces one that simkit does not have."""
    kind = str(settings.get("plugin", "")).replace("/", "::")
    if kind == _SHIM:
        primary = str(settings.get("primary_controller", "")).replace("/", "::")
        if not is_known(primary):
            found.told.append(f"{name}: the primary controller {_PURSUIT} replaces {primary}")
            own = {key: value for key, value in settings.items() if key in _OF_THE_SHIM}
            return {**own, **_pursuit_settings(settings), "plugin": _SHIM, "primary_controller": _PURSUIT}
        kind = primary
    elif kind and not is_known(kind):
        found.told.append(f"{name}: the controller {_PURSUIT} replaces {kind}")
        return _pursuit_settings(settings)
    if kind == _MPPI:
        settings.update({key: value for key, value in of_path.items() if key not in settings})
        _set_motion_model(settings)
    if kind in (_MPPI, _DWB):
        settings["critics"] = _critics(name, kind, settings, found)
    return settings


def _critics(name: str, kind: str, settings: Values, found: ControllerParameters) -> list[str]:
    """Return the critics that simkit has."""
    kept = []
    for critic in _names(settings.get("critics")):
        wanted = str(_block(settings, critic).get("class", critic)).replace("/", "::").rpartition("::")[2]
        wanted += "Critic" if kind == _DWB and "Critic" not in wanted else ""
        if wanted in (DWB_CRITICS if kind == _DWB else MPPI_CRITICS):
            kept.append(critic)
            found.blocks.append(critic)
        else:
            found.told.append(f"{name}: the critic {critic} is left out")
            settings.pop(critic, None)
    return kept


def _add_checkers(what: str, known: Mapping[str, object], default: str, found: ControllerParameters) -> None:
    """Set the list and the blocks of the checkers; before Iron, one name was in a parameter without an s."""
    values = found.values
    lists = [_names(values.pop(key, None)) for key in (f"{what}_plugins", f"{what}_plugin")]
    names = lists[0] or lists[1] or [what]
    for name in names:
        settings = _block(values, name)
        kind = str(settings.get("plugin", default)).replace("/", "::")
        if kind not in known:
            found.told.append(f"{name}: the checker {default} replaces {kind}")
            kind = default
        values[name] = {**settings, "plugin": kind}
    values[f"{what}_plugins"] = names
    found.blocks += names


def _pursuit_settings(settings: Values) -> Values:
    """Return the settings of pure pursuit with the speeds of another controller."""
    speed = next((settings[name] for name in _SPEEDS if name in settings), None)
    rate = next((settings[name] for name in _TURNING_RATES if name in settings), None)
    found: Values = {"plugin": _PURSUIT}
    if isinstance(speed, (int, float)) and speed > 0:
        found["desired_linear_vel"] = speed
    if isinstance(rate, (int, float)) and rate > 0:
        found["rotate_to_heading_angular_vel"] = rate
    return found


def _names(value: object) -> list[str]:
    """Return the names in a list, or in a text with spaces."""
    if isinstance(value, (list, tuple)):
        return [str(item) for item in value if str(item)]
    return value.split() if isinstance(value, str) else []


def _block(values: Mapping[str, object], name: str) -> Values:
    """Return a block as a dictionary that may be changed."""
    block = values.get(name)
    return dict(block) if isinstance(block, dict) else {}
