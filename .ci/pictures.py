"""Draw the pictures of the documentation anew: `python .ci/pictures.py [PATH...]`; by default, all but the long ones.

`PICTURES` is the table: the path of each picture, and how it is drawn. A picture of more than 150 kB gets smaller: it
gets a palette, and fewer pixels unless it is a chart. The gallery has a script of its own: `.ci/gallery.py`.

The page in the browser needs Playwright and Chromium, the charts need matplotlib, and `docs/images/accuracy.png` needs
ContactNets' recorded tosses in `contact-nets/data`.
"""

from __future__ import annotations

import functools
import math
import os
import runpy
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
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
MOST = 150_000  # bytes
FEW = 3_000  # colours of a chart


@dataclass(frozen=True)
class Picture:
    """How a picture is drawn.

    Attributes:
        draw: function that writes the picture to a path.
        is_long: whether it takes more than a minute of processor time; it is then drawn only when its path is given.
    """

    draw: Callable[[Path], None]
    is_long: bool = False


def command(*words: str) -> Callable[[Path], None]:
    """Return a function that calls Python with these words, in which `{}` is the path of the picture."""

    def draw(path: Path) -> None:
        subprocess.run([sys.executable, *(word.format(path) for word in words)], cwd=ROOT, check=True)

    return draw


def run(*words: str) -> Callable[[Path], None]:
    """Return a function that draws the end of a run."""
    return command("-m", "simkit", "run", *words, "--quiet", "--picture", "{}")


def motion(*words: str) -> Callable[[Path], None]:
    """Return a function that draws the end of a motion by name."""
    return command("-m", "simkit", "motion", "play", *words, "--picture", "{}")


@functools.cache
def drawn_folder(*words: str) -> Path:
    """Call Python once with these words, in which `{}` is an empty folder for pictures, and return that folder.

    The folder is also in the variable SIMKIT_BROWSER_PICTURES, which the tests of the page read.
    """
    folder = Path(tempfile.mkdtemp())
    environment = {**os.environ, "SIMKIT_BROWSER_PICTURES": str(folder)}
    subprocess.run([sys.executable, *(word.format(folder) for word in words)], cwd=ROOT, env=environment, check=True)
    return folder


def one_of(name: str, *words: str) -> Callable[[Path], None]:
    """Return a function that copies one of the pictures that a command writes to a folder."""
    return lambda path: (shutil.copyfile(drawn_folder(*words) / name, path), None)[1]


def browser(module: str, test: str) -> Callable[[Path], None]:
    """Return a function that keeps the picture of a browser's test of the page."""
    words = ("-m", "pytest", "-q", "-m", "browser", f"packs/view/tests/view/{module}.py", "-k", test)
    return lambda path: one_of(path.name, *words)(path)


def standard_output(name: str) -> Callable[[Path], None]:
    """Return a function that keeps what a script prints."""

    def draw(path: Path) -> None:
        path.write_bytes(subprocess.run([sys.executable, name], cwd=ROOT, check=True, stdout=subprocess.PIPE).stdout)

    return draw


def speed(path: Path) -> None:
    """Draw the chart of the stored measurements of speed."""
    sys.path.insert(0, str(ROOT / "benchmarks" / "history"))
    page = runpy.run_path(str(ROOT / "benchmarks" / "history" / "page.py"))
    page["draw"](page["read_entries"](), path)


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


def turtlesim(path: Path) -> None:
    """Draw the window of turtlesim: one turtle drives a square, a second one draws an arc with a red pen."""
    with simkit.load("turtlesim") as sim:
        images = sim.subscribe("/turtlesim/image", keep=1)
        sim.call("/spawn", {"x": 2.0, "y": 3.0, "theta": 0.3, "name": "leo"})
        sim.call("/leo/set_pen", {"r": 255, "g": 0, "b": 0, "width": 8})
        for side in range(4):
            sim.publish("/turtle1/cmd_vel", {"linear": {"x": 2.0}})
            if side == 0:
                sim.publish("/leo/cmd_vel", {"linear": {"x": 1.8}, "angular": {"z": 2.0}})
            sim.run(1.1)
            sim.send_goal("/turtle1/rotate_absolute", {"theta": math.remainder((side + 1) * math.pi / 2, math.tau)})
            sim.run(2.0)
        save_window(images.latest, path)


def save_window(image: Any, path: Path) -> None:
    """Save an image message with the colours red, green and blue."""
    Image.fromarray(np.asarray(image.data).reshape(image.height, image.width, 3)).save(path, optimize=True)


def drive(world: str, duration: str) -> Picture:
    """Return a picture of the end of a drive by the script of a world; the duration is in s."""
    return Picture(run(world, "--script", f"worlds/{world}_drive.yaml", "--duration", duration))


RENDERERS = ("benchmarks/renderers.py", "--rounds", "1", "--images", "{}")
REALISM = ("benchmarks/realism.py", "--images", "{}")
TOSSES = ("--tosses", "contact-nets/data")
WORLDS = "worlds_of_simkit"  # a test of each world in the browser

