"""Base of all rendered cameras: their options, optics, trigger, noise and messages."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.compiler import Compiled
from simkit.diagnostics import Diagnostics
from simkit.msgs.message_types import Message
from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.pose import IDENTITY, Pose
from simkit.runtime import Simulation
from simkit.scene import SceneSensor
from simkit.sensors.base import Product
from simkit.sensors.cameras import image_messages
from simkit.sensors.cameras.array_pool import ArrayPool
from simkit.sensors.cameras.camera_model import CameraModel, read_camera_model
from simkit.sensors.cameras.camera_options import CameraOptions, read_camera
from simkit.sensors.cameras.image_distortion import ImageDistorter
from simkit.sensors.cameras.image_messages import CameraInfoMaker
from simkit.sensors.cameras.image_noise import CameraReading, ImageNoise, NoisyCameraReading
from simkit.sensors.cameras.rendered_sampler import RenderedSampler
from simkit.sensors.cameras.rendering import render_thread
from simkit.sensors.cameras.rendering.renderer import renderer_of
from simkit.sensors.cameras.rendering.view import Film, Shot, View
from simkit.sensors.cameras.saved_images import ImageSaver
from simkit.sensors.sample import Memory, Reading
from simkit.sensors.topics_and_frames import OPTICAL_POSE, sibling_topic
from simkit.sensors.visibility_mask import hidden_geoms

TRIGGER_TYPES = ("std_msgs/msg/Bool", "std_msgs/msg/Empty")


class Trigger:
    """Messages that each call for a picture at the next due time.

    Attributes:
        pending: pictures that are called for.
        counts: whether messages that come in before a due time give a picture each, at that and the next ones; else
            they give one.
    """

    def __init__(self) -> None:
        self.pending = 0
        self.counts = False

    def on_message(self, _: object) -> None:
        """Call for a picture, whatever the message says."""
        self.pending = self.pending + 1 if self.counts else 1

    def take(self) -> bool:
        """Whether a picture is called for now, which is one less then."""
        if self.pending == 0:
            return False
        self.pending -= 1
        return True


class PictureMaker:
    """Lens, noise and memory of the pictures of one camera.

    Args:
        options: of the camera.
        sim: the simulation.
        name: of its random streams.
    """

    def __init__(self, options: CameraOptions, sim: Simulation, name: str) -> None:
        self._model, self._encoding = options.model, options.encoding
        self.noise = ImageNoise(options.noise, sim.engine.streams, name, as_ogre=sim.world.gazebo_quirks)
        self.spares = ArrayPool((options.model.height, options.model.width, 3), np.uint8)

    @cached_property
    def distorter(self) -> ImageDistorter | None:
        """The lens; found out at the first picture, since it takes a while. None where it bends nothing."""
        return ImageDistorter(self._model) if self._model.is_distorted else None

    @cached_property
    def view(self) -> View:
        """The frustum that is drawn."""
        return self.distorter.view() if self.distorter else self._model.view()

    def develop(self, colours: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
        """Colours (h, w, 3) that were drawn, through the lens, in memory of their own; brightness (h, w) for grey."""
        if self.distorter:
            colours = self.distorter.distort(colours)
        if image_messages.is_grey(self._encoding):
            return image_messages.grey(colours)
        if self.distorter:
            return colours
        kept: npt.NDArray[np.uint8] = self.spares.take()
        np.copyto(kept, colours)
        return kept

    def perturb(self, picture: CameraReading, index: int) -> object:
        """The picture with the noise of a sample."""
        return picture if self.noise.is_silent else NoisyCameraReading(picture, self.noise, index)


class RenderedCamera(RenderedSampler):
    """A camera: looks along its x axis, y to its left, z up.

    Its options, optics, trigger, noise and messages; `RenderedSampler` draws.
    """

    has_depth: ClassVar[bool] = False
    options: CameraOptions

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        self.optical_frame_id = self.options.optical_frame_id
        self._trigger: Trigger | None = None
        self._baseline = 0.0

    @staticmethod
    def read_model(params: Params, width: int, height: int) -> CameraModel:
        """The optics in a `<camera>` block, for an image of `width` by `height` [px]."""
        return read_camera_model(params, width, height)

    def read_options(self, params: Params) -> CameraOptions:
        """The options of the file; a camera that stands elsewhere in its sensor takes the sensor there."""
        options = read_camera(params.block("camera"), self.read_model, self.has_depth)
        if options.pose != IDENTITY:
            self.scene = replace(self.scene, pose_link=self.scene.pose_link @ options.pose)
        return options

    def describe(self) -> dict[str, object]:
        return {"camera": self._describe_image()}

    def _describe_image(self) -> dict[str, object]:
        model = self.options.model
        return {"width": model.width, "height": model.height, "hfov": model.hfov, "near": model.near, "far": model.far}

    def attach(self, sim: Simulation) -> None:
        if sim.world.gazebo_quirks:
            self.options = replace(self.options, model=self.options.model.as_gazebo())
            self.optical_frame_id = ""  # gz-sensors' main branch passes it over (CameraSensor.cc, OpticalFrameId)
        options = self.options
        self._pictures = PictureMaker(options, sim, self.scoped)
        self._info = CameraInfoMaker(options.model, self._baseline)
        super().attach(sim)
        if options.triggered:
            self.trigger_on(self._trigger_topic())

    def _drawn_view(self) -> View:
        """The frustum that is drawn."""
        return self._pictures.view

    def shots(self) -> Sequence[Shot]:
        """What is drawn for one sample."""
        return (Shot(self._drawn_view()),)

    def override_camera_info(self, change: Callable[[CameraModel], CameraModel]) -> None:
        """Says in `CameraInfo` what another camera would see; the pictures stay as they are.

        Args:
            change: gives that camera for the one that there is.
        """
        model = self.options.model
        self.options = replace(self.options, model=replace(model, info_model=change(model)))
        self._info = CameraInfoMaker(self.options.model, self._baseline)

    def transform_messages(self, product: str, change: Callable[[Message], Message]) -> None:
        """Publishes what `change` makes of each message of a product, instead of it; before the first."""
        of = self._products[product]
        make_message = of.make
        changed = replace(of, make=lambda reading, time_ns: change(make_message(reading, time_ns)))
        self._products = {**self._products, product: changed}

    def set_frame_id(self, frame: str) -> None:
        """Names the frame of all its messages."""
        self.frame_id, self.optical_frame_id = frame, ""

    def optical_frames(self) -> dict[str, Pose]:
        return {self.optical_frame_id: OPTICAL_POSE} if self.optical_frame_id else {}

    def set_baseline(self, baseline: float) -> None:
        """Says how far [m] the left camera of a stereo pair is; it shows in the projection matrix."""
        self._baseline = baseline
        self._info = CameraInfoMaker(self.options.model, baseline)

    def _trigger_topic(self) -> str:
        given = self.options.trigger_topic
        return valid_topic(given or (self.scene.topic or self.topic) + "/trigger")

    def trigger_on(self, topic: str, types: Sequence[str] = TRIGGER_TYPES, counts: bool = False) -> None:
        """Takes pictures only when messages call for them, on this topic too where there is one already.

        Args:
            topic: absolute.
            types: of the messages, whatever they say; the first is the listed one.
            counts: as `Trigger` says.
        """
        if self._trigger is None:
            self._trigger = Trigger()
        self._trigger.counts = counts
        self.sim.communication.bus.listen(topic, types, self._trigger.on_message)

    def accepts(self, tick: int) -> bool:
        return self._trigger is None or self._trigger.take()

    def bind(self, compiled: Compiled) -> None:
        render_thread.drain()
        self.finish_samples()
        super().bind(compiled)
        self._hidden_geoms = hidden_geoms(self.options.visibility_mask, compiled.names)
        renderer_of(self.sim).uploads.reserve(self.options.model.width, self.options.model.height)

    def develop(self, films: Iterator[Film], notes: Memory) -> object:
        colours = next(films).colours
        assert colours is not None
        return CameraReading(self._pictures.develop(colours), None)

    def perturb(self, reading: Reading, index: int) -> object:
        return self._pictures.perturb(reading, index)

    def memory(self) -> object:
        return self._trigger.pending if self._trigger else 0

    def remember(self, memory: Memory) -> None:
        if self._trigger:
            self._trigger.pending = memory

    def restart(self) -> None:
        self.remember(0)

    # ------------------------------------------------------------------ saved pictures

    def saved_products(self) -> dict[str, str]:
        """Image product -> name of the files that it is saved in, where the file says so."""
        names = (
            name
            for name in (*self._topics, *self._products)
            if self._products[name].type_name == image_messages.IMAGE_TYPE
        )
        return dict.fromkeys([next(names)], self.scoped)

    def _open(self, topics: Mapping[str, str]) -> None:
        super()._open(topics)
        folder = self.options.save
        if folder is None or any(isinstance(end, ImageSaver) for _, end, _ in self._publishers):
            return
        for product, name in self.saved_products().items():
            self._publishers.append((product, self._make_image_saver(folder, name), True))

    def _make_image_saver(self, folder: Path, name: str) -> ImageSaver:
        """What writes a product's pictures to files."""
        far = self.options.depth_far if self.has_depth else None
        return ImageSaver(self.sim, self.scene, folder, name, far)

    # ------------------------------------------------------------------ messages

    def _colour_product(self) -> Product:
        return Product(image_messages.IMAGE_TYPE, self._colour_message)

    def _info_product(self) -> Product:
        return Product(image_messages.CAMERA_INFO_TYPE, self._info_message, needs_reading=False)

    def _image_header(self, time_ns: int) -> msgs.Header:
        """Of images, whose axes are optical."""
        return msgs.header(time_ns, self.optical_frame_id or self.frame_id)

    def _colour_message(self, reading: CameraReading, time_ns: int) -> msgs.Image:
        return image_messages.colour_message(self._image_header(time_ns), reading.colours, self.options.encoding)

    def _info_message(self, _: object, time_ns: int) -> msgs.CameraInfo:
        return self._info.make(time_ns, self.optical_frame_id or self.frame_id)

    def _info_topic(self, beside: str) -> str:
        given = self.options.info_topic
        return valid_topic(given) if given else sibling_topic(beside, "camera_info")
