"""Particles of a `<particle_emitter>`: smoke, fog and dust."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from simkit import ModelPlugin, Params, Pose, msgs
from simkit.elementary_functions import power
from simkit.extend import (
    Options,
    OptionsOf,
    block,
    boolean,
    listens,
    number,
    publish_while_subscribed,
    publishes,
    text,
    vector3,
    without_effect,
)
from simkit.msgs import valid_topic
from simkit.runtime.particle_clouds import ParticleCloud, ParticleSource

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder, Vector
    from simkit.msgs import Message

_MARKER, _PARAMETERS, _SWITCH = "visualization_msgs/msg/Marker", "ros_gz_interfaces/msg/ParamVec", "std_msgs/msg/Bool"
_QUOTA = 5000  # particles at once, as in gz-rendering
_MARKER_RATE = 10.0  # [Hz]
_KEPT = 60.0  # [s] for this time after its end, a sensor may still read a sample that contains a particle
_OPACITY = 0.3  # of a sphere, which replaces a picture of smoke with a soft edge
_SPHERE_LIST, _DELETE = 7, 2  # of a `Marker`
_INTEGER, _DOUBLE = 2, 3  # types of a `rcl_interfaces/msg/ParameterValue`
_BIRTH, _END, _SIZE, _GROWTH, _POSITION, _VELOCITY = 0, 1, 2, 3, slice(4, 7), slice(7, 10)
"""Columns of a particle: times [s], diameter [m] and its growth [m/s], position [m] and velocity [m/s] in the world."""

_SETTINGS = {
    "rate": (0.0, 1e5),
    "duration": (-math.inf, math.inf),
    "lifetime": (1e-3, 1e6),
    "min_velocity": (0.0, 1e6),
    "max_velocity": (0.0, 1e6),
    "scale_rate": (0.0, 1e6),
    "particle_scatter_ratio": (0.0, 1.0),
}
"""Smallest and largest values of what commands may change."""


class ParticleMaterialOptions(Options):
    """Options of the `<material>` block."""

    diffuse: str = text("1 1 1 1")


class ParticleEmitterOptions(Options):
    """Options of `ParticleEmitter`, with the defaults of SDF."""

    emitting: bool = boolean(True)
    duration: float = number(0.0, "s")
    size: tuple[float, float, float] = vector3((1, 1, 1), "m")
    particle_size: tuple[float, float, float] = vector3((1, 1, 1), "m")
    lifetime: float = number(5.0, "s", minimum=1e-3, maximum=1e6)
    rate: float = number(10.0, "Hz", minimum=0, maximum=1e5)
    min_velocity: float = number(1.0, "m/s", minimum=0, maximum=1e6)
    max_velocity: float = number(1.0, "m/s", minimum=0, maximum=1e6)
    scale_rate: float = number(0.0, "m/s", minimum=0, maximum=1e6)
    particle_scatter_ratio: float = number(0.65, minimum=0, maximum=1)
    color_start: str = text("1 1 1 1")
    color_end: str = text("1 1 1 1")
    topic: str = text()
    material: ParticleMaterialOptions = block(ParticleMaterialOptions)
    color_range_image: bool = without_effect()


class ParticleEmitter(ModelPlugin, ParticleSource):
    """Emits particles along the x axis of a `<particle_emitter>`, as Gazebo Sim does.

    Cameras and pictures show particles as transparent spheres. Rendered lidars and depth cameras have echoes of a share
    `<particle_scatter_ratio>` of the rays through particles. On `…/particle_emitter/<name>/cmd`, or on `<topic>`, a
    `Bool` begins and ends the emission, and a `ParamVec` changes numbers by the names of their elements. A `Marker`
    with the particles is published on `…/particle_emitter/<name>/particles`.
    """

    endpoints = (
        listens("/model/{model}/link/…/particle_emitter/…/cmd", _SWITCH, _PARAMETERS, named_by=("topic",)),
        publishes("/model/{model}/link/…/particle_emitter/…/particles", _MARKER),
    )
    options = OptionsOf(ParticleEmitterOptions)
    filenames = ("simkit-particle-emitter",)
    after_step_rate = 50.0
    lets_sleep = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self._settings: dict[str, float] = {name: getattr(options, name) for name in _SETTINGS}
        self._kind = params.attribute("type") or "point"
        self._pose = params.pose("pose")
        params.block("material").mark_all_read()  # the other elements are of Gazebo's picture of a particle
        tint = _colour(options.material.diffuse)
        self._start, self._finish = tint * _colour(options.color_start), tint * _colour(options.color_end)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        *models, link = self.scoped.split("::")
        base = "".join(f"/model/{name}" for name in models) + f"/link/{link}/particle_emitter/{self.name}"
        self._emitting = options.emitting
        self._begun, self._count, self._serial = 0.0, 0, 0
        self._particles: Vector = np.zeros((0, 10))
        self._stream = self.random("particles", 4)
        self.listen(valid_topic(options.topic or f"{base}/cmd"), (_SWITCH, _PARAMETERS), self._on_command)
        self._marker = self.advertise(valid_topic(f"{base}/particles"), _MARKER)
        publish_while_subscribed(self, self._marker, _MARKER_RATE, "publish_marker")

    def _on_command(self, message: Message) -> None:
        if message.__msgtype__ == _SWITCH:
            self._switch(bool(message.data))
            return
        for parameter in message.params:
            value = parameter.value
            given = float(value.double_value if value.type == _DOUBLE else value.integer_value)
            limits = _SETTINGS.get(parameter.name)
            if parameter.name == "emitting":
                self._switch(bool(value.bool_value))
            elif limits is not None and value.type in (_INTEGER, _DOUBLE) and limits[0] <= given <= limits[1]:
                self._settings[parameter.name] = given
                self._begun, self._count = self.sim.time, 0
            else:
                what = f"parameter {parameter.name!r} is unknown, has a wrong type or is out of range; it is ignored"
                self._once.left_out(parameter.name, what, "known are emitting, " + ", ".join(_SETTINGS))

    def _switch(self, is_on: bool) -> None:
        if is_on and not self._emitting:
            self._begun, self._count = self.sim.time, 0
        self._emitting = is_on

    def after_step(self) -> None:
        """Emit the particles that are due, and forget those that no sensor can read any more."""
        settings, now = self._settings, self.sim.time
        if len(self._particles) and self._particles[0, _END] < now - _KEPT:
            self._particles = self._particles[self._particles[:, _END] >= now - _KEPT]
        if not self._emitting or settings["rate"] == 0:
            return
        last = min(now, self._begun + settings["duration"]) if settings["duration"] > 0 else now
        due = math.floor((last - self._begun) * settings["rate"] + 1e-9)
        missing = due - self._count
        if missing <= 0:
            return
        self._count = due
        alive = int(np.count_nonzero(self._particles[:, _END] > now))
        pose = self.sim.link(self.scoped).pose @ self._pose
        births = [self._begun + (due - missing + 1 + n) / settings["rate"] for n in range(missing)]
        born = [self._new_particle(birth, pose) for birth in births[: max(_QUOTA - alive, 0)]]
        if born:
            self._particles = np.concatenate((self._particles, np.array(born)))

    def _new_particle(self, birth: float, pose: Pose) -> list[float]:
        settings = self._settings
        numbers = self._stream.uniform(self._serial).tolist()
        self._serial += 1
        low, high = settings["min_velocity"], settings["max_velocity"]
        speed = low + (high - low) * (numbers[3] + 1) / 2
        position = pose.transform(self._place(*numbers[:3]))
        velocity = pose.rotate((speed, 0.0, 0.0))
        width, height, _ = self.options.particle_size
        return [
            birth,
            birth + settings["lifetime"],
            (width + height) / 2,
            settings["scale_rate"],
            *map(float, position),
            *map(float, velocity),
        ]

    def _place(self, a: float, b: float, c: float) -> tuple[float, float, float]:
        """Return a place in the emitter for three numbers within ±1.

        The first two sizes are across the x axis, and the third one is along it (Ogre's area emitters).
        """
        if self._kind == "cylinder":
            radius = math.sqrt((a + 1) / 2)
            a, b = radius * math.cos(math.pi * b), radius * math.sin(math.pi * b)
        elif self._kind == "ellipsoid":
            radius = float(power((a + 1) / 2, 1 / 3))
            flat = radius * math.sqrt(1 - c * c)
            a, b, c = flat * math.cos(math.pi * b), flat * math.sin(math.pi * b), radius * c
        elif self._kind != "box":
            return 0.0, 0.0, 0.0
        across, up, along = self.options.size
        return c * along / 2, a * across / 2, b * up / 2

    def cloud_at(self, time: float) -> ParticleCloud | None:
        particles = self._particles
        rows = particles[(particles[:, _BIRTH] <= time) & (particles[:, _END] > time)]
        if not len(rows):
            return None
        ages = time - rows[:, _BIRTH]
        share = (ages / (rows[:, _END] - rows[:, _BIRTH]))[:, None]
        colours = self._start * (1 - share) + self._finish * share
        colours[:, 3] *= _OPACITY
        return ParticleCloud(
            rows[:, _POSITION] + rows[:, _VELOCITY] * ages[:, None],
            (rows[:, _SIZE] + rows[:, _GROWTH] * ages) / 2,
            colours,
            self._settings["particle_scatter_ratio"],
        )

    def publish_marker(self) -> None:
        """Publish the particles, with their mean size."""
        cloud = self.cloud_at(self.sim.time)
        fields: dict[str, Any] = {
            "header": msgs.header(self.sim.time_ns, self.sim.world.name),
            "ns": f"{self.scoped}::{self.name}",
        }
        if cloud is None:
            self._marker.publish({**fields, "action": _DELETE})
            return
        size = 2 * float(np.median(cloud.radii))
        self._marker.publish(
            {
                **fields,
                "type": _SPHERE_LIST,
                "scale": {"x": size, "y": size, "z": size},
                "points": [{"x": x, "y": y, "z": z} for x, y, z in cloud.positions.tolist()],
                "colors": [{"r": r, "g": g, "b": b, "a": a} for r, g, b, a in cloud.colours.tolist()],
            }
        )


def _colour(words: str) -> Vector:
    """Return red, green, blue and opacity; white if the text has neither three nor four numbers."""
    try:
        numbers = [float(word) for word in words.split()]
    except ValueError:
        numbers = []
    if len(numbers) not in (3, 4) or not all(map(math.isfinite, numbers)):
        numbers = [1.0] * 4
    return np.clip([*numbers, 1.0][:4], 0.0, 1.0)
