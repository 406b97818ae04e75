"""Shooter of balls: `vrx::BallShooterPlugin` of VRX.

Parameters and defaults are those of `BallShooterPlugin.cc`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from simkit import ModelPlugin, Params, Pose
from simkit.extend import Options, OptionsOf, block, integer, listens, number, pose, text
from simkit.linear_algebra import matmul
from simkit.msgs import valid_topic

if TYPE_CHECKING:
    from simkit import Model
    from simkit.msgs import Message

_BOOL: Final = "std_msgs/msg/Bool"
_MOST: Final = 2**32 - 1  # shots


class ProjectileOptions(Options):
    """Options of `<projectile>`."""

    model: str = text(None, element="model_name", required=True)
    link: str = text(None, element="link_name", required=True)
    frame: str = text()
    offset: Pose = pose(element="pose")


class BallShooterOptions(Options):
    """Options of `BallShooter`."""

    projectile: ProjectileOptions = block(ProjectileOptions)
    topic: str = text("/ball_shooter/fire")
    shots: int = integer(_MOST, element="num_shots", minimum=0, maximum=_MOST)
    force: float = number(250.0, "N", element="shot_force", minimum=-1e9, maximum=1e9)


class BallShooter(ModelPlugin):
    """Shoots a model, the `<projectile>`, along the x axis of the frame `<frame>`, at each message on `<topic>`.

    The projectile stops, moves to `<pose>` in the frame, and gets the force `<shot_force>` [N] for one step. There are
    `<num_shots>` shots.
    """

    endpoints = (listens("/ball_shooter/fire", _BOOL, named_by=("topic",)),)
    options = OptionsOf(BallShooterOptions)
    filenames = ("libBallShooterPlugin.so",)
    names = ("vrx::BallShooterPlugin",)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options.read_all()
        options.projectile.read_all()
        self._left, self._is_fired = options.shots, False
        self.listen(valid_topic("/" + options.topic.strip().strip("/")), _BOOL, self._on_fire)

    def _on_fire(self, _: Message) -> None:
        if self._left > 0:
            self._is_fired = True
        else:
            self._once.left_out("shots", f"all {self.options.shots} shots of plugin {self.name!r} are used")

    def before_step(self) -> None:
        """Shoot, if a message has come."""
        if not self._is_fired:
            return
        self._is_fired = False
        given, names = self.options.projectile, self.sim.engine.names
        scoped = f"{given.model}::{given.link}"
        if scoped not in names.links:
            self._once.left_out("projectile", f"there is no link {scoped!r}, so plugin {self.name!r} shoots nothing")
            return
        place = self._frame() @ given.offset
        model = self.sim.model(given.model)
        model.set_velocity((0.0, 0.0, 0.0))
        model.set_pose(place)
        link = self.sim.link(scoped)
        link.apply_wrench(matmul(link.pose.matrix, (self.options.force, 0.0, 0.0)))
        self._left -= 1

    def _frame(self) -> Pose:
        """Return the pose of the frame in the world; that of the world without a frame or if it does not exist."""
        name = self.options.projectile.frame
        if not name:
            return Pose()
        for scoped in self.sim.engine.names.links:
            if f"::{scoped}".endswith(f"::{name}"):
                return self.sim.link(scoped).pose
        if name in self.sim.models:
            return self.sim.model(name).pose
        self._once.left_out("frame", f"there is no link or model {name!r}; plugin {self.name!r} shoots from the world")
        return Pose()
