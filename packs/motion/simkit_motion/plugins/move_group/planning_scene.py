"""Planning scene: obstacles that requests name, objects that are attached to links, and pairs that may touch."""

from __future__ import annotations

from collections.abc import Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Pose, msgs
from simkit.extend import SharedByCopies, counted, did_you_mean
from simkit.linear_algebra import norm
from simkit.pose import IDENTITY
from simkit_motion.plugins.move_group.collision_shapes import shape_of_primitive, triangle_mesh, voxels
from simkit_motion.plugins.move_group.error_codes import Code, PlanningFailed, check_packages
from simkit_motion.plugins.move_group.goal_constraints import Frames, pose_of_message
from simkit_motion.plugins.move_group.group_model import Obstacle
from simkit_motion.plugins.move_group.planning import find_link

if TYPE_CHECKING:
    from coal import CollisionGeometry

    from simkit import Model
    from simkit.msgs import Message

_MANY_CUBES: Final = 50
_SHAPE_FIELDS: Final = ("primitives", "primitive_poses", "meshes", "mesh_poses", "planes", "plane_poses")


@dataclass(frozen=True, eq=False)
class SceneObject(SharedByCopies):
    """Object of the planning scene, which never changes; a change replaces it.

    Attributes:
        message: `moveit_msgs/msg/CollisionObject` with the shapes.
        pose: Pose of the object in the world, or in the frame of `link`.
        link: Scoped name of the link that carries the object; empty for an obstacle.
        touches: Plain names of links that may touch the object.
    """

    message: Message
    pose: Pose
    link: str = ""
    touches: frozenset[str] = frozenset()

    def shapes(self) -> list[tuple[CollisionGeometry, Pose]]:
        """Return the shapes of the package `coal` with their poses in the object.

        Raises:
            PlanningFailed: A shape is invalid or unsupported.
        """
        check_packages()
        placed, m = [], self.message
        for kind, shapes, poses in (
            ("primitives", m.primitives, m.primitive_poses),
            ("meshes", m.meshes, m.mesh_poses),
            ("planes", m.planes, m.plane_poses),
        ):
            if len(poses) not in (0, len(shapes)):
                text = f"object {m.id!r} has {len(shapes)} {kind} and {counted(len(poses), 'pose')}"
                raise PlanningFailed(Code.INVALID_OBJECT_NAME, text)
            places = [pose_of_message(pose) for pose in poses] or [IDENTITY] * len(shapes)
            items = list(zip(shapes, places, strict=True))
            if kind == "primitives" and len(items) >= _MANY_CUBES:
                octrees, items = _join_cubes(items)
                placed += octrees
            placed += [(self._shape(kind, shape), place) for shape, place in items]
        return placed

    def _shape(self, kind: str, shape: Message) -> CollisionGeometry:
        import coal

        try:
            if kind == "primitives":
                return shape_of_primitive(shape)
            if kind == "planes":
                a, b, c, d = (float(v) for v in shape.coef)
                length = norm([a, b, c])
                if not np.isfinite([length, d]).all() or length < 1e-9:
                    raise ValueError(f"the plane {[a, b, c, d]} has no normal")
                return coal.Halfspace(np.array([a, b, c]) / length, -d / length)
            points = np.array([(p.x, p.y, p.z) for p in shape.vertices], dtype=float)
            corners = np.array([t.vertex_indices for t in shape.triangles], dtype=int).reshape(-1, 3)
            if not len(corners) or not np.isfinite(points).all() or corners.min() < 0 or corners.max() >= len(points):
                raise ValueError("the mesh has no triangles, or a triangle names a missing vertex")
            return triangle_mesh(points, corners)
        except ValueError as error:
            raise PlanningFailed(Code.INVALID_OBJECT_NAME, f"object {self.message.id!r}: {error}") from None


def _join_cubes(
    items: list[tuple[Message, Pose]],
) -> tuple[list[tuple[CollisionGeometry, Pose]], list[tuple[Message, Pose]]]:
    """Join the cubes that lie in a grid to one shape for each size; return these shapes and all other items."""
    cubes: dict[float, list[tuple[Message, Pose]]] = {}
    others = []
    for shape, place in items:
        sides = {round(float(v), 9) for v in shape.dimensions}
        is_cube = shape.type == shape.BOX and len(shape.dimensions) == 3 and len(sides) == 1 and min(sides) > 0.0
        if is_cube and abs(place.quaternion[0]) > 1.0 - 1e-12:
            cubes.setdefault(sides.pop(), []).append((shape, place))
        else:
            others.append((shape, place))
    joined = []
    for side, group in cubes.items():
        grid = voxels(np.array([place.position for _, place in group]), side)
        if grid is None:
            others += group
        else:
            joined.append((grid[0], Pose(grid[1], IDENTITY.quaternion)))
    return joined, others