PICTURES: dict[str, Picture] = {
    "docs/images/simkit.webp": Picture(moving_picture),
    "docs/images/first_run.png": drive("turtlebot3_world", "36"),
    "docs/images/house.png": drive("turtlebot3_house", "72"),
    "docs/images/office.png": Picture(
        motion("home", "--world", "simple_office_with_people", "--spawn", "tiago:0.5,0.1,0")
    ),
    "docs/images/tiago_table.png": Picture(motion("home", "--world", "tiago_table")),
    "docs/images/tiago.png": Picture(three_views("tiago", 400, 500)),
    "docs/images/baxter.png": Picture(baxter),
    "docs/images/baxter_table.png": Picture(
        run("baxter_table", "--script", "worlds/baxter_table_pick.yaml", "--duration", "11")
    ),
    "docs/images/turtlebot2.png": Picture(three_views("turtlebot2", 400, 440)),
    "docs/images/tiago_carry.png": Picture(command("examples/tiago/carry.py", "{}")),
    "docs/images/visual_servoing.png": Picture(command("examples/visual_servoing/servo.py", "{}")),
    "docs/images/graph.svg": Picture(command("-m", "simkit", "graph", "worlds/turtlebot3_world.sdf", "-o", "{}")),
    "docs/images/rooms.svg": Picture(standard_output("docs/room_map.py")),
    "docs/images/speed.svg": Picture(speed),
    "docs/images/accuracy.png": Picture(command("benchmarks/contact.py", *TOSSES, "--plot", "{}"), is_long=True),
    "docs/images/sensors/allan.png": Picture(command("benchmarks/allan.py", "--out", "{}"), is_long=True),
    "docs/images/turtlebot3_training.svg": Picture(
        one_of("c.svg", "packs/learning/examples/train_turtlebot3.py", "--picture", "{}/c.svg", "--curve", "{}/c.csv",
               "--policy", "{}/policy.npz"),
        is_long=True,
    ),
    "packs/turtlesim/docs/images/turtlesim.png": Picture(turtlesim),
    **{f"docs/images/rendering/{name}.png": Picture(one_of(f"{name}.png", "examples/rendering/looks.py", "{}"))
       for name in ("fog", "house", "looks")},
    **{f"docs/images/rendering/software_{name}.jpg": Picture(one_of(drawn, *RENDERERS), is_long=True)
       for name, drawn in {
           "turtlebot3_world": "turtlebot3_world_gazebo_high.jpg",
           "turtlebot3_house": "turtlebot3_house_gazebo_outside.jpg",
           "tiago_table": "tiago_table_gazebo_view.jpg",
           "office": "simple_office_with_people_gazebo_view.jpg",
           "sensor_bench": "sensor_bench_gazebo_view.jpg",
           "looks": "world_gazebo_glow and glass.jpg",
       }.items()},
    **{f"docs/images/realism/{name}.png": Picture(one_of(f"{name}.png", *REALISM), is_long=True)
       for name in ("x3_depth", "x3_gaps", "x3_scan", "x3_wedge")},
    **{f"packs/view/docs/images/view_{world}.jpg": Picture(browser("test_browser", WORLDS), is_long=True)
       for world in ("turtlebot3_world", "turtlebot3_house", "tiago_table", "simple_office_with_people",
                     "sensor_bench")},
    "packs/view/docs/images/view_displays.jpg": Picture(browser("test_displays_in_browser", "drawn_while")),
    **{f"packs/view/docs/images/view_{name}.jpg": Picture(browser("test_browser_panels", test), is_long=True)
       for name, test in {
           "plots": "odometry_is_plotted",
           "forms": "odometry_is_plotted",
           "motions": "panels_of_tiago",
           "graph": "panels_of_tiago",
       }.items()},
    **{
        f"docs/images/sensors/{path.stem}.png": Picture(command(f"examples/sensors/{path.name}", "{}"))
        for path in sorted((ROOT / "examples" / "sensors").glob("*.py"))
        if path.stem != "plots"
    },
}  # fmt: skip


def shrink(path: Path) -> None:
    """Reduce a file that is too large: a chart to 256 colours, a picture also to three quarters of its size.

    A JPEG file keeps its size and gets a lower quality.
    """
    if path.suffix not in (".png", ".jpg") or path.stat().st_size <= MOST:
        return
    with Image.open(path) as opened:
        image = opened.convert("RGB")
    if path.suffix == ".jpg":
        image.save(path, quality=78, optimize=True)
        return
    if image.getcolors(FEW) is None:
        image = image.resize((image.width * 3 // 4, image.height * 3 // 4), Image.Resampling.LANCZOS)
    image.quantize(256, kmeans=2, dither=Image.Dither.NONE).save(path, optimize=True)


def main(names: list[str]) -> None:
    for name in names or [name for name, picture in PICTURES.items() if not picture.is_long]:
        path = ROOT / name
        PICTURES[name].draw(path)
        shrink(path)
        print(f"{path.stat().st_size:8d} {name}")


if __name__ == "__main__":
    unknown = [name for name in sys.argv[1:] if name not in PICTURES]
    if unknown:
        sys.exit(f"unknown: {', '.join(unknown)}; there are {', '.join(PICTURES)}")
    main(sys.argv[1:])
