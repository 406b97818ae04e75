"""Images drawn on the render thread: the same bits in the same order, whatever happens before they are finished."""

from __future__ import annotations

import gc
import os
import signal
import subprocess
import sys
import textwrap
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from renderer import NEEDS_GL
from sensor_worlds import box, noise, sensor, world

import simkit
from simkit import msgs
from simkit.errors import RenderError
from simkit.recording.bags.recorder import Recorder
from simkit.sensors.cameras.camera import Camera
from simkit.sensors.cameras.rendering import gl_context, render_thread
from simkit.sensors.cameras.rgbd_camera import RgbdCamera

ROOT = Path(__file__).resolve().parents[4]
SCENE = "<scene><ambient>1 1 1 1</ambient><background>0.2 0.4 0.6 1</background></scene>"
CRATE = f'<sdf version="1.9">{box("crate", "2 0.3 1 0 0 0", "0.3 0.3 0.3", colour="0 1 0")}</sdf>'


def camera(more: str = "", width: int = 48, height: int = 32) -> str:
    return f"""<camera><horizontal_fov>1.2</horizontal_fov>
      <image><width>{width}</width><height>{height}</height></image><clip><near>0.1</near><far>20</far></clip>{more}</camera>"""


def two_cameras(latency: str = "") -> str:
    """Return a world with a rotating body, a wall and a falling ball; the body has two noisy cameras and an IMU."""
    sensors = (
        sensor("rgbd_camera", camera(noise(0.02)), rate=30, name="a", extra="<topic>a</topic>" + latency)
        + sensor("camera", camera(noise(0.05), width=32), rate=50, name="b", extra="<topic>b/image</topic>")
        + sensor("imu", "<imu/>", rate=200, name="i", extra="<topic>imu</topic>")
    )
    ball = """<model name="ball"><pose>3 0 2 0 0 0</pose><link name="l"><visual name="v"><geometry><sphere>
      <radius>0.2</radius></sphere></geometry></visual></link></model>"""
    others = box("wall", "5 0 1 0 0 0.4", "1 9 9", colour="1 0 0") + ball
    return world(sensors, others=others, top=SCENE, static=False, pose="0 0 1 0 0.1 0.2")


TOPICS = ("/a/image", "/a/depth_image", "/a/points", "/a/camera_info", "/b/image", "/imu")


def as_bytes(messages: list[Any]) -> list[bytes]:
    return [msgs.serialize(message) for message in messages]


def on_both(script: Callable[[Any], Any], text: str = "") -> tuple[Any, Any]:
    """Return the results of a script for a simulation without the render thread and for one with it."""
    found = []
    for is_on in (False, True):
        with simkit.load(text or two_cameras(), render_thread=is_on) as sim:
            assert sim.engine.render_thread is is_on
            found.append(script(sim))
    return found[0], found[1]


# ---------------------------------------------------------------------- the same bits


def test_every_message_is_the_same_with_a_spawn_in_the_middle() -> None:
    def script(sim: Any) -> list[list[bytes]]:
        subs = [sim.subscribe(topic) for topic in TOPICS]
        sim.run(0.15)
        sim.spawn(CRATE)
        sim.run(0.1)
        sim.remove("crate")
        sim.run(0.1)
        return [as_bytes(sub.messages) for sub in subs]

    alone, beside = on_both(script)
    assert [len(messages) for messages in alone] == [11, 11, 11, 11, 18, 71]
    assert alone == beside


@pytest.mark.parametrize("latency", ["", "<latency>0.05</latency>"])
def test_a_recorded_bag_is_the_same_byte_for_byte(tmp_path: Path, latency: str) -> None:
    def script(sim: Any) -> bytes:
        path = tmp_path / f"{sim.engine.render_thread}.mcap"
        with Recorder(sim, path):
            sim.run(0.12)
            sim.spawn(CRATE)
            sim.run(0.12)
        return path.read_bytes()

    alone, beside = on_both(script, two_cameras(latency))
    assert len(alone) > 10_000
    assert alone == beside


def test_reset_and_restore_while_images_are_being_drawn() -> None:
    def script(sim: Any) -> list[list[bytes]]:
        subs = [sim.subscribe(topic) for topic in TOPICS]
        sim.run(0.1)
        before = sim.snapshot()
        sim.run(0.05)
        sim.restore(before)
        sim.run(0.1)
        sim.reset(seed=7)
        sim.run(0.05)
        return [as_bytes(sub.messages) for sub in subs]

    alone, beside = on_both(script)
    assert alone == beside


