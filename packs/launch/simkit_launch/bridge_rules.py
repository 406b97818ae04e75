"""Rules of Gazebo's bridge: words of its command line, entries of its file, and the types that belong together."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final, Literal

import yaml

from simkit import msgs
from simkit.diagnostics import did_you_mean
from simkit.errors import SimkitError
from simkit.input_file import read_input_text

Direction = Literal["GZ_TO_ROS", "ROS_TO_GZ", "BIDIRECTIONAL"]

_SIGNS: Final[tuple[tuple[str, Direction], ...]] = (("]", "ROS_TO_GZ"), ("[", "GZ_TO_ROS"), ("@", "BIDIRECTIONAL"))
_PACKAGES: Final = ("gz.msgs.", "ignition.msgs.", "ign.msgs.", "gz::msgs::")
_NAMES: Final = {
    "ros": ("ros_topic_name", "topic_name", "gz_topic_name", "ign_topic_name"),
    "gz": ("gz_topic_name", "ign_topic_name", "topic_name", "ros_topic_name"),
}
_KEYS: Final = frozenset(
    (
        *("topic_name", "ros_topic_name", "gz_topic_name", "ign_topic_name", "ros_type_name", "gz_type_name"),
        *("ign_type_name", "direction", "lazy", "subscriber_queue", "publisher_queue", "service_name", "qos_profile"),
        *("gz_req_type_name", "gz_rep_type_name", "ros_service_name", "gz_service_name", "frame_id"),
    )
)


class BridgeError(ValueError):
    """Rule of the bridge that is not valid."""


@dataclass(frozen=True)
class BridgeRule:
    """Rule of a bridge between a topic of Gazebo and one of ROS.

    Attributes:
        ros_name: name in ROS, before remapping.
        gz_name: name in Gazebo.
        ros_type: ROS 2 type, full name; type of a service if `is_service` is true.
        gz_type: type in Gazebo.
        direction: direction of the messages.
        is_service: True for a service of Gazebo that ROS can call.
        frame_id: frame of the header of all messages in ROS; empty for that of Gazebo.
    """

    ros_name: str
    gz_name: str
    ros_type: str
    gz_type: str = ""
    direction: Direction = "BIDIRECTIONAL"
    is_service: bool = False
    frame_id: str = ""


@cache
def ros_types() -> dict[str, list[str]]:
    """Return the ROS 2 types by the type of Gazebo, without its package."""
    file = Path(__file__).with_name("bridge_types.toml")
    return tomllib.loads(read_input_text(file))


def rule_of_word(word: str) -> BridgeRule:
    """Return the rule of a word such as `/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan`.

    Raises:
        BridgeError: the word is no rule.
    """
    name, sign, rest = word.partition("@")
    if not sign or not name:
        raise BridgeError(f"found {word!r}; expected TOPIC@ROS_TYPE[GZ_TYPE, with @, [ or ] between the types")
    if "/srv/" in rest:
        kind, _, _ = rest.partition("@")
        return BridgeRule(name, name, kind, is_service=True)
    for letter, direction in _SIGNS:
        ros_type, found, gz_type = rest.partition(letter)
        if found and ros_type and gz_type:
            gz_type, _, gz_name = gz_type.partition("@")
            return BridgeRule(name, gz_name or name, _full_type(ros_type, word), gz_type, direction)
    raise BridgeError(f"found {word!r}; expected a ROS type and a type of Gazebo with @, [ or ] between them")


def rules_of_file(file: Path) -> list[BridgeRule]:
    """Return the rules of a YAML file of the bridge.

    Raises:
        BridgeError: the file cannot be read, or an entry is not valid.
    """
    try:
        content = yaml.safe_load(read_input_text(file))
    except OSError as error:
        raise BridgeError(f"{file}: cannot be read: {error.strerror}") from None
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise BridgeError(f"{file}: {error}") from None
    if content is None:
        return []
    if not isinstance(content, list):
        raise BridgeError(f"{file}: found a {type(content).__name__}; expected a list with an entry for each topic")
    return rules_of_entries(content, str(file))


def rules_of_entries(entries: Iterable[Any], place: str) -> list[BridgeRule]:
    """Return the rules of the entries of a file or of parameters.

    Raises:
        BridgeError: an entry is not valid.
    """
    rules = []
    for number, entry in enumerate(entries, 1):
        if not isinstance(entry, Mapping):
            raise BridgeError(f"{place}: entry {number} is {entry!r:.40}; expected names and types of a topic")
        try:
            rules.append(_rule_of_entry(entry))
        except BridgeError as error:
            raise BridgeError(f"{place}: entry {number}: {error}") from None
    return rules


def _rule_of_entry(entry: Mapping[str, Any]) -> BridgeRule:
    unknown = sorted(str(key) for key in entry.keys() - _KEYS)
    if unknown:
        raise BridgeError(
            f"unknown key {unknown[0]!r}; {did_you_mean(unknown[0], sorted(_KEYS)) or 'it has no effect'}"
        )
    if "service_name" in entry or "/srv/" in str(entry.get("ros_type_name", "")):
        name = str(entry.get("service_name", entry.get("ros_service_name", entry.get("ros_topic_name", ""))))
        gz_name = str(entry.get("gz_service_name", entry.get("gz_topic_name", name)))
        return BridgeRule(name, gz_name, str(entry.get("ros_type_name", "")), is_service=True)
    ros_name, gz_name = (next((str(entry[key]) for key in _NAMES[side] if entry.get(key)), "") for side in _NAMES)
    missing = next((key for key in ("ros_type_name", "gz_type_name") if not _type_of(entry, key)), None)
    if not ros_name or missing:
        raise BridgeError(f"lacks {missing or 'topic_name'!r}")
    direction = str(entry.get("direction", "BIDIRECTIONAL"))
    known: dict[str, Direction] = {each: each for _, each in _SIGNS}
    if direction not in known:
        raise BridgeError(f"found direction {direction!r}; allowed: {', '.join(sorted(known))}")
    ros_type = _full_type(_type_of(entry, "ros_type_name"), ros_name)
    frame = str(entry.get("frame_id") or "")
    return BridgeRule(ros_name, gz_name, ros_type, _type_of(entry, "gz_type_name"), known[direction], frame_id=frame)


def _type_of(entry: Mapping[str, Any], key: str) -> str:
    return str(entry.get(key) or entry.get(key.replace("gz_", "ign_")) or "")


def _full_type(name: str, place: str) -> str:
    try:
        full = msgs.full_name(name)
        msgs.type_of(full)
    except SimkitError as error:
        raise BridgeError(f"{place}: {error}") from None
    return full


def pair_fault(rule: BridgeRule) -> str:
    """Return why Gazebo's bridge does not connect the two types of a rule; empty if it does."""
    gz_type = next((rule.gz_type.removeprefix(each) for each in _PACKAGES if rule.gz_type.startswith(each)), None)
    known = ros_types()
    if gz_type is None or gz_type not in known:
        near = did_you_mean(gz_type or rule.gz_type, sorted(known))
        return f"there is no type {rule.gz_type!r} of Gazebo" + (f"; {near}" if near else "")
    if rule.ros_type not in known[gz_type]:
        return f"{rule.gz_type} is connected to {' or '.join(known[gz_type])}, not to {rule.ros_type}"
    return ""
