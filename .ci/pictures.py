"""Draw the pictures of the documentation anew: `python .ci/pictures.py [NAME...]`; without a name, all of them.

A picture of more than 150 kB gets smaller: it gets a palette, and fewer pixels unless it is a chart. The gallery has a
script of its own: `.ci/gallery.py`.
"""

from __future__ import annotations

import math
import runpy
import subprocess
import sys
import tempfile
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import numpy as np
from PIL import Image

import simkit
from simkit.recording.pictures.camera import Camera, frame_points, line_of_sight
from simkit.recording.pictures.frames import Look, draw_frame
from simkit.recording.pictures.overlay import Marks
from simkit.recording.pictures.subject import find_subject
from simkit.sensors.cameras.overview_image import render_view

ROOT = Path(__file__).resolve().parents[1]
IMAGES = ROOT / "docs" / "images"
MOST = 150_000  # bytes
FEW = 3_000  # colours of a chart


def run(*words: str) -> Callable[[Path], None]:
    """Return a function that draws the end of a run."""

    def draw(path: Path) -> None:
        command = [sys.executable, "-m", "simkit", "run", *words, "--quiet", "--picture", str(path)]
        subprocess.run(command, cwd=ROOT, check=True)

    return draw


def motion(*words: str) -> Callable[[Path], None]:
    """Return a function that draws the end of a motion by name."""

    def draw(path: Path) -> None:
        command = [sys.executable, "-m", "simkit", "motion", "play", *words, "--picture", str(path)]
        subprocess.run(command, cwd=ROOT, check=True)

    return draw


def graph(path: Path) -> None:
    subprocess.run([sys.executable, "-m", "simkit", "graph", "turtlebot3_world", "-o", str(path)], cwd=ROOT, check=True)


def script(name: str) -> Callable[[Path], None]:
    """Return a function that runs an example, which writes a picture."""

    def draw(path: Path) -> None:
        subprocess.run([sys.executable, name, str(path)], cwd=ROOT, check=True)

    return draw


def three_views(model: str, width: int, height: int) -> Callable[[Path], None]:
    """Return a function that draws a robot from the front, from its left and from behind."""

    def draw(path: Path) -> None:
        with simkit.load("empty", spawn=[f"{model}:0,0,0"]) as sim:
            sim.run(2.0)
            draw_three_views(sim, path, Look(width, height))

    return draw


def baxter(path: Path) -> None:
    """Baxter in its neutral pose, from the front, from its left and from behind."""
    neutral = {"s0": 0.0, "s1": -0.55, "e0": 0.0, "e1": 0.75, "w0": 0.0, "w1": 1.26, "w2": 0.0}
    with simkit.load("empty", spawn=["baxter:0,0,0"]) as sim:
        sim.publish("/robot/set_super_enable", {"data": True})
        sim.run(0.1)
        for side in ("left", "right"):
            names = [f"{side}_{joint}" for joint in neutral]
            command = {"mode": 1, "names": names, "command": list(neutral.values())}
            sim.publish(f"/robot/limb/{side}/joint_command", command)
        sim.run(6.0)
        draw_three_views(sim, path, Look(400, 500))


CLIPS: list[tuple[int, list[str]]] = [  # how many times faster than simulated time, and the run
    (4, ["turtlebot3_world", "--script", "worlds/turtlebot3_world_drive.yaml", "--duration", "36"]),
    (2, ["baxter_table", "--script", "worlds/baxter_table_pick.yaml", "--duration", "11"]),
    (
        2,
        [
            "simple_office_with_people",
            "--spawn",
            "tiago:-3.5,0,0",
            "--cmd-vel",
            "0.4,0",
            "--duration",
            "11",
            "--camera",
            "follow",
        ],
    ),
]
FRAMES_PER_SECOND = 10


