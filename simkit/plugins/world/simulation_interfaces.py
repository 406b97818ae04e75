"""Services and action of ROS 2's `simulation_interfaces`, under their published names; every world has them."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.errors import InputError
from simkit.number_text import counted
from simkit.params import Params
from simkit.plugins.base import WorldPlugin
from simkit.plugins.world import interface_entities as entities
from simkit.plugins.world.interface_entities import PACKAGE, Refusal, ResultCode, result_fields
from simkit.plugins.world.interface_spawning import delete_entity, spawn_entity, spawn_several
from simkit.plugins.world.service_entities import RequestRefused

if TYPE_CHECKING:
    from simkit.runtime import Simulation
    from simkit.runtime.communication.action_server import GoalHandle

Handler = Callable[["Simulation", "msgs.Message"], dict[str, object] | None]

PLAYING, PAUSED = 1, 2
STOPPED: Final = 0
_STATE_NAMES: Final = ("STOPPED", "PLAYING", "PAUSED", "QUITTING", "NO_WORLD", "LOADING_WORLD")
_ALREADY_THERE, _INCORRECT_TRANSITION = 101, 103
_TIME, _STATE, _SPAWNED, _ALL = 1, 2, 4, 255
_MOST_FEEDBACK: Final = 100
"""Largest number of feedback messages of a goal."""

UNSUPPORTED: Final = {
    "SetEntityInfo": "the category of an entity comes from its model",
    "GetNamedPoses": "the world has no named poses",
    "GetNamedPoseBounds": "the world has no named poses",
    "LoadWorld": "a simulation has one world; start simkit with another one",
    "UnloadWorld": "a simulation has one world; end simkit",
    "GetAvailableWorlds": "simkit has no list of worlds",
}
"""Services without a function, and the reason."""

_FEATURES: Final = {
    "SpawnEntity": ("SPAWNING", "SPAWNING_RESOURCE_STRING"),
    "SpawnEntities": ("SPAWNING_ENTITIES",),
    "DeleteEntity": ("DELETING",),
    "GetEntityBounds": ("ENTITY_BOUNDS", "ENTITY_BOUNDS_BOX"),
    "GetEntities": ("ENTITY_CATEGORIES",),
    "GetEntityState": ("ENTITY_STATE_GETTING",),
    "SetEntityState": ("ENTITY_STATE_SETTING",),
    "GetEntityInfo": ("ENTITY_INFO_GETTING",),
    "ResetSimulation": ("SIMULATION_RESET", "SIMULATION_RESET_STATE", "SIMULATION_RESET_SPAWNED"),
    "GetSimulationState": ("SIMULATION_STATE_GETTING",),
    "SetSimulationState": ("SIMULATION_STATE_SETTING", "SIMULATION_STATE_PAUSE"),
    "StepSimulation": ("STEP_SIMULATION_SINGLE", "STEP_SIMULATION_MULTIPLE", "STEP_SIMULATION_ACTION"),
    "GetCurrentWorld": ("WORLD_INFO_GETTING",),
    "GetSpawnables": ("SPAWNABLES",),
}
"""Features that a world has while it serves the service."""


def service_name(interface: str) -> str:
    """Return the name of a service of the package: `/spawn_entity` for `SpawnEntity`."""
    return "/" + re.sub(r"(?<!^)(?=[A-Z])", "_", interface).lower()


class SimulationInterfaces(WorldPlugin):
    """Offers the services of `simulation_interfaces` and the action `/simulate_steps`; every world has this plugin.

    A service whose name is also one of Gazebo Classic's is served by one of both; `<simkit:entity_services>` of the
    world says by which. A service without a function answers RESULT_FEATURE_UNSUPPORTED.
    """

    on_error = "stop"
    only_publishes = True

    def load(self, parent: Simulation, params: Params) -> None:
        self._is_stopped = False
        self._goal: GoalHandle | None = None
        self._first = self._last = 0
        sim = self.sim
        handlers: dict[str, Handler] = {
            **{name: _refuse(reason) for name, reason in UNSUPPORTED.items()},
            "SpawnEntity": spawn_entity,
            "SpawnEntities": spawn_several,
            "DeleteEntity": delete_entity,
            "GetEntityState": entities.entity_state,
            "SetEntityState": entities.set_entity_state,
            "GetEntities": entities.list_entities,
            "GetEntitiesStates": entities.list_states,
            "GetEntityInfo": entities.entity_info,
            "GetEntityBounds": entities.entity_bounds,
            "GetCurrentWorld": _current_world,
            "GetSpawnables": _spawnables,
            "ResetSimulation": self._reset_simulation,
            "StepSimulation": self._step_simulation,
            "GetSimulationState": lambda *_: {"state": {"state": self._state}},
            "SetSimulationState": self._set_state,
        }
        offer = sim.communication.services.offer_by_default
        for interface, handler in handlers.items():
            name = service_name(interface)
            offer(name, f"{PACKAGE}/srv/{interface}", _answering(sim, name, handler))
        offer("/get_simulator_features", f"{PACKAGE}/srv/GetSimulatorFeatures", self._features)
        action = self.act("/simulate_steps", f"{PACKAGE}/action/SimulateSteps", self._begin_steps, self._cancel_steps)
        action.deliver_at_once()  # the world is paused, so no step would come that delivers the goal
        sim.control.pausing.on_change(self._abort_if_paused)
        sim.communication.on_demand.add(lambda: self._goal is not None, None, self._follow_steps)

    def _features(self, _: object) -> dict[str, object]:
        served = self.sim.communication.services.names()
        features = msgs.type_of(f"{PACKAGE}/msg/SimulatorFeatures")
        feature_numbers = [
            int(getattr(features, feature))
            for interface, names in _FEATURES.items()
            if served.get(service_name(interface), "").startswith(PACKAGE)
            for feature in names
        ]
        info = "simkit: entities are models; SetEntityState and GetEntityState also take links and lights"
        return {
            "features": {"features": feature_numbers, "spawn_formats": ["sdf", "urdf", "mjcf"], "custom_info": info}
        }

    # ------------------------------------------------------------------ state of the simulation

    @property
    def _state(self) -> int:
        if not self.sim.paused:
            return PLAYING
        return STOPPED if self._is_stopped and self.sim.tick == 0 else PAUSED

    def _set_state(self, sim: Simulation, request: msgs.SetSimulationState_Request) -> None:
        target = int(request.state.state)
        if target not in (STOPPED, PLAYING, PAUSED):
            named = _STATE_NAMES[target] if target < len(_STATE_NAMES) else str(target)
            raise Refusal(_INCORRECT_TRANSITION, f"a client cannot set the state {named}; it can set 0, 1 and 2")
        if target == self._state:
            raise Refusal(_ALREADY_THERE, f"the simulation has the state {_STATE_NAMES[target]} already")
        if target == STOPPED:
            sim.reset()
        sim.paused = target != PLAYING
        self._is_stopped = target == STOPPED

    def _reset_simulation(self, sim: Simulation, request: msgs.ResetSimulation_Request) -> None:
        scope, is_paused = int(request.scope) or _ALL, sim.paused
        parts = scope & (_TIME | _STATE | _SPAWNED)
        if (scope != _ALL and scope != parts) or (parts & _TIME and parts != _TIME | _STATE | _SPAWNED):
            allowed = "0 or 255 (everything), 2 (state), 4 (spawned entities) and 6"
            raise Refusal(ResultCode.UNSUPPORTED, f"found the scope {scope}; simkit has {allowed}")
        if parts & _TIME:
            sim.reset()
            sim.paused = is_paused
            return
        if parts & _SPAWNED:
            loaded = {model.name for model in sim.world.models}
            for name in [name for name in sim.models if name not in loaded]:
                sim.remove(name)
        if parts & _STATE:
            sim.control.reset_models()

    # ------------------------------------------------------------------ steps

    def _step_simulation(self, sim: Simulation, request: msgs.StepSimulation_Request) -> None:
        self._start_steps(int(request.steps))

    def _start_steps(self, steps: int) -> None:
        sim = self.sim
        if not sim.paused:
            raise Refusal(ResultCode.INCORRECT_STATE, "the simulation is running; pause it first")
        if steps < 1:
            raise Refusal(ResultCode.FAILED, f"found {counted(steps, 'step')}; expected at least one")
        sim.control.pausing.step(sim.engine.clock.checked_count(steps))
        sim.control.pausing.catch_up()

    def _begin_steps(self, goal: GoalHandle) -> None:
        if self._goal is not None and not self._goal.is_done:
            busy = Refusal(ResultCode.INCORRECT_STATE, "another goal is being executed")
            goal.abort({"result": result_fields(busy)}, str(busy))
            return
        steps = int(goal.request.steps)
        self._goal, self._first, self._last = goal, self.sim.tick, self.sim.tick + steps
        self.sim.communication.on_demand.look()
        try:
            self._start_steps(steps)
        except (Refusal, InputError) as error:
            self._end_goal()
            goal.abort({"result": result_fields(error)}, str(error))

    def _cancel_steps(self, goal: GoalHandle) -> None:
        if goal is self._goal:
            self._end_goal()
            self.sim.control.pausing.pause()
        goal.canceled({"result": result_fields(Refusal(ResultCode.FAILED, "the goal was cancelled"))})

    def _follow_steps(self, tick: int) -> None:
        """Report the progress of the goal, and end it after its last step."""
        goal = self._goal
        if goal is None:
            return
        done, left = tick - self._first, max(0, self._last - tick)
        if goal.is_done:
            self._end_goal()
        elif not left or done % max(1, (self._last - self._first) // _MOST_FEEDBACK) == 0:
            goal.publish_feedback({"completed_steps": done, "remaining_steps": left})
            if not left:
                self._end_goal()
                goal.succeed({"result": {"result": ResultCode.OK}})

    def _abort_if_paused(self) -> None:
        """Abort the goal if another client pauses the simulation before the last step."""
        goal = self._goal
        if goal is not None and self.sim.paused and self.sim.tick < self._last:
            self._end_goal()
            error = Refusal(ResultCode.FAILED, "the simulation was paused before the last step")
            goal.abort({"result": result_fields(error)}, str(error))

    def _end_goal(self) -> None:
        self._goal = None
        self.sim.communication.on_demand.look()


def _current_world(sim: Simulation, _: object) -> dict[str, object]:
    source = sim.run_spec.world if sim.run_spec is not None else ""
    is_text = source.lstrip().startswith("<")
    resource = {"resource_string": source} if is_text else {"uri": source}
    return {"world": {"name": sim.world.name, "world_resource": resource}}


def _spawnables(sim: Simulation, request: msgs.GetSpawnables_Request) -> dict[str, object]:
    """Return simkit's models and those of the resource paths; the message of the result lists the sources."""
    models = sim.control.list_models()
    spawnables = [{"entity_resource": {"uri": source}, "description": name} for name, source in models.items()]
    listed = ", ".join(request.sources)
    text = f"sources are not searched: {listed}; name folders by --resource-path" if listed else ""
    return {"result": {"result": ResultCode.OK, "error_message": text}, "spawnables": spawnables}


def _refuse(reason: str) -> Handler:
    def refuse(*_: object) -> None:
        raise Refusal(ResultCode.UNSUPPORTED, reason)

    return refuse


def _answering(sim: Simulation, name: str, handler: Handler) -> Callable[[object], Mapping[str, object]]:
    """Return a service handler whose response has the result code, and the reason of a failure."""

    def handle(request: object) -> Mapping[str, object]:
        from simkit.runtime.handles.handle import UnknownName

        try:
            response = handler(sim, request)
        except (Refusal, RequestRefused, InputError, UnknownName) as error:
            if not isinstance(error, Refusal) or error.code != ResultCode.UNSUPPORTED:
                sim.engine.log.warning("%s: %s", name, error)
            return {"result": result_fields(error)}
        return {"result": {"result": ResultCode.OK}, **(response or {})}

    return handle
