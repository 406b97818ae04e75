"""Spawning of models by known programs: command lines in the manner of gflags, and the reasons of failures."""

from __future__ import annotations

import os
import re
from argparse import ArgumentParser, Namespace
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

from simkit import Pose
from simkit.errors import SimkitError
from simkit.input_file import read_input_text

if TYPE_CHECKING:
    from simkit import Simulation

POSE_FLAGS: Final = ("x", "y", "z", "R", "P", "Y")
"""Names of the options for a pose: position [m], then roll, pitch and yaw [rad]."""

_TEXTS: Final = ("world", "file", "param", "string", "topic", "name")
CREATE_FLAGS: Final = {**dict.fromkeys(_TEXTS, ""), "allow_renaming": False, **dict.fromkeys(POSE_FLAGS, 0.0)}
"""Options of `ros_gz_sim create` with their default values."""

LOADED_MODEL: Final = "SIMKIT_LOADED_MODEL"
"""Variable of the environment with the name of a model that the run has loaded with its world for this program."""

_TRUE: Final = frozenset(("true", "t", "1", "yes", "y"))
_ROS_CONTROL: Final = re.compile(r"(<plugin\b[^>]*\blibgazebo_ros_control\b[^>]*?)(?:/>|>(.*?)</plugin\s*>)", re.DOTALL)


class FlagError(ValueError):
    """Command line that a program does not accept."""


class SpawnError(Exception):
    """Model that cannot be spawned; the text says why."""


