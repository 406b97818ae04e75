"""Lenses of cameras."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import sensor

_IMAGE = "<image><width>64</width><height>48</height></image>"


def _camera(content: str, hfov: float = 1.2) -> str:
    return f"<camera>\n  <horizontal_fov>{hfov}</horizontal_fov>\n  {_IMAGE}\n  {content}\n</camera>"


CODES: tuple[Code, ...] = (
    Code(
        "SK-SENSOR-100",
        "warning",
        "the centre of a lens distortion is off the principal point: it is drawn so, and `CameraInfo` cannot say it",
        "move the principal point with `<lens><intrinsics>`; a `<center>` of 0.5 0.5 is the principal point",
        sensor("camera", _camera("<distortion><k1>0.1</k1><center>0.4 0.5</center></distortion>")),
    ),
    Code(
        "SK-SENSOR-101",
        "warning",
        "a lens distortion folds back within the picture, which stays black from there on",
        "Brown's model holds up to the radius where 1 + 3·k1·r² + 5·k2·r⁴ + 7·k3·r⁶ is 0",
        sensor("camera", _camera("<distortion><k1>-0.6</k1></distortion>", hfov=1.6)),
    ),
    Code(
        "SK-SENSOR-102",
        "note",
        "ROS's four coefficients describe a wide lens to more than half a pixel only",
        "a smaller `<cutoff_angle>` lets them fit better",
        sensor(
            "wide_angle_camera",
            _camera("<lens><type>stereographic</type><cutoff_angle>3.1</cutoff_angle></lens>", hfov=6),
        ),
    ),
    Code(
        "SK-SENSOR-103",
        "warning",
        "an element that a wide lens, or this type of it, has no use for",
        "`<custom_function>` is for `<type>custom</type>`; `<intrinsics>`, `<projection>` and `<distortion>` are for a "
        "`camera`",
        sensor(
            "wide_angle_camera",
            _camera("<lens><type>equidistant</type><custom_function><c1>2</c1></custom_function></lens>"),
        ),
    ),
)
