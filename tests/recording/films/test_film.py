"""Films: frames at equal steps of simulated time, files that are whole, and no changed bit."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

import simkit
from simkit.errors import InputError
from simkit.recording.bags.reader import open_bag_to_read
from simkit.recording.bags.recorder import Recorder
from simkit.recording.films.film import Film, FilmOptions, film_bag, film_options
from simkit.recording.run_picture import DrivenPath
from simkit.runtime.engine.snapshot import state_hash
from simkit.sensors.cameras.overview_image import render_view

WORLD = """<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity><model name="rover"><link name="body">
  <visual name="v"><geometry><box><size>0.4 0.2 0.1</size></box></geometry></visual></link></model></world></sdf>"""
SIZE = (64, 48)


def plain(seen: list[np.ndarray]) -> object:
    """Return a function that draws nothing and stores the eyes of large images."""

    def render(_sim: object, width: int, height: int, *, eye: np.ndarray, **_: object) -> np.ndarray:
        if (width, height) == SIZE:
            seen.append(eye)
        return np.full((height, width, 3), 200, np.uint8)

    return render


def drive(film: Film, sim: simkit.Simulation, duration: float) -> list[float]:
    """Advance to each frame as the run loop does; return the times of the frames."""
    times = []
    while (due := film.next_tick) is not None and due * sim.timestep <= duration + 1e-9:
        sim.step(max(0, due - sim.tick)) if due > sim.tick else None
        film.send_due()
        times.append(sim.time)
    return times


@pytest.mark.parametrize(("camera", "travel"), [("follow", 0.5), ("fixed", 0.0)])
def test_frames_lie_at_equal_times_and_a_following_camera_keeps_its_distance(
    tmp_path: Path, camera: str, travel: float
) -> None:
    eyes: list[np.ndarray] = []
    options = FilmOptions((tmp_path / "out.gif",), SIZE, 10.0, camera)
    with simkit.load(WORLD) as sim:
        film = Film(sim, options, plain(eyes), DrivenPath(sim))  # type: ignore[arg-type]
        sim.model("rover").set_velocity((1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        times = drive(film, sim, 0.5)
        film.close()
    assert times == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4, 0.5])
    np.testing.assert_allclose(eyes[-1] - eyes[0], (travel, 0, 0), atol=1e-6)
    from PIL import Image

    with Image.open(tmp_path / "out.gif") as gif:
        assert gif.size == SIZE
        assert gif.info["duration"] == 100


@pytest.mark.parametrize(("name", "codec"), [("out.mp4", "h264"), ("out.webm", "vp9")])
def test_a_video_has_all_frames_at_the_asked_rate(tmp_path: Path, name: str, codec: str) -> None:
    av = pytest.importorskip("av", reason="pip install 'simkit-robotics[video]'")
    with simkit.load(WORLD) as sim:
        film = Film(sim, FilmOptions((tmp_path / name,), (65, 49), 20.0), plain([]), DrivenPath(sim))  # type: ignore[arg-type]
        drive(film, sim, 0.5)
        film.close()
    with av.open(str(tmp_path / name)) as video:
        stream = video.streams.video[0]
        assert (stream.codec_context.name.replace("libvpx-", ""), stream.average_rate) == (codec, 20)
        frames = [frame.to_ndarray(format="rgb24") for frame in video.decode(video=0)]
    assert len(frames) == 11
    assert frames[0].shape == (48, 64, 3)


def test_a_film_changes_no_bit_of_the_run(tmp_path: Path) -> None:
    lidar = """<sensor name="eye" type="gpu_lidar"><update_rate>10</update_rate><topic>scan</topic><lidar><scan>
      <horizontal><samples>9</samples><min_angle>-3</min_angle><max_angle>3</max_angle></horizontal></scan><range><min>0.05</min>
      <max>10</max></range><noise><type>gaussian</type><stddev>0.1</stddev></noise></lidar></sensor></link>"""
    ends = []
    for is_filmed in (False, True):
        with simkit.load(WORLD.replace("</link>", lidar)) as sim:
            scans = sim.subscribe("/scan", keep=1)
            sim.model("rover").set_velocity((0.3, 0.0, 0.0), (0.0, 0.0, 0.5))
            if is_filmed:
                film = Film(sim, FilmOptions((tmp_path / "out.gif",), SIZE, 20.0), render_view, DrivenPath(sim))
                assert len(drive(film, sim, 0.3)) == 7
                film.close()
            else:
                sim.run(0.3)
            ends.append((state_hash(sim), scans.latest.ranges.tobytes()))
    assert ends[0] == ends[1]


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="Windows sends no SIGINT to one process")
def test_an_interrupted_run_leaves_a_whole_video(tmp_path: Path) -> None:
    av = pytest.importorskip("av", reason="pip install 'simkit-robotics[video]'")
    video = tmp_path / "out.mp4"
    (tmp_path / "w.sdf").write_text(WORLD, encoding="utf-8")
    command = [sys.executable, "-m", "simkit", "run", str(tmp_path / "w.sdf"), "--video", str(video)]
    child = subprocess.Popen([*command, "--resolution", "64x48"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    while not video.exists() and child.poll() is None:
        with suppress(subprocess.TimeoutExpired):
            child.wait(0.05)
    child.send_signal(signal.SIGINT)
    out, _ = child.communicate(timeout=60)
    assert child.returncode == 130, out
    with av.open(str(video)) as opened:
        assert sum(1 for _ in opened.decode(video=0)) >= 1


def test_invalid_options_of_a_film_are_reported_before_the_run(tmp_path: Path) -> None:
    for arguments, text in (
        ((None, tmp_path / "a.avi", None, None, "auto"), "found .avi; expected .mp4 or .webm"),
        ((tmp_path / "a.mp4", None, None, None, "auto"), "--gif .*found .mp4; expected .gif"),
        ((tmp_path / "no" / "a.gif", None, None, None, "auto"), "does not exist"),
        ((tmp_path / "a.gif", None, "640", None, "auto"), "expected WIDTHxHEIGHT"),
        ((tmp_path / "a.gif", None, None, 1000.0, "auto"), "expected 0.1 to 120"),
        ((tmp_path / "a.gif", None, None, None, "top"), "expected auto, fixed, follow"),
    ):
        with pytest.raises(InputError, match=text):
            film_options(*arguments)  # type: ignore[arg-type]
    assert film_options(None, None, None, None, "auto") is None


def test_a_bag_moves_the_models_of_its_world_as_the_run_did(tmp_path: Path) -> None:
    bag, gif = tmp_path / "run.mcap", tmp_path / "out.gif"
    with simkit.load("turtlebot3_empty") as sim, Recorder(sim, bag, topics=("/odom", "/joint_states")):
        name = next(name for name, model in sim.models.items() if not model.static)
        sim.publish("/cmd_vel", {"linear": {"x": 0.2}, "angular": {"z": 0.5}})
        sim.run(1.0)
        true, wheel = sim.model(name).pose, sim.model(name).joint("wheel_left_joint").position
    with simkit.load("turtlebot3_empty") as sim, open_bag_to_read(bag) as opened:
        options = FilmOptions((gif,), SIZE, 10.0)
        count, moved = film_bag(sim, opened, options, plain([]), (None, None), lambda: False)  # type: ignore[arg-type]
        assert (count, moved) == (11, {name})
        np.testing.assert_allclose(sim.model(name).pose.position[:2], true.position[:2], atol=0.02)
        assert sim.model(name).pose.rpy[2] == pytest.approx(true.rpy[2], abs=0.05)
        assert sim.model(name).joint("wheel_left_joint").position == pytest.approx(wheel, abs=0.3)
