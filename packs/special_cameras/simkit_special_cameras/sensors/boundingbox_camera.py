"""Bounding box cameras: a box around each labelled object in view."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar

import mujoco
import numpy as np
import numpy.typing as npt

from simkit import Simulation, msgs
from simkit.extend import Product
from simkit.sensors.cameras import image_messages
from simkit.sensors.cameras.rendering.view import DrawnView, Ids, Shot
from simkit_special_cameras.sensors import bounding_box_messages, label_camera
from simkit_special_cameras.sensors.bounding_boxes import (
    Box2D,
    Box3D,
    LabelledShapes,
    PosedShapes,
    Projection,
    full_box,
    gazebo_boxes,
    visible_boxes,
)
from simkit_special_cameras.sensors.label_camera import LabelCamera
from simkit_special_cameras.sensors.labelled_objects import LabelledObjects

_VISIBLE, _FULL, _SPACE = "visible_2d", "full_2d", "3d"
_TWO_D = {"2d": _VISIBLE, "visible_2d": _VISIBLE, "visible_box_2d": _VISIBLE, "full_2d": _FULL, "full_box_2d": _FULL}


@dataclass(frozen=True, slots=True, eq=False)
class Boxes:
    """Reading of a bounding box camera.

    Attributes:
        boxes: boxes in the order of the objects' instances.
        colours: image that the boxes are drawn into, shape (h, w, 3).
    """

    boxes: Sequence[Box2D | Box3D]
    colours: npt.NDArray[np.uint8]


class BoundingBoxCamera(LabelCamera):
    """Bounding box camera, `boundingbox_camera`: a box around each labelled object with at least one visible pixel.

    All visuals with the same label in one top-level model are one object. The visible box surrounds the object's
    visible pixels. The full box surrounds its projection within the image, even if other objects hide it. The 3-D box
    is in the sensor's frame.
    """

    kinds = ("boundingbox_camera", "boundingbox")
    makes_boxes = True
    type_element = "box_type"
    types: ClassVar[dict[str, str]] = {**_TWO_D, "3d": _SPACE}
    _shapes: LabelledShapes | None = None

    def attach(self, sim: Simulation) -> None:
        self._is_gazebos = bool(sim.world.gazebo_quirks)
        super().attach(sim)

    def products(self) -> dict[str, Product]:
        kind = bounding_box_messages.TYPE_3D if self.options.type == _SPACE else bounding_box_messages.TYPE_2D
        return {
            "boundingbox": Product(kind, self._boxes_message),
            "image": Product(image_messages.IMAGE_TYPE, self._image_message),
            "camera_info": self._info_product(),
            "picture": self._colour_product(),
        }

    def default_topics(self) -> dict[str, str]:
        topic = self._default_topic("boundingbox")
        return {"boundingbox": topic, "image": f"{topic}_image", "camera_info": self._info_topic(topic)}

    def leave(self) -> None:
        super().leave()
        self._shapes = None

    def saved_products(self) -> dict[str, str]:
        return {"picture": label_camera.IMAGE, "boundingbox": label_camera.BOXES}

    def shots(self) -> Sequence[Shot]:
        view = self._drawn_view()
        return Shot(view), Shot(view, ids=True)

    def capture_context(self, model: mujoco.MjModel, data: mujoco.MjData) -> tuple[LabelledObjects, PosedShapes | None]:
        items = self.items
        if self.options.type == _VISIBLE:
            return items, None
        if self._shapes is None or self._shapes.items is not items:
            self._shapes = LabelledShapes(items, self.structure)
        return items, self._shapes.pose_shapes(data, *self._frame_in_world(data))

    def make_reading(
        self, drawn_views: Iterator[DrawnView], context: tuple[LabelledObjects, PosedShapes | None]
    ) -> Boxes:
        colours = self._picture(next(drawn_views))
        geoms = self.seen(next(drawn_views))
        items, shapes = context
        if self._is_gazebos:
            return Boxes(gazebo_boxes(self.options.type, geoms, items, shapes, self._projection()), colours)
        if shapes is None:
            return Boxes(visible_boxes(items.item_of.take(geoms, mode="wrap"), items.items), colours)
        return Boxes(self._projected(geoms, items, shapes), colours)

    def _projection(self) -> Projection:
        return Projection(self.options.model, self._drawn_view())

    def _projected(self, geoms: Ids, items: LabelledObjects, shapes: PosedShapes) -> list[Box2D] | list[Box3D]:
        """Return the boxes around whole items, for the items with at least one visible pixel."""
        positions = np.flatnonzero(np.bincount(items.item_of.take(geoms, mode="wrap").ravel() + 1)[1:])
        if self.options.type == _SPACE:
            return [shapes.box_3d(int(position)) for position in positions]
        projection = self._projection()
        seen = (items.items[position] for position in positions)
        boxes = [full_box(i, projection.shape(*shapes.points(i.visuals)), projection.model) for i in seen]
        return [box for box in boxes if box is not None]

    # ------------------------------------------------------------------ messages

    def _boxes_message(self, reading: Boxes, time_ns: int) -> msgs.Detection2DArray | msgs.Detection3DArray:
        if self.options.type == _SPACE:
            header = msgs.header(time_ns, self.frame_id)
            space = [box for box in reading.boxes if isinstance(box, Box3D)]
            return bounding_box_messages.detections_3d(header, space, in_ogre_axes=self._is_gazebos)
        flat = [box for box in reading.boxes if isinstance(box, Box2D)]
        return bounding_box_messages.detections_2d(self._image_header(time_ns), flat)

    def _image_message(self, reading: Boxes, time_ns: int) -> msgs.Image:
        drawn = bounding_box_messages.draw_boxes(reading.colours, reading.boxes, self._projection())
        return image_messages.image_message(self._image_header(time_ns), drawn, "rgb8")
