"""Video streams of cameras: `GstCameraPlugin` of ardupilot_gazebo and `libgazebo_gst_camera_plugin.so` of PX4."""

from __future__ import annotations

from ipaddress import ip_address
from typing import TYPE_CHECKING

import numpy as np

from simkit import Params, SensorPlugin, msgs
from simkit.extend import Options, OptionsOf, boolean, integer, listens, text, without_effect
from simkit.install_command import install_command
from simkit.msgs import valid_topic
from simkit_special_cameras.plugins.video_stream import LOOPBACK, StreamError, VideoStream

if TYPE_CHECKING:
    from simkit.extend import SceneSensor, Sensor, SpecBuilder
    from simkit.msgs import Message

_KINDS = ("camera", "rgbd_camera", "depth_camera", "depth", "wide_angle_camera", "wideanglecamera", "thermal_camera")
_BOOL, _INT = "std_msgs/msg/Bool", "std_msgs/msg/Int32"


class VideoStreamPlugin(SensorPlugin):
    """Base class of plugins that stream the images of their camera on request."""

    def prepare(self, scene: SceneSensor, params: Params, builder: SpecBuilder) -> None:
        if scene.kind not in _KINDS:
            message = f"plugin {self.name!r} needs a sensor of type camera; this sensor is {scene.kind!r}"
            params.error("SK-PLUGIN-003", message)

    def _prepare_stream(self, sensor: Sensor, host: str, port: int, is_rtp: bool, rtmp_location: str) -> None:
        """Make the stream, which waits for a request, and report what differs from the file."""
        self._images = sensor.topics.get("image", sensor.topic)
        self._stream = VideoStream(port, sensor.update_rate, is_rtp)
        changed = [f"<rtmp_location> {rtmp_location}"] if rtmp_location else []
        changed += [] if _is_loopback(host) else [f"<udp_host> {host}"]
        for element in changed:
            message = f"plugin {self.name!r}: {element} is not used; the video goes to port {port} of {LOOPBACK}"
            hint = "forward the stream with a program such as ffmpeg"
            self.params.diagnostics.note("SK-SENSOR-150", message, self.where, hint)

    def _on_request(self, message: Message) -> None:
        stream = self._stream
        if not message.data:
            stream.close()
        elif stream.source is None:
            try:
                stream.open()
            except ImportError as error:
                text = f"there is no stream, because it needs the package av ({error})"
                hint = f"{install_command('video')}; the images are on {self._images}, in a recording and on the page"
                self._once.warn("SK-SENSOR-151", "av", text, hint)
            else:
                stream.source = self.subscribe(self._images, self._on_image, keep=1)

    def _on_image(self, message: Message) -> None:
        pixels = msgs.image(message)
        if pixels.dtype == np.uint16:
            pixels = (pixels >> 8).astype(np.uint8)
        if pixels.dtype == np.uint8:
            try:
                self._stream.send(pixels[..., :3] if pixels.ndim == 3 else np.repeat(pixels[..., None], 3, axis=2))
            except StreamError as error:
                self._once.warn("SK-SENSOR-151", "encoder", f"there is no stream, because the encoder failed ({error})")

    def close(self) -> None:
        """End the stream."""
        self._stream.close()


class GstCameraOptions(Options):
    """Options of `GstCameraPlugin`."""

    udp_host: str = text(LOOPBACK)
    udp_port: int = integer(5600, minimum=1, maximum=65535)
    use_basic_pipeline: bool = boolean()  # true: RTP; false: MPEG transport stream
    image_topic: str = text()
    enable_topic: str = text()
    rtmp_location: str = text()
    use_cuda: bool = without_effect()


class GstCamera(VideoStreamPlugin):
    """Streams the images of its camera as H.264 by UDP to `<udp_port>` of this machine, on request.

    A `Bool` on `<image topic>/enable_streaming`, or on `<enable_topic>`, begins and ends the stream. The stream needs
    the package `av` and never leaves the machine: another `<udp_host>` is replaced by 127.0.0.1.
    """

    endpoints = (listens("…/enable_streaming", _BOOL, named_by=("enable_topic",)),)
    options = OptionsOf(GstCameraOptions)
    filenames = ("GstCameraPlugin",)
    names = ("gz::sim::systems::GstCameraPlugin",)

    def load(self, parent: Sensor, params: Params) -> None:
        options = self.options.read_all()
        host, port, is_rtp = options.udp_host, options.udp_port, options.use_basic_pipeline
        self._prepare_stream(parent, host, port, is_rtp, options.rtmp_location)
        if options.image_topic:
            self._images = valid_topic(options.image_topic)
        self.listen(valid_topic(options.enable_topic or f"{self._images}/enable_streaming"), _BOOL, self._on_request)


class Px4GstCameraOptions(Options):
    """Options of `libgazebo_gst_camera_plugin.so`."""

    udp_host: str = text(LOOPBACK, element="udpHost")
    udp_port: int = integer(5600, element="udpPort", minimum=1, maximum=65535)
    rtmp_location: str = text(element="rtmpLocation")
    use_rtmp_pipeline: bool = without_effect(element="useRtmpPipeline")
    use_cuda: bool = without_effect(element="useCuda")
    robot_namespace: bool = without_effect(element="robotNamespace")


class Px4GstCamera(VideoStreamPlugin):
    """Streams the images of its camera as H.264 in RTP to `<udpPort>` of this machine, on request.

    A `Bool`, or an `Int32` that is not zero, on `/video_stream` begins the stream; in Gazebo Classic it begins at once.
    """

    endpoints = (listens("/video_stream", _BOOL, _INT),)
    options = OptionsOf(Px4GstCameraOptions)
    filenames = ("libgazebo_gst_camera_plugin.so",)

    def load(self, parent: Sensor, params: Params) -> None:
        options = self.options.read_all()
        self._prepare_stream(parent, options.udp_host, options.udp_port, True, options.rtmp_location)
        self.listen("/video_stream", (_BOOL, _INT), self._on_request)


def _is_loopback(host: str) -> bool:
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"
