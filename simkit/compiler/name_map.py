"""Name map: scoped names of the file to MuJoCo's names, and after a compile to its ids."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any, TypeVar

import mujoco

from simkit.compiler.geom_groups import COLLISION, COLLISION_CONTACT, COLLISION_RAY, DRAWN_COLLISION
from simkit.compiler.kinematic_tree import WORLD
from simkit.compiler.state_transfer import JOINT_WIDTHS
from simkit.diagnostics import did_you_mean
from simkit.pose import IDENTITY, Pose
from simkit.scene import Mesh, SceneJoint, SceneLight, SceneLink, SceneModel

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class LinkBinding:
    """Link in the MuJoCo model.

    Attributes:
        body_name: MuJoCo body, `world` for a static link.
        body: id of the body; 0 for a static link; -1 before the compile.
        offset: link frame in the body frame; the identity for a link with a body of its own.
        model: scoped name of the top-level model.
        mocap: index among the mocap bodies, or -1.
        free_joint: name of the free joint of the link's own body, or empty.
        root_joint_qpos: address of the free joint's position, or -1.
        root_joint_dof: address of the free joint's velocity, or -1.
        geoms: ids of the geoms that collide (groups COLLISION and COLLISION_CONTACT).
        ray_geoms: ids of the geoms that rays against collisions see (COLLISION and COLLISION_RAY).
        visuals: ids of the drawn geoms.
    """

    scoped: str
    body_name: str
    offset: Pose
    scene: SceneLink
    model: str
    static: bool
    body: int = -1
    mocap: int = -1
    free_joint: str = ""
    root_joint_qpos: int = -1
    root_joint_dof: int = -1
    geoms: tuple[int, ...] = ()
    ray_geoms: tuple[int, ...] = ()
    visuals: tuple[int, ...] = ()

    @property
    def has_missing_visuals(self) -> bool:
        """Check whether the link has visuals, but their mesh files are missing or unreadable: none of them is drawn."""
        shapes = [visual.geometry for visual in self.scene.visuals]
        return bool(shapes) and not self.visuals and all(isinstance(s, Mesh) for s in shapes)


@dataclass(frozen=True, slots=True)
class Follower:
    """Degree of freedom that an equality couples to an axis of a joint: value = offset + ratio · leader.

    Code that sets the state of the leader must also set the state of the follower, or the constraint would start with
    an error.

    Attributes:
        name: MuJoCo joint.
        axis: axis index of the leader.
    """

    name: str
    ratio: float
    qpos: int = -1
    dof: int = -1
    offset: float = 0.0
    axis: int = 0


@dataclass(frozen=True, slots=True)
class JointBinding:
    """Joint in the MuJoCo model.

    Attributes:
        joint_names: MuJoCo joints, one per axis (one for a ball or floating joint, none for a fixed one).
        joint_ids: ids of these joints.
        qpos: address of the first coordinate of each joint, in axis order.
        dofs: addresses of every degree of freedom, in axis order.
        parent_body: body id of the file's parent link (0: world).
        child_body: body id of the file's child link (0: world).
        pose_child: joint frame in the file's child link frame at load.
        pose_parent: joint frame in the file's parent link frame at load (in the world for `world`).
        is_reversed: True if the file's parent link is below its child link in the tree. Positions and axes keep the
            meaning that they have in the file.
        is_loop: True if the joint closes a loop. Then it moves a twin of its child link, and a weld fixes the twin to
            the link.
        equalities: names of the joint's equality constraints.
        twin: name of the twin body; empty if the joint is part of the tree.
        carried: scoped name of the link whose body (or twin) the joint moves in the tree. The link is in the rigid
            group of the file's child link, or of its parent link if the joint is reversed.
        moved_body: id of the body that the joint moves (the twin if the joint closes a loop); 0 if it moves no body.
        pose_moved: joint frame in the frame of the moved body.
        free: for a floating joint, the scoped name of the link whose free joint stores its position; empty if neither
            link has a free joint.
    """

    scoped: str
    type: str
    scene: SceneJoint
    model: str
    joint_names: tuple[str, ...] = ()
    pose_child: Pose = IDENTITY
    pose_parent: Pose = IDENTITY
    is_reversed: bool = False
    is_loop: bool = False
    equalities: tuple[str, ...] = ()
    twin: str = ""
    carried: str = ""
    free: str = ""
    followers: tuple[Follower, ...] = ()
    pose_moved: Pose = IDENTITY
    moved_body: int = -1
    joint_ids: tuple[int, ...] = ()
    qpos: tuple[int, ...] = ()
    dofs: tuple[int, ...] = ()
    parent_body: int = -1
    child_body: int = -1


@dataclass(frozen=True, slots=True)
class LightBinding:
    """Light in the MuJoCo model, with the file's scoped name; `id` is -1 before the compile, or if the light is off."""

    scoped: str
    scene: SceneLight
    model: str
    body_name: str = "world"
    id: int = -1


