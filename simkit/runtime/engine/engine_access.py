"""The engine underneath a simulation: its objects, and what is written to them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from simkit.pose import IDENTITY
from simkit.runtime.aspect import Aspect
from simkit.runtime.engine.held_state import HeldState
from simkit.runtime.engine.physics import CONTROL
from simkit.runtime.handles.entity_handles import draw_light

if TYPE_CHECKING:
    from simkit.runtime.engine.external_forces import PersistentWrenches
    from simkit.runtime.engine.physics import Physics
    from simkit.runtime.handles.light import Light

_LARGEST_CONTROL = 9e9
"""[rad/s, N·m, …]; one of 1e10 (mjMAXVAL) or more makes the engine take every control in the world for zero."""


class EngineAccess(Aspect):
    """The part of a simulation that reaches down to the engine.

    Attributes:
        physics: the engine with its state.
        originals: model fields that were written to, as compiled.
    """

    physics: Physics
    originals: dict[str, Any]
    _standing: PersistentWrenches

    @property
    def mj_model(self) -> Any:
        """The `mujoco.MjModel`; a new object after a spawn or a removal."""
        return self.physics.model

    @property
    def mj_data(self) -> Any:
        """The `mujoco.MjData`; a new object after a spawn or a removal."""
        return self.physics.data

    @property
    def names(self) -> Any:
        """The compiler's name map of the present model."""
        return self._whole.structure.compiled.names

    @property
    def compiled(self) -> Any:
        """What the compiler made of the present structure."""
        return self._whole.structure.compiled

    def fresh_data(self) -> Any:
        """`mj_data` with everything computed for the state at `time`."""
        return self.physics.fresh()

    def fresh_acceleration(self) -> Any:
        """The same with body accelerations and interaction forces."""
        return self.physics.fresh_accelerations()

    def hold_state(self) -> HeldState:
        """The physics state of this tick, to be measured later."""
        return self.physics.hold()

    def data_of(self, held: HeldState) -> Any:
        """An `MjData` of a held state with everything computed."""
        return self.physics.data_of(held)

    def set_control(self, actuator: Any, value: float) -> None:
        """Writes the control of an actuator that a plugin added; the next step sees it.

        A velocity is kept within the joint's velocity limit; the control is what its servo makes of it.
        """
        limit = _LARGEST_CONTROL
        if actuator.kind == "velocity":
            limit = min(limit, float(self._whole.joint(actuator.joint)._velocity_limit[actuator.axis]))
            self._whole.velocity_servos.command(actuator, max(-limit, min(limit, value)))
        else:
            self.mj_data.ctrl[self.names.actuator(actuator)] = max(-limit, min(limit, value))
        self.physics.changed(CONTROL)

    def touch(self, field: str) -> Any:
        """A model field to be written to; snapshots and restores cover it from now on."""
        values = getattr(self.mj_model, field)
        if not field.startswith("light_"):
            for sensor in self._whole.structure.all_sensors():
                sensor.take_held()
            self.physics.changed_model()
        if field not in self.originals:
            self.originals[field] = values.copy()
        return values

    def original(self, field: str) -> Any:
        """A touched field's values as compiled."""
        return self.originals[field]

    def set_standing_wrenches(self, owner: Any, wrenches: Mapping[str, Any], *, are_applied: bool = False) -> None:
        """Wrenches (force [N], torque [N·m], world frame, at the centre of mass) by link that hold until set anew.

        Args:
            owner: the plugin that sets them; what others set holds too, and nothing that it sets once it is gone.
            wrenches: by scoped link name; a link that is not there is waited for.
            are_applied: the state has them already (it was restored).
        """
        self._standing.set(owner, wrenches, are_applied=are_applied)

    def stand_wrenches(self, are_applied: bool = False) -> None:
        """Lets the standing wrenches push the links that are there now."""
        self._standing.push(are_applied=are_applied)

    def place_light(self, light: Light) -> None:
        """Shows a light where its handle says."""
        carrier = self.names.links.get(light.scene.link)
        draw_light(self.mj_model, light, carrier.offset if carrier else IDENTITY, self.touch)
        self.physics.changed_lights()
