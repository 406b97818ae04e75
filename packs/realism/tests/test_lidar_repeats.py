"""Artefacts of lidars repeat their bits: after a reset or restore, in another process, with and without readers."""

from __future__ import annotations

import hashlib
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from lidar_worlds import box, lidar, shell, world

import simkit

ALL = """
<simkit:dropout><probability>0.1</probability><burst_length>3</burst_length></simkit:dropout>
<simkit:signal><range>6</range><spread>0.2</spread></simkit:signal>
<simkit:range_error><stddev>0.01</stddev><inverse_resolution>0.0005</inverse_resolution></simkit:range_error>
<simkit:blind_zone><range>1</range><probability>0.5</probability></simkit:blind_zone>
<simkit:intensity><stddev>0.1</stddev></simkit:intensity>
<simkit:sun><azimuth>0.1</azimuth><probability>0.5</probability></simkit:sun>
<simkit:glass_and_mirrors/>
<simkit:beam><divergence>0.01</divergence><returns>dual</returns></simkit:beam>"""
PANE = "<simkit:transmittance>0.9</simkit:transmittance>"
BALL = """<model name="ball"><pose>2 0.3 0.5 0 0 0</pose><link name="l"><collision name="c"><geometry><sphere>
  <radius>0.3</radius></sphere></geometry></collision></link></model>"""
WORLD = world(lidar(ALL), shell("wall", 5.0), box("pane", "1.5 -0.3 0 0 0 0.4", "0.02 0.4 1", PANE), BALL)
SWEPT = WORLD.replace("</sensor>", "<simkit:sweep><duration>0.08</duration></simkit:sweep></sensor>")


def scan(sim: simkit.Simulation) -> tuple[bytes, bytes]:
    message = sim.sensor("m::l::scan").latest
    return message.ranges.tobytes(), message.intensities.tobytes()


def scans(sim: simkit.Simulation, count: int) -> list[tuple[bytes, bytes]]:
    found = []
    for _ in range(count):
        sim.run(0.1)
        found.append(scan(sim))
    return found


@pytest.fixture(scope="module")
def expected() -> list[tuple[bytes, bytes]]:
    with simkit.load(WORLD, seed=5) as sim:
        return scans(sim, 4)


def test_a_reset_repeats_the_bits(expected: list[tuple[bytes, bytes]]) -> None:
    with simkit.load(WORLD, seed=5) as sim:
        sim.run(0.25)
        sim.reset()
        assert scans(sim, 4) == expected


def test_a_restore_repeats_the_bits(expected: list[tuple[bytes, bytes]]) -> None:
    with simkit.load(WORLD, seed=5) as sim:
        sim.run(0.2)
        saved = sim.snapshot()
        assert scans(sim, 2) == expected[2:]
        sim.restore(saved)
        assert scans(sim, 2) == expected[2:]


def test_a_reader_changes_no_bit(expected: list[tuple[bytes, bytes]]) -> None:
    with simkit.load(WORLD, seed=5) as sim:
        sim.run(0.4)  # nobody reads the first samples
        assert scan(sim) == expected[3]
    heard = []
    with simkit.load(WORLD, seed=5) as sim:
        sim.subscribe(
            sim.sensor("m::l::scan").topic, lambda m: heard.append((m.ranges.tobytes(), m.intensities.tobytes()))
        )
        sim.run(0.4)
    assert heard[-4:] == expected


def test_another_process_has_the_same_bits(expected: list[tuple[bytes, bytes]], tmp_path: Path) -> None:
    (tmp_path / "w.sdf").write_text(WORLD)
    code = f"""import hashlib, simkit
with simkit.load({str(tmp_path / "w.sdf")!r}, seed=5) as sim:
    sim.run(0.4)
    message = sim.sensor("m::l::scan").latest
    print(hashlib.sha256(message.ranges.tobytes() + message.intensities.tobytes()).hexdigest())"""
    other = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert other.stdout.strip() == hashlib.sha256(b"".join(expected[3])).hexdigest()


def test_a_sweep_repeats_its_bits_from_the_middle_of_a_scan() -> None:
    with simkit.load(SWEPT, seed=5) as sim:
        sim.run(0.13)
        saved = sim.snapshot()
        expected = scans(sim, 2)
        sim.restore(saved)
        assert scans(sim, 2) == expected
        sim.reset()
        sim.run(0.13)
        assert scans(sim, 2) == expected


def test_the_truth_has_no_artefact() -> None:
    with simkit.load(WORLD, seed=5) as sim, simkit.load(WORLD.replace(ALL, ""), seed=5) as ideal:
        sim.run(0.1)
        ideal.run(0.1)
        truth = sim.sensor("m::l::scan").truth
        np.testing.assert_array_equal(truth.ranges, ideal.sensor("m::l::scan").truth.ranges)
        assert (sim.sensor("m::l::scan").latest.ranges != truth.ranges).any()
