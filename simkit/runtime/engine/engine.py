"""Engine of a simulation: physics, step loop, servos, wrenches, wind, random streams and plugin faults."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from simkit.run_spec import PluginErrorPolicy
from simkit.runtime.contact.anisotropic_friction import AnisotropicFriction
from simkit.runtime.engine.engine_state import EngineCallbacks, EngineState
from simkit.runtime.engine.external_forces import PersistentWrenches, Wind
from simkit.runtime.engine.number_changes import NumberChanges
from simkit.runtime.engine.physics_state import CONTROL, STALE
from simkit.runtime.engine.plugin_faults import PluginFaults
from simkit.runtime.engine.random_streams import RandomStreams
from simkit.runtime.engine.step_loop import CommandSource, StepLoop
from simkit.runtime.engine.stray_bodies import StrayBodies
from simkit.runtime.engine.velocity_limits import NO_LIMIT
from simkit.runtime.engine.velocity_servos import VelocityServos

if TYPE_CHECKING:
    import logging

    from simkit.compiler import ActuatorRef
    from simkit.diagnostics import Diagnostics
    from simkit.runtime.engine.entity_structure import WorldStructure
    from simkit.runtime.engine.scheduler import Scheduler
    from simkit.runtime.engine.simulated_time import Clock
    from simkit.scene import SceneWorld

_LARGEST_CONTROL: Final = 9e9
"""Largest control [rad/s, N·m, …]. From 1e10 (mjMAXVAL) on, MuJoCo sets every control of the world to zero."""

_FASTEST_WHEEL, _LARGEST_TURN = 150.0, 0.2
"""Largest speed [rad/s] of a drive's joint without a velocity limit, and its largest rotation in a step [rad].

Six vehicles of 1 to 60 kg, with two or four wheels of unlimited torque, were driven straight and on the spot and then
reversed, at steps of 0.5, 1 and 2 ms. None of them diverged up to these speeds. At 200 rad/s and 1 ms, one run of
twelve did. At 4 ms, one vehicle was tried: it was stable at 50 and 75 rad/s.
"""


class Engine(EngineState):
    """All parts of a simulation that advance it.

    Args:
        world: scene of the world.
        structure: compiled structure of the world.
        clock: simulated time.
        seed: seed of all random streams.
        reports: collection of the diagnostics of the run.
        log: logger of the simulation.
        callbacks: functions of the other parts of the simulation.
        commands: source of the commands that are delivered between two steps.
        on_error: policy for plugins that raise; None uses the policy of the file or of the plugin's class.
        render_thread: True to draw camera images on another thread.

    Attributes:
        streams: random numbers by name.
        faults: handling of plugins that raise, and the set of disabled plugins.
        velocity_servos: velocity servos that plugins requested.
        numbers: numbers of the model that a program changed.
        wrenches: wrenches that persist until they are replaced.
        wind: velocity of the air.
        friction: contacts with directional friction or slip.
        stray_bodies: warnings about bodies that leave the world.
        loop: step loop.
        render_thread: True to draw camera images on another thread during the physics, unless a subscriber waits for
            them. The value may change at any time, because it has no effect on the messages.
        renderer: description of the renderer that draws the images; empty before an image is drawn or requested.
    """

    renderer = ""

    def __init__(
        self,
        world: SceneWorld,
        structure: WorldStructure,
        clock: Clock,
        seed: int,
        reports: Diagnostics,
        log: logging.Logger,
        callbacks: EngineCallbacks,
        commands: CommandSource,
        on_error: PluginErrorPolicy | None = None,
        *,
        render_thread: bool = False,
    ) -> None:
        self.render_thread = render_thread
        super().__init__(world, structure, clock, reports, log, callbacks)
        self.streams = RandomStreams(seed)
        self.loop = StepLoop(self.physics, commands, callbacks.fill, callbacks.schedule_inputs)
        self.faults = PluginFaults(self, self.loop.reschedule, on_error)
        self.numbers = NumberChanges(self, lambda: self.velocity_servos.renew())
        self.velocity_servos = VelocityServos(self, self.numbers)
        self.wrenches = PersistentWrenches(self, self.faults)
        self.wind = Wind(world)
        self.friction = AnisotropicFriction(self.physics.use_shaper, self.physics.changed_contacts, reports)
        self.stray_bodies = StrayBodies(self)
        self._drive_bound = min(_FASTEST_WHEEL, _LARGEST_TURN / clock.timestep)
        self._bounded: set[tuple[str, str]] = set()

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

    def use_renderer(self, description: str) -> None:
        """Store the description of the renderer that draws the images."""
        self.renderer = description

    def look_for_rest(self, _tick: int) -> None:
        """Let bodies at rest sleep, and set the rolling resistance in heaps."""
        physics = self.physics
        torques = None if physics.sleep.rests else physics.sleep.look(physics.fresh())
        if torques is not None:
            for sensor in self.structure.all_sensors():
                sensor.take_held()  # with the present resistance
            physics.sleep.heaps.torques = torques
            physics.changed(STALE)

    def speed_limit(self, actuator: ActuatorRef) -> float:
        """Return the largest command of a velocity servo [rad/s]: the joint's limit, else the bound of drives."""
        return self.bounded_limit(self.callbacks.velocity_limit(actuator.joint, actuator.axis))

    def bounded_limit(self, limit: float) -> float:
        """Return a velocity limit [rad/s or m/s], or the bound of drives if the limit means no limit."""
        return limit if limit < NO_LIMIT else self._drive_bound

    def set_control(self, actuator: ActuatorRef, value: float) -> None:
        """Write the control of an actuator that a plugin added; the next step uses it.

        A velocity is limited to the joint's velocity limit, or to the bound of drives, with a warning; its servo
        computes the control from it.
        """
        if actuator.kind == "velocity":
            limit = self.speed_limit(actuator)
            if abs(value) > limit:
                self.report_bound(actuator, value)
            self.velocity_servos.command(actuator, max(-limit, min(limit, value)))
        else:
            self.physics.data.ctrl[self.names.actuator(actuator)] = max(-_LARGEST_CONTROL, min(_LARGEST_CONTROL, value))
        self.physics.changed(CONTROL)

    def report_bound(self, actuator: ActuatorRef, value: float) -> None:
        """Warn, once for each drive, that a command is larger than the bound of a joint without a velocity limit."""
        drive = actuator.joint.rpartition("::")[0], actuator.owner
        if drive in self._bounded or self.callbacks.velocity_limit(actuator.joint, actuator.axis) < NO_LIMIT:
            return
        self._bounded.add(drive)
        joint = self.names.joints[actuator.joint].scene
        message = (
            f"plugin {actuator.owner!r}: a command asks joint {actuator.joint} for {value:.4g} rad/s; the joint has no "
            f"velocity limit, so it gets {self._drive_bound:g} rad/s at most"
        )
        self.reports.warning("SK-PHYS-033", message, joint.where, "give the joint a <limit> with a <velocity>")
