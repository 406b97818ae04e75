"""Packet `recording`: the motion and the scans of a bag, for a page that plays them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit import progress
from simkit.msgs import Message
from simkit.recording.bags.bag_motion import SCAN, BagMotion
from simkit.run_spec import JsonObject
from simkit_view.view import scene_packet
from simkit_view.view.packet import make_packet
from simkit_view.view.recorded_displays import RecordedDisplays

if TYPE_CHECKING:
    from simkit import Pose, Simulation
    from simkit.recording.bags.reader import BagReader

RATE: Final = 15.0
"""Number of states a second; the page interpolates."""
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


class _Playback:
    """Bag whose messages move the models of a simulation.

    Args:
        sim: simulation of the bag's world, or of `MARKER`.
        bag: open bag.
    """

    def __init__(self, sim: Simulation, bag: BagReader) -> None:
        self._sim, self._bag = sim, bag
        topics = {topic.name: topic.type_name for topic in bag.topics}
        self._scans = {name for name, type_name in topics.items() if type_name == SCAN}
        self._motion = BagMotion(sim, topics)
        self._moving = scene_packet.moving_bodies(sim.mj_model)
        self._lidars: dict[str, _Lidar] = {}
        self._displays = RecordedDisplays(sim, self._motion, topics)

    def packet(self) -> bytes:
        """Read the bag and return the packet."""
        wanted = list(dict.fromkeys([*self._motion.topics, *sorted(self._scans), *self._displays.topics]))
        times: list[float] = []
        states: list[npt.NDArray[np.generic]] = []
        begun = None
        with progress.task(
            f"reading {self._bag.path.name}", (self._bag.end - self._bag.start) * 1e-9, unit="s"
        ) as task:
            for message in self._bag.messages(wanted) if wanted else ():
                time = message.time_ns * 1e-9
                begun = time if begun is None else begun
                task.done = time - begun
                while time - begun >= len(times) / RATE:
                    times.append(len(times) / RATE)
                    states.append(scene_packet.poses(self._sim, self._moving))
                decoded = self._bag.decode(message)
                if message.topic in self._scans:
                    self._take_scan(message.topic, decoded, time - begun)
                else:
                    self._motion.take(message.topic, decoded)
                    self._displays.take(message.topic, decoded, time - begun)
        times.append(len(times) / RATE)
        states.append(scene_packet.poses(self._sim, self._moving))
        head: JsonObject = {"kind": "recording", "name": self._bag.path.name, "begin": begun or 0.0, "lidars": []}
        head["displays"], drawings = self._displays.finish(times[-1])
        arrays = {"times": np.array(times), "poses": np.array(states), **drawings}
        for number, (topic, lidar) in enumerate(self._lidars.items()):
            head["lidars"].append({"topic": topic, "low": lidar.low, "step": lidar.step, "count": lidar.count})
            arrays |= {f"lidar{number}.{name}": values for name, values in lidar.arrays().items()}
        return make_packet(head, arrays)

    def _take_scan(self, topic: str, message: Message, time: float) -> None:
        if (pose := self._motion.scan_pose(topic, message)) is not None:
            self._lidars.setdefault(topic, _Lidar(message)).add(message, time, pose)


class _Lidar:
    """Scans of one topic."""

    def __init__(self, message: Message) -> None:
        self.low, self.step = float(message.angle_min), float(message.angle_increment)
        self.count = len(message.ranges)
        self._times: list[float] = []
        self._poses: list[npt.NDArray[np.generic]] = []
        self._ranges: list[npt.NDArray[np.generic]] = []

    def add(self, message: Message, time: float, pose: Pose) -> None:
        """Add a scan; one with another number of rays is left out."""
        ranges = np.asarray(message.ranges, dtype=np.float64)
        if len(ranges) != self.count:
            return
        usable = np.isfinite(ranges) & (ranges > 0) & (ranges < _FARTHEST)
        self._ranges.append(np.where(usable, ranges * _MILLIMETRES, 0).astype(np.uint16))
        self._times.append(time)
        self._poses.append(np.concatenate((pose.position, pose.quaternion)))

    def arrays(self) -> dict[str, npt.NDArray[np.generic]]:
        """Return times [s], poses (x y z, w x y z) and ranges [mm]; 0 is no hit."""
        return {"times": np.array(self._times), "poses": np.array(self._poses), "ranges": np.array(self._ranges)}


def make_recording(sim: Simulation, bag: BagReader) -> bytes:
    """Return the packet of a bag. The simulation of its world is used to compute poses, and never steps."""
    packet = _Playback(sim, bag).packet()
    sim.reset()
    return packet
