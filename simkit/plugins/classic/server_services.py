"""Services of Gazebo Classic's server for ROS 2, and the services under `/gazebo` for worlds of ROS 1."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from simkit import msgs
from simkit.params import Params
from simkit.plugins.base import WorldPlugin
from simkit.plugins.classic import property_services as properties
from simkit.plugins.classic import state_services as states
from simkit.plugins.classic.state_services import LINK_STATES, MODEL_STATES, STATES_RATE
from simkit.plugins.classic.wrench_services import TimedWrench, apply_wrenches, joint_effort, link_wrench
from simkit.plugins.endpoints import offers, offers_all
from simkit.plugins.options import Options, OptionsOf, number
from simkit.plugins.world.service_entities import (
    RequestRefused,
    answer_handler,
    command_handler,
    find_entity,
    pose_fields,
    twist_fields,
)
from simkit.plugins.world.world_settings import physics_fields, set_physics

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Simulation
    from simkit.scene import ScenePlugin, SceneWorld

Handler = Callable[["msgs.Message"], Any]
"""Function from a request to a response, each of the service's type."""

Table = Mapping[str, tuple[str, Handler]]
"""Short name -> type and handler of a service."""

_ROS_1: Final = re.compile(r"libgazebo_ros_(api|paths)_plugin\.so$")
_LIBRARY: Final = re.compile(r"libgazebo_ros_\w+\.so$")
_CAMEL: Final = re.compile(r"^[a-z]+[A-Z]")
_EMPTY: Final = "std_srvs/srv/Empty"


class ClassicServices(WorldPlugin):
    """Offers the services of Gazebo Classic's server; part of every world.

    They spawn, delete and list models, pause and reset the world, and apply wrenches and efforts; `gazebo.launch.py` of
    ROS 2 loads them into every server. Classic offers the services for states and properties only with a plugin in the
    world. simkit always offers them, because they cost nothing. ROS 1's services, under `/gazebo`, always answer, too,
    but only a world with plugins in ROS 1's spelling (camelCase) or with `libgazebo_ros_api_plugin.so` lists them.
    `docs/services.md` describes the requests and effects of all services.
    """

    on_error = "stop"
    only_publishes = True

    def prepare(self, scene: SceneWorld, params: Params, builder: SpecBuilder) -> None:
        self._is_ros_1 = any(_is_of_ros_1(plugin) for plugin in _plugins(scene))

    def load(self, parent: Simulation, params: Params) -> None:
        sim = self.sim
        self.pushes: list[TimedWrench] = []
        tables = [_server_services(sim), _wrench_services(self), state_services(sim), property_services(sim)]
        offer_table("", sim, *tables)
        _broadcast_states("", sim)
        ros_1_tables = (_server_services(sim), _ros_1_services(self), property_services(sim))
        offer_table("/gazebo", sim, *ros_1_tables, is_listed=self._is_ros_1)
        _broadcast_states("/gazebo", sim)
        listen_to_states("/gazebo", sim)
        sim.communication.on_demand.add(lambda: bool(self.pushes), None, self._apply, "before")

    def push_link(self, request: msgs.ApplyLinkWrench_Request | msgs.ApplyBodyWrench_Request, link: str) -> str:
        """Add a wrench on a link for a limited time."""
        self._push(link_wrench(self.sim, link, request))
        return ""

    def push_joint(self, request: msgs.ApplyJointEffort_Request) -> str:
        """Add an effort on a joint for a limited time."""
        self._push(joint_effort(self.sim, request))
        return f"Effort on joint [{request.joint_name}] set"

    def clear_link(self, name: str) -> None:
        """Remove the wrenches on a link."""
        link = find_entity(self.sim, name, ("link",))[1]
        if not self._replace_wrenches([push for push in self.pushes if push.link != link]):
            raise RequestRefused(f"no applied wrenches on {link!r}")

    def clear_joint(self, name: str) -> None:
        """Remove the efforts on a joint."""
        joint = properties.joint_of(self.sim, name).scoped
        if not self._replace_wrenches([push for push in self.pushes if push.joint != joint]):
            raise RequestRefused(f"no applied efforts on {joint!r}")

    def _push(self, push: TimedWrench | None) -> None:
        if push is not None:
            self._replace_wrenches([*self.pushes, push])

    def _replace_wrenches(self, pushes: list[TimedWrench]) -> bool:
        """Replace the active wrenches if their number has changed; return whether they were replaced."""
        if len(pushes) == len(self.pushes):
            return False
        self.pushes = pushes
        self.sim.communication.on_demand.look()
        return True

    def _apply(self, _: int) -> None:
        self._replace_wrenches(apply_wrenches(self.sim, self.pushes))