def parse_flags(words: Sequence[str], defaults: Mapping[str, object]) -> dict[str, str | float | bool]:
    """Return the values of options that may be written `-x 1`, `--x 1` or `-x=1`; other words are left out.

    Args:
        words: words of the command line without the name of the program and the arguments for ROS.
        defaults: default values by name; their types are those of the options.

    Raises:
        FlagError: an option is unknown, lacks its value, or has a value of another type.
    """
    values = dict(defaults)
    rest = list(words)
    while rest:
        word = rest.pop(0)
        if not word.startswith("-") or word in ("-", "--") or _is_number(word):
            continue
        name, equals, text = word.lstrip("-").partition("=")
        if name.startswith("no") and isinstance(values.get(name[2:]), bool) and not equals:
            values[name[2:]] = False
            continue
        if name not in values:
            raise FlagError(f"unknown command line flag '{name}'; known: {', '.join(f'-{each}' for each in values)}")
        if isinstance(values[name], bool):
            values[name] = text.lower() in _TRUE if equals else True
            continue
        if not equals:
            if not rest:
                raise FlagError(f"flag '-{name}' is missing its argument")
            text = rest.pop(0)
        values[name] = text if isinstance(values[name], str) else _number(name, text)
    return values  # type: ignore[return-value]  # the values have the types of the defaults


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _number(name: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise FlagError(f"illegal value '{text}' specified for the number '-{name}'") from None


def pose_of(values: Mapping[str, object]) -> Pose:
    """Return the pose of the options `POSE_FLAGS`."""
    x, y, z, roll, pitch, yaw = (float(str(values[name])) for name in POSE_FLAGS)
    return Pose.from_rpy(x, y, z, roll, pitch, yaw)


def spawn_model(
    sim: Simulation, source: str, name: str, pose: Pose | None, *, may_rename: bool = False, namespace: str = ""
) -> str:
    """Spawn a model; return its name.

    Args:
        sim: simulation.
        source: XML text, file or URI.
        name: name of the model; empty for the name in the source.
        pose: pose in the world; None for the pose in the source.
        may_rename: True to append a number to a name that is in use, as Gazebo does.
        namespace: namespace of the model's plugins; empty for their own.

    Raises:
        SpawnError: the model cannot be spawned.
    """
    if name and name == os.environ.get(LOADED_MODEL) and name in sim.models:
        return name
    if namespace:
        try:
            source = with_namespace(source, namespace)
        except OSError as error:
            raise SpawnError(f"{source}: cannot be read: {error.strerror}") from None
    elif not _is_text(source):
        source = source.removeprefix("file://")
    try:
        name = name or sim.contents.name_in_file(source)
        if name in sim.models and may_rename:
            name = next(free for number in range(10**9) if (free := f"{name}_{number}") not in sim.models)
        if name in sim.models:
            raise SpawnError(f"a model {name!r} already exists")
        return sim.spawn(source, name, pose).name
    except SimkitError as error:
        raise SpawnError(str(error)) from error


def with_namespace(source: str, namespace: str) -> str:
    """Return the text of a model whose plugins have a namespace.

    ROS 1 gives the namespace of the spawner also if it is `/`; only the plugin of ros_control would have another one
    without it, the name of the model.

    Args:
        source: XML text or file.
        namespace: namespace, with or without slashes around it.

    Raises:
        OSError: the file cannot be read.
    """
    from simkit.plugins.world.service_entities import add_namespace

    if not namespace.strip("/"):
        return _ROS_CONTROL.sub(_in_root_namespace, source) if _is_text(source) else source
    text = source if _is_text(source) else read_input_text(source.removeprefix("file://"))
    return add_namespace(text, namespace.strip("/"))


def _in_root_namespace(plugin: re.Match[str]) -> str:
    content = plugin[2] or ""
    if "<robotNamespace" not in content:
        content = f"<robotNamespace>/</robotNamespace>{content}"
    return f"{plugin[1]}>{content}</plugin>"


def _is_text(source: str) -> bool:
    return source.lstrip("\ufeff \t\r\n").startswith("<")


# ---------------------------------------------------------------------- Gazebo Classic


def add_entity_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of `spawn_entity.py` for the model."""
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("-file")
    source.add_argument("-topic")
    source.add_argument("-database")
    source.add_argument("-stdin", action="store_true")
    parser.add_argument("-entity", required=True)


def add_model_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of ROS 1's `spawn_model` for the model."""
    kind = parser.add_mutually_exclusive_group(required=True)
    for name in ("urdf", "sdf", "gazebo"):
        kind.add_argument(f"-{name}", action="store_true")
    source = parser.add_mutually_exclusive_group(required=True)
    for name in ("file", "param", "database"):
        source.add_argument(f"-{name}")
    source.add_argument("-stdin", action="store_true")
    parser.add_argument("-model", required=True)


def add_spawn_arguments(parser: ArgumentParser) -> None:
    """Add the arguments that `spawn_entity.py` and ROS 1's `spawn_model` share."""
    for name in ("reference_frame", "gazebo_namespace", "robot_namespace", "wait"):
        parser.add_argument(f"-{name}", default="")
    for name in POSE_FLAGS:
        parser.add_argument(f"-{name}", type=float, default=0.0)
    parser.add_argument("-J", dest="joints", default=[], action="append", nargs=2)
    for name in ("unpause", "package_to_model"):
        parser.add_argument(f"-{name}", action="store_true")
    parser.add_argument("-b", dest="bond", action="store_true")


def spawn_with(sim: Simulation, given: Namespace, source: str, name: str) -> str:
    """Spawn a model with the arguments of `add_spawn_arguments`; return its name.

    Raises:
        SpawnError: the model cannot be spawned.
    """
    from simkit.plugins.world.service_entities import RequestRefused, frame_of

    pose = pose_of(vars(given))
    try:
        pose = frame_of(sim, given.reference_frame) @ pose
    except RequestRefused as error:
        raise SpawnError(str(error)) from None
    return spawn_model(sim, source, name, pose, namespace=given.robot_namespace)


def set_joints(sim: Simulation, model: str, joints: Sequence[Sequence[str]]) -> None:
    """Set the positions of joints of a model.

    Args:
        sim: simulation.
        model: name of the model.
        joints: pairs of a name and a text with a position [rad or m].

    Raises:
        SpawnError: a joint does not exist, or a position is no number.
    """
    try:
        positions = {name: float(text) for name, text in joints}
        if positions:
            sim.model(model).set_joint_positions(positions)
    except (KeyError, ValueError, SimkitError) as error:
        raise SpawnError(f"the joints cannot be set: {error}") from None
