"""Several cameras in one sensor that take images at the same instant: stereo pairs and camera rigs."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from simkit import msgs
from simkit.compiler import Compiled
from simkit.diagnostics import Diagnostics
from simkit.linear_algebra import norm
from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.pose import IDENTITY, Pose
from simkit.runtime import Simulation
from simkit.scene import SceneSensor
from simkit.sensors.base import Product
from simkit.sensors.cameras import image_messages
from simkit.sensors.cameras.camera_model import CameraModel
from simkit.sensors.cameras.camera_options import CameraOptions, read_camera
from simkit.sensors.cameras.image_messages import CameraInfoMaker
from simkit.sensors.cameras.image_noise import CameraReading
from simkit.sensors.cameras.rendered_camera import PictureMaker, RenderedCamera
from simkit.sensors.cameras.renderer_choice import reserve_image
from simkit.sensors.cameras.rendering.view import DrawnView, Shot
from simkit.sensors.sample import Reading
from simkit.sensors.topics_and_frames import OPTICAL_POSE, sibling_topic

_PARALLEL = 1e-6  # tolerance of parallel axes [rad], and of the forward distance between two cameras of a pair [m]


class CameraUnit:
    """One camera of the sensor.

    Attributes:
        name: name in topics.
        options: the `<camera>` block, with the pose in the sensor's frame.
    """

    def __init__(self, name: str, options: CameraOptions) -> None:
        self.name, self.options = name, options
        self._unzoomed: CameraModel | None = None  # optics of the file, once they were changed
        self.offset = (0.0, 0.0)  # distance to the left of the reference and above it, for P [m]

    def open(self, sim: Simulation, scoped: str) -> None:
        """Make lens, noise and buffers; called once, when the simulation is known."""
        if sim.world.gazebo_quirks:
            self.options = replace(self.options, model=self.options.model.as_gazebo())
        self._pictures = PictureMaker(self.options, sim, f"{scoped}::{self.name}")
        self.update_camera_info()

    def set_zoom(self, factor: float) -> None:
        """Make the focal lengths `factor` times those of the file."""
        if self._unzoomed is None:
            self._unzoomed = self.options.model
        self.options = replace(self.options, model=self._unzoomed if factor == 1.0 else self._unzoomed.zoomed(factor))
        self._pictures.set_model(self.options.model)
        self.update_camera_info()

    def update_camera_info(self) -> None:
        """Update `CameraInfo` after a change of its model."""
        model = self.options.model.info_model or self.options.model
        if (model.tx, model.ty) == (0.0, 0.0):
            (left, up), p = self.offset, model.projection
            model = replace(model, tx=p[0] * left, ty=p[5] * up)
        self.info = CameraInfoMaker(model)

    @property
    def shot(self) -> Shot:
        """View to draw."""
        pose = self.options.pose
        return Shot(self._pictures.view, position=np.asarray(pose.position), rotation=pose.matrix)

    def make_reading(self, drawn_view: DrawnView) -> CameraReading:
        """Return the image without noise, in arrays of its own."""
        assert drawn_view.colours is not None
        return CameraReading(self._pictures.process(drawn_view.colours), None)

    def perturb(self, picture: CameraReading, index: int) -> object:
        """Return the image with the noise of a sample."""
        return self._pictures.perturb(picture, index)


class MultiCamera(RenderedCamera["msgs.Image"]):
    """Multicamera, `multicamera`: an image and a `CameraInfo` of each `<camera name="…"><pose>`, at the same instant.

    The reference is the camera with `left` in its name, or else the first. For cameras parallel to the reference, P's
    last column contains their offset from it, as ROS defines P for rectified stereo pairs.
    """

    kinds = ("multicamera",)
    artefact_families = ("colour",)
    example = '<camera name="left"/><camera name="right"><pose>0 -0.1 0 0 0 0</pose></camera>'
    options: CameraOptions

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        self._find_offsets()

    def read_options(self, params: Params) -> CameraOptions:
        blocks = params.all("camera") or [params.block("camera")]
        self.eyes: list[CameraUnit] = []
        for number, block in enumerate(blocks):
            options = read_camera(block, self.read_model)
            self.eyes.append(CameraUnit(_free_name(self.eyes, options.name or f"camera_{number}", block), options))
        options = self.eyes[0].options
        self._report_shared()
        triggered = next((eye.options for eye in self.eyes if eye.options.triggered), options)
        folder = next((eye.options.save for eye in self.eyes if eye.options.save), None)
        return replace(
            options, pose=IDENTITY, triggered=triggered.triggered, trigger_topic=triggered.trigger_topic, save=folder
        )

    def _report_shared(self) -> None:
        """Report options that differ between the cameras, although one value applies to the whole sensor."""
        options = [eye.options for eye in self.eyes]
        values_by_element: dict[str, set[object]] = {
            "<visibility_mask>": {o.visibility_mask for o in options},
            "<anti_aliasing>": {o.anti_aliasing > 0 for o in options},
            "<trigger_topic>": {o.trigger_topic for o in options if o.triggered},
            "<path> of <save>": {o.save for o in options if o.save is not None},
        }
        for element, values in values_by_element.items():
            if len(values) > 1:
                message = (
                    f"found {len(values)} different values of {element}; the sensor uses the first for all cameras"
                )
                self.diagnostics.warning("SK-SENSOR-125", message, self.scene.where, "use one sensor per camera")

    @property
    def camera_models(self) -> tuple[CameraModel, ...]:
        return tuple(eye.options.model for eye in self.eyes)

    @property
    def reference(self) -> CameraUnit:
        """Camera of the stereo rig that the offsets of all other cameras refer to."""
        return next((eye for eye in self.eyes if "left" in eye.name), self.eyes[0])

    def _find_offsets(self) -> None:
        """Set each camera's offset from the reference."""
        reference = self.reference
        for eye in self.eyes:
            if eye is reference:
                continue
            relative = reference.options.pose.inverse() @ eye.options.pose
            if _is_parallel(relative):
                eye.offset = relative.position[1], relative.position[2]
            else:
                message = f"camera {eye.name!r} is not parallel to {reference.name!r}, or not beside it"
                effect = "its projection matrix has no baseline; rectify the images first"
                self.diagnostics.note("SK-SENSOR-124", f"{message}: {effect}", self.scene.where)

    def set_baseline(self, baseline: float) -> None:
        """Set how far all other cameras are to the right of the reference [m] in `CameraInfo`; no pose changes."""
        for eye in self.eyes:
            if eye is not self.reference:
                eye.offset = -baseline, 0.0
                eye.update_camera_info()

    def override_camera_info(self, change: Callable[[CameraModel], CameraModel]) -> None:
        for eye in self.eyes:
            model = eye.options.model
            eye.options = replace(eye.options, model=replace(model, info_model=change(model)))
            eye.update_camera_info()

    def _apply_model(self) -> None:
        super()._apply_model()
        for eye in self.eyes:
            eye.set_zoom(self.zoom)

    def set_frame_id(self, frame: str) -> None:
        super().set_frame_id(frame)
        for eye in self.eyes:
            eye.options = replace(eye.options, optical_frame_id="")

    def optical_frames(self) -> dict[str, Pose]:
        options = [eye.options for eye in self.eyes]
        return {o.optical_frame_id: o.pose @ OPTICAL_POSE for o in options if o.optical_frame_id}

    def describe(self) -> dict[str, object]:
        description = super().describe()
        description["cameras"] = [
            {
                "name": eye.name,
                "pose_sensor": eye.options.pose.as_list(),
                "width": eye.options.model.width,
                "height": eye.options.model.height,
                "hfov": eye.options.model.hfov,
            }
            for eye in self.eyes
        ]
        return description

    def attach(self, sim: Simulation) -> None:
        for eye in self.eyes:
            eye.open(sim, self.scoped)
        super().attach(sim)

    def bind(self, compiled: Compiled) -> None:
        super().bind(compiled)
        for eye in self.eyes:
            reserve_image(self.sim, eye.options.model.width, eye.options.model.height)

    # ------------------------------------------------------------------ images

    def shots(self) -> Sequence[Shot]:
        return tuple(eye.shot for eye in self.eyes)

    def make_reading(self, drawn_views: Iterator[DrawnView], context: object) -> tuple[CameraReading, ...]:
        return tuple(eye.make_reading(next(drawn_views)) for eye in self.eyes)

    def perturb(self, reading: Reading, index: int) -> tuple[object, ...]:
        return tuple(eye.perturb(picture, index) for eye, picture in zip(self.eyes, reading, strict=True))

    # ------------------------------------------------------------------ messages

    def products(self) -> dict[str, Product]:
        products = {}
        for number, eye in enumerate(self.eyes):
            products[f"{eye.name}/image"] = Product(image_messages.IMAGE_TYPE, partial(self._image_of, number))
            products[f"{eye.name}/camera_info"] = Product(
                image_messages.CAMERA_INFO_TYPE, partial(self._info_of, number), needs_reading=False
            )
        return products

    def default_topics(self) -> dict[str, str]:
        base = self._default_topic("")
        topics = {}
        for eye in self.eyes:
            topics[f"{eye.name}/image"] = topic = valid_topic(f"{base}/{eye.name}/image")
            info = eye.options.info_topic
            topics[f"{eye.name}/camera_info"] = valid_topic(info) if info else sibling_topic(topic, "camera_info")
        return topics

    def _trigger_topic(self) -> str:
        topic = self.options.trigger_topic
        return valid_topic(topic) if topic else self._default_topic("") + "/trigger"

    def saved_products(self) -> dict[str, str]:
        return {f"{eye.name}/image": f"{self.scoped}::{eye.name}" for eye in self.eyes if eye.options.save}

    def _image_of(self, number: int, reading: Reading, time_ns: int) -> msgs.Image:
        eye = self.eyes[number]
        header = msgs.header(time_ns, self._frame_of(eye))
        return image_messages.colour_message(header, reading[number].colours, eye.options.encoding)

    def _info_of(self, number: int, _: object, time_ns: int) -> msgs.CameraInfo:
        eye = self.eyes[number]
        return eye.info.make(time_ns, self._frame_of(eye))

    def _frame_of(self, eye: CameraUnit) -> str:
        return eye.options.optical_frame_id or self.frame_id


def _is_parallel(relative: Pose) -> bool:
    """Check whether a pose relative to the reference camera has parallel axes and lies in its image plane."""
    angle = 2 * math.atan2(norm(relative.quaternion[1:]), abs(relative.quaternion[0]))
    return angle < _PARALLEL and abs(relative.position[0]) < _PARALLEL


def _free_name(others: Sequence[CameraUnit], name: str, block: Params) -> str:
    """Return the name; if another camera already has the name, report an error and return a different name."""
    used = {eye.name for eye in others}
    if name not in used:
        return name
    block.error("SK-PARAM-002", f"two cameras of a sensor have the name {name!r}; expected different names")
    return f"{name}_{len(others)}"