def offer_table(
    prefix: str,
    sim: Simulation,
    *tables: Table,
    full_name: Callable[[str], str] | None = None,
    is_listed: bool = True,
) -> None:
    """Offer the services of tables.

    With `full_name` the services belong to a plugin in the file and are permanent. Otherwise a service is replaced when
    another service with the same name is offered.

    Args:
        prefix: start of each service name.
        sim: simulation.
        *tables: tables of services.
        full_name: function from a short name to the service name, in place of the prefix.
        is_listed: False for services without `full_name` that lists of services omit.
    """
    for table in tables:
        for short, (type_name, execute) in table.items():
            name = f"{prefix}/{short}" if full_name is None else full_name(short)
            if type_name == _EMPTY or type_name.endswith(("LinkRequest", "BodyRequest", "JointRequest")):
                handler: Handler = command_handler(sim, name, execute)
            else:
                has_status = not type_name.endswith(("GetModelList", "GetEntityState", "SetEntityState"))
                handler = answer_handler(sim, name, execute, has_status)
            if full_name is None:
                sim.communication.services.offer_by_default(name, type_name, handler, is_listed=is_listed)
            else:
                sim.communication.services.offer(name, type_name, handler)


# ---------------------------------------------------------------------- services of the server


def _server_services(sim: Simulation) -> Table:
    """Return the services of gazebo_ros_init and gazebo_ros_factory."""
    return {
        "spawn_entity": ("gazebo_msgs/srv/SpawnEntity", partial(_spawn_entity, sim)),
        "delete_entity": ("gazebo_msgs/srv/DeleteEntity", partial(_delete_entity, sim)),
        "get_model_list": ("gazebo_msgs/srv/GetModelList", partial(_model_list, sim)),
        "pause_physics": (_EMPTY, lambda _: setattr(sim.control, "paused", True)),
        "unpause_physics": (_EMPTY, lambda _: setattr(sim.control, "paused", False)),
        "reset_simulation": (_EMPTY, lambda _: _reset_simulation(sim)),
        "reset_world": (_EMPTY, lambda _: sim.control.reset_models()),
    }


def _spawn_entity(sim: Simulation, request: msgs.gazebo_msgs__srv__SpawnEntity_Request) -> str:
    pose, frame = request.initial_pose, request.reference_frame
    name = states.spawn_model(sim, request.xml, request.name, request.robot_namespace, pose, frame)
    return f"SpawnEntity: Successfully spawned entity [{name}]"


def _delete_entity(sim: Simulation, request: msgs.gazebo_msgs__srv__DeleteEntity_Request) -> str:
    states.delete_model(sim, request.name)
    return f"Successfully deleted entity [{request.name}]"


def _model_list(sim: Simulation, _: object) -> dict[str, object]:
    return {"header": msgs.header(sim.time_ns, ""), "model_names": list(sim.models)}


def _reset_simulation(sim: Simulation) -> None:
    """Reset time, models and plugins; as in Classic, a paused world stays paused."""
    is_paused = sim.paused
    sim.reset()
    sim.paused = is_paused


