"""Writer of one top-level model: bodies, joints, geoms, lights, and pairs of links that never touch."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import combinations
from typing import Final

import mujoco

from simkit.compiler.assets import Assets
from simkit.compiler.bodies import KINEMATIC_ARMATURE, add_body, is_massless
from simkit.compiler.geoms import GeomParent, GeomWriter, WorldGeoms
from simkit.compiler.joints import JointWriter
from simkit.compiler.kinematic_tree import WORLD, KinematicTree, plan_tree
from simkit.compiler.lights import add_light, report_light
from simkit.compiler.name_map import LightBinding, LinkBinding, ModelRecord
from simkit.compiler.refused_inertias import BodyInertia, plan_inertials
from simkit.compiler.wheel_cylinders import turning_axis
from simkit.diagnostics import Diagnostics
from simkit.pose import IDENTITY
from simkit.scene import SceneJoint, SceneLink, SceneModel, SceneWorld

DEEPEST: Final = 1000
"""Largest number of links in a chain; MuJoCo supports 1024 bodies."""


class ModelWriter:
    """Writer of one model that fills its record."""

    def __init__(
        self,
        world_geoms: WorldGeoms,
        assets: Assets,
        record: ModelRecord,
        world: SceneWorld,
        diagnostics: Diagnostics,
    ) -> None:
        self.spec, self.record, self.world, self.diagnostics = world_geoms.spec, record, world, diagnostics
        step = float(self.spec.option.timestep)
        ambient, has_rolling = world.surroundings.ambient, world.physics.engine == "bullet"
        self.geoms = GeomWriter(world_geoms, assets, record, step, diagnostics, ambient, has_rolling)
        self.joints = JointWriter(self.spec, record, step, diagnostics)

    def write(self, joints: list[SceneJoint]) -> None:
        """Add the whole model with `joints` (its own joints and its joints to the world)."""
        model = self.record.scene
        links = list(_links(model, False))
        static = {link.scoped for link, is_static in links if is_static}
        moving = [link for link, is_static in links if not is_static]
        self.joints.links = {link.scoped: link for link, _ in links}
        for link, is_static in links:
            if is_static:
                self._static_link(link)
        for joint in joints:
            if {joint.parent_link, joint.child_link} <= static | {WORLD}:
                self.joints.bind_static(joint, is_expected=model.static)
        joints = [j for j in joints if not {j.parent_link, j.child_link} <= static | {WORLD}]
        tree = plan_tree(moving, joints, static)
        if tree.depth > DEEPEST:
            self._report_depth(tree)
            return
        self.joints.carriers = tree.carriers
        self._bodies(tree)
        for joint in tree.loops:
            self.joints.add_loop_joint(joint)
        for joint in tree.constraints:
            self.joints.add_gearbox(joint)
        self.joints.couplings.mimics(joints)
        exclude_self_collisions(self.spec, self.record, moving, joints)

    def join(self, joints: list[SceneJoint], links: Mapping[str, LinkBinding]) -> None:
        """Add joints between models as constraints."""
        self._bind_links(links)
        for joint in joints:
            ends = {joint.parent_link, joint.child_link}
            if not ends <= {WORLD, *links}:
                continue
            if all(end == WORLD or links[end].static for end in ends):
                self.joints.bind_static(joint, is_expected=False)
            elif joint.type == "floating":
                self.joints.bind_floating(joint)
            elif joint.type == "gearbox":
                self.joints.add_gearbox(joint)
            else:
                self.joints.add_loop_joint(joint, "connects two models")
                self._exclude(joint, links)
        self._unbind_links(links)

    def _exclude(self, joint: SceneJoint, links: Mapping[str, LinkBinding]) -> None:
        """Exclude contacts between the links of a joint.

        This is impossible for a static link, which is part of the world body.
        """
        bodies = [links[end].body_name for end in (joint.parent_link, joint.child_link) if end != WORLD]
        if len(bodies) == 2 and WORLD not in bodies:
            self.spec.add_exclude(name=joint.scoped, bodyname1=bodies[0], bodyname2=bodies[1])
            self.record.excludes.append(joint.scoped)

    def weld(self, name: str, parent: str, child: str, links: Mapping[str, LinkBinding], active: bool) -> None:
        """Add a weld between two links, of this model or of others."""
        known = dict(self.record.links)
        self._bind_links(links)
        self.joints.add_weld(name, parent, child, active)
        self._unbind_links({n: b for n, b in links.items() if n not in known})

    def _bind_links(self, links: Mapping[str, LinkBinding]) -> None:
        self.joints.links = {n: b.scene for n, b in links.items()}
        self.record.links.update(links)

    def _unbind_links(self, links: Mapping[str, LinkBinding]) -> None:
        for name in links:
            self.record.links.pop(name, None)

    # ------------------------------------------------------------------ links

    def _static_link(self, link: SceneLink) -> None:
        """Add a static link: geoms of the world, or of a mocap body if it is movable."""
        binding = LinkBinding(link.scoped, WORLD, link.pose_world, link, self.record.scene.scoped, True)
        body: mujoco.MjsBody = self.spec.worldbody
        if self.record.movable:
            pose = link.pose_world
            body = self.spec.worldbody.add_body(name=link.scoped, pos=pose.position, quat=pose.quaternion, mocap=True)
            binding = replace(binding, body_name=link.scoped, offset=IDENTITY)
            self.record.root_bodies.append(link.scoped)
        self.record.links[link.scoped] = binding
        is_world = binding.body_name == WORLD
        self._add_contents(GeomParent(body, binding.offset, True, 0.0, link.scoped, is_world=is_world), link)

    def _bodies(self, tree: KinematicTree) -> None:
        model = self.record.scene
        bodies: dict[str, mujoco.MjsBody] = {}
        base = tree.root_of(model.canonical_link) if tree.roots.get(model.canonical_link) else ""
        afloat = {end for j in tree.floating for end in (j.child_link,)}
        free = {
            link.scoped
            for link in tree.order
            if link.scoped not in tree.edges
            and (model.base != "fixed" or link.scoped not in (base, tree.order[0].scoped) or link.scoped in afloat)
        }
        inertials = self._inertials(tree, free)
        for link in tree.order:
            edge = tree.edges.get(link.scoped)
            parent = edge.parent if edge is not None else WORLD
            is_free = link.scoped in free
            needs_mass = self._needs_mass(link, tree, is_free)
            if parent == WORLD:
                pose, above = link.pose_world, self.spec.worldbody
                self.record.root_bodies.append(link.scoped)
            else:
                pose, above = self.joints.links[parent].pose_world.inverse() @ link.pose_world, bodies[parent]
            body = bodies[link.scoped] = add_body(above, link, pose, inertials.get(link.scoped), needs_mass=needs_mass)
            free_joint = self._add_free_joint(body, link) if is_free else ""
            binding = LinkBinding(link.scoped, link.scoped, IDENTITY, link, model.scoped, False, free_joint=free_joint)
            if not is_free and (link.kinematic or any(link.velocity_decay)):
                self._report_kinematic(link)
            self.record.links[link.scoped] = binding
            mass = tree.masses[tree.root_of(link.scoped)]
            self._add_contents(GeomParent(body, IDENTITY, False, mass, link.scoped, turning_axis(link, tree)), link)
        for link in tree.order:
            edge = tree.edges.get(link.scoped)
            if edge is not None:
                self.joints.add_tree_joint(bodies[link.scoped], link, edge)
        for joint in tree.floating:
            self.joints.bind_floating(joint)

    def _inertials(self, tree: KinematicTree, free: set[str]) -> dict[str, BodyInertia]:
        """Return a mass and an inertia that the compiler accepts for every link that has a mass or an inertia.

        The record stores the file's tensors that the compiler refuses.
        """
        rigid: dict[str, str] = {}
        still = set()
        for link in tree.order:
            edge = tree.edges.get(link.scoped)
            is_fixed = edge is not None and edge.joint.type == "fixed"
            if edge is not None and is_fixed and edge.parent != WORLD:
                rigid[link.scoped] = rigid[edge.parent]
                continue
            rigid[link.scoped] = link.scoped
            if is_fixed or (edge is None and link.scoped not in free):
                still.add(link.scoped)
        massive = [link for link in tree.order if not is_massless(link.inertial)]
        written = plan_inertials(massive, rigid, frozenset(still), self.diagnostics)
        self.record.exact = {name: (w.mass, w.exact) for name, w in written.items() if w.exact is not None}
        return written

    def _add_free_joint(self, body: mujoco.MjsBody, link: SceneLink) -> str:
        """Make a link move freely; return the name of the joint."""
        name = f"{link.scoped}#free"
        joint = body.add_freejoint(name=name)
        if link.kinematic:
            # so large that no force moves the link, only a velocity that the user sets
            joint.armature = KINEMATIC_ARMATURE
        if any(link.velocity_decay):
            step = float(self.spec.option.timestep)
            # an implicit step with damping c divides the velocity by 1 + c·step
            parts = (min(0.999, max(0.0, part)) for part in link.velocity_decay)
            linear, angular = (part / (1.0 - part) / step for part in parts)
            self.record.damped[name] = (linear, angular)
            message = (
                f"velocity_decay of link {link.scoped} is simulated as a damping of {linear:g}/s linear and "
                f"{angular:g}/s angular"
            )
            self.diagnostics.note("SK-PHYS-026", message, link.where)
        return name

    def _report_kinematic(self, link: SceneLink) -> None:
        if link.kinematic:
            text = f"kinematic: link {link.scoped} is on a joint; gravity does not act on it, but contacts push it"
            self.diagnostics.warning("SK-PHYS-012", text, link.where)
        if any(link.velocity_decay):
            text = f"velocity_decay of link {link.scoped} is ignored: the link is on a joint"
            self.diagnostics.warning("SK-PHYS-027", text, link.where, "use <dynamics><damping> of the joint")

    def _report_depth(self, tree: KinematicTree) -> None:
        """Report that a chain of links is too long; the model is not written.

        Its links and joints are recorded, so that later look-ups by name succeed.
        """
        last = self.joints.links[tree.deepest]
        message = f"link {last.scoped} is at the end of a chain of {tree.depth} links; at most {DEEPEST} are supported"
        self.diagnostics.error("SK-JOINT-015", message, last.where)
        for link in tree.order:
            self.record.links[link.scoped] = LinkBinding(
                link.scoped, WORLD, link.pose_world, link, self.record.scene.scoped, True
            )
        for joint in (*(e.joint for e in tree.edges.values()), *tree.loops, *tree.constraints, *tree.floating):
            self.joints.bind_static(joint)

    def _needs_mass(self, link: SceneLink, tree: KinematicTree, is_free: bool) -> bool:
        """Check whether a link's body needs a mass: a joint moves the link, and no link that is fixed to it has a mass.

        If no link below has a mass either, an effort cannot move the link. This is an error for a free link; the joint
        of any other link gets an armature (`model_compilation.add_idle_armature`).
        """
        edge = tree.edges.get(link.scoped)
        moves = is_free or (edge is not None and edge.joint.type != "fixed")
        if not moves or not is_massless(link.inertial):
            return moves
        if tree.carried[link.scoped] <= 0.0:
            if edge is None:
                self.diagnostics.error(
                    "SK-JOINT-010",
                    f"link {link.scoped} moves freely, but neither it nor any link that it carries has mass",
                    link.where,
                    "give the link an <inertial>, or fix the model: <static>, or --base fixed for a robot alone",
                )
                return True
            self.record.unladen.add(link.scoped)
            self.record.massless[link.scoped] = edge.joint.scoped
            return True
        if not self._has_rigid_mass(link.scoped, tree):
            self.record.massless[link.scoped] = edge.joint.scoped if edge else ""
            return True
        return False

    def _has_rigid_mass(self, link: str, tree: KinematicTree) -> bool:
        """Check whether a link below that only fixed joints connect to this link has mass. The engine needs no more."""
        stack = list(tree.children.get(link, ()))
        while stack:
            name = stack.pop()
            if tree.edges[name].joint.type == "fixed":
                if not is_massless(self.joints.links[name].inertial):
                    return True
                stack += tree.children.get(name, ())
        return False

    def _add_contents(self, parent: GeomParent, link: SceneLink) -> None:
        for collision in link.collisions:
            self.geoms.collision(parent, collision)
        for visual in link.visuals:
            self.geoms.visual(parent, visual)
        body_name = self.record.links[link.scoped].body_name
        for light in link.lights:
            pose = link.pose_world.inverse() @ light.pose_world
            add_light(parent.body, light, parent.offset @ pose, self.world.surroundings.shadows)
            report_light(light, self.world, self.diagnostics)
            self.record.lights[light.scoped] = LightBinding(light.scoped, light, self.record.scene.scoped, body_name)


def _links(model: SceneModel, in_static: bool) -> Iterator[tuple[SceneLink, bool]]:
    """Yield every link and whether it is static, in document order."""
    is_static = in_static or model.static
    for link in model.links:
        yield link, is_static
    for nested in model.models:
        yield from _links(nested, is_static)


FIRST_OWN_BIT: Final = 16
"""First collision bit that is assigned to models; the bit masks of files have 16 bits."""

PAIRS_MOST: Final = 2000
"""Number of link pairs above which a model excludes contacts by a collision bit instead of a list of pairs."""

_ALL_BITS: Final = 0xFFFF
_ALL_OWN: Final = 0x7FFF0000


def exclude_self_collisions(
    spec: mujoco.MjSpec, record: ModelRecord, moving: list[SceneLink], joints: list[SceneJoint]
) -> None:
    """Exclude contacts between the links of one model.

    Two links still touch if one of them has self-collision and no joint connects them.

    A nested model without joints to the rest is treated as another model, as in Gazebo: its links and the other links
    touch.

    Usually each pair of bodies gets an `<exclude>`. A model with very many links, no self-collision and default bit
    masks uses a collision bit of its own instead: geoms with the bit collide with everything except each other.
    """
    model = record.scene
    joined = {frozenset((j.parent_link, j.child_link)) for j in joints}
    owns = {link.scoped: m.self_collide for m in model.all_models() for link in m.links}
    solid = [link for link in moving if link.collisions]
    touchy = {k.scoped for k in solid if model.self_collide or k.self_collide or owns[k.scoped]}
    record.has_unchecked_hulls = bool(touchy)
    groups = _jointed_groups(model, joints)
    is_one = len({groups[link.scoped] for link in solid}) < 2
    many = is_one and len(solid) * (len(solid) - 1) // 2 > PAIRS_MOST
    if not touchy and many and record.own_bit and _is_plain(solid):
        _mark_geom(spec, record, {link.scoped for link in solid})
        return
    record.own_bit = 0
    for a, b in combinations(solid, 2):
        if groups[a.scoped] != groups[b.scoped]:
            continue
        collide = a.scoped in touchy or b.scoped in touchy
        if not collide or frozenset((a.scoped, b.scoped)) in joined:
            name = f"{a.scoped}|{b.scoped}"
            spec.add_exclude(name=name, bodyname1=a.scoped, bodyname2=b.scoped)
            record.excludes.append(name)


def _jointed_groups(model: SceneModel, joints: list[SceneJoint]) -> dict[str, str]:
    """Return a group name for each link: links of one model, and models connected by joints, form a group."""
    of_link = {link.scoped: m.scoped for m in model.all_models() for link in m.links}
    above: dict[str, str] = {}

    def top(name: str) -> str:
        while name in above:
            name = above[name]
        return name

    for joint in joints:
        if joint.parent_link in of_link and joint.child_link in of_link:
            parent, child = top(of_link[joint.parent_link]), top(of_link[joint.child_link])
            if parent != child:
                above[child] = parent
    return {link: top(owner) for link, owner in of_link.items()}


def _is_plain(links: list[SceneLink]) -> bool:
    surfaces = [c.surface for link in links for c in link.collisions]
    return all(s.collide_bitmask == s.category_bitmask == _ALL_BITS for s in surfaces)


def _mark_geom(spec: mujoco.MjSpec, record: ModelRecord, links: set[str]) -> None:
    for name, owner in record.geoms.items():
        if owner.is_visual or owner.link not in links:
            continue
        geom = spec.geom(name)
        if geom.contype or geom.conaffinity:
            geom.contype, geom.conaffinity = record.own_bit, _ALL_BITS | (_ALL_OWN & ~record.own_bit)
