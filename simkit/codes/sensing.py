"""What all sensors share: noise, timing, place."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import INERTIAL, link, model, python, sensor

_NOISE = "<imu>\n  <angular_velocity><x>\n    {noise}\n  </x></angular_velocity>\n</imu>"


def _noise(text: str) -> str:
    return _NOISE.format(noise=text)


_CHANGED_RATE = """
import simkit

sim = simkit.load("robot.sdf")
sim.publish("/imu/set_rate", {"data": -1.0})
sim.run(0.1)
"""
_WITH_TOPIC = link(
    '<sensor name="imu" type="imu">\n  <update_rate>10</update_rate>\n'
    "  <set_rate_topic>/imu/set_rate</set_rate_topic>\n</sensor>"
).text

CODES: tuple[Code, ...] = (
    Code(
        "SK-SENSOR-020",
        "warning",
        "a `<noise>` without a type is none, as in SDF",
        '`<noise type="gaussian">`',
        sensor("imu", _noise("<noise><stddev>0.1</stddev></noise>")),
    ),
    Code(
        "SK-SENSOR-021",
        "warning",
        "an element of `<noise>` that another one makes void",
        "[what goes together](sensors/noise.md)",
        sensor(
            "imu",
            _noise('<noise type="gaussian"><stddev>0.1</stddev><noise_density>0.001</noise_density></noise>'),
        ),
    ),
    Code(
        "SK-SENSOR-022",
        "error",
        "a jitter that would change the order of samples, or let a reading arrive before it was measured",
        "`<jitter>` less than half a period, `<latency_jitter>` at most the `<latency>`",
        sensor("imu", "<update_rate>10</update_rate>\n<jitter>0.08</jitter>"),
    ),
    Code(
        "SK-SENSOR-023",
        "warning",
        "a jitter that has no effect at this rate or step",
        "",
        sensor("imu", "<jitter>0.01</jitter>"),
    ),
    Code(
        "SK-SENSOR-024",
        "warning",
        "a sensor under a link that belongs to a joint, or the other way round",
        "move it",
        model(
            f'<link name="base">{INERTIAL}</link>\n<link name="arm">{INERTIAL}</link>\n'
            '<joint name="elbow" type="fixed">\n  <parent>base</parent><child>arm</child>\n'
            '  <sensor name="imu" type="imu"/>\n</joint>'
        ),
    ),
    Code(
        "SK-SENSOR-025",
        "note",
        "`<enable_metrics>` publishes no rates of the machine",
        "`simkit bench`",
        sensor("imu", "<enable_metrics>true</enable_metrics>"),
    ),
    Code(
        "SK-SENSOR-026",
        "warning",
        "a rate came in on a `<set_rate_topic>` that cannot be taken",
        "",
        python(_CHANGED_RATE, {"robot.sdf": _WITH_TOPIC}),
    ),
    Code(
        "SK-SENSOR-027",
        "warning",
        "two sensors publish on one topic",
        "give each a `<topic>` of its own",
        link(
            '<sensor name="left" type="imu"><topic>imu</topic></sensor>\n'
            '<sensor name="right" type="imu"><topic>imu</topic></sensor>'
        ),
    ),
    Code(
        "SK-SENSOR-028",
        "note",
        "a sensor's rate is more than the steps a second; it samples at every step",
        "a lower `<update_rate>`, or a smaller `<max_step_size>`",
        sensor("imu", "<update_rate>1e9</update_rate>"),
    ),
    Code(
        "SK-SENSOR-029",
        "note",
        "a rate below zero is every step, as in Gazebo",
        "`<update_rate>0</update_rate>`",
        sensor("imu", "<update_rate>-1</update_rate>"),
    ),
)
