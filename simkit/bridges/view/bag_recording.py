"""Packet `recording`: the motion and the scans of a bag, for a page that plays them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.bridges.view import scene_packet
from simkit.bridges.view.packet import Head, make_packet
from simkit.pose import IDENTITY, Pose

if TYPE_CHECKING:
    from simkit.recording.bags.reader import BagReader
    from simkit.runtime import Link, Model, Simulation

RATE: Final = 15.0
"""Number of states a second; the page interpolates."""
_ODOMETRY, _JOINTS, _TRANSFORMS = "nav_msgs/msg/Odometry", "sensor_msgs/msg/JointState", "tf2_msgs/msg/TFMessage"
_SCAN: Final = "sensor_msgs/msg/LaserScan"
_NEAR: Final = 0.05  # [m] up to which the first odometry lies at the robot's pose in the world, so it is a world pose
_MILLIMETRES: Final = 1000.0
_FARTHEST: Final = 65.0  # [m]; ranges are 16-bit numbers of millimetres, and 0 is no hit

MARKER: Final = """<sdf version="1.9"><world name="{name}">
<light name="sun" type="directional"><direction>-0.4 0.5 -0.9</direction><diffuse>0.7 0.7 0.7 1</diffuse></light>
<model name="ground"><static>true</static><link name="l"><visual name="v"><geometry><plane><size>100 100</size></plane>
</geometry><material><diffuse>0.75 0.76 0.74 1</diffuse></material></visual></link></model>
<model name="robot"><link name="base"><gravity>false</gravity><inertial><mass>1</mass></inertial>
<visual name="body"><pose>0 0 0.08 0 0 0</pose><geometry><cylinder><radius>0.13</radius><length>0.14</length></cylinder>
</geometry><material><diffuse>0.15 0.35 0.65 1</diffuse></material></visual>
<visual name="nose"><pose>0.11 0 0.11 0 0 0</pose><geometry><box><size>0.08 0.06 0.05</size></box></geometry>
<material><diffuse>0.95 0.6 0.1 1</diffuse></material></visual></link></model></world></sdf>"""
"""World for a bag whose world is unknown: level ground, and a mark for the robot."""


class BagPoses:
    """Poses of a bag's robots in a simulation that only draws them.

    Args:
        sim: simulation of the bag's world, or of `MARKER`.
        bag: open bag.
    """

    def __init__(self, sim: Simulation, bag: BagReader) -> None:
        self._sim, self._bag = sim, bag
        self._topics = {topic.name: topic.type_name for topic in bag.topics}
        self._has_odometry = _ODOMETRY in self._topics.values()
        self._links = {
            name.split("::")[-1]: link for name, link in self._tables("link") if not self._model(link).static
        }
        self._joints: dict[str, Any] = {n.split("::")[-1]: j for n, j in self._tables("joint") if j.dof == 1}
        self._origins: dict[str, Pose] = {}
        self._edges: dict[str, tuple[str, Pose]] = {}
        self._moving = scene_packet.moving_bodies(sim.mj_model)
        self._lidars: dict[str, _Lidar] = {}

    def _model(self, link: Link) -> Model:
        """Return the top-level model of a link."""
        return self._sim.models[self._sim.engine.names.links[link.scoped].model]

    def _tables(self, kind: str) -> Iterator[tuple[str, Any]]:
        yield from self._sim.contents.handles.tables[kind].items()

    def packet(self) -> bytes:
        """Read the bag and return the packet."""
        wanted = [n for n, kind in self._topics.items() if kind in (_ODOMETRY, _JOINTS, _TRANSFORMS, _SCAN)]
        times: list[float] = []
        states: list[npt.NDArray[Any]] = []
        begun = None
        for message in self._bag.messages(wanted):
            time = message.time_ns * 1e-9
            begun = time if begun is None else begun
            while time - begun >= len(times) / RATE:
                times.append(len(times) / RATE)
                states.append(scene_packet.poses(self._sim, self._moving))
            self._take(message.topic, self._bag.decode(message), time - begun)
        times.append(len(times) / RATE)
        states.append(scene_packet.poses(self._sim, self._moving))
        head: Head = {"kind": "recording", "name": self._bag.path.name, "begin": begun or 0.0, "lidars": []}
        arrays = {"times": np.array(times), "poses": np.array(states)}
        for number, (topic, lidar) in enumerate(self._lidars.items()):
            head["lidars"].append({"topic": topic, "low": lidar.low, "step": lidar.step, "count": lidar.count})
            arrays |= {f"lidar{number}.{name}": values for name, values in lidar.arrays().items()}
        return make_packet(head, arrays)

    def _take(self, topic: str, message: Any, time: float) -> None:
        kind = self._topics[topic]
        if kind == _ODOMETRY:
            self._place(message.child_frame_id, msgs.pose(message.pose.pose))
        elif kind == _JOINTS:
            for name, position in zip(message.name, message.position, strict=False):
                joint = self._joints.get(name.split("/")[-1])
                if joint is not None and np.isfinite(position):
                    joint.set_position(float(position))
        elif kind == _TRANSFORMS:
            for transform in message.transforms:
                self._take_transform(transform)
        else:
            self._lidars.setdefault(topic, _Lidar(message)).add(message, time, self._lidar_pose(topic, message))

    def _take_transform(self, transform: Any) -> None:
        child, parent, pose = transform.child_frame_id, transform.header.frame_id, msgs.pose(transform.transform)
        self._edges[child] = parent, pose
        if child in self._sim.models and not self._sim.models[child].static:
            self._sim.models[child].set_pose(pose)
        elif not self._has_odometry and parent.split("/")[-1] in ("odom", "map", "world"):
            self._place(child, pose)

    def _place(self, frame: str, pose: Pose) -> None:
        """Place the robot whose link has the name of the frame; a bag's only frame moves the mark."""
        link = self._links.get(frame.split("/")[-1]) or self._first_link()
        if link is None:
            return
        if frame not in self._origins:
            start = link.pose
            is_world = np.linalg.norm(start.position[:2] - pose.position[:2]) < _NEAR
            self._origins[frame] = IDENTITY if is_world else start
        model = self._model(link)
        model.set_pose(self._origins[frame] @ pose @ link.pose.inverse() @ model.pose)

    def _first_link(self) -> Link | None:
        return next(iter(self._links.values()), None)

    def _lidar_pose(self, topic: str, message: Any) -> Pose:
        """Return the pose of a scan's frame in the world: of the sensor, of a link, or along the transforms."""
        for sensor in self._sim.contents.sensors.values():
            if sensor.topic == topic:
                pose: Pose = sensor.pose
                return pose
        frame, offset = message.header.frame_id, IDENTITY
        for _ in range(len(self._edges) + 1):
            link = self._links.get(frame.split("/")[-1])
            if link is not None:
                found: Pose = link.pose @ offset
                return found
            if frame in self._origins or frame not in self._edges:
                break
            parent, pose = self._edges[frame]
            frame, offset = parent, pose @ offset
        first = self._first_link()
        return offset if first is None else first.pose @ offset


