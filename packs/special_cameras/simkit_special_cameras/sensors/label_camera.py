"""Base class of the cameras that publish labels, and the data sets that they save."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar, Final

import numpy as np
import numpy.typing as npt

from simkit import Params, Simulation
from simkit.extend import Diagnostics, SceneSensor, did_you_mean
from simkit.msgs import Message
from simkit.runtime import WorldStructure
from simkit.sensors.cameras.camera_options import CameraOptions, extend_options
from simkit.sensors.cameras.rendered_camera import RenderedCamera
from simkit.sensors.cameras.rendering.view import DrawnView, Ids
from simkit.sensors.cameras.saved_images import ImageSaver, encode_png
from simkit_special_cameras.sensors.bounding_box_messages import TYPE_2D, TYPE_3D, boxes_as_csv
from simkit_special_cameras.sensors.labelled_objects import LabelledObjects, find_labelled_objects

IMAGE, COLOURS, LABELS, BOXES = "image", "colored", "labels", "boxes"
_FOLDERS: Final = {IMAGE: "images", COLOURS: "colored_maps", LABELS: "labels_maps", BOXES: "boxes"}


class DatasetSaver(ImageSaver):
    """Writer of `images/image_0000000.png`, `labels_maps/labels_0000000.png`, ..., `boxes/boxes_0000000.csv`.

    The numbers continue after the files in `images`, so that runs of several worlds make one data set.

    Args:
        sim: simulation that receives the reports.
        sensor: sensor that the images belong to.
        folder: folder of the whole data set.
        what: IMAGE, COLOURS, LABELS or BOXES.
    """

    __slots__ = ()

    def __init__(self, sim: Simulation, sensor: SceneSensor, folder: Path, what: str) -> None:
        super().__init__(sim, sensor, folder / _FOLDERS[what], what, None)
        self._count = _count_files(folder / _FOLDERS[IMAGE])

    def _file(self, message: Message) -> tuple[str, bytes]:
        is_table = message.__msgtype__ in (TYPE_2D, TYPE_3D)
        data, ending = (boxes_as_csv(message), "csv") if is_table else (encode_png(message), "png")
        return f"{self._name}_{self._count:07d}.{ending}", data


def _count_files(folder: Path) -> int:
    try:
        return sum(1 for _ in folder.iterdir())
    except OSError:
        return 0


@dataclass(frozen=True, slots=True)
class LabelCameraOptions(CameraOptions):
    """Options of the `<camera>` block. Depths, clip planes and noise are in m, as for every camera.

    Attributes:
        type: type of the maps or boxes.
    """

    type: str = ""


class LabelCamera(RenderedCamera):
    """Camera with the exact geom at each pixel: without noise and without blending of edges.

    Attributes:
        type_element: element with the type of the maps or boxes.
        types: types by keyword; the first one is the default.
    """

    options: LabelCameraOptions
    type_element: ClassVar[str]
    types: ClassVar[Mapping[str, str]]
    reads_labels: ClassVar[bool] = True
    makes_boxes: ClassVar[bool] = False

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        self._items: LabelledObjects | None = None
        self._items_of: tuple[object, object] = (None, None)
        image = scene.params.block("camera").block("image")
        if self.options.encoding != "rgb8":
            message = f"<format> {image.text('format')!r} has no effect on a {scene.kind}, whose images are R8G8B8"
            diagnostics.warning("SK-SENSOR-130", message, image.block("format").where)
            self.options = replace(self.options, encoding="rgb8")
        noise = self.options.noise
        if noise.mean or noise.stddev:
            message = f"<noise> has no effect on a {scene.kind}, as in Gazebo"
            diagnostics.warning("SK-SENSOR-131", message, scene.params.block("camera").block("noise").where)
        chosen = read_keyword(scene.params, self.type_element, self.types)
        self.options = extend_options(self.options, LabelCameraOptions, type=chosen)

    def describe(self) -> dict[str, object]:
        return {**super().describe(), self.type_element: self.options.type}

    @property
    def items(self) -> LabelledObjects:
        """Labelled objects of the sample that is measured, or was measured last."""
        return self._labelled_surroundings()[0]

    @property
    def structure(self) -> WorldStructure:
        """Structure of the world at the time of the sample that is measured, or was measured last."""
        return self._labelled_surroundings()[1]

    def _labelled_surroundings(self) -> tuple[LabelledObjects, WorldStructure]:
        if self.surroundings is None:
            self.surroundings = self.capture_surroundings()
        surroundings: tuple[LabelledObjects, WorldStructure] = self.surroundings
        return surroundings

    def capture_surroundings(self) -> tuple[LabelledObjects, WorldStructure]:
        """Return the current labelled objects and structure of the world."""
        sim = self.sim
        current = sim.contents.labels.state, sim.engine.structure
        if self._items is None or self._items_of[0] is not current[0] or self._items_of[1] is not current[1]:
            self._items, self._items_of = find_labelled_objects(sim, self.makes_boxes), current
        return self._items, sim.engine.structure

    def leave(self) -> None:
        super().leave()
        self._items, self._items_of = None, (None, None)

    def seen(self, drawn_view: DrawnView) -> Ids:
        """Return the geom at each pixel of the camera's image, -1 where there is none."""
        assert drawn_view.ids is not None
        if self._pictures.distorter:
            return self._pictures.distorter.distort_ids(drawn_view.ids)
        return drawn_view.ids

    def attach(self, sim: Simulation) -> None:
        super().attach(sim)
        self._report_unlabelled(sim)

    def _make_image_saver(self, folder: Path, name: str) -> ImageSaver:
        return DatasetSaver(self.sim, self.scene, folder, name)

    def _picture(self, drawn_view: DrawnView) -> npt.NDArray[np.uint8]:
        """Return the colours of a drawn view through the lens."""
        assert drawn_view.colours is not None
        picture = self._pictures.spares.take()
        if self._pictures.distorter:
            return self._pictures.distorter.distort(drawn_view.colours, picture)
        np.copyto(picture, drawn_view.colours)
        return picture

    def perturb(self, reading: object, index: int) -> object:
        return reading

    def _report_unlabelled(self, sim: Simulation) -> None:
        if not len(sim.contents.labels) and not any(
            getattr(p, "gives_labels", False) for p in sim.engine.structure.all_plugins()
        ):
            message = f"sensor {self.scoped!r} publishes labels, but no object in the world has a label"
            plugin = '<plugin filename="gz-sim-label-system" name="gz::sim::systems::Label"><label>10</label></plugin>'
            hint = f"add to a <model> or <visual>: {plugin}"
            sim.engine.reports.warning("SK-SENSOR-132", message, self.scene.where, hint)


def read_keyword(params: Params, element: str, meanings: Mapping[str, str]) -> str:
    """Return the meaning of a keyword in `<camera>`, or in `<sensor>` as in older files; case is ignored.

    Args:
        params: the `<sensor>` block.
        element: name of the element with the keyword.
        meanings: meanings by keyword; the first one applies without the element.
    """
    camera, default = params.block("camera"), next(iter(meanings))
    block = camera if camera.has(element) or not params.has(element) else params
    child = block.child(element)
    keyword = default if child is None else child.value.strip().lower()
    if child is not None and keyword not in meanings:
        message = f"found <{element}>{child.value}</{element}>; expected one of {', '.join(meanings)}"
        child.error("SK-PARAM-002", message, did_you_mean(keyword, tuple(meanings)))
        keyword = default
    return meanings[keyword]
