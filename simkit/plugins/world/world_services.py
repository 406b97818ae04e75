"""Services that gz's server, UserCommands and SceneBroadcaster offer for every world: `/world/<world>/...`."""

from __future__ import annotations

import math
from collections.abc import Callable, Container
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from simkit import msgs
from simkit.msgs.topic_names import valid_topic
from simkit.number_text import counted
from simkit.params import Params
from simkit.plugins.base import WorldPlugin
from simkit.plugins.drives.wheel_slip import set_compliances
from simkit.plugins.world.service_entities import (
    KINDS,
    RequestRefused,
    answer_handler,
    colour_of,
    command_handler,
    entity_id,
    entity_of,
    find_entity,
    frame_of,
    handle_of,
    pose_fields,
    pose_of,
    require_finite,
    scoped_names,
    spawn_entities,
    vector_of,
)
from simkit.plugins.world.world_settings import set_entity_location, set_physics, set_world_location
from simkit.pose import IDENTITY, Pose

if TYPE_CHECKING:
    from simkit.runtime import Simulation
    from simkit.scene import SceneJoint

LIGHT: Final = "ros_gz_interfaces/msg/Light"
MATERIAL: Final = "ros_gz_interfaces/msg/MaterialColor"
_LIGHTS: Final = ("point", "spot", "directional")
_REQUEST: Final = "simkit_msgs/srv/EntityRequest"
_Does = Callable[..., dict[str, object] | str | None]


