"""The page on clients of a running simulation lists every request; runs of other processes accept clients."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from simkit.bridges.live import requests
from simkit.live import connect

PAGE = (Path(__file__).resolve().parents[3] / "docs" / "live.md").read_text(encoding="utf-8")


def test_the_requests_of_the_page_exist() -> None:
    table = PAGE[PAGE.index("| question |") :]
    assert set(requests.REQUESTS) >= set(re.findall(r"`([a-z_]+)`", "".join(re.findall(r"^\| (`.*?) \|", table, re.M))))


@pytest.mark.slow
def test_a_client_of_another_process_does_not_change_the_end_of_a_run(court_text: str, tmp_path: Path) -> None:
    world = tmp_path / "court.sdf"
    world.write_text(court_text, encoding="utf-8")
    command = [sys.executable, "-m", "simkit", "run", str(world), "--duration", "2", "--quiet"]
    root = str(Path(__file__).resolve().parents[3])
    environment = {**os.environ, "PYTHONPATH": root}
    plain = subprocess.run(command, capture_output=True, text=True, env=environment, check=True).stdout
    paused = subprocess.Popen([*command, "--paused"], stdout=subprocess.PIPE, text=True, env=environment)
    try:
        with connect(timeout=20.0, wait=20.0) as client:
            imu = client.subscribe("/imu")
            client.control("resume")
            assert len(list(imu)) + imu.lost >= 150
        assert paused.wait(20.0) == 0
        assert paused.stdout is not None
        assert paused.stdout.read().splitlines()[-1] == plain.splitlines()[-1], "the hash of the state"
    finally:
        if paused.poll() is None:
            paused.send_signal(signal.SIGKILL)
        paused.communicate()


def test_a_single_model_is_found_by_the_name_in_the_command() -> None:
    command = [sys.executable, "-m", "simkit", "run", "turtlebot3_burger", "--paused", "--duration", "1"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        with connect("turtlebot3_burger", wait=60.0) as client:
            assert client.info["world"] == "default"
    finally:
        process.send_signal(signal.SIGINT)
        process.wait()
