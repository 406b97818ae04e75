"""Objects of the planning scene."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from simkit.extend import Diagnostics, Where
from simkit.loaders.meshes.mesh_reader import load_mesh
from simkit.scene.geometry import Mesh
from simkit_nodes.interfaces import ROS1
from simkit_nodes.ros1_modules.moveit_commander.exception import MoveItCommanderException
from simkit_nodes.ros1_modules.moveit_commander.move_group_client import MoveGroupServices, new_message

__all__ = ["PlanningSceneInterface"]

_OBJECT, _ATTACHED = "moveit_msgs/CollisionObject", "moveit_msgs/AttachedCollisionObject"


class PlanningSceneInterface:
    """Objects of the planning scene of `move_group`.

    Args:
        ns: namespace of `move_group`; empty for that of the program.
        synchronous: accepted; every change waits until it is done.
    """

    def __init__(self, ns: str = "", synchronous: bool = True) -> None:
        self._services = MoveGroupServices(ns)

    # ------------------------------------------------------------------ objects of the world

    def add_object(self, collision_object: Any) -> None:
        """Add a `CollisionObject`."""
        scene = new_message("moveit_msgs/PlanningScene")
        scene.is_diff = scene.robot_state.is_diff = True
        scene.world.collision_objects = [collision_object]
        self._services.apply(scene)

    def add_box(self, name: str, pose: Any, size: Sequence[float] = (1, 1, 1)) -> None:
        """Add a box with three sizes [m] at a `PoseStamped`."""
        self.add_object(self.make_box(name, pose, size))

    def add_sphere(self, name: str, pose: Any, radius: float = 1) -> None:
        """Add a sphere."""
        self.add_object(self.make_sphere(name, pose, radius))

    def add_cylinder(self, name: str, pose: Any, height: float, radius: float) -> None:
        """Add a cylinder."""
        self.add_object(self.make_cylinder(name, pose, height, radius))

    def add_cone(self, name: str, pose: Any, height: float, radius: float) -> None:
        """Add a cone."""
        self.add_object(self.make_cone(name, pose, height, radius))

    def add_plane(self, name: str, pose: Any, normal: Sequence[float] = (0, 0, 1), offset: float = 0) -> None:
        """Add a plane, below which everything is an obstacle."""
        self.add_object(self.make_plane(name, pose, normal, offset))

    def add_mesh(self, name: str, pose: Any, filename: str, size: Sequence[float] = (1, 1, 1)) -> None:
        """Add a mesh of a file, times three factors."""
        self.add_object(self.make_mesh(name, pose, filename, size))

    def remove_world_object(self, name: str | None = None) -> None:
        """Remove an object, or all objects."""
        item = new_message(_OBJECT)
        item.operation, item.id = item.REMOVE, name or ""
        self.add_object(item)

    def clear(self) -> None:
        """Remove all objects."""
        self.remove_attached_object()
        self.remove_world_object()

    # ------------------------------------------------------------------ attached objects

    def attach_object(self, object: Any, link: str | None = None, touch_links: Sequence[str] | None = None) -> None:
        """Attach an object to a link.

        Args:
            object: `CollisionObject`, `AttachedCollisionObject`, or the name of an object of the scene.
            link: name of the link.
            touch_links: links that may touch the object.
        """
        attached = object if getattr(object, "_type", "") == _ATTACHED else new_message(_ATTACHED)
        if attached is not object:
            attached.object = _existing(object) if isinstance(object, str) else object
        attached.link_name = attached.link_name if link is None else link
        attached.touch_links = [attached.link_name] if touch_links is None else list(touch_links)
        self._services.apply_attached(attached)

    def attach_box(
        self,
        link: str,
        name: str,
        pose: Any = None,
        size: Sequence[float] = (1, 1, 1),
        touch_links: Sequence[str] | None = None,
    ) -> None:
        """Attach a new box, or without a pose an object of the scene, to a link."""
        item = _existing(name) if pose is None else self.make_box(name, pose, size)
        self.attach_object(item, link, touch_links)

    def attach_sphere(
        self, link: str, name: str, pose: Any = None, radius: float = 1, touch_links: Sequence[str] | None = None
    ) -> None:
        """Attach a new sphere, or without a pose an object of the scene, to a link."""
        item = _existing(name) if pose is None else self.make_sphere(name, pose, radius)
        self.attach_object(item, link, touch_links)

    def attach_cylinder(
        self,
        link: str,
        name: str,
        pose: Any = None,
        height: float = 1,
        radius: float = 1,
        touch_links: Sequence[str] | None = None,
    ) -> None:
        """Attach a new cylinder, or without a pose an object of the scene, to a link."""
        item = _existing(name) if pose is None else self.make_cylinder(name, pose, height, radius)
        self.attach_object(item, link, touch_links)

    def attach_mesh(
        self,
        link: str,
        name: str,
        pose: Any = None,
        filename: str = "",
        size: Sequence[float] = (1, 1, 1),
        touch_links: Sequence[str] | None = None,
    ) -> None:
        """Attach a mesh of a file, or without a pose or file an object of the scene, to a link."""
        is_new = pose is not None and bool(filename)
        self.attach_object(self.make_mesh(name, pose, filename, size) if is_new else _existing(name), link, touch_links)

    def remove_attached_object(self, link: str | None = None, name: str | None = None) -> None:
        """Detach an object, the objects of a link, or all attached objects; they stay in the scene."""
        attached = new_message(_ATTACHED)
        attached.object.operation, attached.object.id = attached.object.REMOVE, name or ""
        attached.link_name = link or ""
        self._services.apply_attached(attached)

    # ------------------------------------------------------------------ state

    def get_known_object_names(self, with_type: bool = False) -> list[str]:
        """Return the names of the objects of the world; with `with_type`, only of those with a type."""
        items = self.get_objects().values()
        return [item.id for item in items if item.type.key or not with_type]

    def get_known_object_names_in_roi(
        self, minx: float, miny: float, minz: float, maxx: float, maxy: float, maxz: float, with_type: bool = False
    ) -> list[str]:
        """Return the names of the objects whose position is in a box."""
        low, high = (minx, miny, minz), (maxx, maxy, maxz)
        found = []
        for item in self.get_objects().values():
            p = item.pose.position
            is_inside = all(a <= v <= b for a, v, b in zip(low, (p.x, p.y, p.z), high, strict=True))
            if is_inside and (item.type.key or not with_type):
                found.append(item.id)
        return found

    def get_object_poses(self, object_ids: Sequence[str]) -> dict[str, Any]:
        """Return the poses of objects by name."""
        return {name: item.pose for name, item in self.get_objects(object_ids).items()}

    def get_objects(self, object_ids: Sequence[str] = ()) -> dict[str, Any]:
        """Return objects of the world by name, by default all of them."""
        items = self._services.scene().world.collision_objects
        return {item.id: item for item in items if not object_ids or item.id in object_ids}

    def get_attached_objects(self, object_ids: Sequence[str] = ()) -> dict[str, Any]:
        """Return attached objects by name, by default all of them."""
        items = self._services.scene().robot_state.attached_collision_objects
        return {item.object.id: item for item in items if not object_ids or item.object.id in object_ids}

    def get_planning_scene(self, components: int) -> Any:
        """Return the planning scene, a `PlanningScene`."""
        return self._services.scene(components)

    def apply_planning_scene(self, planning_scene_message: Any) -> bool:
        """Change the planning scene; return True on success."""
        return self._services.apply(planning_scene_message)

    # ------------------------------------------------------------------ messages

    @staticmethod
    def make_box(name: str, pose: Any, size: Sequence[float]) -> Any:
        """Return a box as a `CollisionObject`."""
        return _primitive(name, pose, "BOX", size)

    @staticmethod
    def make_sphere(name: str, pose: Any, radius: float) -> Any:
        """Return a sphere as a `CollisionObject`."""
        return _primitive(name, pose, "SPHERE", [radius])

    @staticmethod
    def make_cylinder(name: str, pose: Any, height: float, radius: float) -> Any:
        """Return a cylinder as a `CollisionObject`."""
        return _primitive(name, pose, "CYLINDER", [height, radius])

    @staticmethod
    def make_cone(name: str, pose: Any, height: float, radius: float) -> Any:
        """Return a cone as a `CollisionObject`."""
        return _primitive(name, pose, "CONE", [height, radius])

    @staticmethod
    def make_plane(name: str, pose: Any, normal: Sequence[float] = (0, 0, 1), offset: float = 0) -> Any:
        """Return a plane as a `CollisionObject`."""
        item, plane = _placed(name, pose), new_message("shape_msgs/Plane")
        plane.coef = [*(float(value) for value in normal), float(offset)]
        item.planes = [plane]
        return item

    @staticmethod
    def make_mesh(name: str, pose: Any, filename: str, scale: Sequence[float] = (1, 1, 1)) -> Any:
        """Return a mesh of a file as a `CollisionObject`.

        Raises:
            MoveItCommanderException: the file cannot be read.
        """
        problems = Diagnostics()
        x, y, z = (float(value) for value in scale)
        parts = load_mesh(Mesh(Path(filename).resolve(), filename, (x, y, z)), problems, Where(filename))
        if not parts:
            reason = next((each.message for each in problems), "it has no triangles")
            raise MoveItCommanderException(f"the mesh {filename} cannot be read: {reason}")
        item, mesh = _placed(name, pose), new_message("shape_msgs/Mesh")
        point, triangle = (
            ROS1.message_class("geometry_msgs/msg/Point"),
            ROS1.message_class("shape_msgs/msg/MeshTriangle"),
        )
        for part in parts:
            first = len(mesh.vertices)
            mesh.vertices += [point(*(float(value) for value in vertex)) for vertex in part.vertices]
            mesh.triangles += [triangle([first + int(index) for index in face]) for face in part.faces]
        item.meshes = [mesh]
        return item


def _existing(name: str) -> Any:
    item = new_message(_OBJECT)
    item.id = name
    return item


def _placed(name: str, pose: Any) -> Any:
    item = _existing(name)
    item.operation, item.header, item.pose = item.ADD, pose.header, pose.pose
    return item


def _primitive(name: str, pose: Any, kind: str, sizes: Sequence[float]) -> Any:
    item, shape = _placed(name, pose), new_message("shape_msgs/SolidPrimitive")
    shape.type, shape.dimensions = getattr(shape, kind), [float(size) for size in sizes]
    item.primitives = [shape]
    return item


# ---------------------------------------------------------------------- matrix of allowed collisions


def acm_set_default(acm: Any, obj: str, allow: bool) -> None:
    """Allow or forbid that an object touches anything."""
    if obj in acm.default_entry_names:
        acm.default_entry_values[acm.default_entry_names.index(obj)] = allow
    else:
        acm.default_entry_names.append(obj)
        acm.default_entry_values.append(allow)


def acm_set_allowed(acm: Any, obj: str, other: str | None = None, allow: bool = True) -> None:
    """Allow or forbid that two objects touch, or without a second one that an object touches anything.

    Raises:
        ValueError: the matrix does not have the second object.
    """
    if other is None:
        acm_set_default(acm, obj, allow)
        return
    column = acm.entry_names.index(other)
    if obj not in acm.entry_names:
        defaults = dict(zip(acm.default_entry_names, acm.default_entry_values, strict=True))
        row = [bool(defaults.get(obj, defaults.get(name, False))) for name in acm.entry_names]
        for entry, value in zip(acm.entry_values, row, strict=True):
            entry.enabled = [*entry.enabled, value]
        new = new_message("moveit_msgs/AllowedCollisionEntry")
        new.enabled = [*row, False]
        acm.entry_names.append(obj)
        acm.entry_values.append(new)
    line = acm.entry_names.index(obj)
    for first, second in ((line, column), (column, line)):
        values = list(acm.entry_values[first].enabled)
        values[second] = allow
        acm.entry_values[first].enabled = values


_METHODS: dict[str, Callable[..., None]] = {"set_default": acm_set_default, "set_allowed": acm_set_allowed}
for _name, _method in _METHODS.items():
    setattr(ROS1.message_class("moveit_msgs/msg/AllowedCollisionMatrix"), _name, _method)
