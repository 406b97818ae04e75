"""Vacuum gripper of Gazebo Classic, in ROS 2 and ROS 1 spelling: `libgazebo_ros_vacuum_gripper.so`."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.params import Params
from simkit.plugins.base import NEVER, ModelPlugin
from simkit.plugins.endpoints import offers, publishes
from simkit.plugins.find_entities import find_link, find_named_link
from simkit.plugins.joints.run_time_welds import close_weld, has_weld, open_weld
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.plugins.options import Options, OptionsOf, number, text, texts
from simkit.plugins.publish_on_demand import publish_while_subscribed
from simkit.runtime.engine.physics_step import STALE

if TYPE_CHECKING:
    import mujoco

    from simkit.compiler import NameMap, SpecBuilder
    from simkit.msgs import SetBool_Request
    from simkit.runtime import Model, Simulation, WorldStructure
    from simkit.scene import SceneModel

BOOL: Final = "std_msgs/msg/Bool"
SET_BOOL: Final = "std_srvs/srv/SetBool"
EMPTY: Final = "std_srvs/srv/Empty"
_RATE: Final = 80.0  # [Hz]


class GazeboRosVacuumGripperOptions(Options):
    """Options of `GazeboRosVacuumGripper`."""

    ros_1_marks = ("bodyName", "topicName", "maxForce", "maxDistance", "minDistance")

    body_name: str = text(element="bodyName", required=True)
    topic_name: str = text(element="topicName", required=True)
    max_force: float = number(None, "N", element="maxForce", minimum=0.0)
    min_distance: float = number(None, "m", element="minDistance", minimum=0.0)
    link_name: str = text(required=True)
    max_distance: float = number(0.05, "m", minimum=0.0, ros_1="maxDistance")
    fixed: tuple[str, ...] = texts()


class GazeboRosVacuumGripper(ModelPlugin):
    """Holds every link whose origin is within `<max_distance>` [m] of a gripper link's origin, while switched on.

    A held link keeps its pose relative to the gripper link until the gripper is switched off; the robot carries its
    weight. The robot itself, immovable links, and the models named in `<fixed>` are never held. A Bool on `grasping`
    reports whether a link is held. ROS 2 uses one or more `<link_name>` and the service `switch` (SetBool). ROS 1 uses
    `<bodyName>`, `<topicName>`, `<maxDistance>` and the services `on` and `off` (Empty).

    Gazebo pulls at near links, by a force of 1 N in ROS 2 and by setting their velocity in ROS 1. Both methods cannot
    lift a load and hold its pose. In simkit a weld joint holds the link, like real suction.
    """

    endpoints = (
        publishes("grasping", BOOL, named_by=("topicName",)),
        offers("on", EMPTY),
        offers("off", EMPTY),
        offers("switch", SET_BOOL),
    )
    options = OptionsOf(GazeboRosVacuumGripperOptions)
    filenames = ("libgazebo_ros_vacuum_gripper.so",)
    _services: tuple[str, ...] = ()

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._is_ros_1, self._reach = self.options.is_ros_1, self.options.max_distance
        self._topic, self._rate, self._fixed = "grasping", _RATE, frozenset[str]()
        if self._is_ros_1:
            self._grippers = [find_named_link(scene, "bodyName", params)]
            self._topic, self._rate = self.options.topic_name, 0.0
            for name in ("maxForce", "minDistance"):
                if params.has(name):
                    params.number(name, minimum=0.0)
                    message = f"plugin {self.name!r}: <{name}> has no effect: a weld joint holds the links"
                    params.diagnostics.note("SK-PLUGIN-138", message, self.where)
        else:
            named = params.all("link_name")
            if not named:
                _ = self.options.link_name
            links = [find_link(scene, element.value, element) for element in named]
            self._grippers = [link.scoped for link in links if link is not None]
            self._fixed = frozenset(self.options.fixed)
        self._own = scene.scoped.split("::")[0]

    def load(self, parent: Model, params: Params) -> None:
        self._is_on = False
        self._held: dict[str, str] = {}  # scoped name of a held link -> name of its weld
        self._candidates = _GrippableLinks()
        self.before_step_rate = NEVER
        words = ("on", "off") if self._is_ros_1 else ("switch",)
        self._services = tuple(self.ros.topic(word) for word in words)
        first = self._switched_grippers()[0]
        if first is not self:  # the first of several grippers with the same service names offers the services
            pass
        elif self._is_ros_1:
            self.offer("on", EMPTY, partial(self._on_empty, True))
            self.offer("off", EMPTY, partial(self._on_empty, False))
        else:
            self.offer("switch", SET_BOOL, self._on_switch)
        self._grasping = self.advertise(self._topic, BOOL)
        publish_while_subscribed(self, self._grasping, self._rate, "publish_grasping")

    @property
    def holds(self) -> list[str]:
        """Scoped names of the links that the gripper holds."""
        return [link for link, weld in self._held.items() if has_weld(self.sim, weld)]

    def publish_grasping(self) -> None:
        """Publish whether the gripper holds a link."""
        self._grasping.publish(msgs.make(BOOL, data=bool(self.holds)))

    # ------------------------------------------------------------------ services

    def _switched_grippers(self) -> list[GazeboRosVacuumGripper]:
        """Return the grippers that share the services of this gripper, in the order of the file."""
        grippers = [p for p in self.sim.engine.structure.all_plugins() if isinstance(p, GazeboRosVacuumGripper)]
        return [p for p in grippers if p._services == self._services]

    def _on_switch(self, request: SetBool_Request) -> dict[str, object]:
        is_new = max([gripper._switch(bool(request.data)) for gripper in self._switched_grippers()])
        return {"success": is_new, "message": "" if is_new else f"it is {'on' if request.data else 'off'} already"}

    def _on_empty(self, is_on: bool, _: object) -> None:
        for gripper in self._switched_grippers():
            gripper._switch(is_on)

    def _switch(self, is_on: bool) -> bool:
        """Switch the gripper on or off; return False if the gripper already has this state."""
        if is_on == self._is_on:
            return False
        self._is_on = is_on
        if not is_on:
            for weld in self._held.values():
                open_weld(self.sim, weld)
            self._held = {}
        self.before_step_rate = None if is_on else NEVER
        self.sim.engine.reschedule()
        return True

    # ------------------------------------------------------------------ holding

    def before_step(self) -> None:
        """Attach links that are near enough."""
        if not self._is_on:
            return
        sim, candidates = self.sim, self._candidates
        candidates.bind(sim, self._own, self._fixed, self._grippers)
        physics = sim.engine.physics
        # velocities and forces that were set since the last step do not change positions
        near = candidates.near(physics.fresh() if physics.stage == STALE else physics.data, self._reach)
        for gripper, link in near:
            weld = self._held.get(link)
            if weld is None or not has_weld(self.sim, weld):
                self._hold(gripper, link)

    def _hold(self, gripper: str, link: str) -> None:
        weld = f"{gripper}#vacuum {link}"
        close_weld(self.sim, weld, gripper, link)
        self._held = {**self._held, link: weld}


class _GrippableLinks(SharedByCopies):
    """Positions in the engine of gripper links and of links that they may hold; no part of the simulated state."""

    def __init__(self) -> None:
        self._known: WorldStructure | None = None

    def bind(self, sim: Simulation, model: str, fixed: frozenset[str], grippers: list[str]) -> None:
        """Find the links in the engine's current model."""
        if self._known is sim.engine.structure:
            return
        self._known, names, weld = sim.engine.structure, sim.engine.names, sim.mj_model.body_weldid
        self._grippers = grippers
        self._links = [
            link
            for link in sim.contents.handles.tables["link"]
            if (parts := link.split("::"))[0] != model
            and not fixed.intersection((parts[0], link, parts[-1]))
            and weld[names.link(link).body] != 0
        ]
        self._own = _frames(names, grippers)
        self._others = _frames(names, self._links)

    def near(self, data: mujoco.MjData, reach: float) -> list[tuple[str, str]]:
        """Return pairs (gripper link, near link) of scoped names, at most one pair for each link within `reach` [m]."""
        if not self._links:
            return []
        origins = _origins(data, *self._others)
        gripper_by_link: dict[str, str] = {}
        for gripper, origin in zip(self._grippers, _origins(data, *self._own), strict=True):
            offsets = origins - origin
            for k in np.flatnonzero(np.einsum("ij,ij->i", offsets, offsets) <= reach * reach).tolist():
                gripper_by_link.setdefault(self._links[k], gripper)
        return [(gripper, link) for link, gripper in gripper_by_link.items()]


Numbers = npt.NDArray[np.float64]


def _frames(names: NameMap, links: list[str]) -> tuple[npt.NDArray[np.intp], Numbers]:
    """Return the bodies of links, and the links' origins in these bodies [m], shape (n, 3)."""
    links_in_bodies = [names.link(link) for link in links]
    bodies = np.array([int(link.body) for link in links_in_bodies], dtype=np.intp)
    return bodies, np.array([link.offset.position for link in links_in_bodies]).reshape(-1, 3)


def _origins(data: mujoco.MjData, bodies: npt.NDArray[np.intp], offsets: Numbers) -> Numbers:
    """Return the origins of links in the world [m], shape (n, 3)."""
    turns = data.xmat[bodies].reshape(-1, 3, 3)
    origins: Numbers = data.xpos[bodies] + np.einsum("nij,nj->ni", turns, offsets)
    return origins