def _wrench_services(plugin: ClassicServices) -> Table:
    """Return the services of gazebo_ros_force_system."""
    return {
        "apply_link_wrench": ("gazebo_msgs/srv/ApplyLinkWrench", lambda r: plugin.push_link(r, r.link_name)),
        "clear_link_wrenches": ("gazebo_msgs/srv/LinkRequest", lambda r: plugin.clear_link(r.link_name)),
        "apply_joint_effort": ("gazebo_msgs/srv/ApplyJointEffort", plugin.push_joint),
        "clear_joint_efforts": ("gazebo_msgs/srv/JointRequest", lambda r: plugin.clear_joint(r.joint_name)),
    }


# ---------------------------------------------------------------------- services of Classic's plugins


def state_services(sim: Simulation) -> Table:
    """Return the services of gazebo_ros_state."""
    return {
        "get_entity_state": ("gazebo_msgs/srv/GetEntityState", partial(_get_state, sim)),
        "set_entity_state": ("gazebo_msgs/srv/SetEntityState", partial(_set_state, sim)),
        "set_joint_positions": ("gazebo_msgs/srv/SetModelConfiguration", partial(_set_joints, sim)),
    }


def _get_state(sim: Simulation, request: msgs.GetEntityState_Request) -> dict[str, object]:
    pose, linear, angular = states.state_of(sim, request.name, request.reference_frame)
    frame, twist = request.reference_frame, twist_fields(linear, angular)
    state = {"name": request.name, "pose": pose_fields(pose), "twist": twist, "reference_frame": frame}
    return {"header": msgs.header(sim.time_ns, frame), "state": state}


def _set_state(sim: Simulation, request: msgs.SetEntityState_Request) -> None:
    state = request.state
    states.set_state(sim, state.name, state.pose, state.twist, state.reference_frame)


def _set_joints(sim: Simulation, request: msgs.SetModelConfiguration_Request) -> str:
    states.set_joints(sim, request.model_name, list(request.joint_names), request.joint_positions)
    return "set_joint_positions: success"


def property_services(sim: Simulation) -> Table:
    """Return the services of gazebo_ros_properties.

    `set_link_properties` is missing, because masses and inertias cannot be changed in a compiled world.
    """
    return {
        "get_world_properties": ("gazebo_msgs/srv/GetWorldProperties", partial(_world_properties, sim)),
        "get_model_properties": ("gazebo_msgs/srv/GetModelProperties", partial(properties.model_properties, sim)),
        "get_joint_properties": ("gazebo_msgs/srv/GetJointProperties", partial(properties.joint_properties, sim)),
        "set_joint_properties": ("gazebo_msgs/srv/SetJointProperties", partial(properties.set_joint_properties, sim)),
        "get_link_properties": ("gazebo_msgs/srv/GetLinkProperties", partial(properties.link_properties, sim)),
        "get_light_properties": ("gazebo_msgs/srv/GetLightProperties", partial(properties.light_properties, sim)),
        "set_light_properties": ("gazebo_msgs/srv/SetLightProperties", partial(properties.set_light_properties, sim)),
        "get_physics_properties": ("gazebo_msgs/srv/GetPhysicsProperties", lambda _: physics_fields(sim)),
        "set_physics_properties": ("gazebo_msgs/srv/SetPhysicsProperties", partial(_set_physics, sim)),
    }


def _set_physics(sim: Simulation, request: msgs.SetPhysicsProperties_Request) -> str:
    return set_physics(sim, request) or "physics engine updated"


def _world_properties(sim: Simulation, _: object) -> dict[str, object]:
    properties = {"sim_time": sim.time, "model_names": list(sim.models), "rendering_enabled": True}
    return {**properties, "status_message": "GetWorldProperties: got properties"}


# ---------------------------------------------------------------------- ROS 1


