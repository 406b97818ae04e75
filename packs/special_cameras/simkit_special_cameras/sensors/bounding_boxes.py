"""Bounding boxes of labelled objects: around visible pixels, around projections, in space, or as Gazebo has them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np
import numpy.typing as npt

from simkit import Pose
from simkit.compiler import Compiled, LinkBinding
from simkit.extend import SceneVisual, Vector
from simkit.linear_algebra import matmul
from simkit.matrix_decompositions import eigh
from simkit.runtime import WorldStructure
from simkit.sensors.cameras.camera_model import CameraModel
from simkit.sensors.cameras.rendering.view import Ids, View
from simkit_special_cameras.sensors.labelled_objects import DrawnVisual, LabelledObject, LabelledObjects, Numbers
from simkit_special_cameras.sensors.shape_corners import CUBE, Corners, geom_corners

_EDGE_SEGMENTS = 16  # segments of an edge that a lens bends


@dataclass(frozen=True, slots=True)
class Box2D:
    """Edges of a box in the image [px]; a pixel (u, v) covers u to u + 1 and v to v + 1.

    Attributes:
        item: object inside the box.
    """

    item: LabelledObject
    left: float
    top: float
    right: float
    bottom: float


@dataclass(frozen=True, slots=True, eq=False)
class Box3D:
    """Box in the sensor's frame (x forward, y left, z up).

    Attributes:
        item: object inside the box.
        centre: centre [m], shape (3,).
        rotation: rotation matrix of the box's axes, shape (3, 3).
        size: size along the axes [m], shape (3,).
    """

    item: LabelledObject
    centre: Vector
    rotation: Vector
    size: Vector

    def corners(self) -> Vector:
        """Return the corners [m], shape (8, 3), in the order of `CUBE`."""
        corners: Vector = self.centre + matmul(CUBE * (self.size / 2), self.rotation.T)
        return corners


class LabelledShapes:
    """Shapes of labelled objects, computed once for each set of labels and compiled model.

    Args:
        items: labelled objects.
        structure: models of the world.

    Attributes:
        number_by_geom: number of each geom that has a label, by geom id.
        corners: corners of each of these geoms, by number.
        single_boxes: boxes of items with one visual, by index in `items`. A box has the number of a geom, the pose of
            the visual in that geom's frame, and the lowest and highest corner in the visual's frame.
    """

    def __init__(self, items: LabelledObjects, structure: WorldStructure) -> None:
        compiled: Compiled = structure.compiled
        names, model = compiled.names, compiled.model
        self.items = items
        self._geoms = [g for item in items.items for visual in item.visuals for g in visual.geoms]
        self.number_by_geom = {geom: i for i, geom in enumerate(self._geoms)}
        cache: dict[int, Corners] = names.shared("corners of drawn shapes", dict)
        self.corners: list[Corners] = [_cached(cache, model, g) for g in self._geoms]
        frames = (names.model_frame(structure.models[item.model]) for item in items.items)
        self._frames = [(body, frame.matrix) for body, frame in frames]
        scenes = {v.scoped: v for m in structure.models.values() for link in m.all_links() for v in link.visuals}
        self.single_boxes = {
            position: self._own_box(item.visuals[0], model, names.link(item.visuals[0].link), scenes)
            for position, item in enumerate(items.items)
            if len(item.visuals) == 1
        }

    def pose_shapes(self, data: mujoco.MjData, position: Vector, rotation: Vector) -> PosedShapes:
        """Return the shapes at their current poses relative to a sensor, given its world position and rotation."""
        geoms = self._geoms
        positions = matmul(data.geom_xpos[geoms] - position, rotation)
        rotations = matmul(rotation.T, data.geom_xmat[geoms].reshape(-1, 3, 3))
        axes = [
            matmul(rotation.T, data.xmat[body].reshape(3, 3), geom_rotation) for body, geom_rotation in self._frames
        ]
        return PosedShapes(self, positions, rotations, np.array(axes).reshape(-1, 3, 3))

    def _own_box(
        self, visual: DrawnVisual, model: mujoco.MjModel, link: LinkBinding, scenes: Mapping[str, SceneVisual]
    ) -> tuple[int, Pose, Vector, Vector]:
        """Return a visual's box: number of a geom, visual's pose in that geom's frame, lowest and highest corner."""
        in_body = link.offset @ scenes[visual.scoped].pose_link
        low, high = np.full(3, np.inf), np.full(3, -np.inf)
        for geom in visual.geoms:
            geom_pose = in_body.inverse() @ Pose(model.geom_pos[geom], model.geom_quat[geom])
            points = matmul(self.corners[self.number_by_geom[geom]].points, geom_pose.matrix.T) + geom_pose.position
            low, high = np.minimum(low, points.min(axis=0)), np.maximum(high, points.max(axis=0))
        first = visual.geoms[0]
        pose = Pose(model.geom_pos[first], model.geom_quat[first]).inverse() @ in_body
        return self.number_by_geom[first], pose, low, high


