"""Commands that start a simulator, such as `gz sim -r world.sdf`: simkit takes their place and opens the world."""

from __future__ import annotations

import re
import shlex
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import PurePath
from typing import Final

from simkit_launch.launch_plan import LaunchedProcess

_PROGRAMS: Final = {"gazebo", "gzserver", "gz-sim-server", "gz-sim", "ign-gazebo-server"}
_CLIENTS: Final = {"gzclient", "gz-sim-gui", "ign-gazebo-gui"}
_SUBCOMMANDS: Final = {"gz": "sim", "ign": "gazebo"}
_PACKAGES: Final = {
    "gazebo_ros": {"gazebo", "gzserver", "debug", "perf", "gdbrun"},
    "ros_gz_sim": {"gzserver"},
}
_WITH_VALUE: Final = re.compile(
    "-[vzesgoip]|--(iter(ation)?s|physics(-engine)?|render-engine(-server|-gui)?|gui-config|record[-_]"
    "(path|topic|filter|period|encoding)|playback|play|network-(role|secondaries)|seed|server-plugin|gui-(client-)?plugin"
    "|profile|force-version|initial-sim-time)"
)
"""Options of Gazebo and Gazebo classic whose value is the next word."""
_OPTIONAL_VALUE: Final = {"-v": "[0-4]", "-s": r"\S+\.so", "-g": r"\S+\.so", "-p": r"\S+", "-i": r"\S+"}
"""Options whose value is missing in some programs: gz's `-s` is a flag, that of Gazebo classic names a plugin."""


@dataclass(frozen=True)
class SimulatorCommand:
    """Command that starts a simulator.

    Attributes:
        world: file or name of the world; empty for none.
        is_client: True for a window alone, which opens no world.
        waits: True if the simulator starts paused.
        seed: seed of its random numbers; None for none.
    """

    world: str = ""
    is_client: bool = False
    waits: bool = False
    seed: int | None = None


def simulator_command(process: LaunchedProcess) -> SimulatorCommand | None:
    """Return what a process says to a simulator; None for a process that starts none."""
    words = [word for argument in process.arguments for word in _split(argument)]
    if process.kind in ("node", "component"):
        return _of_node(process, words)
    if process.kind != "command":
        return None
    program = PurePath(words[0]).name if words else ""
    if program in _CLIENTS:
        return SimulatorCommand(is_client=True)
    if program in _SUBCOMMANDS and words[1:2] == [_SUBCOMMANDS[program]]:
        return _parsed(words[2:], is_classic=False)
    if program in _PROGRAMS:
        return _parsed(words[1:], is_classic="sim" not in program and "ign" not in program)
    return None


def _of_node(process: LaunchedProcess, words: Sequence[str]) -> SimulatorCommand | None:
    """Return the command of a node that is a simulator, or the window of one."""
    executable = process.executable.rpartition("::")[2].lower()
    if process.package == "gazebo_ros" and executable == "gzclient":
        return SimulatorCommand(is_client=True)
    if executable not in _PACKAGES.get(process.package, ()):
        return None
    command = _parsed(words, is_classic=process.package == "gazebo_ros")
    values = {k: v for table in process.parameters if not isinstance(table, PurePath) for k, v in table.items()}
    world = str(values.get("world_sdf_file") or values.get("world_sdf_string") or "")
    return SimulatorCommand(world, seed=command.seed) if world else command


def _split(argument: str) -> list[str]:
    """Return the words of an argument: launch files give several options as one text."""
    try:
        return shlex.split(argument)
    except ValueError:
        return argument.split()


def _parsed(words: Sequence[str], *, is_classic: bool) -> SimulatorCommand:
    world, seed, waits, is_client = "", None, not is_classic, False
    rest = _without_ros_arguments(words)
    while rest:
        word = rest.pop(0)
        if not word.startswith("-"):
            world = world or word
            continue
        name, equals, value = word.partition("=")
        if _WITH_VALUE.fullmatch(name) and not equals and rest:
            pattern = _OPTIONAL_VALUE.get(name)
            if pattern is None or (re.fullmatch(pattern, rest[0]) and not _is_world(rest[0])):
                value = rest.pop(0)
        if name == "--seed" and value.isdigit():
            seed = int(value)
        flags = set(name[1:]) if re.fullmatch("-[rsguv0-4]+", name) else set()
        if not is_classic:
            waits = waits and "r" not in flags
            is_client = is_client or name == "-g"
        else:
            waits = waits or name in ("-u", "--pause")
    return SimulatorCommand(world, is_client and not world, waits, seed)


def _without_ros_arguments(words: Sequence[str]) -> list[str]:
    """Return the words that are not between `--ros-args` and `--` or the end of the command."""
    kept, is_kept = [], True
    for word in words:
        if word == "--ros-args":
            is_kept = False
        elif not is_kept and word == "--":
            is_kept = True
        elif is_kept:
            kept.append(word)
    return kept


def _is_world(word: str) -> bool:
    return PurePath(word).suffix in (".sdf", ".world", ".xml")
