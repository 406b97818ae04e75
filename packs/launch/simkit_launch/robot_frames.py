"""Frames of a robot for its transforms: fixed and moving joints of a description in URDF or SDF."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

import simkit
from simkit import Params, Pose
from simkit.errors import SimkitError
from simkit.pose import IDENTITY
from simkit.writers.xml_text import document
from simkit_launch.robot_description import DescriptionError, description_root

_NOT_KINEMATIC = frozenset(("visual", "collision", "sensor", "plugin", "light"))
_TURNING = frozenset(("revolute", "continuous"))


@dataclass(frozen=True)
class JointFrame:
    """Joint between two frames.

    Attributes:
        name: name of the joint.
        kind: motion of the joint.
        parent, child: names of the frames.
        pose: pose of the child in the parent at position 0.
        axis: axis of the motion in the child's frame, length 1.
    """

    name: str
    kind: Literal["fixed", "turns", "slides"]
    parent: str
    child: str
    pose: Pose = IDENTITY
    axis: tuple[float, float, float] = (1.0, 0.0, 0.0)

    def pose_at(self, position: float) -> Pose:
        """Return the pose of the child in the parent at a position of the joint [rad or m]."""
        x, y, z = self.axis
        if self.kind == "slides":
            return self.pose @ Pose((x * position, y * position, z * position))
        sine = math.sin(position / 2)
        return self.pose @ Pose(quaternion=(math.cos(position / 2), x * sine, y * sine, z * sine))


@dataclass(frozen=True)
class MimicRule:
    """Position of a joint that follows another one: `multiplier` times the other one's position, plus `offset`."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class RobotFrames:
    """Frames of a robot.

    Attributes:
        name: name of the robot.
        links: names of the links.
        fixed: joints that do not move, by name.
        moving: joints that move, by name.
        mimics: rules of the joints that follow others, by name.
        limits: lower and upper limit of each moving joint that has limits, by name.
    """

    name: str = ""
    links: tuple[str, ...] = ()
    fixed: dict[str, JointFrame] = field(default_factory=dict)
    moving: dict[str, JointFrame] = field(default_factory=dict)
    mimics: dict[str, MimicRule] = field(default_factory=dict)
    limits: dict[str, tuple[float, float]] = field(default_factory=dict)


def robot_frames(description: str) -> RobotFrames:
    """Return the frames of a description in URDF or SDF.

    Raises:
        DescriptionError: the text is no such description.
    """
    root = description_root(description)
    if root.name == "robot":
        return _frames_of_urdf(root)
    if root.name == "sdf":
        return _frames_of_sdf(root)
    raise DescriptionError(f"found <{root.name}>; expected a description in URDF (<robot>) or SDF (<sdf>)")


def _frames_of_urdf(root: Params) -> RobotFrames:
    links = tuple(link.attribute("name") for link in root.all("link"))
    robot = RobotFrames(root.attribute("name"), links)
    for element in root.all("joint"):
        name, kind = element.attribute("name"), element.attribute("type")
        parent, child = (_attribute(element, tag, "link") for tag in ("parent", "child"))
        missing = next((link for link in (parent, child) if link not in links), None)
        if missing is not None:
            raise DescriptionError(f"joint {name!r} names the link {missing!r}, which the robot does not have")
        pose = Pose.from_rpy(*_numbers(element, "origin", "xyz"), *_numbers(element, "origin", "rpy"))
        axis = _unit(_numbers(element, "axis", "xyz", (1.0, 0.0, 0.0)))
        if kind == "fixed":
            robot.fixed[name] = JointFrame(name, "fixed", parent, child, pose)
            continue
        if kind not in (*_TURNING, "prismatic"):
            continue  # robot_state_publisher has no transforms for floating and planar joints
        robot.moving[name] = JointFrame(name, "turns" if kind in _TURNING else "slides", parent, child, pose, axis)
        if kind == "continuous":
            robot.limits[name] = (-math.pi, math.pi)
        elif element.has("limit"):
            robot.limits[name] = (_number(element, "limit", "lower"), _number(element, "limit", "upper"))
        if element.has("mimic"):
            other, offset = _attribute(element, "mimic", "joint"), _number(element, "mimic", "offset")
            robot.mimics[name] = MimicRule(other, _number(element, "mimic", "multiplier", 1.0), offset)
    return robot


def _frames_of_sdf(root: Params) -> RobotFrames:
    """Return the frames of a model in SDF, after its poses have been resolved as simkit does for a run."""
    _leave_out(root, _NOT_KINEMATIC)  # a mesh that is not found must not hide the frames
    try:
        model = simkit.describe(document(root))["model"]
    except SimkitError as error:
        raise DescriptionError(str(error)) from None
    if model is None:
        raise DescriptionError("found a world; expected a model")
    poses = {link["name"]: _pose(link["pose_world"]) for link in model["links"]}
    robot = RobotFrames(model["name"], tuple(poses))
    for joint in model["joints"]:
        parent_link, child_link = (str(joint[key]).rpartition("::")[2] for key in ("parent_link", "child_link"))
        name, kind = joint["name"], joint["type"]
        if parent_link not in poses or child_link not in poses:
            continue  # a joint to the world
        pose = poses[parent_link].inverse() @ poses[child_link]
        if kind == "fixed":
            robot.fixed[name] = JointFrame(name, "fixed", parent_link, child_link, pose)
        elif kind in (*_TURNING, "prismatic") and joint["axes"]:
            axis = joint["axes"][0]
            in_world = Pose((axis["xyz_world"][0], axis["xyz_world"][1], axis["xyz_world"][2]))
            turned = Pose(quaternion=poses[child_link].quaternion).inverse() @ in_world
            direction = _unit((float(turned.position[0]), float(turned.position[1]), float(turned.position[2])))
            sort: Literal["turns", "slides"] = "slides" if kind == "prismatic" else "turns"
            robot.moving[name] = JointFrame(name, sort, parent_link, child_link, pose, direction)
            robot.limits[name] = (float(axis["lower"]), float(axis["upper"]))
    return robot


def _leave_out(element: Params, names: frozenset[str]) -> None:
    """Remove all inner elements of some names."""
    element.children[:] = [child for child in element.children if child.name not in names]
    for child in element.children:
        _leave_out(child, names)


def _pose(numbers: list[float]) -> Pose:
    return Pose((numbers[0], numbers[1], numbers[2]), (numbers[3], numbers[4], numbers[5], numbers[6]))


def _attribute(element: Params, tag: str, name: str) -> str:
    child = element.child(tag)
    return "" if child is None else child.attribute(name)


def _number(element: Params, tag: str, name: str, default: float = 0.0) -> float:
    text = _attribute(element, tag, name)
    try:
        return float(text) if text else default
    except ValueError:
        raise DescriptionError(f"found {text!r} for {name} of <{tag}>; expected a number") from None


def _numbers(
    element: Params, tag: str, name: str, default: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> tuple[float, float, float]:
    text = _attribute(element, tag, name)
    if not text:
        return default
    try:
        x, y, z = map(float, text.split())
    except ValueError:
        raise DescriptionError(f"found {text!r} for {name} of <{tag}>; expected three numbers") from None
    return x, y, z


def _unit(vector: tuple[float, float, float]) -> tuple[float, float, float]:
    length = math.hypot(*vector) or 1.0
    return vector[0] / length, vector[1] / length, vector[2] / length