def moving_picture(path: Path) -> None:
    """Write the runs of `CLIPS` one after another as an animated WebP file."""
    frames: list[Image.Image] = []
    with tempfile.TemporaryDirectory() as folder:
        for number, (speed, words) in enumerate(CLIPS):
            video = Path(folder) / f"{number}.mp4"
            options = ["--video", str(video), "--resolution", "640x400", "--fps", str(FRAMES_PER_SECOND / speed)]
            command = [sys.executable, "-m", "simkit", "run", *words, "--quiet", *options]
            subprocess.run(command, cwd=ROOT, check=True)
            with av.open(video) as film:
                frames += [frame.to_image() for frame in film.decode(video=0)]
    milliseconds = int(Fraction(1000, FRAMES_PER_SECOND))
    frames[0].save(path, save_all=True, append_images=frames[1:], duration=milliseconds, loop=0, quality=60, method=6)


def draw_three_views(sim: simkit.Simulation, path: Path, look: Look) -> None:
    """Draw the robot from three sides, at one scale."""
    views: list[Any] = []
    subject = find_subject(sim, [])
    sights = [line_of_sight(math.radians(turn), math.radians(12.0)) for turn in (-30.0, 65.0, 150.0)]
    cameras = [frame_points(subject.robots, sight, look.width, look.height) for sight in sights]
    distance = max(camera.distance for camera in cameras)
    for sight, found in zip(sights, cameras, strict=True):
        camera = Camera(found.target - distance * sight, found.target, look.width, look.height)
        views.append(draw_frame(sim, render_view, camera, look, Marks(), subject))
    Image.fromarray(np.hstack(views)).save(path, optimize=True)


PICTURES: dict[str, Callable[[Path], None]] = {
    "simkit.webp": moving_picture,
    "first_run.png": run("turtlebot3_world", "--script", "worlds/turtlebot3_world_drive.yaml", "--duration", "36"),
    "house.png": run("turtlebot3_house", "--script", "worlds/turtlebot3_house_drive.yaml", "--duration", "72"),
    "office.png": motion("home", "--world", "simple_office_with_people", "--spawn", "tiago:0.5,0.1,0"),
    "tiago_table.png": motion("home", "--world", "tiago_table"),
    "tiago.png": three_views("tiago", 400, 500),
    "baxter.png": baxter,
    "baxter_table.png": run("baxter_table", "--script", "worlds/baxter_table_pick.yaml", "--duration", "11"),
    "turtlebot2.png": three_views("turtlebot2", 400, 440),
    "tiago_carry.png": script("examples/tiago/carry.py"),
    "visual_servoing.png": script("examples/visual_servoing/servo.py"),
    "graph.svg": graph,
    "rendering": lambda path: runpy.run_path(str(ROOT / "examples/rendering/looks.py"))["main"](path),
    **{
        f"sensors/{path.stem}.png": script(f"examples/sensors/{path.name}")
        for path in sorted((ROOT / "examples" / "sensors").glob("*.py"))
        if path.stem != "plots" and (IMAGES / "sensors" / f"{path.stem}.png").exists()
    },
}


def shrink(path: Path) -> None:
    """Reduce a PNG file that is too large: a chart to 256 colours, a picture also to three quarters of its size."""
    if path.stat().st_size <= MOST:
        return
    with Image.open(path) as opened:
        image = opened.convert("RGB")
    if image.getcolors(FEW) is None:
        image = image.resize((image.width * 3 // 4, image.height * 3 // 4), Image.Resampling.LANCZOS)
    image.quantize(256, kmeans=2, dither=Image.Dither.NONE).save(path, optimize=True)


def main(names: list[str]) -> None:
    for name in names or PICTURES:
        path = IMAGES / name
        PICTURES[name](path)
        for drawn in sorted(path.glob("*.png")) if path.is_dir() else [path]:
            if drawn.suffix == ".png":
                shrink(drawn)
            print(f"{drawn.stat().st_size:8d} {drawn.relative_to(ROOT)}")


if __name__ == "__main__":
    unknown = [name for name in sys.argv[1:] if name not in PICTURES]
    if unknown:
        sys.exit(f"unknown: {', '.join(unknown)}; there are {', '.join(PICTURES)}")
    main(sys.argv[1:])
