"""Batteries, detectors, messages that answer messages, logs."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import INERTIAL, model, python, world

_LINK = f'<link name="base">{INERTIAL}</link>'


def _answer(inner: str) -> str:
    kind = 'filename="gz-sim-triggered-publisher-system" name="gz::sim::systems::TriggeredPublisher"'
    return f"<plugin {kind}>\n{inner}\n</plugin>"


_DETECTOR = f"""
<model name="gate">
  {_LINK}
  <plugin filename="gz-sim-performer-detector-system" name="gz::sim::systems::PerformerDetector">
    <geometry><box><size>1 1 1</size></box></geometry>
  </plugin>
</model>
"""


def _performers(inner: str) -> str:
    return f'<plugin name="gz::sim" filename="dummy">\n{inner}\n</plugin>'


_PERFORMER = '<performer name="p"><ref>robot</ref>\n  <geometry><box><size>1 1 1</size></box></geometry></performer>'
_BATTERY = f"""
{_LINK}
<plugin filename="gz-sim-linearbatteryplugin-system" name="gz::sim::systems::LinearBatteryPlugin">
  <battery_name>main</battery_name><voltage>12</voltage>
  <open_circuit_voltage_constant_coef>12</open_circuit_voltage_constant_coef>
  <capacity>2</capacity><initial_charge>3</initial_charge><power_load>5</power_load>
</plugin>
"""
_NO_SERVICE = """
import simkit

WORLD = '''<sdf version="1.9"><world name="w">
<plugin filename="gz-sim-triggered-publisher-system" name="gz::sim::systems::TriggeredPublisher">
  <input type="gz.msgs.Empty" topic="/start"/>
  <service name="/world/w/set_pos" reqType="gz.msgs.Pose" repType="gz.msgs.Boolean" timeout="100" reqMsg="name: 'a'"/>
</plugin></world></sdf>'''
with simkit.load(WORLD) as sim:
    sim.publish("/start", {})
    sim.run(0.1)
"""


def _log(kind: str, inner: str) -> str:
    return f'<plugin filename="gz-sim-log-system" name="gz::sim::systems::{kind}">\n  {inner}\n</plugin>'


CODES: tuple[Code, ...] = (
    Code(
        "SK-PLUGIN-120",
        "error",
        "a TriggeredPublisher names a type of message that no topic or service here has",
        "a type of `gz.msgs` that the bridge to ROS knows; the message lists them",
        world(_answer('  <input type="gz.msgs.Bolean" topic="/a"/>\n  <output type="gz.msgs.Empty" topic="/b"/>')),
    ),
    Code(
        "SK-PLUGIN-121",
        "error",
        "a message in protobuf's text form cannot be read, or names a field that its type does not have",
        "`field: value` and `field { … }`, as `gz topic -p` takes them",
        world(
            _answer(
                '  <input type="gz.msgs.Empty" topic="/a"/>\n'
                '  <output type="gz.msgs.Twist" topic="/b">linear: {forward: 1}</output>'
            )
        ),
    ),
    Code(
        "SK-PLUGIN-122",
        "warning",
        "a service that a TriggeredPublisher calls is not there, or did not succeed",
        "the name and the type of a service that the world has",
        python(_NO_SERVICE),
    ),
    Code(
        "SK-PLUGIN-123",
        "warning",
        "a number of a battery is missing or cannot be, and another is used",
        "what the message says",
        model(_BATTERY),
    ),
    Code(
        "SK-PLUGIN-124",
        "warning",
        "part of what a plugin is told has no effect: it is empty, or there is one too many",
        "fill it in, or leave it out",
        world(
            _answer(
                '  <input type="gz.msgs.Boolean" topic="/a">\n'
                "    <match>data: true</match><match/>\n  </input>\n"
                '  <output type="gz.msgs.Empty" topic="/b"/>'
            )
        ),
    ),
    Code(
        "SK-PLUGIN-125",
        "warning",
        "a performer's model is not there, or a detector has no performers to look for",
        'a `<performer>` in the world\'s `<plugin name="gz::sim" filename="dummy">`, whose `<ref>` is a model',
        world(_performers(_PERFORMER) + "\n" + _DETECTOR),
    ),
    Code(
        "SK-PLUGIN-126",
        "note",
        "levels of a world have no effect: every model is there from the start",
        "nothing",
        world(_performers('<level name="hall"/>')),
    ),
    Code(
        "SK-PLUGIN-127",
        "warning",
        "a LogRecord does not record, or no longer",
        "a `<record_path>` below the working directory or a folder in `SIMKIT_SAVE_PATH`; or `simkit run --record`",
        world(_log("LogRecord", "<record_path>/var/logs</record_path>")),
    ),
    Code(
        "SK-PLUGIN-128",
        "note",
        "a LogRecord does without what its bag has no use for",
        "nothing",
        world(_log("LogRecord", "<record_path>log</record_path><compress>true</compress>")),
    ),
    Code(
        "SK-PLUGIN-129",
        "warning",
        "a world is to play back a log of Gazebo, which simkit does not read",
        "run the world with the same seed; read bags with `simkit topic echo --bag`",
        world(_log("LogPlayback", "<playback_path>log</playback_path>")),
    ),
)