def test_callbacks_late_readers_and_latest_get_the_same_images() -> None:
    called: list[Any] = []

    def script(sim: Any) -> list[bytes]:
        called.clear()
        live = sim.subscribe("/b/image", called.append, keep=0)
        sim.run(0.02)
        live.close()
        kept, newest = sim.subscribe("/b/image"), sim.subscribe("/b/image", keep=1)
        sim.run(0.06)
        camera = sim.sensor("m::l::b")
        return as_bytes([*called, *kept.messages, newest.latest, camera.latest, camera.truth])

    alone, beside = on_both(script)
    assert alone == beside
    assert alone[-2] == alone[-3] == alone[-4]


def test_switching_the_thread_on_and_off_changes_no_image() -> None:
    def script(sim: Any) -> list[bytes]:
        sub = sim.subscribe("/a/points")
        for _ in range(4):
            sim.run(0.04)
            sim.engine.render_thread = not sim.engine.render_thread
        return as_bytes(sub.messages)

    alone, beside = on_both(script)
    assert alone == beside


def test_the_thread_draws_where_no_callback_waits() -> None:
    drawn: list[bool] = []
    with simkit.load(two_cameras(), render_thread=True) as sim:
        camera = sim.sensor("m::l::b")
        make_reading = camera.make_reading

        def noticed(drawn_views: Any, context: Any) -> Any:
            drawn.append(threading.current_thread() is threading.main_thread())
            return make_reading(drawn_views, context)

        camera.make_reading = noticed
        sub = sim.subscribe("/b/image")
        sim.run(0.1)
        assert len(sub.messages) == 6
        assert not any(drawn)
        drawn.clear()
        sub.close()
        sim.subscribe("/b/image", lambda message: None)
        sim.run(0.1)
        assert drawn
        assert all(drawn)


# ---------------------------------------------------------------------- what is made, and what is not


def counted(monkeypatch: pytest.MonkeyPatch, kind: type, method: str) -> list[int]:
    calls, original = [0], getattr(kind, method)

    def counting(*what: Any) -> Any:
        calls[0] += 1
        return original(*what)

    monkeypatch.setattr(kind, method, counting)
    return calls


@pytest.mark.parametrize("is_on", [False, True])
def test_only_what_is_read_is_made_and_only_once(monkeypatch: pytest.MonkeyPatch, is_on: bool) -> None:
    pictures, clouds = counted(monkeypatch, RgbdCamera, "make_reading"), counted(monkeypatch, RgbdCamera, "_cloud")
    images = counted(monkeypatch, RgbdCamera, "_colour_message")
    with simkit.load(two_cameras(), render_thread=is_on) as sim:
        sim.subscribe("/a/camera_info")
        sim.run(0.05)
        assert pictures == [0]
        subs = [sim.subscribe("/a/image") for _ in range(4)]
        sim.run(0.1)
        assert [len(sub.messages) for sub in subs] == [3, 3, 3, 3]
        assert (pictures, images, clouds) == ([3], [3], [0])
        assert subs[0].messages[1] is subs[3].messages[1]


# ---------------------------------------------------------------------- when it goes wrong


@pytest.mark.parametrize("is_on", [False, True])
def test_a_failed_image_switches_its_camera_off_with_one_report(monkeypatch: pytest.MonkeyPatch, is_on: bool) -> None:
    make_reading, made = Camera.make_reading, [0]

    def failing(self: Any, drawn_views: Any, context: Any) -> Any:
        made[0] += 1
        if made[0] == 3:
            raise RenderError("SK-RENDER-002", "drawing an image failed: out of memory")
        return make_reading(self, drawn_views, context)

    monkeypatch.setattr(Camera, "make_reading", failing)
    with simkit.load(two_cameras(), render_thread=is_on) as sim:
        image, depth = sim.subscribe("/b/image"), sim.subscribe("/a/depth_image")
        sim.run(0.2)
        render_thread.drain()
        sim.run(0.2)
        assert made[0] < 20
        assert [m.header.stamp.nanosec for m in image.messages[:2]] == [1_000_000, 20_000_000]
        assert len(image.messages) == made[0] - 1
        assert len(depth.messages) == 13
        assert [d.code for d in sim.diagnostics].count("SK-RENDER-002") == 1
        with pytest.raises(RenderError, match="out of memory"):
            sim.sensor("m::l::b").latest  # noqa: B018


