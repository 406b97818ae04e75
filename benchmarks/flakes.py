"""Whether checks of golden runs flake: a world with noise, checked again and again, must never be told to be other.

Bit by bit, with tolerances, and, each time with another seed, by the statistics of its noise.

    python benchmarks/flakes.py [--checks 10000]
"""

from __future__ import annotations

import argparse
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import measure  # noqa: F401 - puts the checkout on the path

IMU = """<sensor name="imu" type="imu"><update_rate>500</update_rate><topic>imu</topic><imu><linear_acceleration>
<x><noise type="gaussian"><stddev>0.02</stddev></noise></x>
<y><noise type="gaussian"><mean>0.01</mean><stddev>0.02</stddev></noise></y></linear_acceleration></imu></sensor>"""
LIDAR = """<sensor name="lidar" type="lidar"><pose>0 0 0.2 0 0 0</pose><update_rate>20</update_rate><topic>scan</topic>
<lidar><scan><horizontal><samples>90</samples><min_angle>-1.5</min_angle><max_angle>1.5</max_angle></horizontal></scan>
<range><min>0.1</min><max>10</max></range><noise><type>gaussian</type><stddev>0.01</stddev></noise></lidar></sensor>"""
WORLD = f"""<sdf version="1.9"><world name="w">
<model name="ball"><pose>0 0 0.15 0 0 0</pose><link name="b"><inertial><mass>1</mass></inertial>
<collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>{IMU}{LIDAR}</link></model>
<model name="floor"><static>1</static><link name="l"><collision name="c"><geometry><plane/></geometry>
</collision></link>
</model><model name="wall"><static>1</static><pose>2 0 0.5 0 0 0</pose><link name="l">
<collision name="c"><geometry><box><size>0.2 8 1</size></box></geometry></collision></link></model></world></sdf>"""


def main() -> None:
    from simkit.run_spec import RunSpec, Tolerance
    from simkit.testing.golden.compare.runs import compare
    from simkit.testing.golden.store import read_golden, write_golden
    from simkit.testing.run_record.run_recorder import record_run

    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--checks", type=int, default=10_000, help="in all")
    given = parser.parse_args()

    noise = (Tolerance("/imu", statistics=True), Tolerance("/scan", statistics=True), Tolerance("*points", ignore=True))
    plain, noisy = RunSpec(WORLD, 0.5), RunSpec(WORLD, 0.5, tolerances=noise, state=False)

    def run(scenario: Any) -> Any:
        record = record_run(scenario)
        record.simulation.close()
        record.simulation = None
        return record

    begun = time.perf_counter()
    flaked = dict.fromkeys(("bits", "tolerances", "statistics"), 0)
    rounds = -(-given.checks // len(flaked))
    with tempfile.TemporaryDirectory() as folder:
        first, second = Path(folder) / "plain", Path(folder) / "noisy"
        write_golden(first, run(plain), reason="as it is")
        write_golden(second, run(noisy), reason="as it is")
        for number in range(rounds):
            found = {
                "bits": compare(read_golden(first), run(plain)),
                "tolerances": compare(read_golden(first), run(plain), exact=False),
                "statistics": compare(read_golden(second), run(replace(noisy, seed=number + 1))),
            }
            for kind, comparison in found.items():
                if not comparison.passed:
                    flaked[kind] += 1
                    print(f"{kind}, round {number}: {comparison.differences[0].words}", flush=True)
    told = ", ".join(f"{count} by {kind}" for kind, count in flaked.items())
    print(f"{rounds * len(flaked)} checks in {time.perf_counter() - begun:.0f} s; flaked: {told}")


if __name__ == "__main__":
    main()
