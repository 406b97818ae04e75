"""World plugin that moves the actors along their scripts."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from simkit.plugins.adapters import EntityPlugin
from simkit.runtime.engine.physics_step import STALE
from simkit_actors.plugins.actor_model import with_actors
from simkit_actors.plugins.animated_actor import AnimatedActor

if TYPE_CHECKING:
    from collections.abc import Mapping

    from simkit import Params, Simulation
    from simkit.extend import Diagnostics, SceneWorld
    from simkit.msgs import SetBool_Request
    from simkit.plugins.adapters import FileFinder

_SERVICE: Final = "std_srvs/srv/SetBool"
_Moving = tuple[AnimatedActor, slice | npt.NDArray[np.intp]]


class ActorMover(EntityPlugin):
    """Moves actors along their scripts 50 times per simulated second, and whenever a sensor takes a sample.

    Every world with actors has this plugin. The pose of an actor depends only on the time, so it is the same after a
    reset or a restore. The service `/<actor>/play` (std_srvs/srv/SetBool) restarts or stops the script of an actor.
    """

    entities = ("actors",)
    scenery_rate = 50.0

    @classmethod
    def with_models(cls, world: SceneWorld, find_file: FileFinder, diagnostics: Diagnostics) -> SceneWorld:
        return with_actors(world, find_file, diagnostics)

    def load(self, parent: Simulation, params: Params) -> None:
        self._began: dict[str, float] = {}
        self._stopped: dict[str, float] = {}
        self._known: tuple[object, tuple[_Moving, ...]] = (None, ())
        for cast, _ in self._moving():
            self._began |= {cast.name: 0.0} if cast.script.starts_by_itself else {}
            self.offer(f"/{cast.name}/play", _SERVICE, partial(self._play, cast.name))

    def get_state(self) -> dict[str, Any]:
        return {"_began": dict(self._began), "_stopped": dict(self._stopped)}

    def set_state(self, state: Mapping[str, Any]) -> None:
        self._began, self._stopped = dict(state["_began"]), dict(state["_stopped"])

    def reset(self) -> None:
        self.move_scenery()

    def move_scenery(self) -> None:
        """Set the pose of every moving actor to its pose at the current simulation time."""
        sim = self.sim
        data, moving = sim.mj_data, self._moving()
        positions, quaternions, now = data.mocap_pos, data.mocap_quat, float(sim.time)
        for cast, rows in moving:
            poses = cast.poses(self._time_of(cast.name, now))
            positions[rows], quaternions[rows] = poses[:, :3], poses[:, 3:]
        if moving:
            sim.engine.physics.changed(STALE)

    def animation_state(self) -> tuple[tuple[str, float, bool, bool], ...]:
        """Return name, time since the start [s], and whether it has started and stopped, of each moving actor."""
        now = float(self.sim.time)
        names = [cast.name for cast, _ in self._moving()]
        return tuple((name, self._time_of(name, now), name in self._began, name in self._stopped) for name in names)

    def _moving(self) -> tuple[_Moving, ...]:
        """Return the actors that move, with the indices of their links among the engine's mocap bodies."""
        structure = self.sim.engine.structure
        if self._known[0] is not structure:
            moving = []
            for model in structure.models.values():
                cast = model.moved_by
                if isinstance(cast, AnimatedActor) and cast.moves and not cast.is_led:
                    places = [structure.compiled.names.link(link.scoped).mocap for link in model.links]
                    in_a_row = places == list(range(places[0], places[0] + len(places)))
                    at = slice(places[0], places[0] + len(places)) if in_a_row else np.array(places, dtype=np.intp)
                    moving.append((cast, at))
            self._known = structure, tuple(moving)
        return self._known[1]

    def _time_of(self, name: str, now: float) -> float:
        """Return the time since the start of a script [s]; 0 before its start."""
        if name in self._stopped:
            return self._stopped[name]
        return now - self._began[name] if name in self._began else 0.0

    def _play(self, name: str, request: SetBool_Request) -> dict[str, object]:
        if request.data:
            self._stopped.pop(name, None)
            self._began[name] = float(self.sim.time)
        else:
            self._stopped[name] = self._time_of(name, float(self.sim.time))
        return {"success": True, "message": f"{name} {'starts' if request.data else 'stops'}"}