class PlanningScene:
    """Obstacles, attached objects and allowed contacts of one robot.

    Args:
        allowed: Pairs of names that may touch in an empty scene.

    Attributes:
        allowed: Pairs of names of links, models and objects that may touch; a single name may touch everything.
    """

    def __init__(self, allowed: frozenset[frozenset[str]] = frozenset()) -> None:
        self._objects: dict[str, SceneObject] = {}
        self._first_allowed = self.allowed = allowed

    def apply(self, scene: Message, frames: Frames) -> None:
        """Change the scene by a `moveit_msgs/msg/PlanningScene`; without `is_diff`, it replaces the scene.

        Raises:
            PlanningFailed: The message is invalid or has something unsupported; the scene does not change.
        """
        before = dict(self._objects), self.allowed
        if not scene.is_diff:
            self._objects, self.allowed = {}, self._first_allowed
        try:
            for name, is_given in (
                ("world.octomap", len(scene.world.octomap.octomap.data)),
                ("link_padding", len(scene.link_padding)),
                ("link_scale", len(scene.link_scale)),
                ("fixed_frame_transforms", len(scene.fixed_frame_transforms)),
            ):
                if is_given:
                    help_text = (
                        "send the voxels as boxes of a collision object" if "octomap" in name else "leave it empty"
                    )
                    raise PlanningFailed(Code.FAILURE, f"{name} is not supported; help: {help_text}")
            for item in scene.world.collision_objects:
                self._apply_object(item, frames)
            for attached in scene.robot_state.attached_collision_objects:
                self._attach(attached, frames)
            if len(scene.allowed_collision_matrix.entry_names) or len(
                scene.allowed_collision_matrix.default_entry_names
            ):
                self.allowed = _allowed_pairs(scene.allowed_collision_matrix)
        except PlanningFailed:
            self._objects, self.allowed = before
            raise

    def _apply_object(self, item: Message, frames: Frames) -> None:
        operation = int(item.operation)
        if operation == item.REMOVE:
            if item.id:
                self._existing(item.id)
                del self._objects[item.id]
            else:  # as in MoveIt: no name removes all
                self._objects = {
                    name: scene_object for name, scene_object in self._objects.items() if scene_object.link
                }
            return
        if not item.id:
            raise PlanningFailed(Code.INVALID_OBJECT_NAME, "a collision object has no id")
        pose = frames.pose(item.header.frame_id) @ _object_pose(item)
        if operation == item.MOVE:
            self._objects[item.id] = SceneObject(self._existing(item.id).message, pose)
            return
        if operation == item.APPEND and item.id in self._objects:
            raise PlanningFailed(Code.INVALID_OBJECT_NAME, f"APPEND is not supported; add object {item.id!r} again")
        if operation not in (item.ADD, item.APPEND):
            text = f"operation {operation} of object {item.id!r}; expected 0 (add), 1 (remove) or 3 (move)"
            raise PlanningFailed(Code.INVALID_OBJECT_NAME, text)
        scene_object = SceneObject(deepcopy(item), pose)  # the client may use its message again
        if not scene_object.shapes():
            raise PlanningFailed(Code.INVALID_OBJECT_NAME, f"object {item.id!r} has no shapes")
        self._objects[item.id] = scene_object

    def _attach(self, attached: Message, frames: Frames) -> None:
        item = attached.object
        if int(item.operation) == item.REMOVE:
            names = [item.id] if item.id else self._carried_by(attached.link_name)
            for name in names:  # the object stays in the world where it is
                before = self._existing(name)
                if before.link:
                    pose = frames.sim.link(before.link).pose @ before.pose
                    self._objects[name] = SceneObject(before.message, pose)
            return
        link = find_link(frames.robot, attached.link_name)
        if not item.id:
            raise PlanningFailed(Code.INVALID_OBJECT_NAME, "an attached object has no id")
        if len(item.primitives) or len(item.meshes) or len(item.planes):
            message, pose = deepcopy(item), frames.pose(item.header.frame_id) @ _object_pose(item)
        else:
            known = self._existing(item.id)
            message, pose = known.message, known.pose
        touches = frozenset((attached.link_name, *(str(name) for name in attached.touch_links)))
        scene_object = SceneObject(message, frames.sim.link(link).pose.inverse() @ pose, link, touches)
        scene_object.shapes()
        self._objects[item.id] = scene_object

    def _carried_by(self, link: str) -> list[str]:
        """Return the names of the objects that are attached to a link, by plain name, or to any link."""
        items = self._objects.items()
        return [name for name, item in items if item.link and link in ("", item.link.rpartition("::")[2])]

    def _existing(self, name: str) -> SceneObject:
        if name not in self._objects:
            near = did_you_mean(name, self._objects) or "there is " + (", ".join(self._objects) or "none")
            raise PlanningFailed(Code.INVALID_OBJECT_NAME, f"the planning scene has no object {name!r}; {near}")
        return self._objects[name]

    def obstacles(self) -> tuple[Obstacle, ...]:
        """Return the shapes of all objects."""
        return tuple(
            Obstacle(name, shape, item.pose @ place, item.link, item.touches)
            for name, item in self._objects.items()
            for shape, place in item.shapes()
        )

    def as_fields(self, robot: Model) -> dict[str, object]:
        """Return the scene as the fields of a `moveit_msgs/msg/PlanningScene`; poses are in the frame `world`."""
        objects, attached = [], []
        for item in self._objects.values():
            link = item.link.rpartition("::")[2]
            message = item.message
            fields = {name: getattr(message, name) for name in ("id", "type", *_SHAPE_FIELDS)}
            fields |= {"header": {"frame_id": link or "world"}, "pose": msgs.pose_message(item.pose)}
            if link:
                attached.append({"link_name": link, "object": fields, "touch_links": sorted(item.touches)})
            else:
                objects.append(fields)
        moving = [(name, float(joint.position)) for name, joint in robot.joints.items() if joint.dof == 1]
        joints = {"name": [name for name, _ in moving], "position": [position for _, position in moving]}
        state = {"joint_state": joints, "attached_collision_objects": attached}
        scene: dict[str, object] = {"name": "scene", "robot_model_name": robot.name, "robot_state": state}
        matrix = self._matrix([*robot.links, *self._objects])
        return scene | {"world": {"collision_objects": objects}, "allowed_collision_matrix": matrix}

    def _matrix(self, names: Sequence[str]) -> dict[str, object]:
        """Return the fields of a `moveit_msgs/msg/AllowedCollisionMatrix`."""
        single = sorted(name for pair in self.allowed if len(pair) == 1 for name in pair)
        rows = [{"enabled": [frozenset((a, b)) in self.allowed for b in names]} for a in names]
        defaults = {"default_entry_names": single, "default_entry_values": [True] * len(single)}
        return {"entry_names": list(names), "entry_values": rows, **defaults}


