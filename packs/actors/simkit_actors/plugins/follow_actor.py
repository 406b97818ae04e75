"""Actor of Gazebo that follows a model or link: `gz::sim::systems::FollowActor`."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import chain
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit import ModelPlugin, Params
from simkit.extend import Options, OptionsOf, did_you_mean, number, text
from simkit.plugins.find_entities import read_required_name
from simkit.runtime.engine.physics_step import STALE
from simkit_actors.plugins.animated_actor import AnimatedActor
from simkit_actors.plugins.skin import SkinRig
from simkit_actors.plugins.walk_cycle import Gait

if TYPE_CHECKING:
    from simkit import Link, Model
    from simkit.extend import SceneModel, SpecBuilder

_RATE: Final = 50.0  # [Hz]


class FollowActorOptions(Options):
    """Options of `FollowActor`."""

    target: str = text(required=True)
    velocity: float = number(0.8, minimum=0.0, maximum=1e6)
    min_distance: float = number(1.2, "m", minimum=0.0)
    max_distance: float = number(4.0, "m", minimum=0.0)
    animation_x_vel: float = number(2.0, minimum=0.0, maximum=1e6)
    animation: str = text()


class FollowActor(ModelPlugin):
    """Makes the actor follow `<target>`, a model or a link, instead of the actor's script.

    The actor walks straight towards the target at `<velocity>`, and faces it, while the planar distance is between
    `<min_distance>` and `<max_distance>`. Otherwise the actor does not move. The walking direction is updated 50 times
    per second of simulated time; between two updates the actor walks straight on. For an actor with a skin,
    `<animation>` (default: the first animation) advances by `<animation_x_vel>` seconds per metre walked. An actor
    without a skin is drawn as simkit's own figure, whose legs also move with the distance walked. If the target does
    not exist yet, the actor follows it as soon as it exists.
    """

    options = OptionsOf(FollowActorOptions)
    filenames = ("gz-sim-follow-actor-system",)
    names = ("gz::sim::systems::FollowActor",)
    scenery_rate = _RATE

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._target = read_required_name(params, "target")
        options = self.options
        options.read_all()
        cast = scene.moved_by
        if not isinstance(cast, AnimatedActor):
            message = f"plugin {self.name!r} needs an actor, but {scene.scoped!r} is a model"
            params.error("SK-PLUGIN-134", message, "move the plugin into an <actor>")
            return
        known = sorted(name for name in cast.rig.clips if name) if isinstance(cast.rig, SkinRig) else []
        if known and options.animation and options.animation not in known:
            missing = f"actor {scene.scoped!r} has no animation {options.animation!r}"
            hint = did_you_mean(options.animation, known) or f"animations: {', '.join(known)}"
            params.warning("SK-ACTOR-003", f"plugin {self.name!r}: {missing}; the first one is played", hint)
        least, most = options.min_distance, options.max_distance
        if most < least:
            message = f"plugin {self.name!r}: <max_distance> {most:g} is below <min_distance> {least:g}"
            params.diagnostics.warning("SK-PLUGIN-135", f"{message}, so the actor never walks", self.where)

    def load(self, parent: Model, params: Params) -> None:
        scene: SceneModel = parent.scene
        assert isinstance(scene.moved_by, AnimatedActor)
        self._gait = Gait(scene.moved_by, self.options.animation, self.options.velocity, self.options.animation_x_vel)
        self._links = [link.scoped for link in scene.links]
        pose = scene.pose_world
        self._x, self._y, self._z = pose.position.tolist()
        self._yaw = float(pose.rpy[2])
        self._travel = 0.0  # distance walked so far [m]
        # time of the last update, walking direction since then, and largest distance to walk in this direction [m]
        self._since_ns, self._way, self._left = self.sim.time_ns, (0.0, 0.0), 0.0
        self._is_following = True
        self._shown = (math.nan, 0.0, 0.0, False)
        self.before_step_rate = None  # the first update is in the next step, later updates follow the rate
        if self._find() is None:
            models = sorted(self.sim.contents.handles.tables["model"])
            message = f"plugin {self.name!r}: there is no model or link {self._target!r} to follow yet"
            params.diagnostics.warning("SK-PLUGIN-136", message, self.where, did_you_mean(self._target, models))

    def before_step(self) -> None:
        """Update the actor's position and its walking direction."""
        gone = self._distance_since_update()
        self._x, self._y = self._x + gone * self._way[0], self._y + gone * self._way[1]
        self._travel += gone
        self._since_ns, self._left = self.sim.time_ns, 0.0
        self._aim()
        self._set_before_step_rate(_RATE)

    def _distance_since_update(self) -> float:
        """Return the distance walked since the last update of the direction [m]."""
        return min(self._left, self.options.velocity * (self.sim.time_ns - self._since_ns) * 1e-9)

    def _aim(self) -> None:
        target = self._find()
        if target is None:
            return
        x, y, _ = target.pose.position.tolist()
        x, y = x - self._x, y - self._y
        far = math.hypot(x, y)
        if far <= self.options.min_distance:
            return
        is_within = far <= self.options.max_distance
        if is_within != self._is_following:
            self._is_following = is_within
            change = "is near enough, the actor walks" if is_within else "is too far away, the actor stops"
            self.log.info("%s: %s %s", self.name, self._target, change)
        if is_within:
            self._way, self._left = (x / far, y / far), far - self.options.min_distance
            self._yaw = math.atan2(y, x)

    def _find(self) -> Model | Link | None:
        """Return the target: an exact match, or the first model or link whose scoped name ends with `::<target>`."""
        tables = self.sim.contents.handles.tables
        tables_by_name: tuple[dict[str, Model | Link], ...] = (tables["model"], tables["link"])
        for table in tables_by_name:
            if self._target in table:
                return table[self._target]
        ending = f"::{self._target}"
        handles: Iterator[tuple[str, Model | Link]] = chain(tables["model"].items(), tables["link"].items())
        return next((handle for name, handle in handles if name.endswith(ending)), None)

    # ------------------------------------------------------------------ scenery

    def move_scenery(self) -> None:
        """Set the actor's pose for the current simulated time."""
        gone = self._distance_since_update()
        x, y, travel = self._x + gone * self._way[0], self._y + gone * self._way[1], self._travel + gone
        goes, sim = self._left > gone, self.sim
        data, places = sim.mj_data, sim.engine.names.shared(f"actor {id(self)}", self._find_bodies)
        shown = x, y, self._yaw, goes
        if shown == self._shown and data.mocap_pos[places[0]].tolist() == [x, y, self._z]:
            return
        self._shown = shown
        poses = self._gait.poses((x, y, self._z), self._yaw, travel, goes)
        data.mocap_pos[places], data.mocap_quat[places] = poses[:, :3], poses[:, 3:]
        sim.engine.physics.changed(STALE)

    def animation_state(self) -> tuple[object, ...]:
        """Return the actor's position, heading, distance walked, and motion since the last update."""
        place = self._x, self._y, self._yaw, self._travel
        return (*place, self._since_ns, self._way, self._left, self._is_following)

    def _find_bodies(self) -> npt.NDArray[np.intp]:
        """Return the mocap indices of the actor's links."""
        return np.array([self.sim.engine.names.link(link).mocap for link in self._links], dtype=np.intp)
