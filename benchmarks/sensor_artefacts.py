"""Cost of artefacts of sensors: CPU time of a sample without and with each element, in worlds of one sensor.

python benchmarks/sensor_artefacts.py [--rounds N]
"""

from __future__ import annotations

import statistics
import time

from measure import arguments

import simkit

WORLD = """<sdf version="1.9" xmlns:simkit="simkit"><world name="w"><gravity>0 0 0</gravity>
  <spherical_coordinates><latitude_deg>48</latitude_deg><longitude_deg>11</longitude_deg></spherical_coordinates>
  <model name="m"><link name="l"><inertial><mass>1</mass></inertial><sensor name="s" type="{kind}">
    <update_rate>1000</update_rate><topic>s</topic>{block}{artefact}</sensor></link></model>
  <model name="room"><static>true</static><link name="l">{walls}</link></model></world></sdf>"""
WALL = '<collision name="c{0}"><pose>{1}</pose><geometry><box><size>{2}</size></box></geometry></collision>'
WALLS = (
    ("5 0 0 0 0 0", "0.1 10 4"),
    ("-5 0 0 0 0 0", "0.1 10 4"),
    ("0 5 0 0 0 0", "10 0.1 4"),
    ("2 1 0 0 0 0.4", "1 1 2"),
)
LIDAR = """<lidar><scan><horizontal><samples>720</samples>
  <min_angle>-3.1</min_angle><max_angle>3.1</max_angle></horizontal>
  </scan><range><min>0.1</min><max>20</max></range></lidar>"""
BLOCKS = {"imu": "<imu/>", "navsat": "<navsat/>", "altimeter": "<altimeter/>", "lidar": LIDAR}
ROWS = (
    ("imu", "calibration_error", "<angular_velocity><scale>0.01 0.01 0.01</scale></angular_velocity>"),
    ("imu", "bandwidth", "<angular_velocity>40</angular_velocity><order>2</order>"),
    ("imu", "saturation", "<angular_velocity>4</angular_velocity>"),
    ("navsat", "outages", "<rate>0.01</rate><area><box>10 10 20 20</box></area>"),
    ("navsat", "multipath", "<stddev>3</stddev>"),
    ("navsat", "fix_types", "<fix><stddev>1</stddev></fix>"),
    ("altimeter", "latency_histogram", "<values>0.01 0.05</values><weights>3 1</weights>"),
    ("altimeter", "gaps", "<probability>0.01</probability><mean_length>3</mean_length>"),
    ("lidar", "dropout", "<probability>0.2</probability><burst_length>3</burst_length>"),
    ("lidar", "range_error", "<stddev><constant>0.01</constant><coefficient>0.002</coefficient></stddev>"),
    ("lidar", "signal", "<range>6</range>"),
    ("lidar", "intensity", ""),
    ("lidar", "blind_zone", "<range>0.5</range>"),
    ("lidar", "sun", "<azimuth>1</azimuth><elevation>0.5</elevation>"),
    ("lidar", "glass_and_mirrors", ""),
    ("lidar", "beam", "<divergence>0.01</divergence>"),
    ("lidar", "no_return", "<value>zero</value>"),
    ("altimeter", "clock", "<offset>0.01</offset><drift>1e-5</drift>"),
)
"""Kind of sensor, element, and content of the element."""


def seconds_a_sample(kind: str, artefact: str, rounds: int) -> float:
    """Return the median CPU time [s] of a step with a sample and a callback."""
    walls = "".join(WALL.format(i, *wall) for i, wall in enumerate(WALLS))
    with simkit.load(WORLD.format(kind=kind, block=BLOCKS[kind], artefact=artefact, walls=walls)) as sim:
        sim.subscribe("/s", lambda _: None)
        sim.step(200)
        times = []
        for _ in range(rounds):
            begun = time.process_time()
            sim.step(1000)
            times.append((time.process_time() - begun) / 1000)
    return statistics.median(times)


def main() -> None:
    rounds = arguments(__doc__, rounds=5).rounds
    plain = {kind: seconds_a_sample(kind, "", rounds) for kind in BLOCKS}
    for kind, name, content in ROWS:
        cost = seconds_a_sample(kind, f"<simkit:{name}>{content}</simkit:{name}>", rounds)
        print(f"{kind + '/' + name:30s} {plain[kind] * 1e6:7.1f} us -> {cost * 1e6:7.1f} us a sample", flush=True)


if __name__ == "__main__":
    main()
