"""Base of all rendered cameras: options, optics, trigger, noise and messages."""

from __future__ import annotations

import copy
import functools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import ClassVar

import mujoco
import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.compiler import Compiled
from simkit.diagnostics import Diagnostics
from simkit.msgs.message_types import M, Message
from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.pose import IDENTITY, Pose
from simkit.runtime import Simulation
from simkit.runtime.engine.pose_history import PoseRows
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
from simkit.sensors.cameras.renderer_choice import reserve_image
from simkit.sensors.cameras.rendering import render_thread
from simkit.sensors.cameras.rendering.lights_and_shadows import read_lights, use_lights
from simkit.sensors.cameras.rendering.view import DrawnView, Shot, View
from simkit.sensors.cameras.saved_images import ImageSaver
from simkit.sensors.cameras.shutter import Exposure, PictureMixer, Shutter, moving_data, rate_problem, read_shutter
from simkit.sensors.lasting_samples import LastingSample, LastingSamples
from simkit.sensors.sample import Memory, Reading, Sample
from simkit.sensors.topics_and_frames import OPTICAL_POSE, sibling_topic
from simkit.sensors.visibility_mask import hidden_geoms

TRIGGER_TYPES = ("std_msgs/msg/Bool", "std_msgs/msg/Empty")


class Trigger:
    """Counter of the images that trigger messages requested for the next due times.

    Attributes:
        pending: number of requested images.
        counts: True if each message requests an image of its own, at this or a later due time. False if all messages
            before a due time request one image together.
    """

    def __init__(self) -> None:
        self.pending = 0
        self.counts = False

    def on_message(self, _: object) -> None:
        """Request an image, whatever the content of the message."""
        self.pending = self.pending + 1 if self.counts else 1

    def take(self) -> bool:
        """Return True and reduce the number of requested images by one, or return False if none is requested."""
        if self.pending == 0:
            return False
        self.pending -= 1
        return True


