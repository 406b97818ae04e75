"""Bounding boxes with Gazebo's own errors, for worlds that ask for them (gz-rendering, Ogre2BoundingBoxCamera.cc)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from simkit.pose import Vector
from simkit.sensors.boxes import Box2D, Box3D, LabelledShapes, Stand, projected, visible_boxes
from simkit.sensors.camera_model import CameraModel
from simkit.sensors.label_items import DrawnVisual, Item, Items
from simkit.sensors.rendering.view import Ids, View


def gazebos_boxes(
    kind: str,
    geoms: Ids,
    items: Items,
    shapes: LabelledShapes | None,
    stand: Stand | None,
    model: CameraModel,
    view: View,
) -> list[Box2D] | list[Box3D]:
    """Boxes as Gazebo has them: what is hidden of a model does not count, and its first seen visual says the label.

    A visible box ends at the last pixel's number. A full box ends one pixel before the right edge, and a visual that
    reaches beyond both sides of the picture has none. Boxes in space around several visuals are along the principal
    axes of their corners.

    Args:
        kind: visible_2d, full_2d or 3d.
        geoms: at each pixel, shape (h, w); -1 for none.
    """
    is_seen = np.bincount(geoms.ravel() + 1, minlength=len(items.item_of))[1:] > 0
    seen: dict[int, list[DrawnVisual]] = {}
    for position, item in enumerate(items.items):
        visuals = [v for v in item.visuals if is_seen[list(v.geoms)].any()]
        if visuals:
            seen[position] = visuals
    told = [replace(item, label=seen[i][0].label) if i in seen else item for i, item in enumerate(items.items)]
    if shapes is None or stand is None:
        found = visible_boxes(items.item_of.take(geoms, mode="wrap"), told)
        return [replace(box, right=box.right - 1, bottom=box.bottom - 1) for box in found]
    if kind == "3d":
        boxes = [(told[i], shapes.box_of_cloud(i, visuals, stand)) for i, visuals in seen.items()]
        return [Box3D(item, box.centre, box.rotation, box.size) for item, box in boxes]
    full = [_full(told[i], visuals, shapes, stand, model, view) for i, visuals in seen.items()]
    return [box for box in full if box is not None]


def _full(
    item: Item, visuals: Sequence[DrawnVisual], shapes: LabelledShapes, stand: Stand, model: CameraModel, view: View
) -> Box2D | None:
    size = np.array((model.width, model.height), dtype=np.float64)
    parts: list[tuple[Vector, Vector]] = []
    for visual in visuals:
        pixels = projected(*shapes.points((visual,), stand), model, view)
        if pixels is None:
            continue
        low, high = pixels.min(axis=0), pixels.max(axis=0)
        if not ((low < 0) & (high > size)).any():
            parts.append((np.maximum(low, 0.0), np.minimum(high, (size[0] - 1, size[1]))))
    if not parts:
        return None
    left, top = np.min([low for low, _ in parts], axis=0)
    right, bottom = np.max([high for _, high in parts], axis=0)
    return Box2D(item, float(left), float(top), float(right), float(bottom))
