"""Cameras with depth: RealSense of Intel, Astra of Orbbec, Xtion of ASUS."""

from __future__ import annotations

from simkit.sensors.presets.blocks import DEGREE
from simkit.sensors.presets.preset import Preset, Settings

_KINECT = (
    "Khoshelham and Oude Elberink, Accuracy and Resolution of Kinect Depth Data, Sensors 12 (2012): deviation, step"
)
_ONE_VIEW = "colours are drawn through the same field of view, as registered"


def _image(width: int, height: int, opening: float) -> Settings:
    """Size [px] and horizontal field of view [degrees]."""
    return {"horizontal_fov": round(opening * DEGREE, 6), "image": {"width": width, "height": height}}


def _devices(
    names: tuple[str, ...],
    maker: str,
    source: str,
    image: Settings,
    reach: tuple[float, float],
    noise: Settings | None = None,
    remark: str = "",
    unconfirmed: tuple[str, ...] = (),
) -> tuple[Preset, Preset]:
    """As `rgbd_camera`, which sees colours beyond the range of its depths, and as `depth_camera`.

    Args:
        names: of the device, the maker's first.
        image: of the depths.
        reach: nearest and farthest depth [m].
        noise: of disparities.
    """
    clip = {"clip": {"near": reach[0], "far": reach[1]}}
    blocks = {"rgbd_camera": {**image, "depth_camera": clip}, "depth_camera": {**image, **clip}}
    remarks = {"rgbd_camera": "; ".join(filter(None, (_ONE_VIEW, remark))), "depth_camera": remark}
    disparity = {"disparity_noise": noise} if noise else {}
    rgbd, depth = (
        Preset(
            names[0],
            kind,
            maker,
            source,
            {"camera": {**block, **disparity}},
            rate=30.0,
            aliases=names[1:],
            remark=remarks[kind],
            unconfirmed=unconfirmed,
        )
        for kind, block in blocks.items()
    )
    return rgbd, depth


PRESETS = (
    *_devices(
        ("RealSense R200", "R200"),
        "Intel",
        "librealsense 1, doc/camera_specs.md: nominal depths of 628 x 468, 56° x 43°, from 0.72 m; indoor range",
        _image(628, 468, 56.0),
        (0.72, 3.5),
        remark="30, 60 or 90 Hz; outdoors up to 10 m; baseline 70 mm; no noise: no deviation is published",
    ),
    *_devices(
        ("RealSense D435", "D435", "D435i", "RealSense D435i"),
        "Intel",
        "Intel D400 series data sheet 337029: field of view, minimum depth, baseline; tuning guide: 848 x 480 is its "
        "best mode; white paper on subpixel linearity: step",
        _image(848, 480, 87.0),
        (0.195, 10.0),
        {"stddev": 0.08, "step": 0.03125, "baseline": 0.05},
        remark="up to 90 Hz; best from 0.3 to 3 m; the accuracy of 2 % at 2 m is left out",
        unconfirmed=("near", "stddev"),
    ),
    *_devices(
        ("Astra", "Orbbec Astra"),
        "Orbbec",
        "Orbbec Astra product page: 640 x 480 at 30 Hz, 60° x 49.5°, 0.6 to 8 m, ±1 to 3 mm at 1 m",
        _image(640, 480, 60.0),
        (0.6, 8.0),
        {"stddev": 0.125, "baseline": 0.075},
        remark="square pixels have 46.8° of the 49.5°; deviation: our choice, 3 mm at 1 m",
        unconfirmed=("horizontal_fov", "stddev", "baseline"),
    ),
    *_devices(
        ("Xtion PRO LIVE", "Xtion", "Xtion PRO"),
        "ASUS",
        f"ASUS Xtion PRO LIVE specifications: 58° x 45°, 640 x 480 at 30 Hz, 0.8 to 3.5 m; {_KINECT}",
        _image(640, 480, 58.0),
        (0.8, 3.5),
        {"stddev": 0.06, "step": 0.125, "baseline": 0.075},
        remark="deviation: our choice, and the step: those of the Kinect, which has the same design (PrimeSense)",
        unconfirmed=("stddev", "step"),
    ),
)