def _ros_1_services(plugin: ClassicServices) -> Table:
    """Return the services of gazebo_ros_api_plugin, except those that it shares with ROS 2."""
    sim = plugin.sim
    spawn_model = ("gazebo_msgs/srv/SpawnModel", partial(_spawn_model, sim))
    return {
        "spawn_sdf_model": spawn_model,
        "spawn_urdf_model": spawn_model,
        "delete_model": ("gazebo_msgs/srv/DeleteModel", partial(_delete_model, sim)),
        "get_model_state": ("gazebo_msgs/srv/GetModelState", partial(_get_model_state, sim)),
        "set_model_state": ("gazebo_msgs/srv/SetModelState", lambda r: _set_model_state(sim, r.model_state)),
        "get_link_state": ("gazebo_msgs/srv/GetLinkState", partial(_get_link_state, sim)),
        "set_link_state": ("gazebo_msgs/srv/SetLinkState", lambda r: _set_link_state(sim, r.link_state)),
        "set_model_configuration": ("gazebo_msgs/srv/SetModelConfiguration", partial(_configure_model, sim)),
        "apply_body_wrench": ("gazebo_msgs/srv/ApplyBodyWrench", lambda r: plugin.push_link(r, r.body_name)),
        "clear_body_wrenches": ("gazebo_msgs/srv/BodyRequest", lambda r: plugin.clear_link(r.body_name)),
        "apply_joint_effort": ("gazebo_msgs/srv/ApplyJointEffort", plugin.push_joint),
        "clear_joint_forces": ("gazebo_msgs/srv/JointRequest", lambda r: plugin.clear_joint(r.joint_name)),
    }


def _spawn_model(sim: Simulation, request: msgs.SpawnModel_Request) -> str:
    pose, frame = request.initial_pose, request.reference_frame
    states.spawn_model(sim, request.model_xml, request.model_name, request.robot_namespace, pose, frame)
    return "SpawnModel: Successfully spawned entity"


def _delete_model(sim: Simulation, request: msgs.DeleteModel_Request) -> str:
    states.delete_model(sim, request.model_name)
    return "DeleteModel: successfully deleted model"


def _get_model_state(sim: Simulation, request: msgs.GetModelState_Request) -> dict[str, object]:
    frame = request.relative_entity_name
    pose, linear, angular = states.state_of(sim, request.model_name, frame, ("model",))
    state = {"pose": pose_fields(pose), "twist": twist_fields(linear, angular)}
    message = "GetModelState: got properties"
    return {"header": msgs.header(sim.time_ns, frame), **state, "status_message": message}


def _set_model_state(sim: Simulation, state: msgs.ModelState) -> str:
    states.set_state(sim, state.model_name, state.pose, state.twist, state.reference_frame, ("model",))
    return "SetModelState: set model state done"


def _get_link_state(sim: Simulation, request: msgs.GetLinkState_Request) -> dict[str, object]:
    name, frame = request.link_name, request.reference_frame
    pose, linear, angular = states.state_of(sim, name, frame, ("link",))
    twist = twist_fields(linear, angular)
    state = {"link_name": name, "pose": pose_fields(pose), "twist": twist, "reference_frame": frame}
    return {"link_state": state, "status_message": "GetLinkState: got state"}


def _set_link_state(sim: Simulation, state: msgs.LinkState) -> str:
    states.set_state(sim, state.link_name, state.pose, state.twist, state.reference_frame, ("link",))
    return "SetLinkState: success"


def _configure_model(sim: Simulation, request: msgs.SetModelConfiguration_Request) -> str:
    _set_joints(sim, request)
    return "SetModelConfiguration: success"


def listen_to_states(prefix: str, sim: Simulation) -> None:
    """Subscribe to ROS 1's topics that set states."""
    inputs: dict[str, tuple[str, Callable[..., str]]] = {
        "set_model_state": ("ModelState", _set_model_state),
        "set_link_state": ("LinkState", _set_link_state),
    }
    for short, (kind, execute) in inputs.items():
        topic = f"{prefix}/{short}"
        sim.communication.bus.aside.add(topic)
        sim.communication.bus.unlisted.add(topic)
        take = command_handler(sim, topic, partial(execute, sim))
        sim.communication.bus.listen(topic, (f"gazebo_msgs/msg/{kind}",), take)