class WorldServices(WorldPlugin):
    """Offers `/world/<world>/control`, `create`, `remove`, `set_pose` and more services; every world has this plugin.

    A service sends its response after the request is completed. gz also has a service `<name>/blocking` that waits for
    the completion, so simkit offers each service except `control` under this name too. `docs/services.md` describes the
    requests and effects of all services.
    """

    on_error = "stop"
    only_publishes = True

    def load(self, parent: Simulation, params: Params) -> None:
        self._prefix = prefix = valid_topic(f"/world/{self.sim.world.name}")
        offer = self.sim.communication.services.offer_by_default
        for short, (type_name, does) in self._services().items():
            name = f"{prefix}/{short}"
            has_status = type_name.startswith(("simkit_msgs", "gazebo_msgs"))
            handler = answer_handler(self.sim, name, does, has_status)
            offer(name, type_name, handler)
            if short != "control":
                offer(f"{name}/blocking", type_name, handler)
        offer(f"{prefix}/scene/info", "simkit_msgs/srv/GetScene", self._scene_info)
        writing = answer_handler(self.sim, f"{prefix}/generate_world_sdf", lambda _: {"sdf": self.sim.control.to_sdf()})
        offer(f"{prefix}/generate_world_sdf", "simkit_msgs/srv/GenerateWorldSdf", writing)
        inputs: dict[str, tuple[str, Callable[..., str | None]]] = {
            "light_config": (LIGHT, self._configure_light),
            "material_color": (MATERIAL, self._paint),
        }
        for short, (type_name, configure) in inputs.items():
            topic = f"{prefix}/{short}"
            self.sim.communication.bus.aside.add(topic)
            self.sim.communication.bus.unlisted.add(topic)
            self.sim.communication.bus.listen(topic, (type_name,), command_handler(self.sim, topic, configure))

    def _services(self) -> dict[str, tuple[str, _Does]]:
        """Return type and handler of each service."""
        return {
            "control": ("ros_gz_interfaces/srv/ControlWorld", self._control),
            "create": ("ros_gz_interfaces/srv/SpawnEntity", lambda request: self._spawn(request.entity_factory)),
            "create_multiple": ("simkit_msgs/srv/SpawnEntities", self._create_multiple),
            "remove": ("ros_gz_interfaces/srv/DeleteEntity", self._remove),
            "set_pose": (
                "ros_gz_interfaces/srv/SetEntityPose",
                lambda request: self._place(request.entity, pose_of(request.pose)),
            ),
            "set_pose_vector": ("simkit_msgs/srv/SetEntityPoses", self._set_pose_vector),
            "set_physics": ("gazebo_msgs/srv/SetPhysicsProperties", self._set_physics),
            "light_config": ("simkit_msgs/srv/SetLight", lambda request: self._configure_light(request.light)),
            "visual_config": ("simkit_msgs/srv/SetMaterialColor", lambda request: self._paint(request.material_color)),
            "wheel_slip": ("simkit_msgs/srv/SetWheelSlip", self._wheel_slip),
            "enable_collision": (_REQUEST, partial(self._switch_collision, True)),
            "disable_collision": (_REQUEST, partial(self._switch_collision, False)),
            "set_spherical_coordinates": ("simkit_msgs/srv/SetSphericalCoordinates", self._set_spherical_coordinates),
        }

    # ------------------------------------------------------------------ running

    def _control(self, request: msgs.ControlWorld_Request) -> None:
        control, sim = request.world_control, self.sim
        pausing, reset, seed = sim.control.pausing, control.reset, int(control.seed)
        time_ns = msgs.stamp_ns(control.run_to_sim_time)
        starts_over = bool(reset.all or reset.time_only)
        if time_ns and time_ns <= (0 if starts_over else sim.time_ns):
            raise RequestRefused(f"run_to_sim_time {time_ns / 1e9:g} s is in the past; the time is {sim.time:g} s")
        if starts_over:
            sim.reset(seed or None)
        elif seed:
            sim.control.reseed(seed)
        if reset.model_only and not starts_over:
            sim.control.reset_models()
        count = int(control.multi_step) or int(bool(control.step))
        if time_ns:
            pausing.run_to(time_ns)
        elif count:
            pausing.step(count)
        else:
            sim.paused = bool(control.pause)
        pausing.catch_up()

    def _set_physics(self, request: msgs.SetPhysicsProperties_Request) -> str:
        # gz's own message has no gravity, so a zero vector here means "unchanged", not weightlessness
        gravity = request.gravity
        return set_physics(self.sim, request, keeps_gravity=not (gravity.x or gravity.y or gravity.z))

    # ------------------------------------------------------------------ entities

    def _create_multiple(self, request: msgs.SpawnEntities_Request) -> None:
        with self.sim.contents.all_or_none():
            waiting: dict[str, tuple[str, Pose | None]] = {}
            for factory in request.entity_factories:
                if factory.clone_name or factory.relative_to not in (
                    "",
                    "world",
                ):  # this request may refer to a model in `waiting`
                    self._spawn_waiting(waiting)
                    self._spawn(factory)
                else:
                    source, name, pose = self._spawn_arguments(factory, waiting)
                    if name is None:
                        name = self._free_name(self.sim.contents.name_in_file(source), False, waiting)
                    waiting[name] = source, pose
            self._spawn_waiting(waiting)

    def _spawn_waiting(self, waiting: dict[str, tuple[str, Pose | None]]) -> None:
        """Spawn models, given by name, and compile the world only once for all of them."""
        if waiting:
            spawn_entities(
                self.sim.contents.spawn_all, [(source, name, pose) for name, (source, pose) in waiting.items()]
            )
            waiting.clear()

    def _spawn(self, factory: msgs.EntityFactory) -> None:
        if factory.clone_name:
            pose = self._requested_pose(factory)
            _, old = find_entity(self.sim, factory.clone_name, ("model",))
            spawn_entities(self.sim.contents.clone, old, self._free_name(factory.name or old, True), pose)
        else:
            spawn_entities(self.sim.spawn, *self._spawn_arguments(factory))

    def _spawn_arguments(
        self, factory: msgs.EntityFactory, waiting: Container[str] = ()
    ) -> tuple[str, str | None, Pose | None]:
        """Return source, name and pose of a new model, as arguments of `sim.spawn`."""
        pose = self._requested_pose(factory)
        source, name = self.sim.control.client_source(factory.sdf or factory.sdf_filename), factory.name or None
        if factory.allow_renaming:
            name = self._free_name(name or self.sim.contents.name_in_file(source), True, waiting)
        elif name is not None:
            self._free_name(name, False, waiting)
        return source, name, pose

    def _requested_pose(self, factory: msgs.EntityFactory) -> Pose | None:
        """Return the requested pose of a model; None for the pose in its file."""
        sources = {"sdf": factory.sdf, "sdf_filename": factory.sdf_filename, "clone_name": factory.clone_name}
        sources_in_request = [field for field, value in sources.items() if value]
        if len(sources_in_request) != 1:
            raise RequestRefused(
                f"found {' and '.join(sources_in_request) or 'none'} of sdf, sdf_filename and clone_name; expected one"
            )
        requested = pose_of(factory.pose)
        # a ROS message always has a pose and a frame, so the identity in the default frame means the pose in the file
        if requested == IDENTITY and factory.relative_to in ("", "world"):
            return None
        return frame_of(self.sim, factory.relative_to) @ requested

    def _free_name(self, name: str, may_rename: bool, waiting: Container[str] = ()) -> str:
        """Return the name, or the name with a number appended as in gz if it is in use; raises `RequestRefused`."""
        models = self.sim.models
        if (name in models or name in waiting) and not may_rename:
            raise RequestRefused(f"a model {name!r} already exists, and allow_renaming is false")
        base, number = name, 0
        while name in models or name in waiting:
            name, number = f"{base}_{number}", number + 1
        return name

    def _remove(self, request: msgs.ros_gz_interfaces__srv__DeleteEntity_Request) -> None:
        kind, name = entity_of(self.sim, request.entity, ("model", "light"))
        if kind == "light":
            raise RequestRefused(f"the light {name!r} cannot be removed; light_config can darken it")
        if "::" in name:
            raise RequestRefused(f"{name!r} is not a direct child of the world; remove {name.split('::')[0]!r}")
        self.sim.remove(name)

    def _set_pose_vector(self, request: msgs.SetEntityPoses_Request) -> None:
        if len(request.entities) != len(request.poses):
            raise RequestRefused(
                f"found {counted(len(request.entities), 'entity', 'entities')} "
                f"and {counted(len(request.poses), 'pose')}; "
                "expected one pose per entity"
            )
        poses = [pose_of(pose) for pose in request.poses]
        for entity in request.entities:  # check all entities before the first one moves
            entity_of(self.sim, entity, ("model", "light"))
        for entity, pose in zip(request.entities, poses, strict=True):
            self._place(entity, pose)

    def _place(self, entity: msgs.Entity, pose: Pose) -> None:
        handle_of(self.sim, *entity_of(self.sim, entity, ("model", "light"))).set_pose(pose)

    def _switch_collision(self, enabled: bool, request: msgs.EntityRequest_Request) -> None:
        kind, name = entity_of(self.sim, request.entity, ("collision", "link", "model"))
        if kind == "model":
            links = [link.scoped for link in self.sim.model(name).scene.all_links()]
            self.sim.control.enable_collisions(links, enabled)
        elif kind == "link":
            self.sim.control.enable_collisions([name], enabled)
        else:
            self.sim.control.enable_collisions([name.rpartition("::")[0]], enabled, only=name)

    def _wheel_slip(self, request: msgs.SetWheelSlip_Request) -> None:
        kind, name = entity_of(self.sim, request.entity, ("model", "link"))
        links = {link.scoped for link in self.sim.model(name).scene.all_links()} if kind == "model" else {name}
        values = float(request.slip_compliance_lateral), float(request.slip_compliance_longitudinal)
        if not set_compliances(self.sim, links, *values):
            raise RequestRefused(f"{kind} {name!r} has no wheel of a wheel slip plugin")

    # ------------------------------------------------------------------ looks

    def _configure_light(self, request: msgs.Light) -> None:
        """Change a light; zeros in the message mean "unchanged", because ROS cannot omit a field."""
        sim = self.sim
        name = request.name
        if not name and request.id:
            raise RequestRefused("the request has an id but no name; lights are identified by their names")
        light = sim.light(find_entity(sim, name, ("light",))[1])
        scene = light.scene
        kind = _LIGHTS[int(request.type)] if 0 <= int(request.type) < len(_LIGHTS) else ""
        if int(request.type) and kind != scene.type:
            other = f"a {kind} light" if kind else f"a light of type {int(request.type)}"
            raise RequestRefused(f"light {light.scoped!r} is a {scene.type} light and cannot become {other}")
        change: dict[str, Any] = {"cast_shadows": bool(request.cast_shadows)}
        for part in ("diffuse", "specular"):
            colour = colour_of(getattr(request, part), part)
            if colour is not None:
                change[part] = colour
        fading = ("range", "attenuation_constant", "attenuation_linear", "attenuation_quadratic")
        values = [require_finite(getattr(request, field), field, 0.0) for field in fading]
        if any(values):
            change["attenuation"] = (values[0] or scene.attenuation[0], *values[1:])
        spot = [require_finite(getattr(request, f"spot_{field}"), f"spot_{field}", 0.0) for field in _SPOT]
        if any(spot):
            change["spot"] = tuple(spot)
        if request.intensity:
            change["intensity"] = require_finite(request.intensity, "intensity", 0.0)
        direction = vector_of(request.direction, "direction")
        size = math.hypot(*direction)
        if size > 0.0:
            change["direction"] = tuple(part / size for part in direction)
        pose = pose_of(request.pose)
        light.change(replace(scene, **change))
        if pose != IDENTITY:
            light.set_pose(pose)

    def _paint(self, request: msgs.MaterialColor) -> str | None:
        sim, entity = self.sim, request.entity
        kind, name = entity_of(sim, entity, ("visual", "link", "model"))
        diffuse = colour_of(request.diffuse, "diffuse")
        if diffuse is None:
            raise RequestRefused("the diffuse colour is all zero, which means unchanged; set it to the new colour")
        if kind == "visual":
            painted = [name]
            if int(request.entity_match) == 1:
                plain = name.rpartition("::")[2]
                painted = [visual for visual in scoped_names(sim, "visual") if visual.rpartition("::")[2] == plain]
        else:
            painted = [visual for visual in scoped_names(sim, "visual") if visual.startswith(f"{name}::")]
        for visual in painted:
            sim.visual(visual).set_colour(*diffuse)
        others = [part for part in ("specular", "emissive") if any(getattr(getattr(request, part), c) for c in "rgb")]
        if others or request.shininess:
            unused = " and ".join([*others, *(["shininess"] if request.shininess else [])])
            return f"the diffuse colour is set; {unused} cannot be set and did not change"
        return None

    def _scene_info(self, _: object) -> dict[str, object]:
        sim = self.sim
        entities = [_entity_description(sim, kind, scoped) for kind in KINDS[1:] for scoped in scoped_names(sim, kind)]
        around = sim.world.surroundings
        ambient, background = (dict(zip("rgba", colour, strict=True)) for colour in (around.ambient, around.background))
        return {
            "name": sim.world.name,
            "header": msgs.header(sim.time_ns, sim.world.name),
            "entities": entities,
            "ambient": ambient,
            "background": background,
            "shadows": around.shadows,
            "grid": around.grid,
            "sky": around.sky,
        }

    # ------------------------------------------------------------------ location on Earth

    def _set_spherical_coordinates(self, request: msgs.SetSphericalCoordinates_Request) -> None:
        entity = request.entity
        if entity.name or entity.id:
            handle = handle_of(self.sim, *entity_of(self.sim, entity, ("model", "light")))
            set_entity_location(self.sim, handle, request)
        else:
            set_world_location(self.sim, request)