def test_an_error_in_a_kind_is_raised_where_the_image_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    with simkit.load(two_cameras(), render_thread=True) as sim:
        sub = sim.subscribe("/b/image")
        sim.run(0.05)
        monkeypatch.setattr(Camera, "make_reading", lambda *_: 1 / 0)
        sim.run(0.05)
        with pytest.raises(ZeroDivisionError):
            sub.messages  # noqa: B018


def test_messages_stay_after_the_simulation_is_closed() -> None:
    with simkit.load(two_cameras(), render_thread=True) as sim:
        sub = sim.subscribe("/a/depth_image")
        sim.run(0.1)
    assert len(sub.messages) == 4
    assert np.isfinite(np.asarray(sub.messages[-1].data).view(np.float32)).any()


def test_the_number_of_waiting_images_is_limited() -> None:
    gate, count, done = threading.Event(), 40, []
    first = render_thread.submit(gate.wait)
    accepted: list[render_thread.RenderJob] = []
    filling = threading.Thread(
        target=lambda: [accepted.append(render_thread.submit(lambda i=i: done.append(i))) for i in range(count)]
    )
    filling.start()
    filling.join(0.2)
    assert filling.is_alive()
    assert len(accepted) <= 8
    gate.set()
    filling.join()
    render_thread.drain()
    assert first.is_done
    assert done == list(range(count))


def run(script: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "SIMKIT_TEST_WORLD": two_cameras()}
    return subprocess.run(
        [sys.executable, "-c", textwrap.dedent(script)],
        env=environment, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip


@pytest.mark.parametrize("end", ["sys.exit(3)", "raise KeyboardInterrupt", "threading.Thread(target=more).start()"])
@pytest.mark.slow
def test_the_interpreter_ends_while_images_are_being_drawn(end: str) -> None:
    done = run(
        f"""
        import os, sys, threading, simkit
        sim = simkit.load(os.environ["SIMKIT_TEST_WORLD"], render_thread=True)
        subs = [sim.subscribe("/a/points"), sim.subscribe("/b/image")]
        def more():
            sim.run(0.1)
            sim.close()
        sim.run(0.2)
        {end}
        """
    )
    assert done.returncode == (3 if "exit" in end else -2 if "Interrupt" in end else 0), done.stderr
    # a note says that OpenGL is missing
    problems = [line for line in done.stderr.splitlines() if "SK-RENDER-015" not in line]
    assert not problems or "KeyboardInterrupt" in done.stderr


@pytest.fixture
def no_garbage_collection() -> Iterator[None]:
    """Keep finalizers of older objects out of a test: Python drops the exceptions that are raised in them."""
    gc.collect()
    gc.disable()
    yield
    gc.enable()


@pytest.mark.usefixtures("no_garbage_collection")
def test_an_interrupt_is_raised_and_the_run_can_continue() -> None:
    before = signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
    try:
        with simkit.load(two_cameras(), render_thread=True) as sim:
            sub = sim.subscribe("/a/points")
            sim.run(0.1)
            whole = as_bytes(sub.messages)
            with pytest.raises(KeyboardInterrupt):  # noqa: PT012 - the interrupt may come before the run starts
                signal.setitimer(signal.ITIMER_REAL, 0.03)
                sim.run(100.0)
            until = sim.time + 0.2
            while sim.time < until:
                sim.step()
            stamps = [m.header.stamp.nanosec + m.header.stamp.sec * 10**9 for m in sub.messages]
            assert stamps == sorted(set(stamps))
            assert stamps[-1] > 1e9 * (until - 0.04)
            assert as_bytes(sub.messages)[: len(whole)] == whole
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


@NEEDS_GL
def test_an_interrupt_while_drawing_waits_for_the_image_and_is_no_render_error() -> None:
    reached = []

    def draw() -> None:
        with gl_context.current():
            signal.raise_signal(signal.SIGINT)
            reached.append(gl_context.describe_renderer())

    with pytest.raises(KeyboardInterrupt):
        draw()
    assert reached[0]
    with gl_context.current():
        assert gl_context.is_open()


@pytest.mark.parametrize(
    "wait", [render_thread.RenderJob.wait, lambda _: render_thread.drain()], ids=["for_one", "for_all"]
)
def test_an_interrupt_stops_waiting_for_images_at_once(wait: Callable[[render_thread.RenderJob], None]) -> None:
    gate = threading.Event()

    def interrupt() -> None:
        os.kill(os.getpid(), signal.SIGINT)
        gate.wait()

    work = render_thread.submit(interrupt)
    with pytest.raises(KeyboardInterrupt):
        wait(work)
    assert not work.is_done
    gate.set()
    render_thread.drain()
    assert work.is_done
