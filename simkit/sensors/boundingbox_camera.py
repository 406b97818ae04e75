"""Bounding box cameras: a box around each labelled thing that is seen."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from simkit.diagnostics import Diagnostics
from simkit.sensors import box_messages, pictures, saved_samples
from simkit.sensors.base import Product
from simkit.sensors.boxes import Box2D, Box3D, LabelledShapes, Stand, full_box, projected, visible_boxes
from simkit.sensors.boxes_of_gazebo import gazebos_boxes
from simkit.sensors.camera_options import CameraOptions, extended
from simkit.sensors.label_camera import LabelCamera, Word, read_word
from simkit.sensors.label_items import Items
from simkit.sensors.rendering.view import Film, Ids, Shot

if TYPE_CHECKING:
    from simkit.runtime import Simulation
    from simkit.scene import SceneSensor

_VISIBLE, _FULL, _SPACE = "visible_2d", "full_2d", "3d"
_TYPE: Final = Word(
    "box_type",
    {
        "2d": _VISIBLE,
        "visible_2d": _VISIBLE,
        "visible_box_2d": _VISIBLE,
        "full_2d": _FULL,
        "full_box_2d": _FULL,
        "3d": _SPACE,
    },
    "2d",
)


@dataclass(frozen=True, slots=True)
class BoundingBoxOptions(CameraOptions):
    """The `<camera>` block; depths, distances of clip planes and noise as of every camera, in m.

    Attributes:
        type: visible_2d, full_2d or 3d.
    """

    type: str = _VISIBLE


@dataclass(frozen=True, slots=True, eq=False)
class Boxes:
    """What is seen.

    Attributes:
        boxes: in the order of the instances of their things.
        colours: the picture that they are drawn into, shape (h, w, 3).
    """

    boxes: Sequence[Box2D | Box3D]
    colours: npt.NDArray[np.uint8]


class BoundingBoxCamera(LabelCamera):
    """`boundingbox_camera`: a box around each thing that wears a label and of which at least one pixel is seen.

    A thing is all that wears one label in a top-level model. Its visible box is around its pixels; its full box around
    its projection, within the picture, whatever is in front of it; its 3-D box is in the sensor's frame.
    """

    kinds = ("boundingbox_camera", "boundingbox")
    makes_boxes = True

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        self.options: BoundingBoxOptions = extended(
            self.options, BoundingBoxOptions, type=read_word(scene.params, _TYPE)
        )
        self._shapes: LabelledShapes | None = None

    def attach(self, sim: Simulation) -> None:
        self._is_gazebos = bool(sim.world.gazebo_quirks)
        super().attach(sim)

    def describe(self) -> dict[str, Any]:
        return {**super().describe(), "box_type": self.options.type}

    def products(self) -> dict[str, Product]:
        kind = box_messages.TYPE_3D if self.options.type == _SPACE else box_messages.TYPE_2D
        return {
            "boundingbox": Product(kind, self._boxes_message),
            "image": Product(pictures.TYPE, self._image_message),
            "camera_info": self._info_product(),
            "picture": self._picture_product(),
        }

    def default_topics(self) -> dict[str, str]:
        topic = self._default_topic("boundingbox")
        return {"boundingbox": topic, "image": f"{topic}_image", "camera_info": self._info_topic(topic)}

    def leave(self) -> None:
        super().leave()
        self._shapes = None

    def saved(self) -> dict[str, str]:
        return {"picture": saved_samples.IMAGE, "boundingbox": saved_samples.BOXES}

    def shots(self) -> Sequence[Shot]:
        view = self._aimed()
        return Shot(view), Shot(view, ids=True)

    def note(self, model: Any, data: Any) -> tuple[Items, LabelledShapes | None, Stand | None]:
        items = self.items
        if self.options.type == _VISIBLE:
            return items, None, None
        if self._shapes is None or self._shapes.items is not items:
            self._shapes = LabelledShapes(items, self.structure)
        return items, self._shapes, self._shapes.stand(data, *self._frame_in_world(data))

    def develop(self, films: Iterator[Film], notes: tuple[Items, LabelledShapes | None, Stand | None]) -> Boxes:
        colours = self._picture(next(films))
        geoms = self.seen(next(films))
        items, shapes, stand = notes
        if self._is_gazebos:
            model = self.options.model
            return Boxes(gazebos_boxes(self.options.type, geoms, items, shapes, stand, model, self._aimed()), colours)
        if shapes is None or stand is None:
            return Boxes(visible_boxes(items.item_of.take(geoms, mode="wrap"), items.items), colours)
        return Boxes(self._projected(geoms, shapes, stand), colours)

    def _projected(self, geoms: Ids, shapes: LabelledShapes, stand: Stand) -> list[Box2D] | list[Box3D]:
        """Boxes around all of each item of which a pixel is seen."""
        items, model = shapes.items, self.options.model
        positions = np.flatnonzero(np.bincount(items.item_of.take(geoms, mode="wrap").ravel() + 1)[1:])
        if self.options.type == _SPACE:
            return [shapes.box_3d(int(position), stand) for position in positions]
        found = []
        for position in positions:
            item = items.items[position]
            box = full_box(item, projected(*shapes.points(item.visuals, stand), model, self._aimed()), model)
            if box is not None:
                found.append(box)
        return found

    # ------------------------------------------------------------------ messages

    def _boxes_message(self, reading: Boxes, time_ns: int) -> Any:
        if self.options.type == _SPACE:
            header = self._header(time_ns)
            space = [box for box in reading.boxes if isinstance(box, Box3D)]
            return box_messages.detections_3d(header, space, in_ogre_axes=self._is_gazebos)
        flat = [box for box in reading.boxes if isinstance(box, Box2D)]
        return box_messages.detections_2d(self._image_header(time_ns), flat)

    def _image_message(self, reading: Boxes, time_ns: int) -> Any:
        drawn = box_messages.drawn_on(reading.colours, reading.boxes, self.options.model, self._aimed())
        return pictures.image_message(self._image_header(time_ns), drawn, "rgb8")
