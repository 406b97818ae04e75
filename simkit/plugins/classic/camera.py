"""Cameras of Gazebo Classic: `libgazebo_ros_camera.so` of ROS 2 and ROS 1, and ROS 1's variants, depth and stereo."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from simkit.params import Params
from simkit.plugins.classic import camera_settings
from simkit.plugins.classic.camera_settings import CameraNames, CameraOptions, CameraPlugin
from simkit.plugins.endpoints import listens, publishes
from simkit.plugins.options import OptionsOf, boolean, number, text, without_effect

if TYPE_CHECKING:
    from simkit.sensors.cameras.multicamera import MultiCamera
    from simkit.sensors.cameras.rendered_camera import RenderedCamera
    from simkit.sensors.cameras.rgbd_camera import RgbdCamera

_NEAREST = 0.4  # [m], default of <min_depth>


class GazeboRosCameraOptions(CameraOptions):
    """Options of `GazeboRosCamera`."""

    min_depth: float = number(_NEAREST, "m", minimum=0, maximum=camera_settings.FARTHEST)
    max_depth: float = number(math.inf, "m", minimum=0, finite=False)
    triggered: bool = boolean()
    trigger_topic_name: bool = without_effect(element="triggerTopicName")


class GazeboRosCamera(CameraPlugin):
    """Publishes its camera below `<camera_name>` (by default the sensor's name), in the link's frame.

    The topics are `image_raw` and `camera_info`. A depth camera also has `depth/image_raw`, `depth/camera_info` and
    `points`; the points are in an optical frame. A multicamera has `image_raw` and `camera_info` below the name of each
    of its cameras. `<hack_baseline>` [m] sets the baseline in the projection matrix; in a multicamera it applies to all
    cameras except the left one. If `<triggered>` is true, each message on `image_trigger` takes one picture at the next
    time that the sensor's rate allows. `<min_depth>` and `<max_depth>` [m] limit the depths. Files for ROS 1 write
    `<cameraName>`, `<imageTopicName>`, `<cameraInfoTopicName>`, `<frameName>`, `<updateRate>` and others.
    """

    endpoints = (
        *CameraPlugin.endpoints,
        publishes("{camera_name}/depth/image_raw", "sensor_msgs/msg/Image"),
        publishes("{camera_name}/depth/camera_info", "sensor_msgs/msg/CameraInfo"),
        publishes("{camera_name}/points", "sensor_msgs/msg/PointCloud2"),
        listens("{camera_name}/image_trigger", "std_msgs/msg/Empty", "std_msgs/msg/Bool"),
    )
    options = OptionsOf(GazeboRosCameraOptions)
    filenames = ("libgazebo_ros_camera.so",)
    only_publishes = True

    def load(self, parent: Any, params: Params) -> None:
        if hasattr(parent, "eyes"):
            connect_stereo(self, parent, CameraNames(self, parent), lambda name: name)
        elif camera_settings.is_camera(self, parent, "camera, depth or multicamera"):
            names = CameraNames(self, parent)
            topics = image_topics(names)
            if parent.has_depth:
                near, far = camera_settings.read_depths(self.options, "min_depth", "max_depth")
                parent.set_depth_range(near, far if math.isfinite(far) else None)
                topics["depth_image"] = names.topic("depth/image_raw")
                topics["depth_camera_info"] = names.topic("depth/camera_info")
                topics["points"] = names.topic("points")
                parent.use_optical_cloud_axes()
            connect_camera(self, parent, names, topics)
        if self.options.triggered and hasattr(parent, "trigger_on"):
            parent.trigger_on(CameraNames(self, parent).topic("image_trigger"), camera_settings.EMPTY, counts=True)


class TriggeredCameraOptions(CameraOptions):
    """Options of the cameras that a message triggers."""

    trigger_topic_name: str = text("image_trigger", element="triggerTopicName")


class GazeboRosTriggeredCamera(CameraPlugin):
    """Publishes a ROS 1 camera that takes a picture only after a message on `<triggerTopicName>` (`image_trigger`)."""

    options = OptionsOf(TriggeredCameraOptions)
    filenames = ("libgazebo_ros_triggered_camera.so",)

    def load(self, parent: RenderedCamera, params: Params) -> None:
        if camera_settings.is_camera(self, parent, "camera"):
            names = CameraNames(self, parent, is_ros_1=True)
            connect_camera(self, parent, names, image_topics(names))
            connect_trigger(self, parent, names)


class ProsilicaOptions(CameraOptions):
    """Options of `GazeboRosProsilica`."""

    poll_service_name: bool = without_effect(element="pollServiceName")
    trigger_mode: bool = without_effect()


class GazeboRosProsilica(CameraPlugin):
    """Publishes pictures like the ROS 1 camera; polling is not supported, because its services do not exist."""

    options = OptionsOf(ProsilicaOptions)
    filenames = ("libgazebo_ros_prosilica.so",)

    def load(self, parent: RenderedCamera, params: Params) -> None:
        if camera_settings.is_camera(self, parent, "camera"):
            names = CameraNames(self, parent, is_ros_1=True)
            connect_camera(self, parent, names, image_topics(names))
            why = "its services do not exist; the camera streams"
            camera_settings.report_without_effect(self, {"pollServiceName": why, "trigger_mode": why})


def image_topics(names: CameraNames) -> dict[str, str]:
    """Return the topic of each product (image, depth image, point cloud, …) of a camera with one lens."""
    return {"image": names.topic(names.image), "camera_info": names.topic(names.info)}


def connect_camera(plugin: CameraPlugin, sensor: RenderedCamera, names: CameraNames, topics: dict[str, str]) -> None:
    """Set the topics and the frame of a camera, and apply the parameters that all camera plugins share."""
    baseline = plugin.options.hack_baseline
    camera_settings.name_frame(plugin, sensor)
    if names.is_ros_1:
        camera_settings.apply_update_rate(plugin, sensor)
    camera_settings.override_intrinsics(plugin, sensor, is_ros_1=names.is_ros_1)
    camera_settings.report_without_effect(plugin, camera_settings.CROP)
    if baseline:
        sensor.set_baseline(baseline)
    sensor.publish_on(topics)


def connect_stereo(
    plugin: CameraPlugin, sensor: MultiCamera, names: CameraNames, camera_namespace: Callable[[str], str]
) -> None:
    """Set the topics and the frame of a multicamera, and apply the parameters that all camera plugins share.

    Args:
        plugin: camera plugin.
        sensor: multicamera.
        names: names of the topics in the file.
        camera_namespace: function from a camera's name to the namespace of its topics.
    """
    topics = {}
    for eye in sensor.eyes:
        topics[f"{eye.name}/image"] = names.topic(names.image, camera_namespace(eye.name))
        topics[f"{eye.name}/camera_info"] = names.topic(names.info, camera_namespace(eye.name))
    connect_camera(plugin, sensor, names, topics)


def connect_trigger(plugin: CameraPlugin, sensor: RenderedCamera, names: CameraNames) -> None:
    """Take pictures only after a message on `<triggerTopicName>`, as in ROS 1."""
    topic = TriggeredCameraOptions(plugin.params).trigger_topic_name
    sensor.trigger_on(names.topic(topic), camera_settings.EMPTY)


_CUTOFF, _CUTOFF_MAX = 0.4, 5.0  # [m], defaults
_NOT_DRAWN = {
    "reflectanceTopicName": "there is no reflectance",
    "normalsTopicName": "there are no normals",
    "reduceNormals": "there are no normals",
}


class Ros1DepthCameraOptions(CameraOptions):
    """Options of the depth cameras of ROS 1."""

    use_depth_16_uc_1_format: bool = boolean(element="useDepth16UC1Format")
    depth_image_topic_name: str = text("depth/image_raw", element="depthImageTopicName")
    depth_image_camera_info_topic_name: str = text("depth/camera_info", element="depthImageCameraInfoTopicName")
    point_cloud_topic_name: str = text("points", element="pointCloudTopicName")
    point_cloud_cutoff: float = number(
        _CUTOFF, "m", element="pointCloudCutoff", minimum=0, maximum=camera_settings.FARTHEST
    )


class GazeboRosDepthCameraOptions(Ros1DepthCameraOptions):
    """Options of `GazeboRosDepthCamera`."""

    reflectance_topic_name: bool = without_effect(element="reflectanceTopicName")
    normals_topic_name: bool = without_effect(element="normalsTopicName")
    reduce_normals: bool = without_effect(element="reduceNormals")


class KinectOptions(Ros1DepthCameraOptions):
    """Options of `GazeboRosOpenniKinect`."""

    point_cloud_cutoff_max: float = number(_CUTOFF_MAX, "m", element="pointCloudCutoffMax", minimum=0, finite=False)


class Ros1DepthCamera(CameraPlugin):
    """Base of the depth cameras of ROS 1."""

    endpoints = (
        *CameraPlugin.endpoints,
        publishes("{camera_name}/depth/image_raw", "sensor_msgs/msg/Image", named_by=("depthImageTopicName",)),
        publishes(
            "{camera_name}/depth/camera_info", "sensor_msgs/msg/CameraInfo", named_by=("depthImageCameraInfoTopicName",)
        ),
        publishes("{camera_name}/points", "sensor_msgs/msg/PointCloud2", named_by=("pointCloudTopicName",)),
    )
    options = OptionsOf(Ros1DepthCameraOptions)


class GazeboRosDepthCamera(Ros1DepthCamera):
    """Publishes a depth camera below `<cameraName>` in an optical frame: `<frameName>` or the link's frame.

    The topics are `<imageTopicName>` (image_raw), `<cameraInfoTopicName>` (camera_info), `<depthImageTopicName>`
    (depth/image_raw), `<depthImageCameraInfoTopicName>` (depth/camera_info), `<pointCloudTopicName>` (points). Depths
    up to `<pointCloudCutoff>` [m] (0.4) are NaN, in the image and in the cloud. With `<useDepth16UC1Format>` the image
    is in millimetres, and these depths are 0. All other parameters are the same as for `libgazebo_ros_camera.so` in ROS
    1.
    """

    options = OptionsOf(GazeboRosDepthCameraOptions)
    filenames = ("libgazebo_ros_depth_camera.so",)

    def load(self, parent: RgbdCamera, params: Params) -> None:
        connect_depth_camera(self, parent, self.options.point_cloud_cutoff, math.inf)
        camera_settings.report_without_effect(self, _NOT_DRAWN)


class GazeboRosOpenniKinect(Ros1DepthCamera):
    """Publishes a depth camera like `libgazebo_ros_depth_camera.so`.

    Depths beyond `<pointCloudCutoffMax>` [m] (5) are NaN as well.
    """

    options = OptionsOf(KinectOptions)
    filenames = ("libgazebo_ros_openni_kinect.so",)

    def load(self, parent: RgbdCamera, params: Params) -> None:
        depths = camera_settings.read_depths(self.options, "point_cloud_cutoff", "point_cloud_cutoff_max")
        connect_depth_camera(self, parent, *depths)


def connect_depth_camera(plugin: Ros1DepthCamera, sensor: RgbdCamera, near: float, far: float) -> None:
    """Publish a depth camera whose depths [m] are limited to the range from `near` to `far`."""
    options = plugin.options
    in_millimetres = options.use_depth_16_uc_1_format
    if not camera_settings.is_camera(plugin, sensor, "depth", "points"):
        return
    names = CameraNames(plugin, sensor, is_ros_1=True)
    sensor.crop_depth_images(near, far, in_millimetres=in_millimetres)
    sensor.crop_clouds(near, far)
    sensor.use_optical_cloud_axes()
    topics = {
        "depth_image": options.depth_image_topic_name,
        "depth_camera_info": options.depth_image_camera_info_topic_name,
        "points": options.point_cloud_topic_name,
    }
    connect_camera(
        plugin, sensor, names, image_topics(names) | {name: names.topic(topic) for name, topic in topics.items()}
    )


class GazeboRosMultiCamera(CameraPlugin):
    """Publishes a multicamera below `<cameraName>/left` and `<cameraName>/right`; other cameras use their own names.

    A camera whose name contains `left` or `right` is the left or the right camera. `<hackBaseline>` [m] sets the
    baseline in the projection matrix of the right camera; the default follows from the cameras' poses.
    """

    filenames = ("libgazebo_ros_multicamera.so",)

    def load(self, parent: MultiCamera, params: Params) -> None:
        connect_multicamera(self, parent)


class GazeboRosTriggeredMultiCamera(CameraPlugin):
    """Publishes a multicamera after each message on `<triggerTopicName>` (`image_trigger`) below `<cameraName>`."""

    options = OptionsOf(TriggeredCameraOptions)
    filenames = ("libgazebo_ros_triggered_multicamera.so",)

    def load(self, parent: MultiCamera, params: Params) -> None:
        names = connect_multicamera(self, parent)
        if names is not None:
            connect_trigger(self, parent, names)


def connect_multicamera(plugin: CameraPlugin, sensor: MultiCamera) -> CameraNames | None:
    """Set the topics of a multicamera; return None after an error if the sensor is not a multicamera."""
    if not hasattr(sensor, "eyes"):
        plugin.refuse(sensor, "multicamera")
        return None
    names = CameraNames(plugin, sensor, is_ros_1=True)
    connect_stereo(plugin, sensor, names, _side)
    return names


def _side(name: str) -> str:
    return next((side for side in ("left", "right") if side in name), name)