_SPOT: Final = ("inner_angle", "outer_angle", "falloff")


def _entity_description(sim: Simulation, kind: str, scoped: str) -> dict[str, object]:
    """Return a `SceneEntity`: the entity, its parent and its pose in the world."""
    outer = scoped.rpartition("::")[0]
    if kind == "collision":
        link = sim.link(outer)
        pose = link.pose @ next(c.pose_link for c in link.scene.collisions if c.scoped == scoped)
    elif kind == "joint":
        joint = sim.joint(scoped)
        pose = _joint_pose(sim, joint.scene)
    else:
        pose = handle_of(sim, kind, scoped).pose
    model = sim.engine.structure.models.get(scoped.split("::")[0])
    return {
        "entity": {"id": entity_id(kind, scoped), "name": scoped, "type": KINDS.index(kind)},
        "parent": outer or sim.world.name,
        "pose": pose_fields(pose),
        "is_static": bool(model.static) if model is not None else kind == "light",
    }


def _joint_pose(sim: Simulation, scene: SceneJoint) -> Pose:
    """Return the current pose of a joint's frame, which moves with the child link."""
    if scene.child_link not in sim.contents.handles.tables["link"]:
        return scene.pose_world
    link = sim.link(scene.child_link)
    return link.pose @ link.scene.pose_world.inverse() @ scene.pose_world
