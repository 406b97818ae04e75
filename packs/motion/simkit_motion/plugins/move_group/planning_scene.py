"""Planning scene: obstacles that requests name, objects that are attached to links, and pairs that may touch."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit import msgs
from simkit.diagnostics import did_you_mean
from simkit.linear_algebra import norm
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.pose import IDENTITY, Pose
from simkit_motion.plugins.move_group.collision_shapes import shape_of_primitive, triangle_mesh, voxels
from simkit_motion.plugins.move_group.error_codes import Code, PlanningFailed, check_packages
from simkit_motion.plugins.move_group.goal_constraints import Frames, pose_of_message
from simkit_motion.plugins.move_group.group_model import Obstacle
from simkit_motion.plugins.move_group.planning import find_link

if TYPE_CHECKING:
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

    def shapes(self) -> list[tuple[Any, Pose]]:
        """Return the shapes of the package `coal` with their poses in the object.

        Raises:
            PlanningFailed: A shape is invalid or unsupported.
        """
        check_packages()
        found, m = [], self.message
        for kind, shapes, poses in (
            ("primitives", m.primitives, m.primitive_poses),
            ("meshes", m.meshes, m.mesh_poses),
            ("planes", m.planes, m.plane_poses),
        ):
            if len(poses) not in (0, len(shapes)):
                text = f"object {m.id!r} has {len(shapes)} {kind} and {len(poses)} poses"
                raise PlanningFailed(Code.INVALID_OBJECT_NAME, text)
            places = [pose_of_message(pose) for pose in poses] or [IDENTITY] * len(shapes)
            items = list(zip(shapes, places, strict=True))
            if kind == "primitives" and len(items) >= _MANY_CUBES:
                octrees, items = _join_cubes(items)
                found += octrees
            found += [(self._shape(kind, shape), place) for shape, place in items]
        return found

    def _shape(self, kind: str, shape: Message) -> Any:
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


def _join_cubes(items: list[tuple[Message, Pose]]) -> tuple[list[tuple[Any, Pose]], list[tuple[Message, Pose]]]:
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
        found = voxels(np.array([place.position for _, place in group]), side)
        if found is None:
            others += group
        else:
            joined.append((found[0], Pose(found[1], IDENTITY.quaternion)))
    return joined, others


class PlanningScene:
    """Obstacles, attached objects and allowed contacts of one robot.

    Attributes:
        allowed: Pairs of names of links, models and objects that may touch; a single name may touch everything.
    """

    def __init__(self) -> None:
        self._objects: dict[str, SceneObject] = {}
        self.allowed: frozenset[frozenset[str]] = frozenset()

    def apply(self, scene: Message, frames: Frames) -> None:
        """Change the scene by a `moveit_msgs/msg/PlanningScene`; without `is_diff`, it replaces the scene.

        Raises:
            PlanningFailed: The message is invalid or has something unsupported; the scene does not change.
        """
        before = dict(self._objects), self.allowed
        if not scene.is_diff:
            self._objects, self.allowed = {}, frozenset()
        try:
            for name, given in (
                ("world.octomap", len(scene.world.octomap.octomap.data)),
                ("link_padding", len(scene.link_padding)),
                ("link_scale", len(scene.link_scale)),
                ("fixed_frame_transforms", len(scene.fixed_frame_transforms)),
            ):
                if given:
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
                self._objects = {name: found for name, found in self._objects.items() if found.link}
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
        found = SceneObject(deepcopy(item), pose)  # the client may use its message again
        if not found.shapes():
            raise PlanningFailed(Code.INVALID_OBJECT_NAME, f"object {item.id!r} has no shapes")
        self._objects[item.id] = found

    def _attach(self, attached: Message, frames: Frames) -> None:
        item = attached.object
        if int(item.operation) == item.REMOVE:
            names = [item.id] if item.id else [name for name, found in self._objects.items() if found.link]
            for name in names:  # the object stays in the world where it is
                held = self._existing(name)
                if held.link:
                    pose = frames.sim.link(held.link).pose @ held.pose
                    self._objects[name] = SceneObject(held.message, pose)
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
        found = SceneObject(message, frames.sim.link(link).pose.inverse() @ pose, link, touches)
        found.shapes()
        self._objects[item.id] = found

    def _existing(self, name: str) -> SceneObject:
        if name not in self._objects:
            near = did_you_mean(name, self._objects) or "there is " + (", ".join(self._objects) or "none")
            raise PlanningFailed(Code.INVALID_OBJECT_NAME, f"the planning scene has no object {name!r}; {near}")
        return self._objects[name]

    def obstacles(self) -> tuple[Obstacle, ...]:
        """Return the shapes of all objects."""
        return tuple(
            Obstacle(name, shape, found.pose @ place, found.link, found.touches)
            for name, found in self._objects.items()
            for shape, place in found.shapes()
        )

    def as_fields(self, robot: str) -> dict[str, object]:
        """Return the objects as the fields of a `moveit_msgs/msg/PlanningScene`; poses are in the frame `world`."""
        objects, attached = [], []
        for found in self._objects.values():
            link = found.link.rpartition("::")[2]
            message = found.message
            fields = {name: getattr(message, name) for name in ("id", "type", *_SHAPE_FIELDS)}
            fields |= {"header": {"frame_id": link or "world"}, "pose": msgs.pose_message(found.pose)}
            if link:
                attached.append({"link_name": link, "object": fields, "touch_links": sorted(found.touches)})
            else:
                objects.append(fields)
        state = {"attached_collision_objects": attached, "is_diff": bool(attached)}
        return {"robot_model_name": robot, "world": {"collision_objects": objects}, "robot_state": state}


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
