"""The engine of a simulation: physics, step loop, servos, wrenches, wind, random streams, plugin faults."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from simkit.run_spec import PluginErrorPolicy
from simkit.runtime.contact.anisotropic_friction import AnisotropicFriction
from simkit.runtime.contact.speculative_contacts import FastBodyWarnings
from simkit.runtime.engine.engine_state import EngineState
from simkit.runtime.engine.external_forces import PersistentWrenches, Wind
from simkit.runtime.engine.physics_state import CONTROL
from simkit.runtime.engine.plugin_faults import PluginFaults
from simkit.runtime.engine.random_streams import RandomStreams
from simkit.runtime.engine.step_loop import CommandSource, ScheduleFiller, StepLoop
from simkit.runtime.engine.velocity_servos import VelocityServos

if TYPE_CHECKING:
    from simkit.compiler import ActuatorRef
    from simkit.diagnostics import Diagnostics
    from simkit.run_spec import PluginErrorPolicy
    from simkit.runtime.engine.entity_structure import WorldStructure
    from simkit.runtime.engine.scheduler import Scheduler
    from simkit.runtime.engine.simulated_time import Clock
    from simkit.scene import SceneWorld

_LARGEST_CONTROL: Final = 9e9
"""[rad/s, N·m, …]; one of 1e10 (mjMAXVAL) or more makes the engine take every control in the world for zero."""


class Engine(EngineState):
    """Everything of a simulation that advances it.

    Args:
        world: the scene.
        structure: what is compiled of it.
        clock: simulated time.
        seed: of all random streams.
        reports: collects what is found while the simulation runs.
        commands: delivered between two steps.
        fill: puts every task into the scheduler, in document order.
        on_error: what becomes of plugins that raise; None leaves it to files and classes.

    Attributes:
        streams: random numbers by name.
        faults: what becomes of plugins that raise, and which of them are left out.
        velocity_servos: the velocity servos that plugins asked for.
        wrenches: wrenches that hold until they are set anew.
        wind: how the air moves.
        friction: contacts whose friction has a direction or slips.
        fast_body_warnings: warns of bodies that are too fast for the length of a step.
        loop: makes the steps.
        render_thread: whether pictures of cameras are drawn beside the physics where nobody waits for them; to be
            changed at any time, for it changes no message.
        velocity_limit: limit of an axis of a joint [rad/s or m/s], by scoped name and number of the axis.
    """

    render_thread = False
    velocity_limit: Callable[[str, int], float]

    def __init__(
        self,
        world: SceneWorld,
        structure: WorldStructure,
        clock: Clock,
        seed: int,
        reports: Diagnostics,
        commands: CommandSource,
        fill: ScheduleFiller,
        on_error: PluginErrorPolicy | None = None,
    ) -> None:
        super().__init__(world, structure, clock, reports)
        self.streams = RandomStreams(seed)
        self.loop = StepLoop(self.physics, commands, fill)
        self.faults = PluginFaults(self, self.loop.reschedule, on_error)
        self.velocity_servos = VelocityServos(self)
        self.wrenches = PersistentWrenches(self, self.faults)
        self.wind = Wind(world)
        self.friction = AnisotropicFriction(self.physics, reports)
        self.fast_body_warnings = FastBodyWarnings(reports, clock.timestep)

    @property
    def is_stepping(self) -> bool:
        """Whether a step is under way: this is asked by a hook or a callback."""
        return self.loop.is_running

    @property
    def steps(self) -> int:
        """Steps made since it was loaded, those among them that a reset or a restore has undone."""
        return self.physics.tick - self.loop.jumped

    @property
    def scheduler(self) -> Scheduler:
        """Tasks by the ticks at which they are due."""
        return self.loop.scheduler

    def reschedule(self) -> None:
        """Takes changed rates, sensors and plugins into account; within a hook, once the tick is dealt with."""
        self.loop.reschedule()

    def set_control(self, actuator: ActuatorRef, value: float) -> None:
        """Writes the control of an actuator that a plugin added; the next step sees it.

        A velocity is kept within the joint's velocity limit; the control is what its servo makes of it.
        """
        limit = _LARGEST_CONTROL
        if actuator.kind == "velocity":
            limit = min(limit, self.velocity_limit(actuator.joint, actuator.axis))
            self.velocity_servos.command(actuator, max(-limit, min(limit, value)))
        else:
            self.physics.data.ctrl[self.names.actuator(actuator)] = max(-limit, min(limit, value))
        self.physics.changed(CONTROL)
