"""Force-torque sensors, encoders, and kinds that are known and not simulated."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import joint, model, sensor, world

_LINKS = '<link name="base"/>\n<link name="arm"/>\n'
_WRIST = '<sensor name="wrist" type="force_torque"><force_torque/></sensor>'

CODES: tuple[Code, ...] = (
    Code(
        "SK-SENSOR-050",
        "warning",
        "a sensor on a joint that carries or moves nothing: both links never move, or the joint binds none; it reads "
        "zero",
        "",
        model(
            f"<static>true</static>\n{_LINKS}"
            f'<joint name="elbow" type="fixed">\n  <parent>base</parent><child>arm</child>\n  {_WRIST}\n</joint>'
        ),
    ),
    Code(
        "SK-SENSOR-051",
        "error",
        "an encoder on a joint that has nothing to count, or counts per revolution of one that slides",
        "a joint that turns or slides; a `<resolution>` in metres",
        joint('<sensor name="encoder" type="encoder"><encoder/></sensor>', kind="fixed"),
    ),
    Code(
        "SK-SENSOR-052",
        "warning",
        "a kind of sensor that is known and read, but not simulated; it gives no readings",
        "",
        sensor("wireless_receiver", "<transceiver><gain>2.5</gain><power>14.5</power></transceiver>"),
    ),
    Code(
        "SK-SENSOR-053",
        "warning",
        "a sensor on a joint of the world itself; it is left out",
        "put the joint into one of the models that it ties",
        world(
            '<model name="lamp"><link name="arm"/></model>\n'
            f'<joint name="hook" type="fixed">\n  <parent>world</parent><child>lamp::arm</child>\n  {_WRIST}\n</joint>'
        ),
    ),
)
