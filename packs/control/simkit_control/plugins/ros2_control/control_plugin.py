"""Plugins of Gazebo that run a controller manager: gz_ros2_control, gazebo_ros2_control and gazebo_ros_control."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from shlex import quote
from typing import TYPE_CHECKING, Any, ClassVar, Final

from simkit import ModelPlugin, Params
from simkit.extend import Options, OptionsOf, boolean, did_you_mean, text, texts
from simkit.plugins.endpoints import offers_all
from simkit.plugins.find_entities import find_plugin_file
from simkit.plugins.ros_parameter_block import ParameterBlock
from simkit.plugins.ros_parameter_files import ParameterFiles, read_parameter_file
from simkit_control.plugins.ros2_control.controller_file_hint import find_controller_file
from simkit_control.plugins.ros2_control.controller_manager import ControllerManager
from simkit_control.plugins.ros2_control.controller_manager_services import offer_services
from simkit_control.plugins.ros2_control.hardware import Hardware
from simkit_control.plugins.ros2_control.hardware_description import describe_hardware
from simkit_control.plugins.ros2_control.hardware_interfaces import POSITION, VELOCITY
from simkit_control.plugins.ros2_control.hardware_joint import HardwareJoint, PidGains, read_pid_gains
from simkit_control.plugins.ros2_control.manager_parameter_files import (
    adapt_to_manager,
    report_high_rates,
    report_unused_parameters,
)
from simkit_control.plugins.ros2_control.parameter_substitution import substitute_arguments
from simkit_control.plugins.ros2_control.transmissions import transmissions_of

if TYPE_CHECKING:
    from simkit import Model
    from simkit.compiler import ActuatorRef
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.plugins.ros_parameter_files import ParameterFile
    from simkit_control.plugins.ros2_control.hardware_description import ComponentDescription

UPDATE_RATE: Final = 100.0
"""Default update rate of a controller manager [Hz]."""
_PARAMS_FILE_HINT: Final = "--params-file FILE, params_files=[FILE] in Python"
_CONFIG_FOLDERS: Final = ("config", "../config")
_ROS_1_NODE: Final = "gazebo_ros_control"


class ControlOptions(Options):
    """Options of the plugins that host a controller manager."""

    controller_manager_name: str = text()
    parameters: tuple[str, ...] = texts()
    controllers: tuple[str, ...] = texts()
    hold_joints: bool = boolean(True)


class ControlPlugin(ModelPlugin):
    """Reads the hardware and the controllers' parameter files, and updates the controller manager at its rate.

    Attributes:
        manager: controller manager.
        hardware: joints and sensors that the manager's controllers use.
        files: parameter files of the controllers.
        is_ros_1: true for the plugin of ROS 1.
        manager_class: class of the manager.
        set_without_effort: command interfaces for which Gazebo sets the state of a joint, so that no effort limit acts.
    """

    reads_at_load = ("inertial", "axes")  # gains follow from the inertias at the joints

    options = OptionsOf(ControlOptions)
    endpoints = offers_all(
        "controller_manager_msgs",
        *("ListControllers", "ListControllerTypes", "LoadController", "ConfigureController", "SwitchController"),
        *("UnloadController", "ReloadControllerLibraries", "ListHardwareComponents", "ListHardwareInterfaces"),
        "SetHardwareComponentState",
        below="controller_manager/",
    )
    drives = True
    reads_parameter_files = True
    is_ros_1: ClassVar[bool] = False
    set_without_effort: ClassVar[frozenset[str]] = frozenset()
    manager_class: ClassVar[type[ControllerManager]] = ControllerManager
    manager: ControllerManager
    hardware: Hardware
    files: ParameterFiles

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        transmissions = transmissions_of(scene, [*scene.controls, *params.all("ros2_control")])
        self.hardware = Hardware.of(self.describe_joints(scene, params), scene, params.diagnostics, transmissions)
        renamed = self.ros.node if self.ros.node != self.name else "controller_manager"
        self._manager_name = self.options.controller_manager_name or renamed
        run_files = [entry.file for entry in builder.parameter_files if entry.is_for(scene)]
        find = partial(find_plugin_file, self, builder=builder, places=_CONFIG_FOLDERS)
        argument_files = self.ros.arguments.parameter_files(find, params.diagnostics)
        files = [
            *self.read_files(params, builder, has_other_files=bool(run_files or argument_files)),
            *argument_files,
            *self._adapted_run_files(run_files, params),
        ]
        self.files = ParameterFiles([substitute_arguments(f, scene.arguments, params.diagnostics) for f in files])
        self._chosen_controllers = [
            (name, element) for element in params.all("controllers") for name in element.value.replace(",", " ").split()
        ]
        self.hardware.holds_position = self.options.hold_joints
        self.mark_ignored_elements(params)
        self.before_step_rate = self.read_rate(params, builder)
        refs = [ref for record in builder.records.values() for ref in record.actuators]
        self._earlier = {ref.name for ref in refs}
        self.hardware.lift_zero_efforts(self.set_without_effort, builder, self.name)
        self.hardware.prepare(builder, self.name, self.read_pids())

    # ------------------------------------------------------------------ the plugin's element and its files

    def describe_joints(self, scene: SceneModel, params: Params) -> list[ComponentDescription]:
        """Return the joints and sensors that the controllers may use."""
        return describe_hardware(scene, params)

    def mark_ignored_elements(self, params: Params) -> None:
        """Mark elements that only Gazebo uses as read, so that they are not reported as unknown."""
        for name in ("robot_param", "robot_param_node", "position_proportional_gain", "robotNamespace"):
            params.child(name)
        for name in ("controller_manager_prefix_node_name", "controller_manager_node_name"):
            params.child(name)

    def read_rate(self, params: Params, builder: SpecBuilder) -> float | None:
        """Return the update rate of the manager [Hz]; None for an update at every step."""
        entry = self.files.of_node(f"{self.ros.namespace}/{self._manager_name}")
        if entry is None or "update_rate" not in (entry.below or {}):
            return UPDATE_RATE
        rate = entry.block("controller_manager", params.diagnostics).number("update_rate", UPDATE_RATE, minimum=1e-3)
        steps = 1.0 / builder.world.physics.max_step_size
        if rate > steps * (1.0 + 1e-9):
            message = f"the controller manager's update_rate is {rate:g} Hz, above the step rate of {steps:g} Hz"
            where = (entry.below or {})["update_rate"].where
            params.diagnostics.warning("SK-CONTROL-017", f"{message}; it is updated at every step", where)
        return rate

    def read_pids(self) -> Mapping[str, Mapping[str, PidGains]]:
        """Return the PID gains that replace a servo, by joint and interface.

        The gains come from the hardware's joints. Gains in `pid_gains` of the plugin's own node override them.
        """
        gains_by_joint = {j.name: dict(j.pids) for c in self.hardware.components for j in c.joints}
        entry = self.files.of_node(f"{self.ros.namespace}/{self.name}")
        if entry is not None and "pid_gains" in (entry.below or {}):
            block = entry.block(self.name, self.params.diagnostics).block("pid_gains")
            for interface in (POSITION, VELOCITY):
                for joint, gains in self.gains_of_joints(block.block(interface)).items():
                    gains_by_joint.setdefault(joint, {})[interface] = gains
            block.report_unread("SK-CONTROL-011", "pid_gains")
        return {joint: pids for joint, pids in gains_by_joint.items() if pids}

    def gains_of_joints(self, block: Params) -> dict[str, PidGains]:
        """Return the gains of a block by joint; report joints that the hardware does not have."""
        by_joint = {}
        forms = block.forms if isinstance(block, ParameterBlock) else {}
        for name, (_, where) in forms.items():
            gains = block.block(name)
            if name in self.hardware.joints:
                by_joint[name] = read_pid_gains(gains)
                continue
            gains.mark_all_read()
            message = f"pid_gains names joint {name!r}, which the hardware does not have"
            self.params.diagnostics.warning("SK-CONTROL-008", message, where, did_you_mean(name, self.hardware.joints))
        return by_joint

    def speed_bounds(self, topic: str) -> tuple[tuple[float, float], tuple[float, float]] | None:
        """Return the speed bounds [m/s, rad/s] of the controller that subscribes to a topic.

        Returns:
            Lowest and highest linear velocity, and lowest and highest angular velocity; None if no controller of the
            topic has speed bounds.
        """
        bounds: tuple[tuple[float, float], tuple[float, float]] | None = self._ask_controllers("speed_bounds", topic)
        return bounds

    def command_timeout(self, topic: str) -> float:
        """Return the time after which the controller that subscribes to a topic drops a command [s]; else infinity."""
        seconds = self._ask_controllers("command_timeout", topic)
        return math.inf if seconds is None else float(seconds)

    def _ask_controllers(self, method: str, topic: str) -> Any:
        """Call a method of each controller that has it, with a topic, and return the first result that is not None."""
        getters = (getattr(entry.controller, method, None) for entry in self.manager.controllers.values())
        return next((result for get in getters if get is not None and (result := get(topic)) is not None), None)

    def prevails(self, joint: HardwareJoint, other: ActuatorRef, *, is_later: bool) -> bool:
        """Check whether this plugin moves a joint in Gazebo although another plugin drives the joint too.

        Args:
            joint: joint of the hardware.
            other: actuator of the other plugin.
            is_later: true if the other plugin comes later in the file.
        """
        return other.kind != "motor" and not is_later  # the last velocity of a step counts, and a force replaces it

    def _find_rivals(self) -> None:
        """Report joints that another plugin drives too, and tell the hardware which of the two moves them.

        Another plugin of ros_control that comes later reports itself.
        """
        structure = self.sim.engine.structure
        others = {p.name for p in structure.all_plugins() if isinstance(p, ControlPlugin)}
        refs = [ref for record in structure.builder.records.values() for ref in record.actuators]
        by_scoped = {joint.scoped: joint for joint in self.hardware.joints.values() if joint.command_interfaces}
        shared: dict[tuple[str, bool, bool], list[str]] = {}
        for ref in (ref for ref in refs if ref.joint in by_scoped and ref.owner != self.name):
            joint, is_later, is_manager = by_scoped[ref.joint], ref.name not in self._earlier, ref.owner in others
            if is_manager and is_later:
                continue
            prevails = self.prevails(joint, ref, is_later=is_later)
            if not is_manager:
                self.hardware.rivals.setdefault(joint.name, []).append((ref, prevails))
            shared.setdefault((ref.owner, is_later, prevails), []).append(joint.name)
        for (owner, is_later, prevails), names in shared.items():
            self._report_shared_joints(owner, names, is_later=is_later, prevails=prevails, is_manager=owner in others)

    def _report_shared_joints(
        self, owner: str, names: Sequence[str], *, is_later: bool, prevails: bool, is_manager: bool
    ) -> None:
        """Report joints that another plugin drives too, and which of the two plugins moves them."""
        listed, many = ", ".join(map(repr, names)), len(names) > 1
        message = f"joints {listed} are" if many else f"joint {listed} is"
        message += f" {'also' if is_later else 'already'} driven by plugin {owner!r}: "
        them = "them" if many else "it"
        if is_manager:
            message += f"both act on {them}"
        elif prevails:
            message += f"{self.name!r} holds {them}, and the commands of {owner!r} have no effect, as in Gazebo"
        else:
            message += f"{owner!r} moves {them}, and {self.name!r} has no effect on {them}, as in Gazebo"
        hint = "remove one of the two plugins, or remove the joint from <ros2_control> or <transmission>"
        self.params.diagnostics.warning("SK-CONTROL-004", message, self.where, hint)

    def _adapted_run_files(self, run_files: Sequence[ParameterFile], params: Params) -> Iterator[ParameterFile]:
        """Adapt the parameter files of the run to the node names that this manager expects."""
        for file in run_files:
            namespace, name = self.ros.namespace, self._manager_name
            yield adapt_to_manager(file, namespace, name, params.diagnostics, is_ros_1=self.is_ros_1)

    def read_files(self, params: Params, builder: SpecBuilder, *, has_other_files: bool) -> Iterator[ParameterFile]:
        """Yield the parameter files that the plugin's element names; without any, report it."""
        elements = params.all("parameters")
        given = {str(entry.file.path) for entry in builder.parameter_files}
        for element in elements:
            names = [element.value] if element.value.startswith("$(") else element.value.split()
            if len(names) > 1 and find_plugin_file(self, element.value, builder, _CONFIG_FOLDERS) is not None:
                names = [element.value]  # a path with spaces
            for uri in names:
                if uri in given:
                    continue  # a file of the run, which is read in any case
                path = find_plugin_file(self, uri, builder, _CONFIG_FOLDERS)
                if path is None:
                    message = (
                        f"the controllers' parameter file {uri[:200]} is not found: none of its controllers is loaded"
                    )
                    hint = f"give its package: --package-path NAME=DIR, or the file itself: {_PARAMS_FILE_HINT}"
                    params.diagnostics.warning("SK-CONTROL-015", message, element.where, hint)
                    continue
                read = read_parameter_file(path, params.diagnostics)
                if read is not None:
                    yield read
        if not has_other_files and not any(element.value for element in elements):
            message = f"plugin {self.name!r} names no parameter file: no controller is loaded"
            likely = find_controller_file(self.where.file, self.hardware.joints)
            hint = (
                f"give the file that the ROS launch file loads: {_PARAMS_FILE_HINT}; or name it in <simkit:parameters>"
                if likely is None
                else f"add --params-file {quote(str(likely))}, which has controllers for these joints"
            )
            params.diagnostics.warning("SK-CONTROL-018", message, self.where, hint)

    # ------------------------------------------------------------------ run time

    def load(self, parent: Model, params: Params) -> None:
        self._find_rivals()
        self.hardware.load(self.sim)
        self.manager = self.manager_class(self, self.hardware, self.files, self._manager_name, params.diagnostics)
        self._choose_free_namespace(parent.scoped.partition("::")[0], params)
        self.manager.is_ros_1 = self.is_ros_1
        offer_services(self.manager)
        declared = self.manager.declared()
        report_unused_parameters(self.manager, params.diagnostics)
        chosen = self.controllers_to_start(declared) if not self._chosen_controllers else []
        for name, element in self._chosen_controllers:
            if name in declared:
                chosen.append(name)
                continue
            near = did_you_mean(name, declared) or "declared controllers: " + (", ".join(declared) or "none")
            message = f"<simkit:controllers> names {name!r}, which no parameter file declares with a type"
            params.diagnostics.error("SK-CONTROL-013", message, element.where, near)
        if not self._chosen_controllers and self.manager.is_started_by_nodes:
            chosen = []
        self.manager.start(chosen)
        # the nodes of a run are added after its world was loaded
        self.manager.is_start_open = not self._chosen_controllers and not self.sim.tick and not self.sim.nodes
        report_high_rates(self.manager, self.before_step_rate, params.diagnostics)

    def controllers_to_start(self, declared: Mapping[str, str]) -> list[str]:
        """Return the controllers that start with the robot if `<simkit:controllers>` does not name any."""
        return list(declared)

    def _choose_free_namespace(self, model: str, params: Params) -> None:
        """Append the model's name to the namespace if another robot's manager has the same name."""
        node = f"{self.ros.namespace}/{self._manager_name}"
        if f"{node}/list_controllers" not in self.sim.communication.services.names():
            return
        self.ros = self.ros.in_namespace(f"{self.ros.namespace}/{model}")
        message = (
            f"a controller manager {node!r} exists already: the manager of {model!r}, its controllers and their topics "
        )
        hint = "give each robot a <namespace> in the plugin's <ros>"
        params.diagnostics.note("SK-CONTROL-001", f"{message}are below {self.ros.namespace!r}", self.where, hint)

    def get_loaded_state(self) -> dict[str, object]:
        """Return the attributes themselves, because all of them can be copied; a copy would take 10 % of the load."""
        return vars(self)

    def before_step(self) -> None:
        try:
            self.manager.update(self.sim.time_ns)
        except KeyError:
            if self.scoped.partition("::")[0] in self.sim.models:
                raise
            # a callback removed the robot during the update, so there is nothing left to command

    def get_state(self) -> dict[str, object]:
        state = super().get_state()
        if "manager" in state:
            state["manager"] = self.manager.get_state()
        return state

    def set_state(self, state: Mapping[str, object]) -> None:
        if "manager" not in state:
            super().set_state(state)
            return
        manager = self.manager
        super().set_state({**state, "manager": manager})
        manager.set_state(state["manager"])