def broadcast_states(sim: Simulation, models: str, links: str, rate: float, *, is_aside: bool) -> None:
    """Publish the states of models and links while the topics have subscribers."""
    topics = {models: MODEL_STATES, links: LINK_STATES}
    make = partial(states.states_message, sim)
    sim.communication.on_demand.broadcast(topics, rate, lambda topic: make(topics[topic]), is_aside=is_aside)


def _broadcast_states(prefix: str, sim: Simulation) -> None:
    models, links = f"{prefix}/model_states", f"{prefix}/link_states"
    if not {models, links} & set(sim.communication.bus.all_topics()):  # else a plugin publishes them already
        broadcast_states(sim, models, links, STATES_RATE, is_aside=True)


# ---------------------------------------------------------------------- ROS version of a world


def _plugins(world: SceneWorld) -> Iterator[ScenePlugin]:
    yield from world.plugins
    for model in (nested for outer in world.models for nested in outer.all_models()):
        yield from model.plugins
        for link in model.links:
            yield from link.plugins
            for sensor in link.sensors:
                yield from sensor.plugins


def has_classic_plugins(world: SceneWorld) -> bool:
    """Check whether a world has plugins of gazebo_ros, so that programs expect Gazebo Classic's services."""
    return any(_LIBRARY.search(plugin.filename) for plugin in _plugins(world))


def _is_of_ros_1(plugin: ScenePlugin) -> bool:
    """Check whether a plugin has the spelling of gazebo_ros for ROS 1: parameters in camelCase, and no `<ros>`."""
    if not _LIBRARY.search(plugin.filename):
        return False
    if _ROS_1.search(plugin.filename):
        return True
    names = [child.name for child in plugin.params.children]
    return "ros" not in names and any(_CAMEL.match(name) for name in names)


class GazeboRosStateOptions(Options):
    """Options of `GazeboRosState`."""

    update_rate: float = number(STATES_RATE, "Hz", minimum=0.0)


class GazeboRosState(WorldPlugin):
    """Publishes `model_states` and `link_states`, and offers `get_entity_state`, `set_entity_state` and others.

    All names are in the plugin's `<ros><namespace>`. `<update_rate>` is 100 Hz by default; 0 means every step.
    """

    options = OptionsOf(GazeboRosStateOptions)
    endpoints = (
        *offers_all("gazebo_msgs", "GetEntityState", "SetEntityState"),
        offers("set_joint_positions", "gazebo_msgs/srv/SetModelConfiguration"),
    )
    filenames = ("libgazebo_ros_state.so",)

    def load(self, parent: Simulation, params: Params) -> None:
        rate = self.options.update_rate
        offer_table("", self.sim, state_services(self.sim), full_name=self.ros.topic)
        models, links = self.ros.topic("model_states"), self.ros.topic("link_states")
        broadcast_states(self.sim, models, links, rate, is_aside=False)


class GazeboRosProperties(WorldPlugin):
    """Offers `get_model_properties`, `get_physics_properties` and others in the plugin's `<ros><namespace>`."""

    filenames = ("libgazebo_ros_properties.so",)
    endpoints = offers_all(
        "gazebo_msgs",
        *("GetWorldProperties", "GetModelProperties", "GetJointProperties", "SetJointProperties", "GetLinkProperties"),
        *("GetLightProperties", "SetLightProperties", "GetPhysicsProperties", "SetPhysicsProperties"),
    )

    def load(self, parent: Simulation, params: Params) -> None:
        offer_table("", self.sim, property_services(self.sim), full_name=self.ros.topic)
