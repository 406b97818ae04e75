"""Plugin of the robot Baxter in Gazebo Classic: `libbaxter_gazebo_ros_control.so`, with the robot's own topics.

Sources: `baxter_gazebo`, `baxter_sim_hardware` and `baxter_sim_controllers` of RethinkRobotics/baxter_simulator. The
time limit of commands, the speed ratio and the suppression of the gravity compensation are those of the real robot, as
the page "Arm Control Modes" of its SDK describes them; baxter_simulator has none of them.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit import Params, msgs
from simkit.extend import Options, OptionsOf, block, boolean, counted, did_you_mean
from simkit.plugins.one_time_warnings import are_usable
from simkit.plugins.ros_parameter_files import Entry, ParameterFile
from simkit_control.plugins.ros2_control.control_plugin import ControlOptions, GazeboRosControl
from simkit_control.plugins.ros2_control.hardware_description import (
    MOTION_INTERFACES,
    ComponentDescription,
    JointDescription,
    describe_hardware,
    parse_initial_position,
)
from simkit_control.plugins.ros2_control.hardware_interfaces import POSITION, VELOCITY
from simkit_control.plugins.ros2_control.hardware_joint import PidGains, read_pid_gains
from simkit_robots.controllers.baxter_controllers import (
    SUPPRESSION_TIME,
    BaxterEffortController,
    BaxterGripperController,
    BaxterHeadController,
    BaxterLimbController,
    BaxterPositionController,
    finger_joint,
    limb_joints,
)
from simkit_robots.plugins.baxter.controller_declarations import (
    BOOL,
    EMPTY,
    FLOAT,
    GRIPPER,
    HEAD_PAN,
    HOLD,
    JOINT_COMMAND,
    LIMB_CONTROLLERS,
    POSITION_MODE,
    RAW_POSITION_MODE,
    SIDES,
    TORQUE_MODE,
    VELOCITY_MODE,
    baxter_endpoints,
    declaration,
    kind_of,
)
from simkit_robots.plugins.baxter.inverse_kinematics import IK_SERVICE, IK_TYPE, ArmInverseKinematics
from simkit_robots.plugins.baxter.robot_states import BaxterStates, tip_of

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Bool, EndEffectorCommand, Float64, HeadPanCommand, JointCommand

COMMAND_TIMEOUT: Final = 0.2
"""Time after the last command at which an arm leaves the velocity or torque mode [s]."""
_NS: Final = 1_000_000_000
_NOD_NS: Final = _NS  # duration of a nod
_GAINS: Final = {
    "joint_position_controller": POSITION,
    "joint_velocity_controller": VELOCITY,
    "gripper_controller": POSITION,
    "head_position_controller": POSITION,
}
"""Interface that the gains in the parameters of a controller belong to."""


class BaxterOptions(ControlOptions):
    """Options of `BaxterControl`."""

    enabled: bool = boolean(False)
    initial_positions: Options = block(Options)


class BaxterControl(GazeboRosControl):
    """Drives the arms, the head and the grippers of Baxter by the topics of the robot; see `docs/baxter.md`.

    The robot ignores commands until `true` arrives on `/robot/set_super_enable`, or from the start with
    `<simkit:enabled>`. While it is disabled, it holds its position; with `<hold_joints>` false, its arms fall, as in
    Gazebo.

    Attributes:
        enabled: true if the robot follows commands.
        stopped: true after a stop, until the next reset.
        nods_until: end of the present nod [ns].
    """

    filenames = ("libbaxter_gazebo_ros_control.so",)
    options = OptionsOf(BaxterOptions)
    endpoints = (*GazeboRosControl.endpoints, *baxter_endpoints())
    after_step_rate = 100.0

    enabled = False
    stopped = False
    nods_until = 0

    # ------------------------------------------------------------------ joints, controllers and gains

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        super().prepare(scene, params, builder)
        arms = {joint for side in self._sides for joint in limb_joints(side)}
        actuated = self.hardware.actuated
        self.hardware.is_limp = not self.hardware.holds_position
        actuated.gravity_shares = np.array([float(joint.name in arms) for joint in actuated.joints])

    def _default_to_model_namespace(self, model: str, params: Params) -> None:
        if not params.has("robotNamespace"):
            self.ros = self.ros.in_namespace("robot")

    def describe_joints(self, scene: SceneModel, params: Params) -> list[ComponentDescription]:
        """Return the joints of the file's description, and Baxter's own joints with all interfaces."""
        present = {joint.name for joint in scene.all_joints() if joint.axes}
        self._sides = [side for side in SIDES if present.issuperset(limb_joints(side))]
        self._gripper_sides = [side for side in self._sides if finger_joint(side) in present]
        self._has_head = "head_pan" in present
        joint_names = [joint for side in self._sides for joint in limb_joints(side)] + ["head_pan"] * self._has_head
        joint_names += [name for side in self._gripper_sides for name in _fingers(side) if name in present]
        if not self._sides:
            message = f"model {scene.scoped!r} has no arm of Baxter: its joints have other names"
            params.warning("SK-CONTROL-008", message, f"an arm needs the joints {', '.join(limb_joints('left'))}")
        described = scene.controls or scene.transmissions or params.has("ros2_control")
        components = describe_hardware(scene, params) if described else []
        components = [replace(c, joints=tuple(j for j in c.joints if j.name not in joint_names)) for c in components]
        initial = self._initial_positions(scene, joint_names)
        joints = tuple(
            JointDescription(name, MOTION_INTERFACES, MOTION_INTERFACES, initial=initial.get(name, math.nan))
            for name in joint_names
        )
        return [*components, ComponentDescription(scene.name, "system", "baxter", joints)]

    def _initial_positions(self, scene: SceneModel, own: Sequence[str]) -> dict[str, float]:
        """Return the positions in `<initial_positions>` [rad or m] by joint."""
        positions = {}
        scenes = {joint.name: joint for joint in scene.all_joints()}
        for element in self.params.block("initial_positions").children:
            text = element.value
            if element.name in own:
                positions[element.name] = parse_initial_position(
                    text, scenes[element.name], element, self.params.diagnostics
                )
            else:
                near = did_you_mean(element.name, own) or f"the joints are {', '.join(own)}"
                message = f"<initial_positions> names joint {element.name!r}, which Baxter does not have"
                self.params.diagnostics.warning("SK-CONTROL-008", message, element.where, near)
        self.params.block("initial_positions").mark_all_read()
        return positions

    def read_files(self, params: Params, builder: SpecBuilder, *, has_other_files: bool) -> Iterator[ParameterFile]:
        """Yield the declarations of the robot's controllers, and the parameter files that the element names."""
        where = params.where
        controllers = [f"{side}_{name}" for side in self._sides for name in dict.fromkeys(LIMB_CONTROLLERS.values())]
        controllers += [f"{side}_gripper_controller" for side in self._gripper_sides]
        controllers += ["head_position_controller"] * self._has_head
        below = {name: declaration(name, where) for name in ("joint_state_controller", *controllers)}
        root = Entry(where, below=below)
        for part in reversed(self.ros.namespace.strip("/").split("/")):
            root = Entry(where, below={part: root})
        self._own_controllers = tuple(controllers)
        yield ParameterFile(Path(where.file or "baxter"), root=root)
        yield from super().read_files(params, builder, has_other_files=True)

    def read_pids(self) -> Mapping[str, Mapping[str, PidGains]]:
        """Return the gains in the controllers' parameters; joints without gains have servos."""
        gains_by_joint = {joint: dict(gains) for joint, gains in super().read_pids().items()}
        of_node = self.files.of_node(self.ros.namespace)
        for name, entry in ((of_node.below or {}) if of_node is not None else {}).items():
            interface = _GAINS.get(kind_of(name))
            if interface is not None and name in self._own_controllers:
                for element in entry.block(name, self.params.diagnostics).block("joints").children:
                    joint = element.text("joint", "")
                    if element.has("pid") and joint in self.hardware.joints:
                        gains_by_joint.setdefault(joint, {})[interface] = read_pid_gains(element.block("pid"))
        return gains_by_joint

    def controllers_to_start(self, declared: Mapping[str, str]) -> list[str]:
        """Return the controllers that no enabling starts; of other controllers in files, only the joint states'."""
        return [name for name, kind in declared.items() if kind.startswith("joint_state_controller/")]

    # ------------------------------------------------------------------ run time

    def load(self, parent: Model, params: Params) -> None:
        self._modes = dict.fromkeys(self._sides, HOLD)
        self._timeouts = dict.fromkeys(self._sides, round(COMMAND_TIMEOUT * _NS))
        self._last_commands = dict.fromkeys(self._sides, 0)
        super().load(parent, params)
        for name in self._own_controllers:
            problem = self.manager.load(name) or self.manager.configure(name)
            if problem:
                self.log.error("%s", problem)
        for side in self._sides:
            joints = [self.hardware.joints[joint] for joint in limb_joints(side)]
            solver = ArmInverseKinematics(self.sim, parent, side, joints, tip_of(parent, side))
            prefix = "/" if self.ros.namespace == "/robot" else ""  # another robot's services have its namespace
            self.offer(f"{prefix}{IK_SERVICE.format(side)}", IK_TYPE, solver.solve_all)
        self._states = BaxterStates(self, parent, self._sides, self._gripper_sides, has_head=self._has_head)
        self._open_topics()
        self.enabled = self.options.enabled
        self._switch_controllers()

    def _open_topics(self) -> None:
        for side in self._sides:
            limb: dict[str, tuple[str, Callable[[str, msgs.Message], None]]] = {
                "joint_command": (JOINT_COMMAND, self._on_joint_command),
                "joint_command_timeout": (FLOAT, self._on_timeout),
                "set_speed_ratio": (FLOAT, self._on_speed_ratio),
                "suppress_gravity_compensation": (EMPTY, self._on_suppression),
            }
            for name, (kind, callback) in limb.items():
                self.listen(f"limb/{side}/{name}", kind, partial(callback, side))
        for side in self._gripper_sides:
            self.listen(f"end_effector/{side}_gripper/command", GRIPPER, partial(self._on_gripper, side))
        if self._has_head:
            self.listen("head/command_head_pan", HEAD_PAN, self._on_head_pan)
            self.listen("head/command_head_nod", BOOL, self._on_head_nod)
        self.listen("set_super_enable", BOOL, self._on_enable)
        self.listen("set_super_stop", EMPTY, lambda _: self._set_state(enabled=False, stopped=True))
        self.listen("set_super_reset", EMPTY, lambda _: self._set_state(enabled=False, stopped=False))

    def before_step(self) -> None:
        now = self.sim.time_ns
        for side, mode in self._modes.items():
            if mode in (VELOCITY_MODE, TORQUE_MODE) and now - self._last_commands[side] > self._timeouts[side]:
                self.log.info("no joint command for the %s arm arrives any more: it holds its position", side)
                self._modes[side] = HOLD
                self._switch_controllers()
        super().before_step()

    def after_step(self) -> None:
        self._states.publish()

    def controller(self, name: str) -> Any:
        """Return a controller by its name."""
        return self.manager.controllers[name].controller

    def _switch_controllers(self) -> None:
        """Activate the controllers of the present modes, and no others."""
        wanted: set[str] = set()
        if self.enabled:
            wanted = {f"{side}_{LIMB_CONTROLLERS[mode]}" for side, mode in self._modes.items()}
            wanted |= {
                name
                for name in self._own_controllers
                if name.endswith(("gripper_controller", "head_position_controller"))
            }
        loaded = self.manager.controllers
        names = [name for name in self._own_controllers if name in loaded and loaded[name].state != "unconfigured"]
        active = {name for name in names if loaded[name].state == "active"}
        coming = [name for name in names if name in wanted - active]
        leaving = [name for name in names if name in active - wanted]
        if coming or leaving:
            self.manager.switch(coming, leaving, strict=False)

    def _set_state(self, *, enabled: bool, stopped: bool) -> None:
        self.enabled, self.stopped = enabled, stopped
        self._modes = dict.fromkeys(self._sides, HOLD)
        self._switch_controllers()

    def _on_enable(self, message: Bool) -> None:
        if message.data and self.stopped:
            what = "the robot is stopped and is not enabled"
            self._once.left_out("stopped", what, f"publish on {self.ros.topic('set_super_reset')} first")
            return
        if bool(message.data) != self.enabled:
            self._set_state(enabled=bool(message.data), stopped=self.stopped)

    def _is_disabled(self, command: str) -> bool:
        """Check whether the robot is disabled; report a command that is ignored for that reason."""
        if not self.enabled:
            hint = f"publish true on {self.ros.topic('set_super_enable')}"
            self._once.left_out("disabled", f"{command} is ignored, because the robot is not enabled", hint)
        return not self.enabled

    # ------------------------------------------------------------------ arms

    def prepare_trajectory(self, side: str) -> str:
        """Let the trajectory controller drive an arm; return the reason to refuse that, or an empty text."""
        if not self.enabled:
            return f"the robot is not enabled; publish true on {self.ros.topic('set_super_enable')}"
        self._modes[side] = HOLD
        self._switch_controllers()
        return ""

    def _on_joint_command(self, side: str, message: JointCommand) -> None:
        names, values, mode = [str(n) for n in message.names], [float(v) for v in message.command], int(message.mode)
        if self._is_disabled("a joint command"):
            return
        if len(names) != len(values):
            what = f"a joint command with {len(names)} names and {counted(len(values), 'value')} is ignored"
            self._once.left_out("length", what, "give one value for each name")
            return
        if not are_usable(*values):
            self._once.not_finite("a joint command")
            return
        if mode not in (POSITION_MODE, VELOCITY_MODE, TORQUE_MODE, RAW_POSITION_MODE):
            what = f"a joint command of mode {mode} is ignored"
            self._once.left_out("mode", what, "1 is position, 2 velocity, 3 torque, 4 raw position")
            return
        joints = limb_joints(side)
        for name in names:
            if name not in joints:
                near = did_you_mean(name, joints) or f"the joints are {', '.join(joints)}"
                self._once.left_out(f"joint {side}", f"the {side} arm has no joint {name[:100]!r}: it is ignored", near)
        self._modes[side] = mode
        self._last_commands[side] = self.sim.time_ns
        self._switch_controllers()
        arm: BaxterLimbController = self.controller(f"{side}_{LIMB_CONTROLLERS[mode]}")
        arm.set_command({n: v for n, v in zip(names, values, strict=True) if n in joints}, mode)

    def _on_timeout(self, side: str, message: Float64) -> None:
        if not 0.0 < message.data < 1e9:
            what = f"a time limit of {message.data:g} s for the commands of the {side} arm is ignored"
            self._once.left_out("timeout", what, "give a time above 0 s and below 1e9 s")
            return
        self._timeouts[side] = round(message.data * _NS)

    def _on_speed_ratio(self, side: str, message: Float64) -> None:
        if math.isnan(message.data):
            self._once.not_finite("a speed ratio")
            return
        arm: BaxterPositionController = self.controller(f"{side}_joint_position_controller")
        arm.speed_ratio = min(max(float(message.data), 0.0), 1.0)

    def _on_suppression(self, side: str, _: object) -> None:
        arm: BaxterEffortController = self.controller(f"{side}_joint_effort_controller")
        arm.suppressed_until = self.sim.time_ns + round(SUPPRESSION_TIME * _NS)

    # ------------------------------------------------------------------ head and grippers

    def _on_head_pan(self, message: HeadPanCommand) -> None:
        if self._is_disabled("a command for the head"):
            return
        if not are_usable(message.target, message.speed_ratio):
            self._once.not_finite("a command for the head")
            return
        head: BaxterHeadController = self.controller("head_position_controller")
        head.set_command(float(message.target), float(message.speed_ratio))

    def _on_head_nod(self, message: Bool) -> None:
        if message.data:
            self.nods_until = self.sim.time_ns + _NOD_NS

    def _on_gripper(self, side: str, message: EndEffectorCommand) -> None:
        if self._is_disabled("a command for a gripper"):
            return
        gripper: BaxterGripperController = self.controller(f"{side}_gripper_controller")
        problem, hint = gripper.execute(message)
        if problem:
            kind = re.sub("'[^']*'", "", problem)  # without the sender's texts, which may differ in each message
            self._once.left_out(kind, f"{problem}; the command is ignored", hint)


def _fingers(side: str) -> tuple[str, str]:
    return finger_joint(side), f"{side[0]}_gripper_r_finger_joint"
