"""Names of parts of a simulation that have moved to its `engine`, `communication`, `contents` and `control`."""

from __future__ import annotations

from operator import attrgetter
from typing import Any, Final

MOVED: Final = {
    "bus": "communication.bus",
    "service_table": "communication.services",
    "action_table": "communication.actions",
    "parameter_table": "communication.live_parameters",
    "on_demand": "communication.on_demand",
    "parameters": "communication.parameters",
    "services": "communication.services.names",
    "actions": "communication.actions.names",
    "set_parameter": "communication.set_parameter",
    "forget": "communication.forget",
    "set_active": "communication.set_active",
    "structure": "engine.structure",
    "physics": "engine.physics",
    "names": "engine.names",
    "compiled": "engine.compiled",
    "originals": "engine.originals",
    "touch": "engine.touch",
    "original": "engine.original",
    "faults": "engine.faults",
    "streams": "engine.streams",
    "clock": "engine.clock",
    "reports": "engine.reports",
    "log": "engine.log",
    "velocity_servos": "engine.velocity_servos",
    "friction": "engine.friction",
    "wind": "engine.wind",
    "reschedule": "engine.reschedule",
    "scheduler": "engine.scheduler",
    "set_control": "engine.set_control",
    "steps": "engine.steps",
    "is_stepping": "engine.is_stepping",
    "world": "engine.world",
    "render_thread": "engine.render_thread",
    "seed": "engine.streams.seed",
    "fresh_data": "engine.physics.fresh",
    "fresh_acceleration": "engine.physics.fresh_accelerations",
    "hold_state": "engine.physics.hold",
    "data_of": "engine.physics.data_of",
    "set_standing_wrenches": "engine.wrenches.set",
    "stand_wrenches": "engine.wrenches.push",
    "halt": "engine.loop.halt",
    "jump": "engine.loop.jump",
    "entities": "contents.handles",
    "labels": "contents.labels",
    "temperatures": "contents.temperatures",
    "lights": "contents.lights",
    "sensors": "contents.sensors",
    "plugins": "contents.plugins",
    "has_sensor": "contents.has_sensor",
    "scene_link": "contents.scene_link",
    "spawn_all": "contents.spawn_all",
    "all_or_none": "contents.all_or_none",
    "add_sensor": "contents.add_sensor",
    "make_movable": "contents.make_movable",
    "add_weld": "contents.add_weld",
    "set_weld": "contents.set_weld",
    "models_reader": "contents.models_reader",
    "clone": "contents.clone",
    "name_in_file": "contents.name_in_file",
    "pose_in_file": "contents.pose_in_file",
    "limit_velocity": "contents.handles.limit_velocity",
    "pausing": "control.pausing",
    "paused": "control.paused",
    "site": "control.origin",
    "serve": "control.serve",
    "reseed": "control.reseed",
    "enable_collisions": "control.enable_collisions",
    "reset_models": "control.reset_models",
    "to_sdf": "control.to_sdf",
    "write_sdf": "control.write_sdf",
    "_population": "contents.spawner",
    "_loop": "engine.loop",
}


class OldNames:
    """A simulation under its old names."""

    def __getattr__(self, name: str) -> Any:
        path = MOVED.get(name)
        if path is None:
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        return attrgetter(path)(self)

    def __setattr__(self, name: str, value: Any) -> None:
        path = MOVED.get(name)
        if path is None:
            object.__setattr__(self, name, value)
        else:
            owner, _, last = path.rpartition(".")
            setattr(attrgetter(owner)(self), last, value)
