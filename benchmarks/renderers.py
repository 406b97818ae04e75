"""The software renderer beside OpenGL in the same run: times, colours and depths, and pictures side by side.

python benchmarks/renderers.py [--rounds N] [--images FOLDER]

Times are CPU time of one image of 640 x 480 with colours and depths. Run it on one core: `taskset -c 1`.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import cv2
import numpy as np
from measure import report

import simkit
from simkit.cli.bench_figures import Figure, time_interleaved
from simkit.sensors.cameras.overview_image import render_view
from simkit.sensors.cameras.rendering.appearance import QUALITIES, Appearance
from simkit.sensors.cameras.rendering.renderer import Renderer
from simkit.sensors.cameras.rendering.software.software_renderer import SoftwareRenderer
from simkit.sensors.cameras.rendering.view import DrawnView, Shot, View, depth_line, look_at

ROOT: Final = Path(__file__).resolve().parents[1]
VIEW: Final = View(640, 480, -0.55, 0.55, -0.4125, 0.4125, 0.03125, 60.0)
LOOKS: Final = str(ROOT / "examples" / "rendering" / "world.sdf")


@dataclass(frozen=True, slots=True)
class Scene:
    """One view of a world: eye and target [m], and the longest time of a fast image [ms]."""

    world: str
    name: str
    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    most: float


SCENES: Final = (
    Scene("turtlebot3_world", "TurtleBot3 world, low", (-2.0, -0.5, 0.3), (0.0, 0.0, 0.2), 30),
    Scene("turtlebot3_world", "TurtleBot3 world, high", (-3.0, -3.0, 2.0), (0.0, 0.0, 0.0), 30),
    Scene("turtlebot3_house", "house, inside", (-2.0, -0.5, 0.5), (1.0, 1.0, 0.5), 60),
    Scene("turtlebot3_house", "house, outside", (-12.0, -9.0, 6.0), (0.0, 0.0, 0.0), 60),
    Scene("tiago_table", "TIAGo table", (-1.5, -1.5, 1.2), (0.5, 0.0, 0.7), 30),
    Scene("simple_office_with_people", "office with people", (0.0, 0.0, 1.6), (5.0, 2.0, 1.0), 250),
    Scene("sensor_bench", "sensor bench", (-3.0, -3.0, 2.0), (0.0, 0.0, 0.3), 60),
    Scene(LOOKS, "gloss, glow and glass", (-4.0, -1.0, 1.8), (1.0, 0.0, 0.4), 60),
)


def compare(scene: Scene, sim: Any, quality: str, rounds: int, folder: Path | None) -> Figure:
    """Times one view by both renderers, prints how far their images differ, and saves them side by side."""
    appearance = Appearance(sim.world.surroundings, QUALITIES[quality])
    renderers = SoftwareRenderer(appearance), Renderer(appearance)
    data, eye = sim.engine.physics.fresh(), np.array(scene.eye)
    rotation = look_at(eye, np.array(scene.target))

    def draw(renderer: Any, sharp: bool = False) -> DrawnView:
        composition = renderer.composer.compose(sim.mj_model, data, eye, rotation)
        found: DrawnView = renderer.draw(composition, Shot(VIEW, depth=True, sharp=sharp))
        renderer.composer.give_back(composition)
        return found

    ours, theirs = time_interleaved([lambda r=r: draw(r) for r in renderers], rounds)
    colours = [draw(r).colours.copy() for r in renderers]  # type: ignore[union-attr]
    slope, offset = depth_line(VIEW.near, VIEW.far)
    raw = [draw(r, sharp=True).depths.copy() for r in renderers]  # type: ignore[union-attr]
    both = (raw[0] > 0) & (raw[1] > 0)
    depths = [slope / (values[both] + offset) for values in raw]
    change = np.abs(colours[0].astype(int) - colours[1])
    print(
        f"    colours: mean {change.mean():.3f} of 255, {100 * (change.max(axis=2) > 8).mean():.2f} % above 8; "
        f"depths: half below {np.median(np.abs(depths[0] - depths[1])) * 1e3:.3f} mm, "
        f"99 % below {np.quantile(np.abs(depths[0] - depths[1]), 0.99) * 1e3:.2f} mm"
    )
    if folder is not None:
        pair = [cv2.resize(image, (480, 360), interpolation=cv2.INTER_AREA) for image in (colours[1], colours[0])]
        name = f"{Path(scene.world).stem}_{quality}_{'_'.join(scene.name.split(', ')[1:]) or 'view'}.jpg"
        cv2.imwrite(str(folder / name), np.hstack(pair)[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, 88])
    most = scene.most if quality == "fast" else 200.0  # [ms]
    for renderer in renderers:
        renderer.free()
    return Figure(f"{scene.name}, {quality} (at most {most:.0f} ms)", "picture", ours, theirs, most=most / 1e3)


def images(rounds: int, folder: Path | None) -> Iterator[Figure]:
    """All views at fast and at gazebo."""
    for scene in SCENES:
        with simkit.load(scene.world, render_thread=False) as sim:
            sim.run(0.2)
            for quality in ("fast", "gazebo"):
                yield compare(scene, sim, quality, rounds, folder)


def pictures() -> Iterator[Figure]:
    """A picture of a run, with soft shadows."""
    for world in ("turtlebot3_world", "turtlebot3_house"):
        times = []
        for renderer in ("software", "gl"):
            with simkit.load(world, renderer=renderer, render_thread=False) as sim:
                sim.run(0.2)
                lit = np.zeros(3), 6.0
                (took,) = time_interleaved(
                    [lambda sim=sim, lit=lit: render_view(sim, 1280, 800, quality="gazebo", passes=16, lit=lit)], 2
                )
                times.append(took)
        yield Figure(f"picture of the {world}, 1280 x 800 (at most 3000 ms)", "picture", *times, most=3.0)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--rounds", type=int, default=9, help="timings taken of each side")
    parser.add_argument("--images", type=Path, help="folder for pictures side by side: OpenGL left, software right")
    given = parser.parse_args()
    cv2.setNumThreads(1)
    report(images(given.rounds, given.images))
    report(pictures())


if __name__ == "__main__":
    main()
