"""Saving of camera images as PNG files in a folder that the file names and the user allows (`<save>`)."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.msgs.message_types import Message
from simkit.params import Params
from simkit.runtime import Simulation
from simkit.runtime.communication.publisher import Publisher, TopicSides
from simkit.runtime.communication.subscription import TopicReaders
from simkit.save_path import SAVE_PATH_VARIABLE, allowed_folder
from simkit.scene import SceneSensor
from simkit.sensors.cameras.image_messages import IMAGE_TYPE, pixels_of

MAX_IMAGES = 100_000
"""Largest number of saved images per camera and run."""

_MAX_NAME_LENGTH = 150


def read_save(block: Params) -> Path | None:
    """Read the folder of a `<camera>` block's `<save>`; return None if nothing is to be saved.

    Files may come from untrusted sources, so images are saved only below the working directory and the folders in
    `SIMKIT_SAVE_PATH`.
    """
    save = block.child("save")
    if save is None:
        return None
    enabled = save.attribute("enabled", "") or save.text("enabled", "false")
    if enabled not in ("true", "1"):
        save.mark_all_read()
        if enabled not in ("false", "0"):
            save.error("SK-PARAM-002", f'found <save enabled="{enabled}">; expected true, false, 1 or 0')
        return None
    path = save.text("path", required=True)
    if not path:
        return None
    folder = allowed_folder(path)
    if folder is None:
        where = save.block("path").where
        message = f"<path>{path}</path> of <save> is outside the folders that simkit may write to; nothing is saved"
        hint = f"use a path below the working directory, or add the folder to the variable {SAVE_PATH_VARIABLE}"
        save.diagnostics.warning("SK-SENSOR-009", message, where, hint)
    return folder


class ImageSaver(Publisher):
    """Publisher that writes each image to a file: `<name>_0.png`, `<name>_1.png`, and so on.

    The count continues after a reset, so that a run never overwrites its own images. A write error ends the saving,
    with one report.

    Args:
        sim: simulation that receives the reports.
        sensor: sensor that the images belong to.
        folder: folder of the files, made for the first image.
        name: file name before the number.
        far: depth [m] that is black in a depth image; None where floats are brightness.
    """

    __slots__ = ("_count", "_far", "_folder", "_is_over", "_name", "_sensor", "_sim")

    def __init__(self, sim: Simulation, sensor: SceneSensor, folder: Path, name: str, far: float | None) -> None:
        sides = TopicSides(TopicReaders(), [])  # no subscribers, because this publisher only writes files
        super().__init__(sim.communication.bus, sides, f"/{name}/saved", IMAGE_TYPE, False, None)
        self._sim, self._sensor, self._folder, self._far = sim, sensor, folder, far
        self._name = re.sub(r"[^A-Za-z0-9_.:-]", "_", name)[:_MAX_NAME_LENGTH]
        self._count, self._is_over = 0, False

    @property
    def wanted(self) -> bool:
        return not self._is_over

    @property
    def is_live(self) -> bool:
        return True

    @property
    def patience(self) -> float:
        return 0

    def publish(self, message: Message) -> None:
        """Write one image."""
        if self._is_over:
            return
        if self._count >= MAX_IMAGES:
            self._end(f"the limit of {MAX_IMAGES} images per run is reached")
            return
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            name, data = self._file(message)
            _write(self._folder / name, data)
        except OSError as error:
            self._end(str(error))
        self._count += 1

    def _file(self, message: Message) -> tuple[str, bytes]:
        """Return name and content of the next file."""
        return f"{self._name}_{self._count}.png", encode_png(message, self._far)

    def _end(self, reason: str) -> None:
        self._is_over = True
        self._sim.communication.bus.revision += 1
        message = f"camera {self._sensor.scoped!r} saves no more images: {reason}"
        self._sim.engine.reports.warning("SK-SENSOR-121", message, self._sensor.where)


def _write(path: Path, data: bytes) -> None:
    """Write a whole file, or leave no file."""
    partial = path.with_name(f".{path.name}.part")
    try:
        partial.write_bytes(data)
        partial.replace(path)
    except OSError:
        partial.unlink(missing_ok=True)
        raise


def encode_png(message: msgs.Image, far: float | None = None) -> bytes:
    """Encode an `Image` message as a PNG: 8 or 16 bits unchanged, a Bayer image as its mosaic.

    Depths (`32FC1` in metres) become shades of grey, from white at 0 to black at `far` [m], as in Gazebo. Without
    `far`, floats are brightness from 0 to 1.

    Raises:
        OSError: the image cannot be written as a PNG.
    """
    import cv2

    pixels, encoding = pixels_of(message), message.encoding
    if encoding == "32FC1" and far is not None:
        pixels = _depth_shades(pixels, far)
    elif encoding.startswith("32FC"):
        pixels = np.rint(pixels * 255).astype(np.uint8)
    if encoding in ("rgb8", "rgb16", "32FC3"):
        pixels = pixels[..., ::-1]
    elif encoding == "rgba8":
        pixels = pixels[..., [2, 1, 0, 3]]
    done, data = cv2.imencode(".png", np.ascontiguousarray(pixels))
    if not done:
        raise OSError(f"an image of {message.width}x{message.height} cannot be written as a PNG")
    return bytes(data)


def _depth_shades(depths: npt.NDArray[np.float32], far: float) -> npt.NDArray[np.uint8]:
    near_is_bright = 1 - np.clip(np.nan_to_num(depths, nan=far, posinf=far, neginf=0.0) / np.float32(far), 0, 1)
    return np.asarray(np.rint(near_is_bright * 255), dtype=np.uint8)