class _Lidar:
    """Scans of one topic."""

    def __init__(self, message: Any) -> None:
        self.low, self.step = float(message.angle_min), float(message.angle_increment)
        self.count = len(message.ranges)
        self._times: list[float] = []
        self._poses: list[npt.NDArray[Any]] = []
        self._ranges: list[npt.NDArray[Any]] = []

    def add(self, message: Any, time: float, pose: Pose) -> None:
        """Add a scan; one with another number of rays is left out."""
        ranges = np.asarray(message.ranges, dtype=np.float64)
        if len(ranges) != self.count:
            return
        usable = np.isfinite(ranges) & (ranges > 0) & (ranges < _FARTHEST)
        self._ranges.append(np.where(usable, ranges * _MILLIMETRES, 0).astype(np.uint16))
        self._times.append(time)
        self._poses.append(np.concatenate((pose.position, pose.quaternion)))

    def arrays(self) -> dict[str, npt.NDArray[Any]]:
        """Return times [s], poses (x y z, w x y z) and ranges [mm]; 0 is no hit."""
        return {"times": np.array(self._times), "poses": np.array(self._poses), "ranges": np.array(self._ranges)}


def make_recording(sim: Simulation, bag: BagReader) -> bytes:
    """Return the packet of a bag. The simulation of its world is used to compute poses, and never steps."""
    found = BagPoses(sim, bag).packet()
    sim.reset()
    return found
