"""What each camera of the sensor bench sees at one instant: `python cameras.py [OUT.png]`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import plots

import simkit

TOPICS = (
    "/rover/camera/image",
    "/rover/rgbd/depth_image",
    "/rover/rgbd/points",
    "/rover/stereo/left/image",
    "/rover/stereo/right/image",
    "/rail/wide/image",
    "/rail/segmentation/colored_map",
    "/rail/boxes/detections_image",
    "/rail/thermal/image",
    "/rail/logical",
)


def main(out: Path) -> None:
    with simkit.load("sensor_bench") as sim:
        subscriptions = {topic: sim.subscribe(topic, keep=1) for topic in TOPICS}
        sim.run(1.21)
        seen = {topic: subscription.latest for topic, subscription in subscriptions.items()}
    figure, axes = plots.figure("One scene, nine times", rows=3, columns=3, figsize=(8.0, 6.6))
    (camera, depth, points), (stereo, wide, segmentation), (boxes, thermal, logical) = axes
    show(camera, "camera", pixels(seen["/rover/camera/image"]))
    show(depth, "rgbd_camera: depth, 0 to 4 m", pixels(seen["/rover/rgbd/depth_image"]), cmap="viridis", vmin=0, vmax=4)
    draw_cloud(points, seen["/rover/rgbd/points"])
    left, right = pixels(seen["/rover/stereo/left/image"]), pixels(seen["/rover/stereo/right/image"])
    show(stereo, "multicamera: red left, cyan right", np.dstack([left[..., 0], right[..., 1:]]))
    show(wide, "wide_angle_camera, 160°", pixels(seen["/rail/wide/image"]))
    show(segmentation, "segmentation_camera", pixels(seen["/rail/segmentation/colored_map"]))
    show(boxes, "boundingbox_camera", pixels(seen["/rail/boxes/detections_image"]))
    kelvin = pixels(seen["/rail/thermal/image"]) * 0.01
    show(thermal, "thermal_camera, 270 to 380 K", kelvin, cmap="inferno", vmin=270, vmax=380)
    draw_models(logical, seen["/rail/logical"])
    plots.save(figure, out, colours=256)


def pixels(image: Any) -> np.ndarray:
    """An image message as an array (h, w, 3), or (h, w) where it has one channel."""
    kind = {"rgb8": np.uint8, "mono16": np.uint16, "32FC1": np.float32}[image.encoding]
    values = np.asarray(image.data).view(kind)
    return values.reshape(image.height, image.width, -1).squeeze()


def show(axes: Any, title: str, picture: np.ndarray, **how: Any) -> None:
    axes.imshow(picture, **how)
    axes.set(title=title, xticks=[], yticks=[])
    axes.grid(False)
    axes.spines[:].set_visible(False)


def draw_cloud(axes: Any, cloud: Any) -> None:
    """Every second point from above, in its own colour."""
    layout = {"names": [f.name for f in cloud.fields], "offsets": [f.offset for f in cloud.fields]}
    points = np.asarray(cloud.data).view(np.dtype({**layout, "formats": ["<f4"] * 4, "itemsize": cloud.point_step}))
    points = points.reshape(cloud.height, cloud.width)[::2, ::2].ravel()
    points = points[np.isfinite(points["x"])]
    colours = np.ascontiguousarray(points["rgb"]).view(np.uint8).reshape(-1, 4)[:, 2::-1] / 255.0  # blue comes first
    axes.scatter(-points["y"], points["x"], c=colours, s=2, linewidths=0)
    axes.set(title="rgbd_camera: points from above", xlim=(-2.6, 2.6), ylim=(0, 4.1), xticks=[], yticks=[])


def draw_models(axes: Any, message: Any) -> None:
    """Where each model stands, seen from above; the camera is below, and looks up the page."""
    places: dict[tuple[float, float], list[str]] = {}
    for model in message.model:
        ahead, left = model.pose.position.x, model.pose.position.y
        near = next((place for place in places if abs(place[0] + left) + abs(place[1] - ahead) < 0.1), (-left, ahead))
        places.setdefault(near, []).append(model.name)
    for (x, y), names in places.items():
        axes.plot(x, y, "o", color=plots.BLUE, markersize=4)
        axes.annotate("\n".join(names), (x, y), xytext=(5, -6), textcoords="offset points", fontsize=7)
    axes.set(title="logical_camera", xlim=(-2.2, 2.8), ylim=(1.5, 4.8), xticks=[], yticks=[])


if __name__ == "__main__":
    plots.run(main, "cameras.png")
