"""Artefacts of sensors: a sample with each of them, compared with the same sample without.

python benchmarks/artefacts.py [--rounds N]

One time includes the steps between two samples and a callback for the message.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import partial

from measure import arguments, report

import simkit
from simkit.cli.bench_figures import Figure, time_interleaved

WORLD = """<sdf version="1.9" xmlns:simkit="simkit"><world name="w"><gravity>0 0 0</gravity>
  <spherical_coordinates><latitude_deg>48</latitude_deg><longitude_deg>11</longitude_deg></spherical_coordinates>
  <model name="m"><pose>0 0 0.5 0 0 0</pose><link name="l"><inertial><mass>1</mass></inertial>
  <sensor name="s" type="{kind}"><update_rate>{rate}</update_rate><topic>s</topic>{block}{element}</sensor>
  </link></model>
  <model name="ball"><pose>3 0 0.5 0 0 0</pose><link name="l"><inertial><mass>1</mass></inertial><visual name="v">
  <geometry><sphere><radius>0.5</radius></sphere></geometry></visual></link></model>
  <model name="room"><static>true</static>{boxes}</model></world></sdf>"""
BOX = """<link name="b{0}"><pose>{1}</pose><collision name="c"><geometry><box><size>{2}</size></box></geometry>
  </collision><visual name="v"><geometry><box><size>{2}</size></box></geometry></visual></link>"""
BOXES = (
    ("5 0 1 0 0 0", "0.1 10 4"), ("-5 0 1 0 0 0", "0.1 10 4"), ("0 5 1 0 0 0", "10 0.1 4"),
    ("0 0 -0.05 0 0 0", "20 20 0.1"), ("2 1 0.4 0 0 0.5", "0.6 0.6 1"), ("1.2 -0.3 0.5 0 0 0", "0.1 0.1 1"),
)  # fmt: skip
LIDAR = """<lidar><scan><horizontal><samples>720</samples><min_angle>-3.1</min_angle><max_angle>3.1</max_angle>
  </horizontal></scan><range><min>0.1</min><max>20</max></range></lidar>"""
CAMERA = """<camera><horizontal_fov>1.2</horizontal_fov><image><width>640</width><height>480</height></image>
  <clip><near>0.1</near><far>20</far></clip></camera>"""


@dataclass(frozen=True)
class Family:
    """Sensor of one kind, and elements of it.

    Attributes:
        kind, block: type of the sensor, and its block.
        elements: content of each element, by its name and a remark after a comma.
        rate: samples per second.
        samples: samples of one timing.
        speed: speed of the ball in the picture [m/s].
    """

    kind: str
    block: str
    elements: dict[str, str]
    rate: float = 1000.0
    samples: int = 500
    speed: float = field(default=0.2)

    def load(self, element: str) -> simkit.Simulation:
        """Return a simulation with an element in the sensor, after the first samples."""
        boxes = "".join(BOX.format(i, *box) for i, box in enumerate(BOXES))
        text = WORLD.format(kind=self.kind, block=self.block, rate=self.rate, element=element, boxes=boxes)
        sim = simkit.load(text, render_thread=False)
        sim.model("ball").set_velocity(linear=(0.0, self.speed, 0.0))
        sim.subscribe("/s", lambda message: None)
        sim.run(2.5 / self.rate)
        return sim


SHUTTER = "<type>rolling</type><line_time>0.00003</line_time><exposure>0.01</exposure><sub_frames>{}</sub_frames>"
ERROR = "<stddev>0.002</stddev><coefficient>0.0019</coefficient><exponent>2.36</exponent>"
HOLES = "<probability>0.1</probability><correlation_length>5</correlation_length>"
FAMILIES = (
    Family("imu", "<imu/>", {
        "calibration_error": "<angular_velocity><scale>0.01 0.01 0.01</scale></angular_velocity>",
        "bandwidth": "<angular_velocity>40</angular_velocity><order>2</order>",
        "saturation": "<angular_velocity>4</angular_velocity>",
    }),
    Family("navsat", "<navsat/>", {
        "outages": "<rate>0.01</rate><area><box>10 10 20 20</box></area>",
        "multipath": "<stddev>3</stddev>",
        "fix_types": "<fix><stddev>1</stddev></fix>",
    }),
    Family("altimeter", "<altimeter/>", {
        "latency_histogram": "<values>0.01 0.05</values><weights>3 1</weights>",
        "gaps": "<probability>0.01</probability><mean_length>3</mean_length>",
        "clock": "<offset>0.01</offset><drift>1e-5</drift>",
    }),
    Family("lidar", LIDAR, {
        "no_return": "<value>zero</value>",
        "blind_zone": "<range>0.5</range>",
        "dropout": "<probability>0.2</probability><burst_length>3</burst_length>",
        "sun": "<azimuth>1</azimuth><elevation>0.5</elevation>",
        "range_error": "<stddev><constant>0.01</constant><coefficient>0.002</coefficient></stddev>",
        "signal": "<range>6</range>",
        "glass_and_mirrors": "",
        "intensity": "",
        "beam": "<divergence>0.01</divergence>",
    }, samples=100),
    Family("depth_camera", CAMERA, {
        "depth_error": f"<scale>-0.012</scale>{ERROR}",
        "depth_error, noise of windows of 5 px": f"<correlation_length>5</correlation_length>{ERROR}",
        "depth_error, noise by angle": f"<incidence_exponent>1</incidence_exponent>{ERROR}",
        "depth_holes, by chance": HOLES,
        "depth_holes, that stay for 0.5 s": f"{HOLES}<correlation_time>0.5</correlation_time>",
        "depth_holes, by angle, wedge and vignetting": f"{HOLES}<vignetting>0.5</vignetting><incidence>"
        "<start>1.1</start><end>1.4</end></incidence><wedge><start>0.6</start><end>0.3</end></wedge>",
        "depth_holes, by brightness": f"{HOLES}<brightness><start>0.2</start><end>0.1</end></brightness>",
        "depth_holes, by named surface": f"{HOLES}<surface><name>room</name></surface>",
        "occlusion_shadow": "<baseline>0.05</baseline>",
        "flying_pixels": "",
        "multipath": "",
        "phase_wrap": "<range>3.75</range>",
        "lost_depth": "<value>nan</value>",
    }, rate=100.0, samples=3),
    Family("camera", CAMERA, {
        **{f"shutter, rolling, {n} sub-frames": SHUTTER.format(n) for n in (4, 8, 16, 32)},
        "vignetting": "",
        "exposure_control": "<mode>auto</mode>",
        "image_sensor": "<read_noise>5</read_noise>",
        "white_balance": "<gains>0.9 1 1.1</gains>",
    }, rate=25.0, samples=3),
    Family("camera", CAMERA, {"shutter, rolling, 8 sub-frames, nothing moves": SHUTTER.format(8)}, 25.0, 3, 0.0),
)  # fmt: skip


def rows(rounds: int) -> Iterator[Figure]:
    """Yield the time of a sample with each element, and of one without."""
    for family in FAMILIES:
        for name, content in family.elements.items():
            element = name.partition(",")[0]
            with ExitStack() as stack:
                sides: list[Callable[[], object]] = []
                for text in (f"<simkit:{element}>{content}</simkit:{element}>", ""):
                    sim = stack.enter_context(family.load(text))
                    sides.append(partial(sim.run, family.samples / family.rate))
                times = [time / family.samples for time in time_interleaved(sides, rounds)]
            yield Figure(f"{family.kind}: {name}", "sample", *times)


if __name__ == "__main__":
    report(rows(arguments(__doc__, 9).rounds))