@dataclass(frozen=True, slots=True, eq=False)
class PosedShapes:
    """Labelled shapes at their poses in the sensor's frame at one time.

    Attributes:
        shapes: shapes without poses.
        positions, rotations: poses of the geoms that have a label, shape (k, 3) and (k, 3, 3).
        axes: axes of each item's model, shape (n, 3, 3).
    """

    shapes: LabelledShapes
    positions: Vector
    rotations: Vector
    axes: Vector

    def points(self, visuals: Sequence[DrawnVisual]) -> tuple[Vector, npt.NDArray[np.int32]]:
        """Return the corners (n, 3) in the sensor's frame and the edges (m, 2) of some visuals of an item."""
        shapes = self.shapes
        numbers = [shapes.number_by_geom[g] for visual in visuals for g in visual.geoms]
        points = [matmul(shapes.corners[i].points, self.rotations[i].T) + self.positions[i] for i in numbers]
        starts = np.cumsum([0, *(len(p) for p in points)])
        edges = [shapes.corners[i].edges + start for i, start in zip(numbers, starts, strict=False)]
        return np.concatenate(points), np.concatenate(edges)

    def box_3d(self, position: int) -> Box3D:
        """Return the box of an item along the axes of its only visual, or of its model if it has several visuals."""
        item = self.shapes.items.items[position]
        if position in self.shapes.single_boxes:
            return self._single_box(item, position)
        points, _ = self.points(item.visuals)
        return _box_around(item, points, self.axes[position])

    def box_of_cloud(self, position: int, visuals: Sequence[DrawnVisual]) -> Box3D:
        """Return the box along the principal axes of some visuals' corners, as Gazebo does for several visuals."""
        item = self.shapes.items.items[position]
        if len(visuals) == 1 and position in self.shapes.single_boxes:
            return self._single_box(item, position)
        points, _ = self.points(visuals)
        away = points - points.mean(axis=0)
        _, axes = eigh(matmul(away.T, away) / len(points))
        axes = axes * np.where(axes[np.abs(axes).argmax(axis=0), range(3)] < 0, -1.0, 1.0)
        axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
        return _box_around(item, points, axes)

    def _single_box(self, item: LabelledObject, position: int) -> Box3D:
        number, pose, low, high = self.shapes.single_boxes[position]
        turn = self.rotations[number]
        rotation = matmul(turn, pose.matrix)
        centre = self.positions[number] + matmul(turn, pose.position) + matmul(rotation, (low + high) / 2)
        return Box3D(item, centre, rotation, high - low)


@dataclass(frozen=True, slots=True)
class Projection:
    """Projection of points in the sensor's frame to pixels, by a camera model and the view that is drawn for it."""

    model: CameraModel
    view: View

    def shape(self, points: Vector, edges: npt.NDArray[np.int32]) -> Vector | None:
        """Project the part of a shape in front of the near plane: corners, and points along edges that a lens bends.

        Args:
            points: corners in the sensor's frame [m], shape (n, 3).
            edges: pairs of corners, shape (m, 2).

        Returns:
            Pixels, shape (n, 2), or None if the whole shape is behind the near plane.
        """
        if self.model.distortion or points[:, 0].min() < self.model.near:
            lines = self.edges(points, edges)
            return lines.reshape(-1, 2) if len(lines) else None
        return self._points(points)

    def edges(self, points: Vector, edges: npt.NDArray[np.int32]) -> Vector:
        """Project the parts of edges in front of the near plane.

        Args:
            points: corners in the sensor's frame [m], shape (n, 3).
            edges: pairs of corners, shape (m, 2).

        Returns:
            Pixels along each edge, shape (m, k, 2): two points per edge, or more for a lens that bends edges.
        """
        ends = _clip_to_near_plane(points[edges], self.model.near)
        if self.model.distortion:
            along = np.linspace(0, 1, _EDGE_SEGMENTS + 1)[:, None]
            ends = ends[:, :1] + along * (ends[:, 1:] - ends[:, :1])
        return self._points(ends)

    def _points(self, points: Vector) -> Vector:
        """Project points (..., 3); with a distortion, points outside the drawn view are moved to its edge."""
        x, y = -points[..., 1] / points[..., 0], -points[..., 2] / points[..., 0]
        if self.model.distortion:
            x, y = np.clip(x, self.view.left, self.view.right), np.clip(y, -self.view.top, -self.view.bottom)
        return np.stack(self.model.project(x, y), axis=-1)


