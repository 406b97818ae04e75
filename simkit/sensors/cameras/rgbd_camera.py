"""Cameras with colours and depths."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, ClassVar

import mujoco
import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.diagnostics import Diagnostics
from simkit.pose import IDENTITY, Pose
from simkit.runtime import Simulation
from simkit.runtime.particle_clouds import has_sources
from simkit.scene import SceneSensor
from simkit.sensors.base import Product
from simkit.sensors.cameras import depth_messages, image_messages
from simkit.sensors.cameras.array_pool import ArrayPool
from simkit.sensors.cameras.depth_messages import DepthClouds
from simkit.sensors.cameras.depth_range import DepthRange, clip_planes
from simkit.sensors.cameras.disparity_noise import DisparityNoise, read_disparity_noise
from simkit.sensors.cameras.image_noise import CameraReading, ImageNoise, NoisyCameraReading
from simkit.sensors.cameras.rendered_camera import RenderedCamera
from simkit.sensors.cameras.rendered_sampler import camera_rule
from simkit.sensors.cameras.rendering.appearance import Appearance
from simkit.sensors.cameras.rendering.view import Colours, Depths, DrawnView, Ids, Shot, View
from simkit.sensors.measured_rows import MeasuredRows
from simkit.sensors.particle_echoes import Echoes, find_echoes
from simkit.sensors.sample import Reading
from simkit.sensors.topics_and_frames import OPTICAL_POSE

_NO_COLOURS: Colours = np.empty((0, 0, 3), np.uint8)
_TURNED = 1e-3  # [rad] axes that differ by less are equal


class NoisyDepths(NoisyCameraReading):
    """Colours and depths with noise, drawn when first read, so that unread depths cost nothing.

    Args:
        picture: reading without noise.
        noise: noise of the colours.
        index: number of the sample.
        make_depths: function from true depths and the sample's index to noisy depths.
    """

    def __init__(
        self, picture: CameraReading, noise: ImageNoise, index: int, make_depths: Callable[[Depths, int], Depths]
    ) -> None:
        super().__init__(picture, noise, index)
        self._make_depths = make_depths
        self._depths: Depths | None = None

    @property
    def colours(self) -> Colours:
        return self._picture.colours if self._noise.is_silent else super().colours

    @property
    def true_depths(self) -> Depths:
        """Depths without noise."""
        depths = self._picture.depths  # an artefact before the noise may make them now
        assert depths is not None
        return depths

    @property
    def depths(self) -> Depths:
        if self._depths is None:
            self._depths = self._make_depths(self.true_depths, self._index)
        return self._depths


class RgbdCamera(RenderedCamera["msgs.Image"]):
    """Camera with colour, depth along the optical axis, and an organised cloud of the same pixels, drawn in one pass.

    Depth is +inf where nothing is in range and -inf for an object nearer than the range. Noise is in metres for depths
    and in units of white for colours. The cloud is in the sensor's frame (x forward), or in the optical frame (z
    forward) if the file sets `<optical_frame_id>`. `<points_frame_id>` sets a frame for the cloud only, x forward.
    `<gz:use_ros_convention>` rotates the axes of its points to z forward in any frame.

    Attributes:
        points_frame_id: frame of the cloud; empty for that of the images.
        needs_colours: True if an artefact reads the colours, which are then always drawn; set in its `prepare`.
        needs_geoms: True if an artefact reads which geom each pixel shows; set in its `prepare`.
    """

    kinds: ClassVar[tuple[str, ...]] = ("rgbd_camera",)
    artefact_families: ClassVar[tuple[str, ...]] = ("depth", "colour")
    _names_for_users = ("depth", "true_depth", "points")
    has_depth = True
    needs_colours = False
    needs_geoms = False

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        self._is_classic = False
        self._disparity_options = read_disparity_noise(scene.params.block("camera"), self.options.model)
        self.points_frame_id = scene.params.text("points_frame_id", "")
        self._has_ros_axes = scene.params.block("camera").boolean("gz:use_ros_convention", False)
        self._clouds_made: DepthClouds | None = None

    def attach(self, sim: Simulation) -> None:
        disparity, model = self._disparity_options, self.options.model
        self._disparity = DisparityNoise(disparity, sim.engine.streams, self.scoped) if disparity else None
        self._view: View | None = None
        self._spare_depths = ArrayPool((model.height, model.width), np.float32)
        # with several samples per pixel, only one sample has a depth, and not in the pixel's middle
        self._is_blended = self.options.anti_aliasing > 0 and Appearance.of(sim.world).quality.samples > 0
        super().attach(sim)

    def set_depth_range(self, near: float | None, far: float | None) -> None:
        """Set the range of depths [m]; None does not change that end of the range."""
        old = self.options
        near, far = old.depth_near if near is None else near, old.depth_far if far is None else far
        self.options = replace(old, depth_near=near, depth_far=far)
        self._view = None

    def _apply_model(self) -> None:
        super()._apply_model()
        self._view = self._clouds_made = None

    def _drawn_view(self) -> View:
        if self._view is None:
            options = self.options
            self._range = DepthRange(options.model, options.depth_near, options.depth_far)
            # an object that is too near must be drawn, so the near plane must not clip it
            near, far = clip_planes(options.model.near, options.model.far)
            self._view = replace(super()._drawn_view(), near=near, far=far)
        return self._view

    def array_rule(self) -> MeasuredRows:
        return camera_rule(self)

    def shots(self) -> Sequence[Shot]:
        return self._with_geoms(with_colours=True)

    def _with_geoms(self, *, with_colours: bool) -> tuple[Shot, ...]:
        """Return the shots of a sample, and the shot of geoms if an artefact reads it."""
        view = self._drawn_view()
        if not with_colours:
            shots: tuple[Shot, ...] = (Shot(view, depth=True, sharp=True),)
        elif self._is_blended:
            shots = Shot(view), Shot(view, depth=True, sharp=True)
        else:
            shots = (Shot(view, depth=True),)
        return (*shots, Shot(view, ids=True)) if self.needs_geoms else shots

    def capture_context(self, model: mujoco.MjModel, data: mujoco.MjData) -> Echoes | None:
        """Return the echoes of particles."""
        if not has_sources(self.sim):
            return None
        return find_echoes(self.sim, self.scoped, float(data.time), *self._frame_in_world(data))

    def make_reading(self, drawn_views: Iterator[DrawnView], context: Echoes | None) -> object:
        drawn_view = next(drawn_views)
        colours = _NO_COLOURS if drawn_view.colours is None else self._pictures.process(drawn_view.colours)
        if drawn_view.depths is None:
            drawn_view = next(drawn_views)
        raw = drawn_view.depths
        assert raw is not None
        if self._pictures.distorter:
            raw = self._pictures.distorter.distort_depths(raw)
        depths = self._range.metres(raw, drawn_view.view, self._spare_depths.take())
        if context is not None:
            self._add_echoes(depths, context)
        geoms = self._geoms_of(next(drawn_views)) if self.needs_geoms else None
        return CameraReading(colours, depths, geoms)

    def _geoms_of(self, drawn_view: DrawnView) -> Ids:
        """Return the geom that each pixel shows, shape (h, w), -1 for none."""
        assert drawn_view.ids is not None
        distorter = self._pictures.distorter
        return distorter.distort_ids(drawn_view.ids) if distorter else drawn_view.ids.copy()

    def _add_echoes(self, depths: Depths, echoes: Echoes) -> None:
        """Shorten the depths of the pixels that see a particle; an echo nearer than the range is -inf."""
        left, up = self.options.model.rays()
        left, up = np.broadcast_arrays(left, up if up.ndim == 2 else up[:, None])
        rays = np.stack((np.ones(depths.size), left.ravel(), up.ravel()), axis=1, dtype=np.float64)
        lengths = np.sqrt(1.0 + rays[:, 1] ** 2 + rays[:, 2] ** 2)
        ranges = depths.ravel().astype(np.float64) * lengths
        shortened = echoes.shorten(rays / lengths[:, None], ranges)
        changed = shortened < ranges
        depths.reshape(-1)[changed] = (shortened[changed] / lengths[changed]).astype(np.float32)
        self._range.clip(depths)

    def products(self) -> dict[str, Product]:
        return {
            "image": self._colour_product(),
            "depth_image": Product(image_messages.IMAGE_TYPE, self._depth_message),
            "points": Product(depth_messages.CLOUD_TYPE, self._cloud),
            "camera_info": self._info_product(),
            "depth_camera_info": self._info_product(),
        }

    def default_topics(self) -> dict[str, str]:
        base = self._default_topic("")
        topics = {product: f"{base}/{product}" for product in ("image", "depth_image", "points")}
        return {**topics, "camera_info": self._info_topic(base + "/image")}

    def use_optical_cloud_axes(self) -> None:
        """Make clouds as Gazebo Classic does: z forward, x right, y down, 32 bytes per point, in any frame.

        If the frame of the cloud is a link of the same model with other axes, a note reports the cloud.
        """
        self._is_classic = True
        self._clouds_made = None

    def crop_depth_images(self, near: float, far: float, *, in_millimetres: bool) -> None:
        """Publish depth images as camera drivers do, limited to a range.

        Args:
            near: start of the range of depths [m].
            far: end of the range of depths [m].
            in_millimetres: True for 16UC1 with 0 outside the range, False for floats with NaN outside the range.
        """
        change = depth_messages.depths_in_millimetres if in_millimetres else depth_messages.depths_with_nan
        self.transform_messages("depth_image", functools.partial(change, near=near, far=far))

    def crop_clouds(self, near: float, far: float) -> None:
        """Publish clouds whose points are NaN where the depth, along z, is not between `near` and `far` [m]."""
        self.transform_messages("points", functools.partial(depth_messages.crop_cloud, near=near, far=far))

    def publish_on(self, topics: Mapping[str, str]) -> None:
        super().publish_on(topics)
        if not (self._is_classic and "points" in topics) or self._angle_to_frame() < _TURNED:
            return
        frame = self._cloud_frame
        message = f"sensor {self.scoped!r}: the cloud has z forward, as in Gazebo Classic, but its frame {frame!r}"
        message += " is a link with other axes, so the cloud appears rotated"
        hint = "set <frame_name> to a link with an rpy of -1.5708 0 -1.5708 relative to the sensor"
        self.sim.engine.reports.note("SK-SENSOR-112", message, self.scene.where, hint)

    # ------------------------------------------------------------------ readings

    @property
    def depth(self) -> Depths | Any:
        """Depths along the optical axis of the newest image [m], shape (h, w), or None before the first."""
        return _locked_depths(self._noisy_reading())

    @property
    def true_depth(self) -> Depths | Any:
        """Depths of the newest image without noise [m], shape (h, w), or None before the first."""
        return _locked_depths(self._true_reading())

    @property
    def points(self) -> npt.NDArray[np.float32] | Any:
        """Points of the newest image [m], shape (h, w, 3), as in the cloud's message, or None before the first."""
        reading = self._noisy_reading()
        return None if reading is None else self._clouds.points(reading.depths, self._shift(reading))

    def _noisy_reading(self) -> Reading | None:
        if self._failure is not None:
            raise self._failure
        sample = self._finished_sample()
        return None if sample is None else sample.noisy

    def perturb(self, reading: CameraReading, index: int) -> object:
        if self._pictures.noise.is_silent and (self._disparity is None or self._disparity.is_silent):
            return reading
        return NoisyDepths(reading, self._pictures.noise, index, self._noisy_depths)

    def limit_depths(self, depths: Depths) -> Depths:
        """Apply the range in place to changed depths [m], shape (h, w): +inf beyond it, -inf before it."""
        return self._range.clip(depths)

    def _noisy_depths(self, depths: Depths, index: int) -> Depths:
        """Add noise to the disparities and the depths, then apply the range again, as in Gazebo."""
        if self._disparity is not None and not self._disparity.is_silent:
            depths = self._disparity.on_depths(depths, index)
        if not self._pictures.noise.is_silent:
            depths = self._pictures.noise.on_depths(depths, index)
        return self.limit_depths(depths)

    # ------------------------------------------------------------------ messages

    def _depth_message(self, reading: Reading, time_ns: int) -> msgs.Image:
        return image_messages.image_message(self._image_header(time_ns), reading.depths, "32FC1")

    def _cloud(self, reading: Reading, time_ns: int) -> msgs.PointCloud2:
        header = msgs.header(time_ns, self._cloud_frame)
        return self._clouds.message(header, reading.depths, self._cloud_colours(reading), self._shift(reading))

    @property
    def _clouds(self) -> DepthClouds:
        if self._clouds_made is None:
            step = depth_messages.CLASSIC_POINT_STEP if self._is_classic else depth_messages.GZ_POINT_STEP
            self._clouds_made = DepthClouds(self.options.model, self._is_cloud_optical, step)
        return self._clouds_made

    def _shift(self, reading: Reading) -> Depths | None:
        """Return the noise that Gazebo adds equally to all three coordinates (gaussian_noise_depth_fs.glsl)."""
        if not self.sim.world.gazebo_quirks or not isinstance(reading, NoisyDepths):
            return None
        with np.errstate(invalid="ignore"):
            shift: Depths = reading.depths - reading.true_depths
        return shift

    def _cloud_colours(self, reading: Reading) -> Colours:
        colours: Colours = reading.colours
        return colours

    # ------------------------------------------------------------------ frames

    @property
    def _cloud_frame(self) -> str:
        return self.points_frame_id or self.optical_frame_id or self.frame_id

    @property
    def _is_cloud_optical(self) -> bool:
        """True if the z axis of the cloud's points is forward."""
        is_with_images = bool(self.optical_frame_id) and not self.points_frame_id
        return self._is_classic or self._has_ros_axes or is_with_images

    def set_frame_id(self, frame: str) -> None:
        super().set_frame_id(frame)
        self.points_frame_id = ""

    def optical_frames(self) -> dict[str, Pose]:
        frames = super().optical_frames()
        if self.points_frame_id:
            frames[self.points_frame_id] = OPTICAL_POSE if self._is_cloud_optical else IDENTITY
        return frames

    def _angle_to_frame(self) -> float:
        """Return the angle between the frame's axes and optical axes [rad]; 0 if the model has no such link."""
        frame, (owner, _, _) = self._cloud_frame, self.scene.parent.rpartition("::")
        links = [link for model in self.sim.models.values() for link in model.scene.all_links()]
        named = [link for link in links if link.name == frame and link.scoped.rpartition("::")[0] == owner]
        carriers = [link for link in links if link.scoped == self.scene.parent]
        if not (named and carriers):
            return 0.0
        pose = named[0].pose_world.inverse() @ carriers[0].pose_world @ self.scene.pose_link @ OPTICAL_POSE
        return 2 * math.acos(min(abs(float(pose.quaternion[0])), 1.0))


def _locked_depths(reading: Reading | None) -> Depths | None:
    """Return a read-only view of a reading's depths, because messages share their memory."""
    if reading is None:
        return None
    view: Depths = reading.depths.view()
    view.flags.writeable = False
    return view