def _object_pose(item: Message) -> Pose:
    """Return the pose of an object; a pose of zeros, as in a message without it, is the origin of the frame."""
    o = item.pose.orientation
    if not any((o.w, o.x, o.y, o.z)):
        return pose_of_message(msgs.make("geometry_msgs/msg/Pose", position=item.pose.position, orientation={"w": 1.0}))
    return pose_of_message(item.pose)


def _allowed_pairs(matrix: Message) -> frozenset[frozenset[str]]:
    """Return the pairs of an allowed collision matrix that may touch.

    Raises:
        PlanningFailed: The matrix is not square.
    """
    names, rows = [str(name) for name in matrix.entry_names], [list(row.enabled) for row in matrix.entry_values]
    if len(rows) != len(names) or any(len(row) != len(names) for row in rows):
        text = f"the allowed collision matrix has {len(names)} names; expected as many rows and columns"
        raise PlanningFailed(Code.FAILURE, text)
    defaults, values = list(matrix.default_entry_names), list(matrix.default_entry_values)
    if len(defaults) != len(values):
        raise PlanningFailed(Code.FAILURE, "the matrix has not as many default_entry_values as default_entry_names")
    pairs = {
        frozenset((a, b)) for a, row in zip(names, rows, strict=True) for b, on in zip(names, row, strict=True) if on
    }
    pairs = {pair for pair in pairs if len(pair) == 2}
    return frozenset(pairs | {frozenset((str(name),)) for name, on in zip(defaults, values, strict=True) if on})