def visible_boxes(position_of: Numbers, items: Sequence[LabelledObject]) -> list[Box2D]:
    """Return the boxes around the visible pixels of each item.

    Args:
        position_of: index in `items` at each pixel, -1 for none, shape (h, w).
        items: labelled objects.
    """
    height, width = position_of.shape
    # in each row, only the first and the last of adjacent equal pixels can determine the box
    changes = np.ones((height, width + 1), bool)
    np.not_equal(position_of[:, 1:], position_of[:, :-1], out=changes[:, 1:-1])
    pixel = np.flatnonzero((changes[:, 1:] | changes[:, :-1]) & (position_of >= 0))
    item = position_of.ravel()[pixel]
    row, column = np.divmod(pixel, width)
    rows, columns = np.zeros((len(items), height), bool), np.zeros((len(items), width), bool)
    rows[item, row] = columns[item, column] = True
    boxes = []
    for i in np.flatnonzero(rows.any(axis=1)).tolist():
        high, wide = np.flatnonzero(rows[i]), np.flatnonzero(columns[i])
        boxes.append(Box2D(items[i], float(wide[0]), float(high[0]), float(wide[-1] + 1), float(high[-1] + 1)))
    return boxes


def _clip_to_near_plane(ends: Vector, near: float) -> Vector:
    """Return the parts of edges, shape (m, 2, 3), in front of the near plane."""
    behind = ends[..., 0] < near
    ends = ends[~behind.all(axis=1)]
    behind = ends[..., 0] < near
    for start, end in ((0, 1), (1, 0)):
        cut = behind[:, start]
        hidden, seen = ends[cut, start], ends[cut, end]
        part = (near - hidden[:, :1]) / (seen[:, :1] - hidden[:, :1])
        ends[cut, start] = hidden + part * (seen - hidden)
    return ends


def full_box(item: LabelledObject, pixels: Vector | None, model: CameraModel) -> Box2D | None:
    """Return the box around the projection of an item, within the image; None if the item is outside the image."""
    if pixels is None:
        return None
    left, top = np.maximum(pixels.min(axis=0), 0.0)
    right, bottom = np.minimum(pixels.max(axis=0), (model.width, model.height))
    if not (right > left and bottom > top):
        return None
    return Box2D(item, float(left), float(top), float(right), float(bottom))


def _box_around(item: LabelledObject, points: Vector, axes: Vector) -> Box3D:
    along = matmul(points, axes)
    low, high = along.min(axis=0), along.max(axis=0)
    return Box3D(item, matmul(axes, (low + high) / 2), axes, high - low)


def _cached(cache: dict[int, Corners], model: mujoco.MjModel, geom: int) -> Corners:
    if geom not in cache:
        cache[geom] = geom_corners(model, geom)
    return cache[geom]


def gazebo_boxes(
    kind: str, geoms: Ids, items: LabelledObjects, shapes: PosedShapes | None, projection: Projection
) -> list[Box2D] | list[Box3D]:
    """Return boxes as Gazebo computes them: around visible visuals, with the label of a model's first visible visual.

    A visible box ends at the index u of its last pixel instead of u + 1. A full box ends at most one pixel before the
    right edge of the image. A visual that extends beyond the image on all four sides has no full box. A box in space
    around several visuals has the principal axes of their corners.

    Args:
        kind: visible_2d, full_2d or 3d.
        geoms: geom id at each pixel, -1 for none, shape (h, w).
        items: labelled objects.
        shapes: shapes at their poses; None for visible_2d.
        projection: projection of the camera.
    """
    is_seen = np.bincount(geoms.ravel() + 1, minlength=len(items.item_of))[1:] > 0
    seen: dict[int, list[DrawnVisual]] = {}
    for position, item in enumerate(items.items):
        visuals = [v for v in item.visuals if is_seen[list(v.geoms)].any()]
        if visuals:
            seen[position] = visuals
    labelled = [replace(item, label=seen[i][0].label) if i in seen else item for i, item in enumerate(items.items)]
    if shapes is None:
        visible = visible_boxes(items.item_of.take(geoms, mode="wrap"), labelled)
        return [replace(box, right=box.right - 1, bottom=box.bottom - 1) for box in visible]
    if kind == "3d":
        boxes = [(labelled[i], shapes.box_of_cloud(i, visuals)) for i, visuals in seen.items()]
        return [Box3D(item, box.centre, box.rotation, box.size) for item, box in boxes]
    full = [_gazebo_full_box(labelled[i], visuals, shapes, projection) for i, visuals in seen.items()]
    return [box for box in full if box is not None]


def _gazebo_full_box(
    item: LabelledObject, visuals: Sequence[DrawnVisual], shapes: PosedShapes, projection: Projection
) -> Box2D | None:
    model = projection.model
    size = np.array((model.width, model.height), dtype=np.float64)
    bounds: list[tuple[Vector, Vector]] = []
    for visual in visuals:
        pixels = projection.shape(*shapes.points((visual,)))
        if pixels is None:
            continue
        low, high = pixels.min(axis=0), pixels.max(axis=0)
        if not ((low < 0) & (high > size)).any():
            bounds.append((np.maximum(low, 0.0), np.minimum(high, (size[0] - 1, size[1]))))
    if not bounds:
        return None
    left, top = np.min([low for low, _ in bounds], axis=0)
    right, bottom = np.max([high for _, high in bounds], axis=0)
    return Box2D(item, float(left), float(top), float(right), float(bottom))
