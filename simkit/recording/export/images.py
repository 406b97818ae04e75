"""Export of the images of a topic: PNG files, NumPy files, or a video."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit.errors import InputError
from simkit.msgs.image_arrays import Pixels, decode_compressed, read_pixels
from simkit.msgs.message_types import Message

if TYPE_CHECKING:
    from simkit.msgs import Image as ImageMessage

_MM: Final = 1000.0
_SAMPLE = 8  # number of images that determine the frame rate of a video
_RATE: Final = 30.0  # [Hz] frame rate of a video with one image
_LONGEST_STILL: Final = 600  # [frames] longest repetition of an image in a gap
_CODECS: Final = ("vp09", "mp4v")  # vp09 plays in browsers; mp4v is available in almost every OpenCV


class MessageWriter:
    """Writer of the images or point clouds of one topic.

    Attributes:
        notes: differences from the messages, as text.
    """

    def __init__(self) -> None:
        self.notes: list[str] = []

    def take(self, time_ns: int, message: Message) -> str:
        """Write a message; return the name of its file, relative to the export."""
        raise NotImplementedError

    def close(self) -> None:
        """Complete the output after the last message."""


class NumberedFiles(MessageWriter):
    """Writer of one file per message, in a new folder."""

    def __init__(self, folder: Path) -> None:
        super().__init__()
        self._folder, self._count = folder, 0
        folder.mkdir()

    def take(self, time_ns: int, message: Message) -> str:
        target = self._write(self._folder / f"{self._count:06d}", message)
        self._count += 1
        return f"{self._folder.name}/{target.name}"

    def _write(self, target: Path, message: Message) -> Path:
        """Write a message to a file; return its path, which is `target` with the suffix of the format."""
        raise NotImplementedError


def png_pixels(message: ImageMessage) -> Pixels:
    """Convert an image to the values of a PNG file, with 8 or 16 bits and the blue channel first.

    Depth [m] becomes millimetres (REP 118).

    Raises:
        ValueError: PNG cannot represent the values.
    """
    values, order = read_pixels(message)
    if values.ndim == 3 and values.shape[2] == 2:
        raise ValueError(f"PNG has no images with two channels ({message.encoding})")
    if values.dtype.kind == "f":
        if values.ndim == 3:
            raise ValueError(f"PNG cannot hold the numbers of {message.encoding}")
        values = np.where(np.isfinite(values), values * _MM, 0.0)
        return np.clip(np.rint(values), 0, 65535).astype(np.uint16)
    if values.dtype.kind == "i":
        raise ValueError(f"PNG cannot hold the numbers of {message.encoding}")
    if order == "rgb":
        values = values[:, :, [2, 1, 0, 3][: values.shape[2]]]
    return np.ascontiguousarray(values)


def is_depth(message: ImageMessage) -> bool:
    """Check whether the values of an image are distances [m]."""
    return str(getattr(message, "encoding", "")) in ("32FC1", "64FC1")


class PngFiles(NumberedFiles):
    """Writer of one PNG file per image. Compressed images are copied unchanged."""

    def _write(self, target: Path, message: Message) -> Path:
        import cv2

        if not hasattr(message, "encoding"):
            data = bytes(message.data)
            ending = ".jpg" if data[:2] == b"\xff\xd8" else ".png" if data[:4] == b"\x89PNG" else ".bin"
        else:
            if not self._count and is_depth(message):
                self.notes.append(
                    "depths are in mm, 0 for no depth (REP 118); export the original values with --images npz"
                )
            is_encoded, encoded = cv2.imencode(".png", png_pixels(message))
            if not is_encoded:
                raise ValueError(f"PNG cannot hold an image of {message.encoding}")
            data, ending = encoded.tobytes(), ".png"
        target = target.with_suffix(ending)
        target.write_bytes(data)
        return target


class NpzFile(NumberedFiles):
    """Writer of one NumPy file per image."""

    def _write(self, target: Path, message: Message) -> Path:
        target = target.with_suffix(".npz")
        with target.open("wb") as file:
            np.savez_compressed(
                file, pixels=read_pixels(message)[0] if hasattr(message, "encoding") else decode_compressed(message)
            )
        return target


class VideoFile(MessageWriter):
    """Writer of one MP4 video.

    Each image is repeated until the time of the next image, so that the video has the same timing as the bag.
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._path = path
        self._early: list[tuple[int, Pixels]] = []
        self._writer: Any = None
        self._rate, self._start, self._frames = _RATE, 0, 0
        self._last: Pixels | None = None
        self._size = (0, 0)

    def take(self, time_ns: int, message: Message) -> str:
        """Add an image; return the name of the video."""
        frame = _video_pixels(message)
        if not self._early and self._writer is None:
            self._size, self._start = (frame.shape[1], frame.shape[0]), time_ns
        if (frame.shape[1], frame.shape[0]) != self._size:
            raise ValueError("all images of a video must have the same size")
        if self._writer is None:
            self._early.append((time_ns, frame))
            if len(self._early) == _SAMPLE:
                self._open()
        else:
            self._add(time_ns, frame)
        return self._path.name

    def close(self) -> None:
        """Complete the video."""
        if self._writer is None and self._early:
            self._open()
        if self._writer is not None:
            if self._last is not None:
                self._writer.write(self._last)
            self._writer.release()

    def _open(self) -> None:
        import cv2

        steps = np.diff([time_ns for time_ns, _ in self._early])
        steps = steps[steps > 0]
        if steps.size:
            self._rate = min(max(round(1e9 / float(np.median(steps)), 2), 0.1), 240.0)
        for codec in _CODECS:
            self._writer = cv2.VideoWriter(str(self._path), cv2.VideoWriter.fourcc(*codec), self._rate, self._size)
            if self._writer.isOpened():
                break
        else:
            self._writer = None
            self._early = []
            raise InputError("SK-BAG-014", "--images mp4: OpenCV has no video encoder", help="use --images png")
        early, self._early = self._early, []
        for time_ns, frame in early:
            self._add(time_ns, frame)

    def _add(self, time_ns: int, frame: Pixels) -> None:
        """Repeat the last image until the time of this image."""
        frame_number = math.floor((time_ns - self._start) * 1e-9 * self._rate + 0.5)
        if self._last is not None:
            repeats = frame_number - self._frames
            if repeats > _LONGEST_STILL:
                self.notes.append(
                    f"a gap of {repeats / self._rate:.0f} s is {_LONGEST_STILL / self._rate:.0f} s in the video"
                )
                self._start += round((repeats - _LONGEST_STILL) * 1e9 / self._rate)
                repeats = _LONGEST_STILL
            for _ in range(max(0, repeats)):
                self._writer.write(self._last)
                self._frames += 1
        self._last = frame


def _video_pixels(message: Message) -> Pixels:
    """Convert an image to three channels of 8 bits, with the blue channel first.

    Depths and 16-bit values are scaled from black (0) to white (the largest value).
    """
    if not hasattr(message, "encoding"):
        values = decode_compressed(message)
    elif is_depth(message) or str(message.encoding) in ("16UC1", "mono16"):
        values, _ = read_pixels(message)
        finite = np.where(np.isfinite(values), values, 0).astype(np.float64)
        values = np.clip(finite * 255.0 / (finite.max() or 1.0), 0, 255).astype(np.uint8)
    else:
        values = png_pixels(message)
    if values.dtype == np.uint16:
        values = (values >> 8).astype(np.uint8)
    if values.ndim == 2:
        return np.repeat(values[:, :, None], 3, axis=2)
    return np.ascontiguousarray(values[:, :, :3])