@dataclass(frozen=True, slots=True)
class ActuatorRef:
    """Actuator that a plugin requested; the reference stays valid when models are spawned or removed.

    Attributes:
        name: MuJoCo's name.
        kind: velocity, position, motor or drive (a motor that integrates its effort, for servos).
        joint: scoped name of the joint.
        axis: index of the joint's axis.
        max_effort: effort limit [N or N·m].
        kp: requested position gain; None for the largest stable gain.
        kv: requested velocity gain; None for the largest stable gain.
    """

    name: str
    kind: str
    joint: str
    axis: int
    max_effort: float = field(compare=False)  # a second plugin that shares a servo may raise it
    owner: str
    kp: float | None = None
    kv: float | None = None

    def __deepcopy__(self, memo: dict[int, object]) -> ActuatorRef:
        return self


@dataclass(frozen=True, slots=True)
class GeomOwner:
    """Owner of a geom: link, collision or visual, and True in `is_visual` for a drawn geom."""

    link: str
    scoped: str
    is_visual: bool


@dataclass(slots=True)
class ModelRecord:
    """Elements of a top-level model in the spec, by name, so that the model can be removed.

    Attributes:
        damped: decay rates [1/s] of linear and angular velocity by free joint.
        exact: mass [kg] in the specification and the file's inertia tensor [kg·m²], which is set after the compile, by
            link.
        massless: scoped name of the joint that moves a link without mass, by link; empty for a free link.
        unladen: links in `massless` with no mass below them.
        own_bit: collision bit of the model's links; 0 if excludes are used instead.
        has_unchecked_hulls: true if links of the model can touch each other, until `exclude_overlapping_hulls`.
        attached: prefix of the elements of each model in MuJoCo's own format, by scoped name.
    """

    scene: SceneModel
    movable: bool = False
    root_bodies: list[str] = field(default_factory=list)
    geoms: dict[str, GeomOwner] = field(default_factory=dict)
    links: dict[str, LinkBinding] = field(default_factory=dict)
    joints: dict[str, JointBinding] = field(default_factory=dict)
    lights: dict[str, LightBinding] = field(default_factory=dict)
    sites: list[str] = field(default_factory=list)
    world_sites: list[str] = field(default_factory=list)
    world_cameras: list[str] = field(default_factory=list)
    excludes: list[str] = field(default_factory=list)
    equalities: list[str] = field(default_factory=list)
    actuators: list[ActuatorRef] = field(default_factory=list)
    assets: set[tuple[str, str]] = field(default_factory=set)
    damped: dict[str, tuple[float, float]] = field(default_factory=dict)
    massless: dict[str, str] = field(default_factory=dict)
    unladen: set[str] = field(default_factory=set)
    exact: dict[str, tuple[float, tuple[float, float, float, float, float, float]]] = field(default_factory=dict)
    own_bit: int = 0
    has_unchecked_hulls: bool = False
    attached: dict[str, str] = field(default_factory=dict)

    def copy(self) -> ModelRecord:
        """Return an independent record. Both records share the bindings, which are immutable."""
        same = replace(self)
        for name in (item.name for item in fields(self)):
            content = getattr(self, name)
            if isinstance(content, (dict, list, set)):
                setattr(same, name, content.copy())
        return same

    def replace_scene(self, model: SceneModel) -> None:
        """Refer to the entities of the description of the model with other numbers."""
        self.scene = model
        links = {link.scoped: link for link in model.all_links()}
        joints = {joint.scoped: joint for joint in model.all_joints()}
        for name, binding in self.links.items():
            scene = links.get(name, binding.scene)
            # a static link is part of the world body, so its offset is its pose in the world; an attached model in
            # MuJoCo's own format has offsets of its own
            is_of_world = binding.body_name == WORLD and not self.attached
            offset = scene.pose_world if is_of_world else binding.offset
            self.links[name] = replace(binding, scene=scene, offset=offset)
        self.joints = {n: replace(b, scene=joints.get(n, b.scene)) for n, b in self.joints.items()}


