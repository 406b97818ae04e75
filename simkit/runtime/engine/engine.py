"""Engine of a simulation: physics, step loop, servos, wrenches, wind, random streams and plugin faults."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from simkit.run_spec import PluginErrorPolicy
from simkit.runtime.contact.anisotropic_friction import AnisotropicFriction
from simkit.runtime.contact.speculative_contacts import FastBodyWarnings
from simkit.runtime.engine.engine_state import EngineState
from simkit.runtime.engine.external_forces import PersistentWrenches, Wind
from simkit.runtime.engine.number_changes import NumberChanges
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
"""Largest control [rad/s, N·m, …]. From 1e10 (mjMAXVAL) on, MuJoCo sets every control of the world to zero."""


class Engine(EngineState):
    """All parts of a simulation that advance it.

    Args:
        world: scene of the world.
        structure: compiled structure of the world.
        clock: simulated time.
        seed: seed of all random streams.
        reports: collection of the diagnostics of the run.
        commands: source of the commands that are delivered between two steps.
        fill: function that adds every task to the scheduler, in document order.
        on_error: policy for plugins that raise; None uses the policy of the file or of the plugin's class.

    Attributes:
        streams: random numbers by name.
        faults: handling of plugins that raise, and the set of disabled plugins.
        velocity_servos: velocity servos that plugins requested.
        numbers: numbers of the model that a program changed.
        wrenches: wrenches that persist until they are replaced.
        wind: velocity of the air.
        friction: contacts with directional friction or slip.
        fast_body_warnings: warnings about bodies that are too fast for the time step.
        loop: step loop.
        render_thread: True to draw camera images on another thread during the physics, unless a subscriber waits for
            them. The value may change at any time, because it has no effect on the messages.
        renderer: description of the renderer that draws the images; empty before an image is drawn or requested.
        velocity_limit: function that returns the limit of a joint's axis [rad/s or m/s] by scoped name and axis number.
    """

    render_thread = False
    renderer = ""
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
        self.numbers = self.velocity_servos.numbers = NumberChanges(self, self.velocity_servos.renew)
        self.wrenches = PersistentWrenches(self, self.faults)
        self.wind = Wind(world)
        self.friction = AnisotropicFriction(self.physics, reports)
        self.fast_body_warnings = FastBodyWarnings(reports, clock.timestep)

    @property
    def is_stepping(self) -> bool:
        """True while the simulation makes a step, so when a hook or a callback reads this attribute."""
        return self.loop.is_running

    @property
    def steps(self) -> int:
        """Number of steps since the load, including steps that a reset or a restore has undone."""
        return self.physics.tick - self.loop.jumped

    @property
    def scheduler(self) -> Scheduler:
        """Tasks by the ticks at which they are due."""
        return self.loop.scheduler

    def reschedule(self) -> None:
        """Apply changed rates, sensors and plugins; within a hook, after the other tasks of the tick."""
        self.loop.reschedule()

    def look_for_rest(self, _tick: int) -> None:
        """Let bodies at rest sleep."""
        if not self.physics.sleep.rests:
            self.physics.sleep.look(self.physics.fresh())

    def set_control(self, actuator: ActuatorRef, value: float) -> None:
        """Write the control of an actuator that a plugin added; the next step uses it.

        A velocity is limited to the joint's velocity limit; its servo computes the control from it.
        """
        limit = _LARGEST_CONTROL
        if actuator.kind == "velocity":
            limit = min(limit, self.velocity_limit(actuator.joint, actuator.axis))
            self.velocity_servos.command(actuator, max(-limit, min(limit, value)))
        else:
            self.physics.data.ctrl[self.names.actuator(actuator)] = max(-limit, min(limit, value))
        self.physics.changed(CONTROL)
