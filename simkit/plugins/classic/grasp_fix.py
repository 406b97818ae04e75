"""Grasps that hold: `libgazebo_grasp_fix.so` of J. Buehler's gazebo-pkgs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.linear_algebra import matmul, norm
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.find_entities import find_link
from simkit.plugins.joints.run_time_welds import close_weld, open_weld
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.plugins.options import Options, OptionsOf, block, boolean, integer, number, text, texts, without_effect
from simkit.pose import Vector
from simkit.runtime.contact.collision_contacts import list_contacts

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel

_LEAST_RATIO: Final = 0.3  # of the lengths of two opposite forces


class GripperOptions(Options):
    """Links of a gripper."""

    arm_name: str = text()
    palm_link: str = text(None, required=True)
    gripper_links: tuple[str, ...] = texts(element="gripper_link", required=True)


class GraspFixOptions(GripperOptions):
    """Options of `GraspFix`; the links are in `<arm>`, or directly in the plugin in older files."""

    arm: GripperOptions = block(GripperOptions)
    forces_angle_tolerance: float = number(120.0, "degree", minimum=0, maximum=180)
    update_rate: float = number(5.0, "Hz", minimum=1e-3, maximum=1e6)
    max_grip_count: int = integer(10, minimum=1)
    grip_count_threshold: int = integer(5, minimum=0)
    release_tolerance: float = number(0.005, "m", minimum=0)
    disable_collisions_on_attach: bool = boolean()
    contact_topic: bool = without_effect()


@dataclass(frozen=True)
class Touch(SharedByCopies):
    """Place where a link of the gripper touched the object when it was attached.

    Attributes:
        link: scoped name of the link.
        on_link, on_object: the place in the frames of the link and of the object [m].
        push: force of the link on the object at that time, in the frame of the object [N].
    """

    link: str
    on_link: Vector
    on_object: Vector
    push: Vector


class GraspFix(ModelPlugin):
    """Attaches an object to the palm when links of the gripper press on it from opposite sides, until they open.

    At `<update_rate>` (5 Hz), an object counts as gripped if two links push it at an angle of more than
    `<forces_angle_tolerance>` (120°). Each time its count rises by one, up to `<max_grip_count>` (10), or falls by one.
    The object is attached when the count exceeds `<grip_count_threshold>` (half of the largest count). It is released
    when the count has fallen to the threshold and a link is farther than `<release_tolerance>` (0.005 m) from the place
    where it touched the object, and not further towards the object. With `<disable_collisions_on_attach>` an attached
    object collides with nothing. One object is held at a time.
    """

    options = OptionsOf(GraspFixOptions)
    filenames = ("libgazebo_grasp_fix.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options
        links: GripperOptions = options.arm if params.has("arm") else options
        inner = links.params
        palm_name, _ = links.palm_link, links.arm_name
        palm = find_link(scene, palm_name, inner.block("palm_link")) if palm_name else None
        self._palm = "" if palm is None else palm.scoped
        _ = links.gripper_links
        gripper_links = [find_link(scene, named.value, named) for named in inner.all("gripper_link")]
        self._fingers = tuple(link.scoped for link in gripper_links if link is not None)
        self._model = scene.scoped.split("::")[0]
        self._most = options.max_grip_count
        has_threshold = params.has("grip_count_threshold")
        self._threshold = options.grip_count_threshold if has_threshold else self._most // 2
        self._angle = math.radians(options.forces_angle_tolerance)
        self._opening, self._disables = options.release_tolerance, options.disable_collisions_on_attach
        self.after_step_rate = options.update_rate
        _ = options.contact_topic

    def load(self, parent: Model, params: Params) -> None:
        self._counts: dict[str, int] = {}  # by scoped name of the object's link
        self._held: str | None = None
        self._touches: tuple[Touch, ...] = ()

    @property
    def held(self) -> str | None:
        """Scoped name of the link that is attached to the palm; None without one."""
        return self._held

    def after_step(self) -> None:
        """Count grips, and attach or release an object."""
        pushes = self._pushes()
        gripped = [name for name, forces in pushes.items() if self._is_gripped([f for f, _ in forces.values()])]
        for name in gripped:
            self._counts[name] = min(self._counts.get(name, 0) + 1, self._most)
        for name in [name for name in self._counts if name not in gripped]:
            self._counts[name] = max(self._counts[name] - 1, 0)
        self._counts = {name: count for name, count in self._counts.items() if count > 0 or name == self._held}
        held_link = self._held
        if held_link is not None:
            is_gone = held_link not in self.sim.engine.names.links
            if is_gone or (
                held_link not in gripped and self._counts[held_link] <= self._threshold and self._has_opened(held_link)
            ):
                self._release()
            return
        for name in gripped:
            if self._counts[name] > self._threshold:
                self._attach(name, pushes[name])
                return

    def _pushes(self) -> dict[str, dict[str, tuple[Vector, Vector]]]:
        """Return force [N] and mean position [m] of the contacts, by link of an object and link of the gripper."""
        sums: dict[str, dict[str, list[Vector]]] = {}
        for contact in list_contacts(self.sim.engine.compiled, self.sim.engine.physics.fresh(), self._model):
            first, second = (name.rpartition("::")[0] for name in (contact.first, contact.second))
            if second in self._fingers:
                finger, other, force = second, first, -contact.force
            else:
                finger, other, force = first, second, contact.force
            if finger not in self._fingers or other.split("::")[0] == self._model or not self._is_movable(other):
                continue
            sums.setdefault(other, {}).setdefault(finger, []).extend((force, contact.position))
        return {
            other: {finger: (sum(v[::2], np.zeros(3)), np.mean(v[1::2], axis=0)) for finger, v in fingers.items()}
            for other, fingers in sums.items()
        }

    def _is_movable(self, link: str) -> bool:
        links = self.sim.engine.names.links
        return link in links and bool(self.sim.mj_model.body_weldid[links[link].body] != 0)

    def _is_gripped(self, forces: list[Vector]) -> bool:
        """Check whether two of the forces [N] are opposite and of similar length."""
        for i, force in enumerate(forces):
            for other in forces[i + 1 :]:
                a, b = norm(force), norm(other)
                if min(a, b) <= 0 or min(a, b) < _LEAST_RATIO * max(a, b):
                    continue
                if math.acos(max(-1.0, min(1.0, float(matmul(force, other)) / (a * b)))) > self._angle:
                    return True
        return False

    def _attach(self, name: str, pushes: Mapping[str, tuple[Vector, Vector]]) -> None:
        sim = self.sim
        place = sim.link(name).pose.inverse()
        self._touches = tuple(
            Touch(finger, sim.link(finger).pose.inverse().transform(at), place.transform(at), place.rotate(push))
            for finger, (push, at) in pushes.items()
        )
        close_weld(sim, self._weld(name), self._palm, name)
        self._held = name
        if self._disables:
            sim.link(name).collisions_enabled = False
        self.log.info("attached %s", name)

    def _release(self) -> None:
        name, self._held, self._touches = self._held, None, ()
        if name is None:
            return
        self._counts.pop(name, None)
        if open_weld(self.sim, self._weld(name)):
            if self._disables:
                self.sim.link(name).collisions_enabled = True
            self.log.info("released %s", name)

    def _has_opened(self, name: str) -> bool:
        into_object = self.sim.link(name).pose.inverse()
        for touch in self._touches:
            gap = into_object.transform(self.sim.link(touch.link).pose.transform(touch.on_link)) - touch.on_object
            # without collisions the fingers close through the object
            if norm(gap) > self._opening and matmul(gap, touch.push) < 0:
                return True
        return False

    def _weld(self, name: str) -> str:
        return f"{self._palm}#grasp {name}"
