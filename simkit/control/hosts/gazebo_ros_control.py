"""`libgazebo_ros_control.so`: the controller manager of ROS 1 in Gazebo Classic."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

from simkit.control.host import ControlHost
from simkit.control.interfaces import POSITION, VELOCITY
from simkit.params import Params
from simkit.plugins.ros_names import RosNames

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.control.description import PidGains
    from simkit.scene import SceneModel

_NODE: Final = "gazebo_ros_control"


class GazeboRosControl(ControlHost):
    """Runs the controllers of files in ROS 1's layout.

    In ROS 1 a launch file loads them, so the plugin's own `<parameters>` (or `<simkit:parameters>`) is simkit's. Loops
    in `gazebo_ros_control/pid_gains` drive the joints that have some.
    """

    filenames = ("libgazebo_ros_control.so",)

    is_ros_1 = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._take_namespace(scene.name, params)
        super().prepare(scene, params, builder)

    def load(self, parent: Any, params: Params) -> None:
        self._take_namespace(parent.name, params)
        super().load(parent, params)

    def _take_namespace(self, model: str, params: Params) -> None:
        if not params.has("robotNamespace"):  # then it is the model's name
            self.ros = RosNames(self.name, model, params=params)

    def read_rest(self, params: Params) -> None:
        for name in ("robotSimType", "legacyModeNS", "robotParam", "eStopTopic", "joints"):
            params.child(name)

    def read_rate(self, params: Params, builder: SpecBuilder) -> float | None:
        period = params.number("controlPeriod", 0.0, minimum=0)
        return 1.0 / period if period > 0.0 else None

    def read_pids(self) -> Mapping[str, Mapping[str, PidGains]]:
        found: dict[str, Mapping[str, PidGains]] = {}
        for place in dict.fromkeys((f"{self.ros.namespace}/{_NODE}", f"/{_NODE}")):
            entry = self.files.of_node(place)
            if entry is not None:
                block = entry.block(_NODE, self.params.diagnostics).block("pid_gains")
                for joint, gains in self.gains_of_joints(block).items():
                    found.setdefault(joint, self._loop(joint, gains))
                block.report_unread("SK-CONTROL-011", "pid_gains")
        return found

    def _loop(self, joint: str, gains: PidGains) -> Mapping[str, PidGains]:
        """One set of gains is for whichever interface the joint has."""
        interfaces = self.hardware.joints[joint].command_interfaces
        return {name: gains for name in (POSITION, VELOCITY) if name in interfaces}
