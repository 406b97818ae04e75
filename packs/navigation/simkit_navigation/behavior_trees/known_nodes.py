"""Names of the nodes that a tree may have, and of those that simkit leaves out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from simkit_navigation.behavior_trees.action_nodes import ACTION_NODES
from simkit_navigation.behavior_trees.condition_nodes import CONDITION_NODES
from simkit_navigation.behavior_trees.control_nodes import CONTROL_NODES
from simkit_navigation.behavior_trees.decorator_nodes import DECORATOR_NODES
from simkit_navigation.behavior_trees.path_nodes import PATH_NODES
from simkit_navigation.behavior_trees.service_nodes import SERVICE_NODES
from simkit_navigation.behavior_trees.tree_node import TreeNode

NODES: Final[Mapping[str, type[TreeNode]]] = {
    **CONTROL_NODES,
    **DECORATOR_NODES,
    **CONDITION_NODES,
    **ACTION_NODES,
    **SERVICE_NODES,
    **PATH_NODES,
}
"""Classes by their name in a file."""

SUBTREES: Final = ("SubTree", "SubTreePlus")
"""Elements in whose place another tree is executed."""

_DOCKING: Final = "robots do not dock"
_ROUTES: Final = "there are no routes on a graph"
_FOLLOWING: Final = "robots do not follow objects"

LEFT_OUT: Final[Mapping[str, str]] = {
    "DockRobot": _DOCKING,
    "UndockRobot": _DOCKING,
    "CancelDockRobot": _DOCKING,
    "CancelUndockRobot": _DOCKING,
    "ComputeRoute": _ROUTES,
    "ComputeAndTrackRoute": _ROUTES,
    "CancelComputeAndTrackRoute": _ROUTES,
    "ExtractRouteNodesAsGoals": _ROUTES,
    "FollowObject": _FOLLOWING,
    "CancelFollowObject": _FOLLOWING,
    "PauseResumeController": "a tree is not paused by services",
    "TryCatch": "there is no node with this name yet",
    "LoopInt": "there are no queues on the blackboard",
    "LoopDouble": "there are no queues on the blackboard",
    "LoopString": "there are no queues on the blackboard",
    "LoopBool": "there are no queues on the blackboard",
}
"""Nodes of Nav2 and BehaviorTree.CPP that simkit does not have, with the reason."""
