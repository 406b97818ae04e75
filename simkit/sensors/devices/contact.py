"""Contact sensors: the contacts of some collisions of a link, with position, depth and force."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Final

import mujoco

from simkit import msgs
from simkit.compiler import Compiled, SpecBuilder
from simkit.compiler.name_map import NameMap
from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.linear_algebra import matmul
from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.pose import Vector
from simkit.runtime.contact.collision_contacts import CollisionTable, collision_table, find_contacts
from simkit.scene import SceneModel, SceneSensor, SceneWorld
from simkit.sensors.base import Product, Sensor
from simkit.sensors.devices.collision_names import find_collision
from simkit.sensors.devices.contact_reading import ContactReading, RawContacts, contacts_message, states_message
from simkit.sensors.topics_and_frames import check_topic

CONTACTS: Final = "ros_gz_interfaces/msg/Contacts"
STATES: Final = "gazebo_msgs/msg/ContactsState"
_WORLD_FRAMES = ("", "world", "map")
_PHYSICS_PLUGIN = "physics-system"


@dataclass(frozen=True, slots=True)
class ContactOptions:
    """The `<contact>` block.

    Attributes:
        collisions: names of collisions as in the file, each with its line in the file.
        topic: topic as in the file, or empty.
    """

    collisions: tuple[tuple[str, Where], ...]
    topic: str


class Contact(Sensor["msgs.Contacts"]):
    """Contact sensor, `contact`: the contacts of some collisions of its link; without contacts it publishes nothing.

    The sensor has no noise; `truth` is the same message.

    Attributes:
        collisions: scoped names of the sensor's collisions, in the order of the file.
    """

    kinds = ("contact",)
    example = "<contact><collision>c</collision></contact>"
    sees_scene = False
    needs_acceleration = True  # the contact forces of the last step are needed
    reads_contacts = True
    is_deferred = True
    options: ContactOptions

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        self.collisions: tuple[str, ...] = ()
        self._states_frame: str | None = None

    def read_options(self, params: Params) -> ContactOptions:
        block = params.block("contact")
        named: dict[str, Where] = {}
        for collision in block.all("collision"):
            named.setdefault(collision.attribute("name") or collision.value, collision.where)
        collisions = tuple((name, where) for name, where in named.items() if name)
        topic = block.text("topic", "").replace("__default_topic__", "")
        check_topic(topic, block)
        return ContactOptions(collisions, topic)

    def describe(self) -> dict[str, object]:
        return {"contact": {"collisions": [name for name, _ in self.options.collisions]}}

    def build(self, builder: SpecBuilder) -> None:
        """Find the collisions, and report those that are missing."""
        model = builder.records[self.scene.parent.split("::")[0]].scene
        link = next((candidate for candidate in model.all_links() if candidate.scoped == self.scene.parent), None)
        if link is None:
            return  # the sensor is on a joint, which is reported elsewhere
        listed = [c.name for c in link.collisions]
        available = f"; the link has: {', '.join(map(repr, listed))}" if listed else "; the link has none"
        scoped_names: dict[str, None] = {}
        for name, where in self.options.collisions:
            collision = find_collision(name, link, model)
            if collision is None:
                message = f"contact sensor {self.scoped!r}: its link has no collision {name!r}{available}"
                self.diagnostics.warning("SK-SENSOR-040", message, where, self._hint(name, listed, model))
            else:
                scoped_names[collision.scoped] = None
        self.collisions = tuple(scoped_names)
        if not self.options.collisions:
            message = f"contact sensor {self.scoped!r} has no <collision>: it detects nothing, as in Gazebo{available}"
            hint = "add <collision>NAME</collision> to its <contact>"
            self.diagnostics.warning("SK-SENSOR-041", message, self.scene.where, hint)

    def _hint(self, name: str, listed: Collection[str], model: SceneModel) -> str:
        near = did_you_mean(name, listed)
        others = (link for link in model.all_links() if link.scoped != self.scene.parent)
        other = next((link for link in others if any(c.name == name for c in link.collisions)), None)
        if near or other is None:
            return near
        return f"link {other.scoped!r} has one of that name: move the sensor to that link"

    def prepare(self) -> None:
        self._quirks = bool(self.sim.world.gazebo_quirks)
        if self._quirks:
            self.update_rate = 0.0  # Gazebo publishes contacts at every step, whatever the <update_rate>
        self._is_named = _includes_entity_names(self.sim.world)

    def bind(self, compiled: Compiled) -> None:
        super().bind(compiled)
        self._numbers: CollisionTable = collision_table(compiled)
        self._mine = self._numbers.mask(self.collisions)
        known = {name: number for number, name in enumerate(self._numbers.names)}
        self._order = {known[name]: index for index, name in enumerate(self.collisions) if name in known}
        self._centres = {number: self._centre_of(self._numbers.names[number], compiled) for number in self._order}
        self._frame = self._find_frame(compiled.names)

    def _centre_of(self, collision: str, compiled: Compiled) -> tuple[int, Vector]:
        """Return the body of a collision's link, and the link's centre of mass in the body's frame [m]."""
        link = compiled.names.link(collision.rsplit("::", 1)[0])
        return int(link.body), link.offset.transform(link.scene.inertial.com)

    # ------------------------------------------------------------------ states of Gazebo Classic's bumper

    def publish_states(self, topic: str, frame: str) -> bool:
        """Publish `ContactsState` instead of `Contacts`, at every sample.

        Args:
            topic: absolute topic.
            frame: link that all values are relative to, or `world`. If the link does not exist, the values are in the
                world frame.

        Returns:
            False if no link of that name exists yet.
        """
        self._states_frame = frame.strip("/")
        self.update_rate = self.scene.rate
        self._frame = self._find_frame(self.sim.engine.names)
        self.publish_on({"states": topic})
        return self._frame is not None or self._states_frame in _WORLD_FRAMES

    def _find_frame(self, names: NameMap) -> tuple[int, Vector, Vector] | None:
        """Return the body of the frame of `ContactsState`, and the frame's pose in that body; None for the world."""
        frame = self._states_frame
        if frame is None or frame in _WORLD_FRAMES or self._quirks:
            return None
        matching = [scoped for scoped in names.links if f"::{scoped}".endswith(f"::{frame}")]
        top_model_prefix = self.scene.parent.split("::")[0] + "::"
        matching.sort(key=lambda scoped: not scoped.startswith(top_model_prefix))
        if not matching:
            return None
        link = names.link(matching[0])
        return int(link.body), link.offset.position, link.offset.matrix

    # ------------------------------------------------------------------ readings

    def products(self) -> dict[str, Product]:
        return {"contacts": Product(CONTACTS, self._contacts), "states": Product(STATES, self._states)}

    def default_topics(self) -> dict[str, str]:
        topic = self.options.topic
        return {"contacts": valid_topic(topic) if topic else self._default_topic("contact")}

    def publishes(self, product: str, raw: RawContacts) -> bool:
        return product == "states" or raw.touches is not None

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> ContactReading:
        return self.finish(self.capture(model, data))

    def capture(self, model: mujoco.MjModel, data: mujoco.MjData) -> RawContacts:
        """Return the engine's contacts and the link positions that the bumper's states need."""
        contacts = find_contacts(model, data, self._mine)
        if self._states_frame is None:
            return RawContacts(contacts, self._numbers, self._order)
        centres = {
            number: data.xpos[body] + matmul(data.xmat[body].reshape(3, 3), centre)
            for number, (body, centre) in (self._centres.items() if contacts is not None else ())
        }
        if self._frame is None:
            keeps_name = self._quirks or self._states_frame in _WORLD_FRAMES
            frame = self._states_frame if keeps_name and self._states_frame else "world"
            return RawContacts(contacts, self._numbers, self._order, centres, frame)
        body, position, rotation = self._frame
        axes = data.xmat[body].reshape(3, 3)
        origin = data.xpos[body] + matmul(axes, position)
        return RawContacts(
            contacts, self._numbers, self._order, centres, self._states_frame, origin, matmul(axes, rotation)
        )

    def finish(self, raw: RawContacts) -> ContactReading:
        return raw.reading()

    def _contacts(self, reading: ContactReading, time_ns: int) -> msgs.Contacts:
        return contacts_message(reading, msgs.header(time_ns, self.frame_id), self._is_named)

    def _states(self, reading: ContactReading, time_ns: int) -> msgs.ContactsState:
        return states_message(reading, msgs.header(time_ns, reading.frame_id))


def _includes_entity_names(world: SceneWorld) -> bool:
    """Read `<include_entity_names>` of the world's Physics system; without names, Gazebo publishes ids only."""
    physics = (p for p in world.plugins if p.name.endswith("::Physics") or _PHYSICS_PLUGIN in p.filename)
    return all(p.params.block("contacts").boolean("include_entity_names", True) for p in physics)
