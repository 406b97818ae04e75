"""Substitutions: texts that are known only while the launch file is executed."""

from __future__ import annotations

from simkit_launch.launch_modules.launch.substitutions.boolean_substitution import (
    AllSubstitution,
    AndSubstitution,
    AnySubstitution,
    EqualsSubstitution,
    IfElseSubstitution,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
)
from simkit_launch.launch_modules.launch.substitutions.command import Command
from simkit_launch.launch_modules.launch.substitutions.launch_configuration import (
    EnvironmentVariable,
    LaunchConfiguration,
    LocalSubstitution,
)
from simkit_launch.launch_modules.launch.substitutions.path_join_substitution import (
    PathJoinSubstitution,
    PathSubstitution,
    StringJoinSubstitution,
)
from simkit_launch.launch_modules.launch.substitutions.python_expression import PythonExpression
from simkit_launch.launch_modules.launch.substitutions.substitution_failure import SubstitutionFailure
from simkit_launch.launch_modules.launch.substitutions.text_substitution import TextSubstitution
from simkit_launch.launch_modules.launch.substitutions.this_launch_file import (
    AnonName,
    FileContent,
    FindExecutable,
    LaunchLogDir,
    ThisLaunchFile,
    ThisLaunchFileDir,
)

__all__ = [
    "AllSubstitution",
    "AndSubstitution",
    "AnonName",
    "AnySubstitution",
    "Command",
    "EnvironmentVariable",
    "EqualsSubstitution",
    "FileContent",
    "FindExecutable",
    "IfElseSubstitution",
    "LaunchConfiguration",
    "LaunchLogDir",
    "LocalSubstitution",
    "NotEqualsSubstitution",
    "NotSubstitution",
    "OrSubstitution",
    "PathJoinSubstitution",
    "PathSubstitution",
    "PythonExpression",
    "StringJoinSubstitution",
    "SubstitutionFailure",
    "TextSubstitution",
    "ThisLaunchFile",
    "ThisLaunchFileDir",
]
