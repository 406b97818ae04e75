"""Services to list, describe, add and remove the motions of a robot, as in play_motion2 and play_motion."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Protocol

from simkit.msgs import Message
from simkit_motion.plugins.play_motion.motion import Motion, limit_violations, motion_of_message
from simkit_motion.plugins.play_motion.motion_planning import MotionRefused, active_controllers, find_joints

if TYPE_CHECKING:
    from simkit import Model, Simulation
    from simkit.msgs import (
        AddMotion_Request,
        GetMotionInfo_Request,
        IsAlreadyThere_Request,
        IsJointListReady_Request,
        IsMotionReady_Request,
        RemoveMotion_Request,
    )


class MotionPlayer(Protocol):
    """Plugin whose motions the services describe and change.

    Attributes:
        sim: Simulation of the robot.
        robot: Robot that plays the motions.
        known: Motions by key.
    """

    sim: Simulation
    robot: Model
    known: dict[str, Motion]

    @property
    def log(self) -> logging.Logger:
        """Logger for the reasons why motions cannot be added."""

    @property
    def is_idle(self) -> bool:
        """True while no motion is being played."""

    def offer(self, service: str, type_name: str, handler: Callable[[Message], object]) -> object:
        """Offer a service below the plugin's namespace."""


def offer_services(player: MotionPlayer) -> None:
    """Open the services about the motions of a robot."""
    answers = _ServiceHandlers(player)
    package = "play_motion2_msgs/srv"
    player.offer("play_motion2/list_motions", f"{package}/ListMotions", answers.keys)
    player.offer("play_motion2/is_motion_ready", f"{package}/IsMotionReady", answers.is_ready)
    player.offer("play_motion2/is_joint_list_ready", f"{package}/IsJointListReady", answers.are_joints_ready)
    player.offer("play_motion2/get_motion_info", f"{package}/GetMotionInfo", answers.motion)
    player.offer("play_motion2/add_motion", f"{package}/AddMotion", answers.add)
    player.offer("play_motion2/remove_motion", f"{package}/RemoveMotion", answers.remove)
    player.offer("play_motion/list_motions", "play_motion_msgs/srv/ListMotions", answers.infos)
    player.offer("play_motion/is_already_there", "play_motion_msgs/srv/IsAlreadyThere", answers.is_there)


class _ServiceHandlers:
    """Handlers of the services. A response contains the motions that are known at the time of the request."""

    def __init__(self, player: MotionPlayer) -> None:
        self._player = player

    def keys(self, _: object) -> dict[str, object]:
        """Return the keys of all motions."""
        return {"motion_keys": list(self._player.known)}

    def infos(self, _: object) -> dict[str, object]:
        """Return the name, joints and duration of each motion, for ROS 1."""
        return {"motions": [motion.as_info() for motion in self._player.known.values()]}

    def motion(self, request: GetMotionInfo_Request) -> dict[str, object]:
        """Return a motion; the response is empty if the motion does not exist."""
        motion = self._player.known.get(request.motion_key)
        return {"motion": motion.as_message()} if motion is not None else {}

    def is_ready(self, request: IsMotionReady_Request) -> dict[str, object]:
        """Check whether a motion can be played now."""
        motion = self._player.known.get(request.motion_key)
        if motion is None or not self._are_ready(motion.joints):
            return {"is_ready": False}
        return {"is_ready": not limit_violations(motion, self._player.robot.joints)}

    def are_joints_ready(self, request: IsJointListReady_Request) -> dict[str, object]:
        """Check whether active controllers move these joints and no motion is being played."""
        return {"is_ready": self._are_ready(request.joints)}

    def _are_ready(self, joints: Sequence[str]) -> bool:
        player = self._player
        try:
            find_joints(player.robot, joints, active_controllers(player.sim, player.robot))
        except MotionRefused:
            return False
        return player.is_idle

    def add(self, request: AddMotion_Request) -> dict[str, object]:
        """Add a motion; an existing motion is replaced only if the request says so."""
        known = self._player.known
        try:
            motion = motion_of_message(request.motion)
        except ValueError as error:
            self._player.log.info("motion %r is not added: %s", request.motion.key, error)
            return {"success": False}
        if not motion.key or (motion.key in known and not request.overwrite):
            return {"success": False}
        known[motion.key] = motion
        return {"success": True}

    def remove(self, request: RemoveMotion_Request) -> dict[str, object]:
        """Remove a motion."""
        return {"success": self._player.known.pop(request.motion_key, None) is not None}

    def is_there(self, request: IsAlreadyThere_Request) -> dict[str, object]:
        """Check whether the joints are within a tolerance of the first point of a motion."""
        motion, joints = self._player.known.get(request.motion_name), self._player.robot.joints
        if motion is None or any(name not in joints for name in motion.joints):
            return {"already_there": False}
        here = [float(joints[name].position) for name in motion.joints]
        off = max(abs(a - b) for a, b in zip(here, motion.positions[0], strict=True))
        return {"already_there": off <= request.tolerance}
