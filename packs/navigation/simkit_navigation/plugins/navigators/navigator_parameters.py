"""Parameters of Nav2's nodes `behavior_server` and `bt_navigator` as parameters of their plugins."""

from __future__ import annotations

import re
from typing import Final

from simkit_navigation.plugins.navigation.node_values import NodeValues, Values, names_of

_BEHAVIORS: Final = frozenset(("spin", "backup", "driveonheading", "wait", "assistedteleop"))
_NAVIGATORS: Final = (
    "NavigateToPoseNavigator",
    "NavigateThroughPosesNavigator",
    "navigate_to_pose",
    "navigate_through_poses",
)
_TREE_LIBRARY: Final = re.compile(r"nav2_\w+_(bt_node|condition)")
_RENAMED: Final = {"global_frame": "local_frame", "local_costmap_topic": "costmap_topic"}
"""Names of Jazzy by those of Humble."""


def behavior_parameters(values: Values, costmap: Values) -> NodeValues:
    """Return the parameters of `BehaviorServer`.

    Args:
        values: parameters of the node `behavior_server`.
        costmap: parameters of the local costmap, which has the outline of the robot.
    """
    outline = {name: value for name, value in costmap.items() if name in ("robot_radius", "footprint")}
    own = {new: values[old] for old, new in _RENAMED.items() if old in values and new not in values}
    rest = {name: value for name, value in values.items() if name not in _RENAMED}
    result = NodeValues({**outline, **own, **rest})
    lists = [result.values.pop(key, None) for key in ("behavior_plugins", "recovery_plugins")]
    for name in (name for value in lists for name in names_of(value)):
        kind = _pop_class(result.values, name)
        if _last_word(kind).replace("_", "").lower() not in _BEHAVIORS:
            result.told.append(f"there is no behaviour {name} ({kind})")
    return result


def navigator_parameters(values: Values) -> NodeValues:
    """Return the parameters of `BtNavigator`.

    Args:
        values: parameters of the node `bt_navigator`.
    """
    result = NodeValues({"robot_base_frame": "base_link", **values})
    for name in names_of(result.values.pop("navigators", None)):
        kind = _pop_class(result.values, name)
        if _last_word(kind) not in _NAVIGATORS and name not in _NAVIGATORS:
            result.told.append(f"there is no navigator {name} ({kind})")
    libraries = names_of(result.values.pop("plugin_lib_names", None))
    unknown = [name for name in libraries if not _TREE_LIBRARY.fullmatch(name)]
    if unknown:
        result.told.append(f"the nodes of the C++ libraries {', '.join(unknown)} are not available in behaviour trees")
    return result


def _pop_class(values: Values, name: str) -> str:
    """Remove the block of a name, and return the class in it; the name itself without a class."""
    block = values.pop(name, None)
    return str(block.get("plugin", name) if isinstance(block, dict) else name)


def _last_word(kind: str) -> str:
    """Return the name of a class without its package."""
    return re.split(r"::|/", kind)[-1]