class GzRos2Control(ControlPlugin):
    """Runs the controllers that the files in `<parameters>` declare; see `docs/ros2_control.md`."""

    filenames = ("libgz_ros2_control-system.so", "libign_ros2_control-system.so", "gz_quadruped_hardware-system")
    names = (
        "gz_ros2_control::GazeboSimROS2ControlPlugin",
        "ign_ros2_control::IgnitionROS2ControlPlugin",
        "gz_quadruped_hardware::GazeboSimQuadrupedPlugin",
    )


class GazeboRos2Control(ControlPlugin):
    """Runs the controllers that the files in `<parameters>` declare; see `docs/ros2_control.md`."""

    filenames = ("libgazebo_ros2_control.so",)

    set_without_effort = frozenset((POSITION, VELOCITY))

    def prevails(self, joint: HardwareJoint, other: ActuatorRef, *, is_later: bool) -> bool:
        """Check whether this plugin moves the joint; see `ControlPlugin.prevails`.

        Gazebo Classic sets the velocity of the joint before the step. The motor of a drive plugin then acts within the
        step, so that the joint has the velocity of the motor at its end. A force of another plugin acts for one step.
        """
        return other.kind == "motor"


class GazeboRosControl(ControlPlugin):
    """Runs the controllers that parameter files in ROS 1's layout declare.

    In ROS 1 a launch file loads these files, so the plugin's own `<parameters>` (or `<simkit:parameters>`) is an
    extension of simkit. Joints with gains in `gazebo_ros_control/pid_gains` are driven by PID loops. The plugin of
    cob_gazebo_ros_control differs in that joints with several interfaces switch between them.
    """

    filenames: ClassVar[tuple[str, ...]] = ("libgazebo_ros_control.so", "libhwi_switch_gazebo_ros_control.so")

    is_ros_1 = True
    set_without_effort = frozenset((POSITION,))  # the motor of a velocity command has the effort limit as its fmax

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._default_to_model_namespace(scene.name, params)
        super().prepare(scene, params, builder)

    def load(self, parent: Model, params: Params) -> None:
        self._default_to_model_namespace(parent.name, params)
        super().load(parent, params)

    def _default_to_model_namespace(self, model: str, params: Params) -> None:
        if not params.has("robotNamespace"):  # the default namespace is the model's name
            self.ros = self.ros.in_namespace(model)

    def prevails(self, joint: HardwareJoint, other: ActuatorRef, *, is_later: bool) -> bool:
        """Check whether this plugin moves the joint; see `ControlPlugin.prevails`.

        The plugin sets position or motor velocity at every step, but a drive plugin only at its update rate. An effort
        of 0 leaves the joint to the drive. ROS 2, whose drives have an element `<ros>`, does not have this plugin.
        """
        owners = (p for p in self.sim.engine.structure.all_plugins() if p.name == other.owner)
        if any(owner.params.has("ros") for owner in owners):
            return False
        return bool({POSITION, VELOCITY} & set(joint.command_interfaces))

    def mark_ignored_elements(self, params: Params) -> None:
        for name in ("robotSimType", "legacyModeNS", "robotParam", "eStopTopic", "joints", "filterJointsParam"):
            params.child(name)

    def read_rate(self, params: Params, builder: SpecBuilder) -> float | None:
        period = params.number("controlPeriod", 0.0, minimum=0)
        return 1.0 / period if period > 0.0 else None

    def read_pids(self) -> Mapping[str, Mapping[str, PidGains]]:
        gains_by_joint: dict[str, Mapping[str, PidGains]] = {}
        for node in dict.fromkeys((f"{self.ros.namespace}/{_ROS_1_NODE}", f"/{_ROS_1_NODE}")):
            entry = self.files.of_node(node)
            if entry is not None:
                block = entry.block(_ROS_1_NODE, self.params.diagnostics).block("pid_gains")
                for joint, gains in self.gains_of_joints(block).items():
                    gains_by_joint.setdefault(joint, self._gains_by_interface(joint, gains))
                block.report_unread("SK-CONTROL-011", "pid_gains")
        return gains_by_joint

    def _gains_by_interface(self, joint: str, gains: PidGains) -> Mapping[str, PidGains]:
        """Assign one set of gains to each command interface of the joint, position or velocity."""
        interfaces = self.hardware.joints[joint].command_interfaces
        return {name: gains for name in (POSITION, VELOCITY) if name in interfaces}
