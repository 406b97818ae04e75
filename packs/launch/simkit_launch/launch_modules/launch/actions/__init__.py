"""Actions: what a launch file does."""

from __future__ import annotations

from simkit_launch.launch_modules.launch.actions.declare_launch_argument import (
    DeclareLaunchArgument,
    PopLaunchConfigurations,
    PushLaunchConfigurations,
    ResetLaunchConfigurations,
    SetLaunchConfiguration,
    UnsetLaunchConfiguration,
)
from simkit_launch.launch_modules.launch.actions.emit_event import (
    EmitEvent,
    Log,
    LogDebug,
    LogError,
    LogInfo,
    LogWarning,
    RegisterEventHandler,
    Shutdown,
    UnregisterEventHandler,
)
from simkit_launch.launch_modules.launch.actions.execute_process import ExecuteLocal, ExecuteProcess
from simkit_launch.launch_modules.launch.actions.group_action import (
    ForEach,
    ForLoop,
    GroupAction,
    IncludeLaunchDescription,
    OpaqueCoroutine,
    OpaqueFunction,
    TimerAction,
)
from simkit_launch.launch_modules.launch.actions.set_environment_variable import (
    AppendEnvironmentVariable,
    PopEnvironment,
    PushEnvironment,
    ResetEnvironment,
    SetEnvironmentVariable,
    UnsetEnvironmentVariable,
)

__all__ = [
    "AppendEnvironmentVariable",
    "DeclareLaunchArgument",
    "EmitEvent",
    "ExecuteLocal",
    "ExecuteProcess",
    "ForEach",
    "ForLoop",
    "GroupAction",
    "IncludeLaunchDescription",
    "Log",
    "LogDebug",
    "LogError",
    "LogInfo",
    "LogWarning",
    "OpaqueCoroutine",
    "OpaqueFunction",
    "PopEnvironment",
    "PopLaunchConfigurations",
    "PushEnvironment",
    "PushLaunchConfigurations",
    "RegisterEventHandler",
    "ResetEnvironment",
    "ResetLaunchConfigurations",
    "SetEnvironmentVariable",
    "SetLaunchConfiguration",
    "Shutdown",
    "TimerAction",
    "UnregisterEventHandler",
    "UnsetEnvironmentVariable",
    "UnsetLaunchConfiguration",
]
