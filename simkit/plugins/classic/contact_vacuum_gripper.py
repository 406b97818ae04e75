"""Vacuum gripper of ARIAC: `libROSVacuumGripperPlugin.so`, which holds what its suction cup touches."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.params import Params
from simkit.plugins.base import NEVER, ModelPlugin
from simkit.plugins.endpoints import offers, publishes
from simkit.plugins.find_entities import find_named_link
from simkit.plugins.joints.run_time_welds import close_weld, has_weld, open_weld
from simkit.plugins.options import Options, OptionsOf, block, integer, text, without_effect
from simkit.plugins.publish_on_demand import publish_while_subscribed
from simkit.runtime.contact.collision_contacts import list_contacts

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel

CONTROL: Final = "osrf_gear/srv/VacuumGripperControl"
STATE: Final = "osrf_gear/msg/VacuumGripperState"
_RATE: Final = 10.0  # rate at which contacts are looked for [Hz]


class GraspCheckOptions(Options):
    """Options in `<grasp_check>`."""

    attach_steps: int = integer(0, minimum=0)
    detach_steps: bool = without_effect()
    min_contact_count: bool = without_effect()


class ContactVacuumGripperOptions(Options):
    """Options of `ContactVacuumGripper`."""

    robot_namespace: str = text()
    control_topic: str = text("gripper/control")
    state_topic: str = text("gripper/state")
    suction_cup_link: str = text(required=True)
    grasp_check: GraspCheckOptions = block(GraspCheckOptions)
    drops: bool = without_effect()


class ContactVacuumGripper(ModelPlugin):
    """Holds a link that touches `<suction_cup_link>` while the gripper is on.

    The service `<control_topic>` (`gripper/control`) switches the gripper. While it is on, it looks for contacts ten
    times a second of simulated time. After more than `<attach_steps>` looks with a contact, it holds the touched link
    until it is switched off. The state is published on `<state_topic>` (`gripper/state`) at every step.
    """

    endpoints = (
        offers("gripper/control", CONTROL, named_by=("control_topic",)),
        publishes("gripper/state", STATE, named_by=("state_topic",)),
    )
    options = OptionsOf(ContactVacuumGripperOptions)
    filenames = ("libROSVacuumGripperPlugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self._cup = find_named_link(scene, "suction_cup_link", params)
        self._steps = options.grasp_check.read_all().attach_steps
        self._own = scene.scoped.split("::")[0]

    def load(self, parent: Model, params: Params) -> None:
        if self.options.robot_namespace:
            self.ros = self.ros.in_namespace(self.options.robot_namespace)
        self._is_on, self._count = False, 0
        self._held = ""
        self.after_step_rate = NEVER
        self.offer(self.options.control_topic, CONTROL, self._on_control)
        self._state = self.advertise(self.options.state_topic, STATE)
        publish_while_subscribed(self, self._state, 0.0, "publish_state")

    @property
    def held(self) -> str:
        """Scoped name of the held link; empty without one."""
        return self._held if self._held and has_weld(self.sim, self._weld(self._held)) else ""

    def _on_control(self, request: msgs.VacuumGripperControl_Request) -> dict[str, object]:
        self._is_on, self._count = bool(request.enable), 0
        if not self._is_on and self._held:
            open_weld(self.sim, self._weld(self._held))
            self._held = ""
        self._set_after_step_rate(_RATE if self._is_on else NEVER)
        return {"success": True}

    def after_step(self) -> None:
        """Count looks with a contact, and hold the touched link."""
        if self.held:
            return
        touched = self._touched()
        self._count = self._count + 1 if touched else max(0, self._count - 1)
        if touched and self._count > self._steps:
            close_weld(self.sim, self._weld(touched), self._cup, touched)
            self._held = touched

    def _touched(self) -> str:
        """Return the scoped name of the first movable link that the cup touches; empty without one."""
        links = self.sim.engine.names.links
        for contact in list_contacts(self.sim.engine.compiled, self.sim.engine.physics.fresh(), self._own):
            first, second = (name.rpartition("::")[0] for name in (contact.first, contact.second))
            if self._cup in (first, second):
                other = second if first == self._cup else first
                is_own = other.split("::")[0] == self._own
                if other in links and not is_own and self.sim.mj_model.body_weldid[links[other].body] != 0:
                    return other
        return ""

    def _weld(self, link: str) -> str:
        return f"{self._cup}#suction {link}"

    def publish_state(self) -> None:
        """Publish whether the gripper is on, and whether it holds a link."""
        self._state.publish(msgs.make(STATE, enabled=self._is_on, attached=bool(self.held)))
