"""Actions for nodes."""

from __future__ import annotations

from simkit_launch.launch_modules.launch_ros.actions.lifecycle_node import LifecycleNode, LifecycleTransition
from simkit_launch.launch_modules.launch_ros.actions.node import ComposableNodeContainer, LoadComposableNodes, Node
from simkit_launch.launch_modules.launch_ros.actions.set_parameter import (
    PushROSNamespace,
    PushRosNamespace,
    ROSTimer,
    RosTimer,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    SetUseSimTime,
)

__all__ = [
    "ComposableNodeContainer",
    "LifecycleNode",
    "LifecycleTransition",
    "LoadComposableNodes",
    "Node",
    "PushROSNamespace",
    "PushRosNamespace",
    "ROSTimer",
    "RosTimer",
    "SetParameter",
    "SetParametersFromFile",
    "SetROSLogDir",
    "SetRemap",
    "SetUseSimTime",
]
