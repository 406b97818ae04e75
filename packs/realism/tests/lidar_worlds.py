"""Small worlds with one lidar, for tests of its artefacts."""

from __future__ import annotations

from typing import Any

import numpy as np

import simkit

HEAD = '<sdf version="1.9" xmlns:simkit="simkit"><world name="w">'
TAIL = "</world></sdf>"


def lidar(artefacts: str, *, samples: int = 720, view: float = 0.5, kind: str = "lidar", more: str = "") -> str:
    """Return a model with a lidar at the origin that looks along x."""
    return f"""<model name="m"><static>true</static><link name="l"><sensor name="scan" type="{kind}">
      <update_rate>10</update_rate><lidar><scan><horizontal><samples>{samples}</samples>
      <min_angle>{-view}</min_angle><max_angle>{view}</max_angle></horizontal>{more}</scan>
      <range><min>0.1</min><max>30</max></range></lidar>{artefacts}</sensor></link></model>"""


def box(name: str, pose: str, size: str, optics: str = "") -> str:
    """Return a static box with the same collision and visual."""
    shape = f"<geometry><box><size>{size}</size></box></geometry>{optics}"
    return f"""<model name="{name}"><static>true</static><pose>{pose}</pose><link name="l">
      <collision name="c">{shape}</collision><visual name="v">{shape}</visual></link></model>"""


def shell(name: str, far: float, optics: str = "") -> str:
    """Return a wall that faces the sensor at a distance along x."""
    return box(name, f"{far + 0.05} 0 0 0 0 0", "0.1 40 40", optics)


def world(*parts: str) -> str:
    """Return a world."""
    return HEAD + "".join(parts) + TAIL


def readings(text: str, seconds: float = 0.1, seed: int = 0, **options: Any) -> tuple[Any, Any]:
    """Return the newest reading and its ground truth."""
    with simkit.load(text, seed=seed, **options) as sim:
        sim.run(seconds)
        sensor = sim.sensor("m::l::scan")
        return sensor.latest, sensor.truth


def many_ranges(text: str, samples: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Return the ranges of consecutive samples with and without errors, shape (samples, rays)."""
    with simkit.load(text, seed=seed) as sim:
        found, true = [], []
        for _ in range(samples):
            sim.run(0.1)
            sensor = sim.sensor("m::l::scan")
            found.append(np.asarray(sensor.latest.ranges))
            true.append(np.asarray(sensor.truth.ranges))
        return np.array(found), np.array(true)
