"""Processor time of an update of `amcl` with 500 particles and 360 rays, in the house. Aim: at most 2 ms.

python benchmarks/localisation.py [--rounds N]
"""

from __future__ import annotations

import statistics
import time
from typing import Any

from measure import arguments

import simkit
from simkit_navigation.plugins.localisation.amcl import Amcl
from simkit_navigation.plugins.maps.map_server import MapServer

SECONDS = 4.0
OPTIONS: dict[str, Any] = {"min_particles": 500, "max_particles": 500, "max_beams": 360, "update_min_d": 0.0}


def processor_time(sim: simkit.Simulation) -> float:
    begin = time.process_time()
    sim.run(SECONDS)
    return time.process_time() - begin


def main() -> None:
    rounds = arguments(__doc__, rounds=9).rounds
    with simkit.load("turtlebot3_house", plugins=[MapServer(), Amcl(**OPTIONS)]) as sim:
        poses = sim.subscribe("/amcl_pose")
        scans_only = [processor_time(sim) for _ in range(rounds)]  # no initial pose: scans are made, but not used
        pose = sim.model("turtlebot3").pose
        sim.call("/set_initial_pose", {"pose": {"pose": {"pose": simkit.msgs.pose_message(pose)}}})
        with_amcl = [processor_time(sim) for _ in range(rounds)]
        updates = len(poses.messages) / rounds
    extra = (statistics.median(with_amcl) - statistics.median(scans_only)) / updates
    print(f"an update of amcl with 500 particles and 360 rays {extra * 1e3:.2f} ms   aim <= 2 ms")


if __name__ == "__main__":
    main()
