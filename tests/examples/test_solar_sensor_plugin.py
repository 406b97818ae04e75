"""The solar sensor example points at its lamp, repeatably."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import simkit
from simkit.pose import Pose, quat_rotate

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "solar_sensor_plugin"


def readings(seed: int = 0, edit: tuple[str, str] = ("", "")) -> list[Any]:
    with simkit.load((EXAMPLE / "world.sdf").read_text().replace(*edit), plugin_paths=[EXAMPLE], seed=seed) as sim:
        subscription = sim.subscribe("/solar_compass")
        sim.run(0.5)
        return list(subscription.messages)


def points_at(message: Any) -> np.ndarray:
    q = message.orientation
    return quat_rotate((q.w, q.x, q.y, q.z), (1.0, 0.0, 0.0))


def test_without_noise_it_points_at_the_lamp() -> None:
    found = readings(edit=("<noise>0.002</noise>", ""))
    assert len(found) == 10
    # seen from 1 m up by a mast turned by 90°: (3, 4, 11) in the world is (4, -3, 11) in its axes
    np.testing.assert_allclose(points_at(found[-1]), np.array([4, -3, 11]) / np.sqrt(146), atol=1e-3)


def test_its_noise_is_what_the_file_says_and_repeats_with_the_seed() -> None:
    clean = points_at(readings(edit=("<noise>0.002</noise>", ""))[-1])
    first, again, other = ([points_at(m) for m in readings(seed)] for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert not np.array_equal(first, other)
    assert 0 < np.linalg.norm(first[-1] - clean) < 0.02


def test_an_unknown_lamp_is_an_error_that_lists_the_lights() -> None:
    with pytest.raises(simkit.LoadError, match="lights are: lamp"):
        readings(edit=("<lamp>lamp</lamp>", "<lamp>moon</lamp>"))


def test_it_follows_the_lamp_when_that_moves() -> None:
    text = (EXAMPLE / "world.sdf").read_text().replace("<noise>0.002</noise>", "")
    with simkit.load(text, plugin_paths=[EXAMPLE]) as sim:
        subscription = sim.subscribe("/solar_compass")
        sim.light("lamp").set_pose(Pose((0.0, 50.0, 1.0)))
        sim.run(0.2)
        np.testing.assert_allclose(points_at(subscription.latest), (1.0, 0.0, 0.0), atol=1e-3)
