"""Small worlds of labelled models for the cameras that publish labels."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import sensor_worlds

import simkit

WIDTH, HEIGHT, FOV = 64, 48, 1.0
FOCAL = WIDTH / (2 * np.tan(FOV / 2))


def label(number: int | str) -> str:
    """Return the Label plugin of Gazebo."""
    return f'<plugin filename="gz-sim-label-system" name="gz::sim::systems::Label"><label>{number}</label></plugin>'


def visual(shape: str, name: str = "v", pose: str = "0 0 0 0 0 0", more: str = "") -> str:
    return f'<visual name="{name}"><pose>{pose}</pose><geometry>{shape}</geometry>{more}</visual>'


def cube(edge: float = 1.0) -> str:
    return f"<box><size>{edge} {edge} {edge}</size></box>"


def labelled_model(name: str, pose: str, content: str, number: int | None = None, *, static: bool = True) -> str:
    """Return a model with one link that contains `content`, which is one or more visuals."""
    plugin = "" if number is None else label(number)
    fixed = str(static).lower()
    head = f'<model name="{name}"><static>{fixed}</static><pose>{pose}</pose>'
    return f'{head}<link name="l">{content}</link>{plugin}</model>'


def camera(kind: str, block: str = "", *, size: tuple[int, int] = (WIDTH, HEIGHT), pose: str = "0 0 0 0 0 0") -> str:
    image = f"<image><width>{size[0]}</width><height>{size[1]}</height></image>"
    inner = f"<camera><horizontal_fov>{FOV}</horizontal_fov>{image}{block}</camera><topic>eye</topic>"
    return sensor_worlds.sensor(kind, inner, rate=10, pose=pose)


def load(kind: str, models: str, block: str = "", *, top: str = "", **how: Any) -> Any:
    """Load a world with models and a camera at the origin that looks along x."""
    return simkit.load(sensor_worlds.world(camera(kind, block, **how), others=models, pose="0 0 0 0 0 0", top=top))


def bare(content: str) -> Any:
    """Return a world `w` with a static model `m`, whose link contains `content`."""
    link = f'<link name="l">{content}</link>'
    return simkit.load(
        f'<sdf version="1.9"><world name="w"><model name="m"><static>true</static>{link}</model></world></sdf>'
    )


def eye(sim: Any) -> Any:
    return sim.sensor("m::l::s")


def labels(sim: Any) -> npt.NDArray[np.uint8]:
    """Return the newest map of labels, shape (h, w, 3)."""
    return sensor_worlds.colours(eye(sim).latest)


def counts(image: npt.NDArray[np.uint8]) -> dict[tuple[int, ...], int]:
    """Return the number of pixels of each colour."""
    found, number = np.unique(image.reshape(-1, image.shape[-1]), axis=0, return_counts=True)
    return {tuple(c): n for c, n in zip(found.tolist(), number.tolist(), strict=True)}


def edges(box: Any) -> tuple[float, float, float, float]:
    """Return the left, top, right and bottom edge of a `BoundingBox2D`."""
    x, y = box.center.position.x, box.center.position.y
    return x - box.size_x / 2, y - box.size_y / 2, x + box.size_x / 2, y + box.size_y / 2
