"""Velocity control of Gazebo: `gz::sim::systems::VelocityControl`."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from typing import TYPE_CHECKING, cast

from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.drives.kinematic_motion import (
    KinematicMotion,
    KinematicMover,
    KinematicPlugin,
    Triple,
    VelocityTarget,
)
from simkit.plugins.drives.odometry import COMMAND_TYPES
from simkit.plugins.find_entities import find_link
from simkit.plugins.one_time_warnings import are_usable
from simkit.plugins.options import Options, OptionsOf, text, texts, vector3

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.msgs import Twist, TwistStamped
    from simkit.runtime import Model, Simulation
    from simkit.scene import SceneModel

Motion = tuple[Triple, Triple]


class VelocityControlOptions(Options):
    """Options of `VelocityControl`."""

    topic: str = text()
    link_name: tuple[str, ...] = texts()
    initial_linear: Triple = vector3()
    initial_angular: Triple = vector3()


class VelocityControl(KinematicPlugin):
    """Moves the model with the twist on `/model/<model>/cmd_vel`, in the model's own axes, around the model's origin.

    The velocity is `<initial_linear>` and `<initial_angular>` (default: zero) until the first command; each command
    stays active until the next. Only these commands and contacts move the model, so it does not fall and needs no
    wheels. For each `<link_name>`, the plugin also reads a twist in the link's own axes from
    `/model/<model>/link/<link>/cmd_vel`. From its first message on, this twist moves the link and all links that joints
    connect to the link.
    """

    options = OptionsOf(VelocityControlOptions)
    filenames = ("gz-sim-velocity-control-system",)
    names = ("gz::sim::systems::VelocityControl",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        named_links = [(element.value, find_link(scene, element.value, params)) for element in params.all("link_name")]
        self._link_names = {name: link.scoped for name, link in named_links if link is not None}
        self._links = {link.scoped: link.pose_world for link in scene.all_links()}
        self._canonical, self._pose = scene.canonical_link, scene.pose_world

    def load(self, parent: Model, params: Params) -> None:
        self._target: Motion = self.options.initial_linear, self.options.initial_angular
        self._link_targets: dict[str, Motion] = {}
        self._mover = KinematicMover(self.sim)
        trees = _connected_links(self.sim, list(self._links))
        self._whole = self._with_model_frame(self._links)
        # links that move with each commandable link
        self._parts = {name: KinematicMotion(self.sim, trees[link], link) for name, link in self._link_names.items()}
        # for each set of commanded links: the other links of the model, which the model's own command moves
        self._rests: dict[frozenset[str], KinematicMotion] = {}
        for name in [name for name, part in self._parts.items() if not part] + ([] if self._whole else [""]):
            self._report_fixed(name)
        model_topic = f"/model/{parent.name}"
        self.listen(valid_topic(self.options.topic or f"{model_topic}/cmd_vel"), COMMAND_TYPES, self._on_command)
        for name in self._link_names:
            self.listen(
                valid_topic(f"{model_topic}/link/{name}/cmd_vel"), COMMAND_TYPES, partial(self._on_link_command, name)
            )

    def _report_fixed(self, link: str) -> None:
        entity = f"link {link!r} of model {self.scoped!r}" if link else f"model {self.scoped!r}"
        message = f"plugin {self.name!r}: {entity} has a joint to the world, so no command moves it"
        self.params.diagnostics.warning("SK-PLUGIN-053", message, self.where, "remove the joint to the world")

    # ------------------------------------------------------------------ commands

    def _on_command(self, message: Twist | TwistStamped) -> None:
        motion = self._motion_of(message)
        if motion is not None:
            self._target = motion

    def _on_link_command(self, link: str, message: Twist | TwistStamped) -> None:
        motion = self._motion_of(message)
        if motion is not None:
            self._link_targets.pop(link, None)  # the latest command is the last entry
            self._link_targets[link] = motion

    def _motion_of(self, message: Twist | TwistStamped) -> Motion | None:
        twist = cast("Twist", getattr(message, "twist", message))
        linear, angular = ((float(v.x), float(v.y), float(v.z)) for v in (twist.linear, twist.angular))
        if are_usable(*linear, *angular):
            return self.bounded(linear, angular)
        self._once.not_finite()
        return None

    def velocity_targets(self) -> list[VelocityTarget]:
        """Return the commanded velocities of the next step."""
        if not self._link_targets:
            return [VelocityTarget(self._whole, self._whole.frame, *self._target)] if self._whole else []
        rest = self._rest()
        moves = [VelocityTarget(rest, rest.frame, *self._target)] if rest else []
        # of several commands for one tree, the last one counts
        trees = {self._parts[name].links: name for name in self._link_targets}
        parts = [(self._parts[name], self._link_targets[name]) for name in trees.values()]
        return moves + [VelocityTarget(part, part.frame, *motion) for part, motion in parts if part]

    def _with_model_frame(self, links: Iterable[str]) -> KinematicMotion:
        """Return a motion of these links of the model; its reference is the model's frame."""
        return KinematicMotion(self.sim, links, self._canonical, self._links[self._canonical].inverse() @ self._pose)

    def _rest(self) -> KinematicMotion:
        """Return a motion of all links of the model that no link command moves."""
        commanded = frozenset(self._link_targets)
        if commanded not in self._rests:
            gone = {link for name in commanded for link in self._parts[name].links}
            self._rests[commanded] = self._with_model_frame([link for link in self._links if link not in gone])
        return self._rests[commanded]


def _connected_links(sim: Simulation, links: list[str]) -> dict[str, list[str]]:
    """Return for each link all links that joints connect to it, including itself."""
    model, names = sim.mj_model, sim.engine.names
    root = {link: int(model.body_rootid[names.link(link).body]) for link in links}
    return {link: [other for other in links if root[other] == root[link]] for link in links}
