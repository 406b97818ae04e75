"""Parameters of a node as values and as elements of the plugin that does its work."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from simkit import Params, Plugin
from simkit.extend import Diagnostics, Where
from simkit.plugins.unread_parameters import names_read

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
_OF_ALL_NODES: Final = frozenset(
    (
        *("use_sim_time", "qos_overrides", "bond_heartbeat_period", "use_realtime_priority"),
        *("introspection_mode", "service_introspection_mode", "allow_parameter_qos_overrides"),
        *("action_server_result_timeout", "enable_groot_monitoring", "groot_zmq_publisher_port"),
        "groot_zmq_server_port",
    )
)
"""Parameters of nodes that change nothing here and need no warning."""


@dataclass
class NodeValues:
    """Parameters of a node in the form that a plugin reads.

    Attributes:
        values: parameters; blocks are dictionaries.
        blocks: names of blocks that the user has chosen, such as `FollowPath`.
        told: sentences about what differs from the node's parameters.
    """

    values: Values
    blocks: list[str] = field(default_factory=list)
    told: list[str] = field(default_factory=list)

    def elements(
        self, kind: type[Plugin], places: Places, unused: list[str], diagnostics: Diagnostics | None = None
    ) -> Params:
        """Return the parameters as elements.

        Args:
            kind: class of the plugin.
            places: places of the values by their names in the files.
            unused: list to which the names of parameters without an effect are added.
            diagnostics: collector of the problems with the values.
        """
        names = {part for name in names_read(kind) for part in name.split(".")} | set(self.blocks)
        root = Params("plugin", diagnostics=diagnostics)
        root.where = next(iter(places.values()), Where())
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


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return " ".join(map(_text, value)) if isinstance(value, (list, tuple)) else str(value)


def is_class_of_user(kind: object) -> bool:
    """Check whether the class of a block may be one that a user has written: its parameters are not known here."""
    name = str(kind or "").replace("/", "::")
    return name in _TUTORIAL_CLASSES or (bool(name) and not name.startswith(_PREFIXES_OF_NAV2))


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


def block_of(values: Mapping[str, object], name: str) -> Values:
    """Return a copy of a block; an empty one if there is none."""
    block = values.get(name)
    return dict(block) if isinstance(block, dict) else {}


def names_of(value: object) -> list[str]:
    """Return the names in a list, or in a text with spaces."""
    if isinstance(value, (list, tuple)):
        return [str(item) for item in value if str(item)]
    return value.split() if isinstance(value, str) else []


def split_names(texts: Iterable[str]) -> list[str]:
    """Return the names in repeated elements; an element may contain several names."""
    return [name for text in texts for name in text.replace(",", " ").split()]


def shortened(names: Sequence[str]) -> str:
    """Return a list of names as text; of a long list, the first twelve and the number of the others."""
    return ", ".join(names[:12]) + (f" and {len(names) - 12} others" if len(names) > 12 else "")