def lookup(items: Mapping[str, T], name: str, kind: str) -> T:
    """Return `items[name]`; a KeyError suggests the closest name."""
    try:
        return items[name]
    except KeyError:
        hint = did_you_mean(name, items)
        raise KeyError(f"no {kind} {name!r}" + (f"; {hint}" if hint else "")) from None


class NameMap:
    """Map from scoped names to bindings. The ids are -1 before a compile."""

    def __init__(
        self, links: dict[str, LinkBinding], joints: dict[str, JointBinding], lights: dict[str, LightBinding]
    ) -> None:
        self.links, self.joints, self.lights = links, joints, lights
        self._owners: dict[int, GeomOwner] = {}
        self._model: mujoco.MjModel | None = None
        # a compile makes a new map, so values of the old model vanish without a call to each sensor
        self._shared: dict[str, Any] = {}

    def shared(self, key: str, make: Callable[[], T]) -> T:
        """Return a value that sensors derive from the compiled model; `make` computes it once for each key."""
        if key not in self._shared:
            self._shared[key] = make()
        value: T = self._shared[key]
        return value

    def forget_shared(self, key: str) -> None:
        """Let the next call of `shared` compute the value of a key again."""
        self._shared.pop(key, None)

    def replace_scenes(self, records: Iterable[ModelRecord]) -> None:
        """Refer to the descriptions that the records of the models refer to."""
        for record in records:
            links = {n: b.scene for n, b in record.links.items() if self.links[n].scene is not b.scene}
            joints = {n: b.scene for n, b in record.joints.items() if self.joints[n].scene is not b.scene}
            self.links.update({n: replace(self.links[n], scene=scene) for n, scene in links.items()})
            self.joints.update({n: replace(self.joints[n], scene=scene) for n, scene in joints.items()})

    def link(self, scoped: str) -> LinkBinding:
        """Return a link; a KeyError suggests the closest name."""
        return lookup(self.links, scoped, "link")

    def joint(self, scoped: str) -> JointBinding:
        """Return a joint; a KeyError suggests the closest name."""
        return lookup(self.joints, scoped, "joint")

    def light(self, scoped: str) -> LightBinding:
        """Return a light; a KeyError suggests the closest name."""
        return lookup(self.lights, scoped, "light")

    def site(self, name: str) -> int:
        """Return MuJoCo's id of a site, or raise KeyError."""
        return self._id("SITE", name)

    def camera(self, name: str) -> int:
        """Return MuJoCo's id of a camera, or raise KeyError."""
        return self._id("CAMERA", name)

    def equality(self, name: str) -> int:
        """Return MuJoCo's id of an equality constraint, or raise KeyError."""
        return self._id("EQUALITY", name)

    def actuator(self, ref: ActuatorRef | str) -> int:
        """Return MuJoCo's id of an actuator, or raise KeyError."""
        return self._id("ACTUATOR", ref if isinstance(ref, str) else ref.name)

    def geom_owner(self, geom_id: int) -> tuple[str, str, bool]:
        """Return (link, collision or visual, True if drawn) of a geom; empty names for a geom without a model."""
        owner = self._owners.get(int(geom_id))
        return (owner.link, owner.scoped, owner.is_visual) if owner else ("", "", False)

    def geom_owner_link(self, scoped: str) -> str:
        """Return the link of a collision or visual by its scoped name; empty without one."""
        return next((o.link for o in self._owners.values() if o.scoped == scoped), "")

    def drawn(self, link: str) -> dict[str, tuple[int, ...]]:
        """Return the drawn geoms of a link by the scoped name of their visual."""
        geoms: dict[str, tuple[int, ...]] = {}
        for geom in self.link(link).visuals:
            scoped = self.geom_owner(geom)[1]
            geoms[scoped] = (*geoms.get(scoped, ()), geom)
        return geoms

    def model_frame(self, model: SceneModel) -> tuple[int, Pose]:
        """Return the body that moves with the frame of a model, and the pose of the frame in the frame of the body.

        For a model without links, the body is the world body.
        """
        canonical = self.links.get(model.canonical_link)
        if canonical is None:
            return 0, model.pose_world
        return canonical.body, canonical.offset @ canonical.scene.pose_world.inverse() @ model.pose_world

    def _id(self, kind: str, name: str) -> int:
        if self._model is None:
            raise KeyError(f"{name!r} has no id before the compile")
        number = int(mujoco.mj_name2id(self._model, getattr(mujoco.mjtObj, f"mjOBJ_{kind}"), name))
        if number < 0:
            raise KeyError(f"no {kind.lower()} {name!r}")
        return number

    @classmethod
    def of(cls, records: Iterable[ModelRecord], model: mujoco.MjModel | None = None) -> NameMap:
        """Return the map of all records, bound to the ids of `model` if given."""
        links: dict[str, LinkBinding] = {}
        joints: dict[str, JointBinding] = {}
        lights: dict[str, LightBinding] = {}
        records = list(records)
        for record in records:
            links.update(record.links)
            joints.update(record.joints)
            lights.update(record.lights)
        names = cls(links, joints, lights)
        if model is not None:
            names._bind(records, model)
        return names

    def _bind(self, records: list[ModelRecord], model: mujoco.MjModel) -> None:
        def number(kind: mujoco.mjtObj, name: str) -> int:
            return int(mujoco.mj_name2id(model, kind, name))

        self._model = model
        collide: dict[str, list[int]] = {}
        seen: dict[str, list[int]] = {}
        drawn: dict[str, list[int]] = {}
        group = model.geom_group.tolist()
        for record in records:
            for name, owner in record.geoms.items():
                i = number(mujoco.mjtObj.mjOBJ_GEOM, name)
                self._owners[i] = owner
                if owner.is_visual:
                    drawn.setdefault(owner.link, []).append(i)
                else:
                    # contacts and rays may use different geoms: a mesh collides as convex pieces that no ray hits, and
                    # rays hit an exact copy that never collides
                    if group[i] == DRAWN_COLLISION:
                        drawn.setdefault(owner.link, []).append(i)
                    if group[i] in (COLLISION, COLLISION_CONTACT, DRAWN_COLLISION):
                        collide.setdefault(owner.link, []).append(i)
                    if group[i] in (COLLISION, COLLISION_RAY, DRAWN_COLLISION):
                        seen.setdefault(owner.link, []).append(i)
        # new bindings, because the record keeps those without ids for the next compile
        for scoped, link in self.links.items():
            body = number(mujoco.mjtObj.mjOBJ_BODY, link.body_name)
            free = number(mujoco.mjtObj.mjOBJ_JOINT, link.free_joint) if link.free_joint else -1
            self.links[scoped] = replace(
                link,
                body=body,
                mocap=int(model.body_mocapid[body]),
                root_joint_qpos=int(model.jnt_qposadr[free]) if free >= 0 else -1,
                root_joint_dof=int(model.jnt_dofadr[free]) if free >= 0 else -1,
                geoms=tuple(collide.get(scoped, ())),
                ray_geoms=tuple(seen.get(scoped, ())),
                visuals=tuple(drawn.get(scoped, ())),
            )
        for scoped, joint in self.joints.items():
            self.joints[scoped] = self._bound_joint(joint, model)
        for scoped, light in self.lights.items():
            self.lights[scoped] = replace(light, id=number(mujoco.mjtObj.mjOBJ_LIGHT, scoped))

    def _bound_joint(self, joint: JointBinding, model: mujoco.MjModel) -> JointBinding:
        ids = tuple(int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, n)) for n in joint.joint_names)
        dofs: list[int] = []
        for i in ids:
            _, width = JOINT_WIDTHS.get(int(model.jnt_type[i]), (1, 1))
            dofs += range(int(model.jnt_dofadr[i]), int(model.jnt_dofadr[i]) + width)
        followers = []
        for f in joint.followers:
            i = int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, f.name))
            followers.append(replace(f, qpos=int(model.jnt_qposadr[i]), dof=int(model.jnt_dofadr[i])))
        parent, child = self.links.get(joint.scene.parent_link), self.links.get(joint.scene.child_link)
        carried = self.links.get(joint.carried)

        def number_of(body: str) -> int:
            return int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, body))

        return replace(
            joint,
            joint_ids=ids,
            qpos=tuple(int(model.jnt_qposadr[i]) for i in ids),
            dofs=tuple(dofs),
            followers=tuple(followers),
            # a twin is no link of the file, so only its body's name leads to it
            moved_body=number_of(joint.twin) if joint.twin else (carried.body if carried else 0),
            parent_body=parent.body if parent else 0,
            child_body=child.body if child else 0,
        )
