"""Segmentation cameras: the label, and the number of the object with that label, at each pixel.

Coloured maps have Gazebo's colours, which come from a random generator seeded with the number.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import ClassVar, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.extend import Product
from simkit.sensors.cameras import image_messages
from simkit.sensors.cameras.rendering.view import DrawnView, Ids, Shot
from simkit_special_cameras.sensors import label_camera
from simkit_special_cameras.sensors.label_camera import LabelCamera
from simkit_special_cameras.sensors.labelled_objects import LabelledObjects

Colour = tuple[int, int, int]

BACKGROUND: Final[Colour] = (0, 0, 0)
_FACTOR, _MODULUS = 16807, 2147483647
_BUCKET: Final = (_MODULUS - 2) // 256


def label_colours(numbers: Iterable[int]) -> dict[int, Colour]:
    """Return a colour for each number; all are different, and none is black.

    Gazebo draws a number's red, green and blue one after the other from C++'s `default_random_engine`, seeded with that
    number, through `uniform_int_distribution` from 0 to 255 (gz-rendering, Ogre2SegmentationMaterialSwitcher.cc). In
    GNU's library, this generator is Lehmer's with the factor 16807, and its range is divided into 256 equal parts. If
    a colour is already used, the generator draws again.
    """
    used = {BACKGROUND}
    colours: dict[int, Colour] = {}
    for number in numbers:
        if number in colours:
            continue
        draws = _random_channels(number)
        colour = BACKGROUND
        while colour in used:
            red, green, blue = islice(draws, 3)
            colour = red, green, blue
        used.add(colour)
        colours[number] = colour
    return colours


def _random_channels(seed: int) -> Iterator[int]:
    """Yield numbers from 0 to 255."""
    state = seed % _MODULUS or 1
    while True:
        state = state * _FACTOR % _MODULUS
        part = (state - 1) // _BUCKET
        if part < 256:
            yield part


Pixels = npt.NDArray[np.uint8]


@dataclass(frozen=True, slots=True, eq=False)
class Palette:
    """Pixel values of each geom: four bytes, as one number; the last entry is for no geom."""

    labels: npt.NDArray[np.uint32]
    colours: npt.NDArray[np.uint32]


@dataclass(frozen=True, slots=True, eq=False)
class Segmentation:
    """Reading of a segmentation camera.

    Attributes:
        geoms: geom id at each pixel, -1 for none, shape (h, w).
        palette: pixel values of each geom.
        colours: camera image, shape (h, w, 3); present if the sensor saves images too.
    """

    geoms: Ids
    palette: Palette
    colours: Pixels | None = None

    @property
    def labels(self) -> Pixels:
        """Map of labels, shape (h, w, 3)."""
        return _paint(self.palette.labels, self.geoms)

    @property
    def coloured(self) -> Pixels:
        """Map of colours, shape (h, w, 3)."""
        return _paint(self.palette.colours, self.geoms)


class SegmentationCamera(LabelCamera):
    """Segmentation camera, `segmentation_camera`: a map of labels and a map of colours.

    In a semantic map, all three channels contain the label. In a panoptic map, red and green are the low and the high
    byte of the object's number among those of its label, from 1; blue is the label. Pixels without a label are 0, and
    black.
    """

    kinds = ("segmentation_camera", "segmentation")
    type_element = "segmentation_type"
    types: ClassVar[dict[str, str]] = {"semantic": "semantic", "instance": "panoptic", "panoptic": "panoptic"}
    _palette: Palette | None = None
    _palette_of: LabelledObjects | None = None

    def products(self) -> dict[str, Product]:
        return {
            "labels_map": Product(image_messages.IMAGE_TYPE, self._labels_message),
            "colored_map": Product(image_messages.IMAGE_TYPE, self._colours_message),
            "camera_info": self._info_product(),
            "picture": self._colour_product(),
        }

    def default_topics(self) -> dict[str, str]:
        base = self._default_topic("segmentation")
        topics = {product: f"{base}/{product}" for product in ("labels_map", "colored_map")}
        return {**topics, "camera_info": self._info_topic(base + "/labels_map")}

    def shots(self) -> Sequence[Shot]:
        view = self._drawn_view()
        ids = Shot(view, ids=True)
        return (Shot(view), ids) if self.options.save is not None else (ids,)

    def saved_products(self) -> dict[str, str]:
        return {
            "picture": label_camera.IMAGE,
            "colored_map": label_camera.COLOURS,
            "labels_map": label_camera.LABELS,
        }

    def capture_context(self, model: mujoco.MjModel, data: mujoco.MjData) -> Palette:
        items = self.items
        if self._palette is None or items is not self._palette_of:
            self._palette, self._palette_of = make_palette(items, self.options.type), items
        return self._palette

    def make_reading(self, drawn_views: Iterator[DrawnView], context: Palette) -> Segmentation:
        colours = self._picture(next(drawn_views)) if self.options.save is not None else None
        return Segmentation(np.array(self.seen(next(drawn_views))), context, colours)

    def _labels_message(self, reading: Segmentation, time_ns: int) -> msgs.Image:
        return image_messages.image_message(self._image_header(time_ns), reading.labels, "rgb8")

    def _colours_message(self, reading: Segmentation, time_ns: int) -> msgs.Image:
        return image_messages.image_message(self._image_header(time_ns), reading.coloured, "rgb8")


def make_palette(items: LabelledObjects, kind: str) -> Palette:
    """Return the pixel values of each geom in a semantic or panoptic map."""
    labels, instances = np.maximum(items.label_of, 0), items.instance_of
    codes = np.zeros((len(labels), 4), np.uint8)
    if kind == "semantic":
        numbers = labels
        codes[:, :3] = labels[:, None]
    else:
        numbers = np.where(labels > 0, labels * 65536 + instances % 65536, 0)
        counts = np.where(labels > 0, instances, 0)
        codes[:, 0], codes[:, 1], codes[:, 2] = counts & 255, counts >> 8 & 255, labels
    colour_by_label = {0: BACKGROUND, **label_colours(sorted({int(n) for n in numbers} - {0}))}
    colours = np.zeros_like(codes)
    colours[:, :3] = [colour_by_label[int(n)] for n in numbers]
    return Palette(codes.view(np.uint32)[:, 0], colours.view(np.uint32)[:, 0])


def _paint(palette: npt.NDArray[np.uint32], geoms: Ids) -> Pixels:
    import cv2

    picked = palette.take(geoms, mode="wrap").view(np.uint8).reshape(*geoms.shape, 4)
    return np.asarray(cv2.cvtColor(picked, cv2.COLOR_RGBA2RGB), dtype=np.uint8)
