"""Thrusters and joints of floating robots in Gazebo Classic: `libfreefloating_gazebo_control.so`.

Parameters, defaults and topics are those of `freefloating_gazebo_control.cpp` and `hydro_model_parser.cpp` of
freefloating_gazebo, with the thrust above water of the branch of usv_sim_lsa.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import ModelPlugin, Params, msgs
from simkit.extend import (
    JointAxis,
    Options,
    OptionsOf,
    blocks,
    counted,
    find_link,
    listens,
    number,
    publish_while_subscribed,
    publishes,
    text,
    without_effect,
)
from simkit.linear_algebra import matmul
from simkit.matrix_decompositions import pinv
from simkit.number_text import number_or_nan
from simkit.plugins.joint_states import JOINT_STATE, joint_readings, joint_state_message
from simkit.plugins.one_time_warnings import are_usable
from simkit_water_and_air.plugins.classic.freefloating_fluid import FreefloatingFluid
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data
from simkit_water_and_air.plugins.fluids.rigid_links import rigid_group

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder, Vector
    from simkit.msgs import Message

_WRENCH: Final = "geometry_msgs/msg/Wrench"
_THRUST: Final = 100.0  # largest thrust by default [N]


class ThrusterOptions(Options):
    """Options of a `<thruster>`."""

    name: str = text()
    map: str = text()
    effort: float = number(_THRUST, "N", minimum=0.0, maximum=1e9)
    below: float = number(_THRUST, "N", element="effortUnderWater", minimum=0.0, maximum=1e9, instead="effort")
    above: float = number(_THRUST, "N", element="effortOverWater", minimum=0.0, maximum=1e9)


class FreefloatingControlOptions(Options):
    """Options of `FreefloatingControl`."""

    link: str = text()
    update_rate: float = number(0.0, "Hz", element="updateRate", minimum=0.0)
    switch: bool = without_effect(element="switchService")
    thrusters: tuple[ThrusterOptions, ...] = blocks(ThrusterOptions, element="thruster")


@dataclass
class _Thruster:
    """Thruster with its present command.

    Attributes:
        name: Name in messages.
        link: Scoped name of the link that it pushes.
        wrench: Force and torque of a thrust of 1 N in the axes of the link.
        below, above: Largest thrust below and above the surface [N].
        command: Present command [N].
    """

    name: str
    link: str
    wrench: Vector
    below: float
    above: float
    command: float = 0.0

    def limit(self, is_wet: bool) -> float:
        """Return the largest thrust [N]."""
        return self.below if is_wet else self.above


class FreefloatingControl(ModelPlugin):
    """Pushes a robot in water by thrusters and moves its joints by efforts.

    `/<model>/thruster_command` (JointState) has the thrusts [N] by name in `effort`, or in `position`. A `<thruster>`
    with a `<map>` pushes `<link>` by this force and torque for each newton. Else its `<name>` is that of a link, which
    it pushes along -z. If all thrusters have maps, `/<model>/body_command` (Wrench) is shared among them.
    `/<model>/joint_command` has efforts of joints. A thruster out of the water has no thrust, or `<effortOverWater>`.
    """

    endpoints = (
        listens("/{model}/thruster_command", JOINT_STATE),
        listens("/{model}/body_command", _WRENCH),
        listens("/{model}/joint_command", JOINT_STATE),
        publishes("/{model}/thruster_use", JOINT_STATE),
        publishes("/{model}/joint_states", JOINT_STATE),
    )
    options = OptionsOf(FreefloatingControlOptions)
    filenames = ("libfreefloating_gazebo_control.so",)
    drives = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        links = scene.all_links()
        named = find_link(scene, options.link, params.block("link")) if options.link else links[0]
        self._body = links[0].scoped if named is None else named.scoped
        self._thrusters: list[_Thruster] = []
        base = next((link.scoped for link in links if link.name == "base_link"), self._body)
        fixed = rigid_group(scene, base)
        poses = {link.scoped: link.pose_world for link in links}
        for thruster in options.thrusters:
            thruster.read_all()
            element = thruster.params
            # only a file of usv_sim_lsa lets a thruster push in air
            above = thruster.above if element.has("effortUnderWater") or element.has("effortOverWater") else 0.0
            limits = thruster.below, above
            if thruster.map:
                name = thruster.name or f"thr{len(self._thrusters)}"
                self._thrusters.append(_Thruster(name, self._body, _read_map(element), *limits))
                continue
            link = find_link(scene, thruster.name, element.block("name")) if thruster.name else None
            if not thruster.name:
                element.error("SK-PARAM-001", "<thruster> needs <map> or <name>, the name of a link")
            if link is None:
                continue
            pushed, wrench = link.scoped, np.array((0.0, 0.0, -1.0, 0.0, 0.0, 0.0))
            if pushed in fixed:
                mounted = poses[base].inverse() @ poses[pushed]
                way = mounted.rotate((0.0, 0.0, -1.0))
                pushed, wrench = self._body, np.concatenate((way, np.cross(mounted.position, way)))
            self._thrusters.append(_Thruster(thruster.name, pushed, wrench, *limits))
        self._joint_names = [joint.scoped for joint in scene.all_joints() if len(joint.axes) == 1]

    def load(self, parent: Model, params: Params) -> None:
        name, thrusters = parent.name, self._thrusters
        self._links = PushedLinks(self.sim, self._link_names())
        self._is_commanded = False
        self._axes = {joint.rsplit("::", 1)[-1]: JointAxis(self.sim.joint(joint)) for joint in self._joint_names}
        self._efforts: dict[str, float] = {}
        self._use = self.advertise(f"/{name}/thruster_use", JOINT_STATE)
        if thrusters:
            self.listen(f"/{name}/thruster_command", JOINT_STATE, self._on_thrusters)
        if thrusters and all(thruster.link == self._body for thruster in thrusters):
            self._allocation = pinv(np.array([thruster.wrench for thruster in thrusters]).T)
            self.listen(f"/{name}/body_command", _WRENCH, self._on_wrench)
        if self._axes:
            self.listen(f"/{name}/joint_command", JOINT_STATE, self._on_joints)
            self._states = self.advertise(f"/{name}/joint_states", JOINT_STATE)
            publish_while_subscribed(self, self._states, self.options.update_rate, "publish_joints")

    def _link_names(self) -> list[str]:
        return list(dict.fromkeys(thruster.link for thruster in self._thrusters))

    # ------------------------------------------------------------------ commands

    def _read_command(self, message: Message, what: str) -> dict[str, float]:
        """Return the numbers of a message by name; empty after a warning."""
        names = list(message.name)
        values = message.effort if len(message.effort) else message.position
        numbers = [float(value) for value in values]
        if len(names) != len(numbers):
            text = f"{what} with {len(names)} names and {counted(len(numbers), 'number')} is ignored"
            self._once.left_out(f"length {what}", text)
            return {}
        if not are_usable(*numbers):
            self._once.not_finite(what)
            return {}
        return dict(zip(names, numbers, strict=True))

    def _on_thrusters(self, message: Message) -> None:
        commands = self._read_command(message, "a command of thrusters")
        self._is_commanded = self._is_commanded or bool(commands)
        for thruster in self._thrusters:
            thruster.command = commands.get(thruster.name, thruster.command)

    def _on_wrench(self, message: Message) -> None:
        wrench = [float(getattr(part, axis)) for part in (message.force, message.torque) for axis in "xyz"]
        if not are_usable(*wrench):
            self._once.not_finite()
            return
        self._is_commanded = True
        thrusts = matmul(self._allocation, np.array(wrench)).tolist()
        pairs = list(zip(self._thrusters, thrusts, strict=True))
        excess = max([1.0, *(abs(thrust) / t.below for t, thrust in pairs if t.below > 0)])
        for thruster, thrust in pairs:
            thruster.command = thrust / excess

    def _on_joints(self, message: Message) -> None:
        commands = self._read_command(message, "a command of joints")
        self._efforts = {name: effort for name, effort in commands.items() if name in self._axes} or self._efforts

    # ------------------------------------------------------------------ forces

    def _fluids(self) -> list[FreefloatingFluid]:
        plugins = self.sim.engine.structure.all_plugins()
        return [plugin for plugin in plugins if isinstance(plugin, FreefloatingFluid)]

    def before_step(self) -> None:
        """Apply the thrusts and the efforts for the next step."""
        for name, effort in self._efforts.items():
            self._axes[name].push(effort)
        if not self._is_commanded:
            return
        if not self._links.is_current:
            self._links = PushedLinks(self.sim, self._link_names())
        fluids = self.sim.engine.names.shared(f"water {id(self)}", self._fluids)
        if not fluids:
            text = "the world has no libfreefloating_gazebo_fluid.so: all thrusters push"
            self._once.warn(
                "SK-PLUGIN-111", "no water", text, "add the plugin to the world, or run the robot in its world"
            )
        data, shares = moving_data(self.sim), list[float]()
        wrenches: dict[int, Vector] = {}
        for thruster in self._thrusters:
            if thruster.link not in self._links.names:
                shares.append(0.0)
                continue
            row = self._links.names.index(thruster.link)
            body = self._links.ids[row]
            surface = fluids[0].surface_at(thruster.link) if fluids else None
            is_wet = surface is None or float(data.xipos[body][2]) < surface
            limit = thruster.limit(is_wet)
            thrust = max(-limit, min(limit, thruster.command))
            shares.append(100.0 * abs(thrust) / limit if limit > 0 else 0.0)
            if thrust:
                axes, wrench = data.xmat[body].reshape(3, 3), thrust * thruster.wrench
                pushed = np.concatenate((matmul(axes, wrench[:3]), matmul(axes, wrench[3:])))
                wrenches[row] = wrenches[row] + pushed if row in wrenches else pushed
        self._links.push_some(data, {row: wrench.tolist() for row, wrench in wrenches.items()})
        if self._use.wanted:
            names = [thruster.name for thruster in self._thrusters]
            header = msgs.header(self.sim.time_ns, "")
            self._use.publish(msgs.make(JOINT_STATE, header=header, name=names, position=np.array(shares)))

    def publish_joints(self) -> None:
        """Publish the states of the joints."""
        joints = joint_readings([axis.joint for axis in self._axes.values()])
        self._states.publish(joint_state_message(self.sim.time_ns, joints))


def _read_map(element: Params) -> Vector:
    """Return the force and torque of a thruster for each newton; zeros after an error."""
    words = element.text("map").split()
    numbers = np.array([number_or_nan(word) for word in words])
    if len(numbers) != 6 or not np.isfinite(numbers).all():
        message = (
            f"found <map> with {counted(len(words), 'value')}; expected 6 finite numbers: force and torque per newton"
        )
        element.block("map").error("SK-PARAM-002", message)
        return np.zeros(6)
    return numbers
