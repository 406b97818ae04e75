"""One top-level model into the specification: bodies, joints, geoms, lights, excludes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import combinations
from typing import Any

import mujoco

from simkit.compiler.assets import Assets
from simkit.compiler.bodies import add_body
from simkit.compiler.geoms import GeomWriter, Place
from simkit.compiler.joints import JointWriter
from simkit.compiler.lights import add_light
from simkit.compiler.names import LightBinding, LinkBinding, ModelRecord
from simkit.compiler.tree import WORLD, Tree, plan_tree
from simkit.diagnostics import Diagnostics
from simkit.pose import IDENTITY
from simkit.scene import SceneJoint, SceneLink, SceneModel, SceneWorld


class ModelWriter:
    """Writes one model and fills its record."""

    def __init__(
        self, spec: mujoco.MjSpec, assets: Assets, record: ModelRecord, world: SceneWorld, diagnostics: Diagnostics
    ) -> None:
        self.spec, self.record, self.world, self.diagnostics = spec, record, world, diagnostics
        step = float(spec.option.timestep)
        self.geoms = GeomWriter(assets, record, step, diagnostics)
        self.joints = JointWriter(spec, record, step, diagnostics)

    def write(self, joints: list[SceneJoint]) -> None:
        """Adds the whole model with `joints` (its own and those that tie it to the world)."""
        model = self.record.scene
        static = {link.scoped for link, is_static in _links(model, False) if is_static}
        moving = [link for link, is_static in _links(model, False) if not is_static]
        self.joints.links = {link.scoped: link for link, _ in _links(model, False)}
        for link, is_static in _links(model, False):
            if is_static:
                self._static_link(link)
        for joint in joints:
            if {joint.parent_link, joint.child_link} <= static | {WORLD}:
                self.joints.unmoving(joint)
        joints = [j for j in joints if not {j.parent_link, j.child_link} <= static | {WORLD}]
        tree = plan_tree(moving, joints, static)
        self._bodies(tree)
        for joint in tree.loops:
            self.joints.close(joint)
        for joint in tree.constraints:
            self.joints.gear(joint)
        self.joints.mimics(joints)
        self._excludes(moving, joints)

    def join(self, joints: list[SceneJoint], links: Mapping[str, LinkBinding]) -> None:
        """Adds joints between models as constraints."""
        self._know(links)
        for joint in joints:
            if joint.parent_link in (WORLD, *links) and joint.child_link in (WORLD, *links):
                self.joints.close(joint)
        self._forget(links)

    def weld(self, name: str, parent: str, child: str, links: Mapping[str, LinkBinding], active: bool) -> None:
        """Adds a weld between two links, of this model or of others."""
        known = dict(self.record.links)
        self._know(links)
        point = links[child].scene.pose_world.position
        self.joints.tie(name, mujoco.mjtEq.mjEQ_WELD, parent, child, point, active)
        self._forget({n: b for n, b in links.items() if n not in known})

    def _know(self, links: Mapping[str, LinkBinding]) -> None:
        self.joints.links = {n: b.scene for n, b in links.items()}
        self.record.links.update(links)

    def _forget(self, links: Mapping[str, LinkBinding]) -> None:
        for name in links:
            self.record.links.pop(name, None)

    # ------------------------------------------------------------------ links

    def _static_link(self, link: SceneLink) -> None:
        """A static link: geoms of the world, or of a mocap body when it is to be movable."""
        binding = LinkBinding(link.scoped, WORLD, link.pose_world, link, self.record.scene.scoped, True)
        body: Any = self.spec.worldbody
        if self.record.movable:
            pose = link.pose_world
            body = self.spec.worldbody.add_body(name=link.scoped, pos=pose.position, quat=pose.quaternion, mocap=True)
            binding = replace(binding, body_name=link.scoped, offset=IDENTITY)
            self.record.root_bodies.append(link.scoped)
        self.record.links[link.scoped] = binding
        self._fill(Place(body, binding.offset, True, 0.0, link.scoped), link)

    def _bodies(self, tree: Tree) -> None:
        model = self.record.scene
        mass: dict[str, float] = {}
        for link in tree.order:
            root = tree.root_of(link.scoped)
            mass[root] = mass.get(root, 0.0) + link.inertial.mass
        bodies: dict[str, Any] = {}
        base = tree.root_of(model.canonical_link) if model.canonical_link else ""
        for link in tree.order:
            edge = tree.edges.get(link.scoped)
            parent = edge.parent if edge is not None else WORLD
            if parent == WORLD:
                body = add_body(self.spec.worldbody, link, link.pose_world, self.diagnostics)
                self.record.root_bodies.append(link.scoped)
            else:
                above = self.joints.links[parent].pose_world
                body = add_body(bodies[parent], link, above.inverse() @ link.pose_world, self.diagnostics)
            bodies[link.scoped] = body
            binding = LinkBinding(link.scoped, link.scoped, IDENTITY, link, model.scoped, False)
            if edge is None and not (model.base == "fixed" and link.scoped in (base, tree.order[0].scoped)):
                free = f"{link.scoped}#free"
                body.add_freejoint(name=free)
                binding = replace(binding, free_joint=free)
            self.record.links[link.scoped] = binding
            self._fill(Place(body, IDENTITY, False, mass[tree.root_of(link.scoped)], link.scoped), link)
        for link in tree.order:
            edge = tree.edges.get(link.scoped)
            if edge is not None:
                self.joints.hang(bodies[link.scoped], link, edge)

    def _fill(self, place: Place, link: SceneLink) -> None:
        for collision in link.collisions:
            self.geoms.collision(place, collision)
        for visual in link.visuals:
            self.geoms.visual(place, visual)
        body_name = self.record.links[link.scoped].body_name
        for light in link.lights:
            pose = link.pose_world.inverse() @ light.pose_world
            add_light(place.body, light, place.offset @ pose, self.world.surroundings.shadows)
            self.record.lights[light.scoped] = LightBinding(light.scoped, light, self.record.scene.scoped, body_name)

    # ------------------------------------------------------------------ who never touches whom

    def _excludes(self, moving: list[SceneLink], joints: list[SceneJoint]) -> None:
        """Links of one model touch only where one of them collides with its own model, and never across a joint."""
        model = self.record.scene
        joined = {frozenset((j.parent_link, j.child_link)) for j in joints}
        owns = {link.scoped: m.self_collide for m in model.all_models() for link in m.links}
        solid = [link for link in moving if link.collisions]
        for a, b in combinations(solid, 2):
            collide = model.self_collide or any(k.self_collide or owns[k.scoped] for k in (a, b))
            if not collide or frozenset((a.scoped, b.scoped)) in joined:
                name = f"{a.scoped}|{b.scoped}"
                self.spec.add_exclude(name=name, bodyname1=a.scoped, bodyname2=b.scoped)
                self.record.excludes.append(name)


def _links(model: SceneModel, in_static: bool) -> Iterator[tuple[SceneLink, bool]]:
    """Every link and whether it is static, in document order."""
    is_static = in_static or model.static
    for link in model.links:
        yield link, is_static
    for nested in model.models:
        yield from _links(nested, is_static)
