"""`<save>` of a camera: each picture as a PNG in a folder that the file names and the user allows."""

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
"""Pictures of one camera in a run."""

_MAX_NAME_LENGTH = 150


def read_save(block: Params) -> Path | None:
    """The folder of a `<camera>` block's `<save>`; None where nothing is to be saved.

    A file from somewhere else writes nowhere but below the working directory and the folders in `SIMKIT_SAVE_PATH`.
    """
    save = block.child("save")
    if save is None:
        return None
    given = save.attribute("enabled", "") or save.text("enabled", "false")
    if given not in ("true", "1"):
        save.mark_all_read()
        if given not in ("false", "0"):
            save.error("SK-PARAM-002", f'found <save enabled="{given}">, allowed is true, false, 1 or 0')
        return None
    path = save.text("path", required=True)
    if not path:
        return None
    folder = allowed_folder(path)
    if folder is None:
        where = save.block("path").where
        message = f"<path>{path}</path> of <save> lies outside the folders that may be written to; nothing is saved"
        hint = (
            f"a path below the working directory, or the folder's name in the environment variable {SAVE_PATH_VARIABLE}"
        )
        save.diagnostics.warning("SK-SENSOR-009", message, where, hint)
    return folder


class ImageSaver(Publisher):
    """An end of a camera's images that writes each of them to a file: `<name>_0.png`, `<name>_1.png`, …

    They are counted through resets, so that a run never writes over its own pictures. What cannot be written ends the
    saving, and is said once.

    Args:
        sim: whose reports it writes to.
        sensor: of whom.
        folder: made when the first picture comes.
        name: before the number.
        far: the distance [m] that is black in a picture of depths; None where floats are brightness.
    """

    __slots__ = ("_count", "_far", "_folder", "_is_over", "_name", "_sensor", "_sim")

    def __init__(self, sim: Simulation, sensor: SceneSensor, folder: Path, name: str, far: float | None) -> None:
        sides = TopicSides(TopicReaders(), [])  # nobody reads what is written to files
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
        """Writes one picture."""
        if self._is_over:
            return
        if self._count >= MAX_IMAGES:
            self._end(f"{MAX_IMAGES} pictures of it have been saved")
            return
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            name, data = self._file(message)
            _write(self._folder / name, data)
        except OSError as error:
            self._end(str(error))
        self._count += 1

    def _file(self, message: Message) -> tuple[str, bytes]:
        """Name and content of the next file."""
        return f"{self._name}_{self._count}.png", encode_png(message, self._far)

    def _end(self, why: str) -> None:
        self._is_over = True
        self._sim.communication.bus.revision += 1
        message = f"camera {self._sensor.scoped!r} saves no more pictures: {why}"
        self._sim.engine.reports.warning("SK-SENSOR-121", message, self._sensor.where)


def _write(path: Path, data: bytes) -> None:
    """All of the file or nothing."""
    partial = path.with_name(f".{path.name}.part")
    try:
        partial.write_bytes(data)
        partial.replace(path)
    except OSError:
        partial.unlink(missing_ok=True)
        raise


def encode_png(message: msgs.Image, far: float | None = None) -> bytes:
    """An `Image` message as a PNG: 8 or 16 bits as they are, a Bayer image as its mosaic.

    Depths (`32FC1` in metres) become shades of grey, from white at 0 to black at `far` [m], as in Gazebo; without it
    floats are brightness from 0 to 1.

    Raises:
        OSError: it cannot be written as one.
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
