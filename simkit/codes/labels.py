"""Cameras that tell labels."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import sensor, world

_IMAGE = "<image><width>64</width><height>48</height>{}</image>"
_LABELLED = (
    '<model name="crate"><static>true</static><pose>2 0 0 0 0 0</pose><link name="l">\n'
    '  <visual name="v"><geometry><box><size>1 1 1</size></box></geometry></visual></link>\n'
    '  <plugin filename="gz-sim-label-system" name="gz::sim::systems::Label"><label>10</label></plugin></model>\n'
)


def _seen(content: str) -> str:
    return (
        f'{_LABELLED}<model name="eye"><static>true</static><link name="l">\n'
        f'  <sensor name="s" type="segmentation_camera">{content}</sensor></link></model>'
    )


_FORMAT = _seen(f"<camera>{_IMAGE.format('<format>L8</format>')}</camera>")
_NOISE = _seen(f'<camera>{_IMAGE.format("")}<noise type="gaussian"><stddev>0.1</stddev></noise></camera>')

CODES: tuple[Code, ...] = (
    Code(
        "SK-SENSOR-130",
        "warning",
        "a camera that tells labels has a pixel format of its own; its pictures are R8G8B8",
        "leave `<format>` out",
        world(_FORMAT),
    ),
    Code(
        "SK-SENSOR-131",
        "warning",
        "noise has no effect on a camera that tells labels",
        "leave `<noise>` out; labels are exact, as in Gazebo",
        world(_NOISE),
    ),
    Code(
        "SK-SENSOR-132",
        "warning",
        "a camera that tells labels, and nothing in the world has one: all is background, and there are no boxes",
        "the Label plugin in a `<model>` or a `<visual>`, or `sim.labels[name] = 10`",
        sensor("segmentation_camera", f"<camera>{_IMAGE.format('')}</camera>"),
    ),
)