class PictureMaker:
    """Lens, noise and buffers of the images of one camera.

    Args:
        options: options of the camera.
        sim: simulation of the camera.
        name: name of its random streams.
    """

    def __init__(self, options: CameraOptions, sim: Simulation, name: str) -> None:
        self._encoding = options.encoding
        self.set_model(options.model)
        self.noise = ImageNoise(options.noise, sim.engine.streams, name, as_ogre=sim.world.gazebo_quirks)
        self.spares = ArrayPool((options.model.height, options.model.width, 3), np.uint8)

    def set_model(self, model: CameraModel) -> None:
        """Set the optics of the next images."""
        self._model = model
        for name in ("distorter", "view"):
            self.__dict__.pop(name, None)

    @cached_property
    def distorter(self) -> ImageDistorter | None:
        """Lens distortion, computed at the first image because its tables take time; None without distortion."""
        return ImageDistorter(self._model) if self._model.is_distorted else None

    @cached_property
    def view(self) -> View:
        """View that is drawn."""
        return self.distorter.view() if self.distorter else self._model.view()

    def process(self, colours: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
        """Return drawn colours (h, w, 3) as seen through the lens, as a copy; brightness (h, w) for grey encodings."""
        if self.distorter:
            colours = self.distorter.distort(colours)
        if image_messages.is_grey(self._encoding):
            return image_messages.grey(colours)
        if self.distorter:
            return colours
        picture: npt.NDArray[np.uint8] = self.spares.take()
        np.copyto(picture, colours)
        return picture

    def perturb(self, picture: CameraReading, index: int) -> object:
        """Return the image with the noise of a sample."""
        return picture if self.noise.is_silent else NoisyCameraReading(picture, self.noise, index)


class RenderedCamera(RenderedSampler[M]):
    """Camera that looks along its x axis, with y to its left and z up.

    This class contains options, optics, trigger, noise and messages; `RenderedSampler` draws.
    """

    has_depth: ClassVar[bool] = False
    _names_for_users = ("zoom", "set_zoom", "true_colours")
    options: CameraOptions

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        self.optical_frame_id = self.options.optical_frame_id
        self._trigger: Trigger | None = None
        self._baseline = 0.0
        self._zoom = 1.0
        self._unzoomed: CameraModel | None = None  # optics of the file, once they were changed
        self.shutter: Shutter | None = None
        if "colour" in self.artefact_families:
            self.shutter = read_shutter(scene.params, self._height, scene.rate)
        if self.shutter is not None:
            self.lasting = LastingSamples()

    @staticmethod
    def read_model(params: Params, width: int, height: int) -> CameraModel:
        """Read the optics of a `<camera>` block for an image of `width` by `height` [px]."""
        return read_camera_model(params, width, height)

    def read_options(self, params: Params) -> CameraOptions:
        """Read the options; a camera with a pose of its own moves the sensor to that pose."""
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
            self.optical_frame_id = ""  # gz-sensors ignores the element (main branch, CameraSensor.cc, OpticalFrameId)
        options = self.options
        self._pictures = PictureMaker(options, sim, self.scoped)
        self._info = CameraInfoMaker(options.model, self._baseline)
        super().attach(sim)
        if options.triggered:
            self.trigger_on(self._trigger_topic())

    @property
    def camera_models(self) -> tuple[CameraModel, ...]:
        """Optics of each camera of the sensor."""
        return (self.options.model,)

    def true_colours(self) -> tuple[npt.NDArray[np.uint8], ...]:
        """Return the colours of each camera in the newest sample without noise; empty before the first sample."""
        reading = self._true_reading()
        if reading is None:
            return ()
        return tuple(picture.colours for picture in (reading if isinstance(reading, tuple) else (reading,)))

    def _drawn_view(self) -> View:
        """Return the view that is drawn."""
        return self._pictures.view

    def shots(self) -> Sequence[Shot]:
        """Return the views to draw for one sample."""
        return (Shot(self._drawn_view()),)

    def override_camera_info(self, change: Callable[[CameraModel], CameraModel]) -> None:
        """Publish another camera's model in `CameraInfo`; the images stay the same.

        Args:
            change: function from the model of the images to the model to publish.
        """
        model = self.options.model
        self.options = replace(self.options, model=replace(model, info_model=change(model)))
        self._info = CameraInfoMaker(self.options.model, self._baseline)

    @property
    def zoom(self) -> float:
        """Focal lengths as a multiple of those in the file."""
        return self._zoom

    def set_zoom(self, factor: float) -> None:
        """Make the focal lengths of the next images, and in their `CameraInfo`, `factor` times those of the file.

        A reset returns to the file's focal lengths, and a snapshot contains the factor.
        """
        if factor == self._zoom:
            return
        self.sim.communication.bus.settle()  # messages that wait for a reader have the present optics
        self.finish_samples()
        self._apply_zoom(factor)

    def _apply_zoom(self, factor: float) -> None:
        """Change the optics; samples that are not finished get the new optics, too."""
        if factor == self._zoom:
            return
        render_thread.drain()
        self._zoom = factor
        if self._unzoomed is None:
            self._unzoomed = self.options.model
        self.options = replace(self.options, model=self._unzoomed if factor == 1.0 else self._unzoomed.zoomed(factor))
        self._apply_model()

    def _apply_model(self) -> None:
        """Replace what was computed from the optics of the images."""
        self._pictures.set_model(self.options.model)
        self._info = CameraInfoMaker(self.options.model, self._baseline)

    def transform_messages(self, product: str, change: Callable[[Message], Message]) -> None:
        """Replace each message of a product by the result of `change`; call this method before the first message."""
        original = self._products[product]
        make_message = original.make
        changed = replace(original, make=lambda reading, time_ns: change(make_message(reading, time_ns)))
        self._products = {**self._products, product: changed}

    def set_frame_id(self, frame: str) -> None:
        """Set the frame of the messages of all later samples."""
        super().set_frame_id(frame)
        self.optical_frame_id = ""

    def optical_frames(self) -> dict[str, Pose]:
        return {self.optical_frame_id: OPTICAL_POSE} if self.optical_frame_id else {}

    def set_baseline(self, baseline: float) -> None:
        """Set the distance [m] to the left camera of a stereo pair, which the projection matrix P contains."""
        self._baseline = baseline
        self._info = CameraInfoMaker(self.options.model, baseline)

    def _trigger_topic(self) -> str:
        topic = self.options.trigger_topic
        return valid_topic(topic or (self.scene.topic or self.topic) + "/trigger")

    def trigger_on(self, topic: str, types: Sequence[str] = TRIGGER_TYPES, counts: bool = False) -> None:
        """Take images only when messages request them, on this topic in addition to earlier ones.

        Args:
            topic: absolute topic.
            types: accepted message types; lists of topics show the first.
            counts: see `Trigger`.
        """
        if self._trigger is None:
            self._trigger = Trigger()
        self._trigger.counts = counts
        self.sim.communication.bus.listen(topic, types, self._trigger.on_message)

    @property
    def selects_ticks(self) -> bool:
        return self._trigger is not None or self._is_switched

    def accepts(self, tick: int) -> bool:
        return self._trigger is None or self._trigger.take()

    def bind(self, compiled: Compiled) -> None:
        render_thread.drain()
        self.finish_samples()
        super().bind(compiled)
        self._hidden_geoms = hidden_geoms(self.options.visibility_mask, compiled.names)
        reserve_image(self.sim, self.options.model.width, self.options.model.height)
        if self.shutter is not None:
            self.sim.engine.physics.record_poses(self, self.measurement_ticks(1) + 1)

    # ------------------------------------------------------------------ shutter

    @property
    def _height(self) -> int:
        """Largest number of rows of the images of the sensor."""
        return max(model.height for model in self.camera_models)

    def rate_problem(self, rate: float) -> str:
        return "" if self.shutter is None else rate_problem(self.shutter, self._height, rate)

    def measurement_ticks(self, index: int) -> int:
        if self.shutter is None:
            return 0
        return math.ceil(self.shutter.duration(self._height) / self.sim.timestep - 1e-6)

    def continue_measurement(self, sample: LastingSample, tick: int) -> Memory:
        return None  # the image shows the shapes and colours at the end of its exposure

    def end_measurement(self, sample: LastingSample, tick: int) -> Exposure:
        data, history = self.computed_data(), self.sim.engine.physics.poses
        if history is None:
            rows = PoseRows(tick, (data.xpos.tobytes(),), (data.xquat.tobytes(),))
        else:
            rows = history.rows(sample.start, tick, data)
        return Exposure(self.capture_surroundings(), read_lights(self.sim.mj_model), rows, sample.start)

    def leave(self) -> None:
        super().leave()
        if self.shutter is not None:
            self.sim.engine.physics.end_record_of_poses(self)

    def capture_held(self, model: mujoco.MjModel, data: mujoco.MjData, sample: Sample) -> render_thread.RenderJob:
        exposure = sample.surroundings
        if not isinstance(exposure, Exposure):
            return super().capture_held(model, data, sample)
        if exposure.is_still():
            sample.surroundings = exposure.surroundings, exposure.lights
            return super().capture_held(model, data, sample)
        self.surroundings = exposure.surroundings
        return render_thread.run_now(functools.partial(self._expose_moving, model, copy.copy(data), exposure))

    def _expose_moving(self, model: mujoco.MjModel, data: mujoco.MjData, exposure: Exposure) -> Reading:
        """Return the mean of the pictures of an exposure; `data` is changed."""
        shutter = self.shutter
        assert shutter is not None
        duration, count = shutter.duration(self._height), shutter.sub_frames
        times = (np.arange(float(count)) + 0.5) * (duration / count)
        mixer = PictureMixer(tuple(shutter.weights(model.height, duration) for model in self.camera_models))
        is_tuple = False
        with use_lights(model, data, exposure.lights):
            for moved in moving_data(model, data, exposure, times, self.sim.timestep):
                reading = self._make_exposure(model, moved)()
                is_tuple = isinstance(reading, tuple)
                mixer.add(reading if is_tuple else (reading,))
        images = mixer.result()
        return images if is_tuple else images[0]

    def make_reading(self, drawn_views: Iterator[DrawnView], context: Memory) -> object:
        colours = next(drawn_views).colours
        assert colours is not None
        return CameraReading(self._pictures.process(colours), None)

    def perturb(self, reading: Reading, index: int) -> object:
        return self._pictures.perturb(reading, index)

    def memory(self) -> object:
        return self._trigger.pending if self._trigger else 0, self._zoom, super().memory()

    def remember(self, memory: Memory) -> None:
        pending, zoom, noise = memory
        self._set_trigger_and_zoom(pending, zoom)
        super().remember(noise)

    def restart(self) -> None:
        self._set_trigger_and_zoom(0, 1.0)
        super().restart()

    def _set_trigger_and_zoom(self, pending: int, zoom: float) -> None:
        if self._trigger:
            self._trigger.pending = pending
        self._apply_zoom(zoom)

    # ------------------------------------------------------------------ saved images

    def saved_products(self) -> dict[str, str]:
        """Return the file names of saved images by product."""
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
        """Return the publisher that writes a product's images to files."""
        far = self.options.depth_far if self.has_depth else None
        return ImageSaver(self.sim, self.scene, folder, name, far)

    # ------------------------------------------------------------------ messages

    def _colour_product(self) -> Product:
        return Product(image_messages.IMAGE_TYPE, self._colour_message)

    def _info_product(self) -> Product:
        return Product(image_messages.CAMERA_INFO_TYPE, self._info_message, needs_reading=False)

    def _image_header(self, time_ns: int) -> msgs.Header:
        """Return the header of images, whose axes are optical."""
        return msgs.header(time_ns, self.optical_frame_id or self.frame_id)

    def _colour_message(self, reading: CameraReading, time_ns: int) -> msgs.Image:
        return image_messages.colour_message(self._image_header(time_ns), reading.colours, self.options.encoding)

    def _info_message(self, _: object, time_ns: int) -> msgs.CameraInfo:
        return self._info.make(time_ns, self.optical_frame_id or self.frame_id)

    def default_topics(self) -> dict[str, str]:
        topic = self._default_topic("image")
        return {"image": topic, "camera_info": self._info_topic(topic)}

    def _info_topic(self, image_topic: str) -> str:
        info_topic = self.options.info_topic
        return valid_topic(info_topic) if info_topic else sibling_topic(image_topic, "camera_info")
