"""Files of moving pictures: GIF with Pillow, MP4 and WebM with PyAV.

PyAV encodes inside the process. A separate encoder program would receive Ctrl-C too, and leave a file without an index.
"""

from __future__ import annotations

import itertools
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Protocol

import numpy as np
from numpy.typing import NDArray

from simkit.errors import InputError
from simkit.install_command import install_command
from simkit.recording.pictures.overlay import MARK_COLOURS

if TYPE_CHECKING:
    from PIL.Image import Image

Colours = NDArray[np.uint8]

VIDEO_SUFFIXES: Final = (".mp4", ".webm")
_CODECS: Final = {
    # H.264 and VP9 play in every browser; presets are fast, because the pictures take most of the time
    ".mp4": ("libx264", {"crf": "21", "preset": "veryfast"}, {"movflags": "+faststart"}),
    ".webm": ("libvpx-vp9", {"crf": "31", "b": "0", "deadline": "realtime", "cpu-used": "6", "row-mt": "1"}, {}),
}
_GIF_COLOURS: Final = 120  # of the first frame
_CUBE: Final = tuple(itertools.product((0, 64, 128, 191, 255), repeat=3))  # colours that may appear later
_GIF_UNIT: Final = 10  # [ms] unit of the durations in a GIF file
_VERSION: Final = b"GIF89a"  # that of files with durations
_REPEATS: Final = b"!\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00"  # extension: plays for ever


class FrameFile(Protocol):
    """File that takes frames."""

    def take(self, frame: Colours) -> None:
        """Add a frame, shape (height, width, 3)."""
        ...

    def close(self) -> None:
        """Complete the file; a second call does nothing."""
        ...


def check_video_target(path: Path, option: str, suffixes: tuple[str, ...]) -> None:
    """Check before a run whether its video can be written.

    Raises:
        InputError: SK-CLI-053 the suffix is not supported, the folder does not exist, or PyAV is not installed.
    """
    expected = " or ".join(suffixes)
    if path.suffix.lower() not in suffixes:
        suffix = path.suffix or "no suffix"
        raise InputError("SK-CLI-053", f"{option} {path}: found {suffix}; expected {expected}")
    if not path.absolute().parent.is_dir():
        raise InputError("SK-CLI-053", f"{option} {path}: folder {path.absolute().parent} does not exist")
    if path.exists() and not path.is_file():
        raise InputError("SK-CLI-053", f"{option} {path}: it is not a regular file")
    if path.suffix.lower() != ".gif":
        _import_av()


def open_video(path: Path, rate: Fraction) -> FrameFile:
    """Open a file for frames: `.gif`, `.mp4` or `.webm`.

    Args:
        path: file to write.
        rate: frames per second of simulated time [Hz].
    """
    return GifFile(path, rate) if path.suffix.lower() == ".gif" else VideoFile(path, rate)


def _import_av() -> Any:
    try:
        import av
    except ImportError as error:
        help_ = f"{install_command('video')}, or write a GIF with --gif OUT.gif"
        raise InputError("SK-CLI-053", f"videos need the package av ({error})", help=help_) from None
    return av


class VideoFile:
    """Writer of an MP4 or WebM file.

    Args:
        path: file to write.
        rate: frames per second [Hz].
    """

    def __init__(self, path: Path, rate: Fraction) -> None:
        self._av = _import_av()
        self._path, self._rate = path, rate
        self._container: Any = None
        self._stream: Any = None

    def take(self, frame: Colours) -> None:
        """Add a frame; all frames have the size of the first one, without an odd last row or column."""
        height, width = (size - size % 2 for size in frame.shape[:2])
        if self._container is None:
            self._open(width, height)
        picture = self._av.VideoFrame.from_ndarray(np.ascontiguousarray(frame[:height, :width]), format="rgb24")
        for packet in self._stream.encode(picture):
            self._container.mux(packet)

    def close(self) -> None:
        """Write the last frames and the index."""
        container, self._container = self._container, None
        if container is None:
            return
        for packet in self._stream.encode():
            container.mux(packet)
        container.close()

    def _open(self, width: int, height: int) -> None:
        codec, options, settings = _CODECS[self._path.suffix.lower()]
        try:
            self._container = self._av.open(str(self._path), "w", options=settings)
        except OSError as error:
            raise InputError("SK-CLI-053", f"cannot write {self._path}: {error.strerror}") from None
        self._stream = self._container.add_stream(codec, rate=self._rate, options=options)
        self._stream.width, self._stream.height, self._stream.pix_fmt = width, height, "yuv420p"


class GifFile:
    """Writer of a GIF file, which repeats for ever. All frames have the colours of the first one and those of marks.

    Each frame is written when the next one comes: only the rectangle that differs from the frame before it.

    Args:
        path: file to write.
        rate: frames per second [Hz]; the file has durations in units of 10 ms.
    """

    def __init__(self, path: Path, rate: Fraction) -> None:
        self._path, self._rate = path, rate
        self._file: Any = None
        self._palette: Image | None = None
        self._last: Image | None = None  # newest frame, and the part of it that waits with its corner
        self._part: tuple[Image, tuple[int, int]] | None = None
        self._count, self._begun = 0, 0  # frames so far, and before the one that waits

    def take(self, frame: Colours) -> None:
        """Add a frame; a frame like the one before makes that longer."""
        from PIL import Image, ImageChops

        picture = Image.fromarray(frame)
        if self._palette is None:
            palette = picture.quantize(_GIF_COLOURS).getpalette() or []
            self._palette = Image.new("P", (1, 1))
            self._palette.putpalette([*palette[: 3 * _GIF_COLOURS], *itertools.chain(*MARK_COLOURS, *_CUBE)])
        picture = picture.quantize(palette=self._palette, dither=Image.Dither.NONE)
        changed = (0, 0, *picture.size)
        if self._last is not None:
            changed = ImageChops.difference(self._last, picture).getbbox()
        if changed is not None:
            self._write_part()
            self._part, self._begun = (picture.crop(changed), changed[:2]), self._count
        self._last = picture
        self._count += 1

    def close(self) -> None:
        """Write the last frame and the end of the file."""
        if self._last is None:
            return
        self._write_part()
        self._last = self._part = None
        self._write(b";")
        self._file.close()

    def _write_part(self) -> None:
        """Write the part that waits."""
        from PIL import GifImagePlugin

        if self._part is None:
            return
        picture, corner = self._part
        begin, end = (round(n * 1000 / _GIF_UNIT / self._rate) * _GIF_UNIT for n in (self._begun, self._count))
        if self._file is None:
            header = b"".join(GifImagePlugin.getheader(picture)[0])
            self._write(_VERSION, header[len(_VERSION) :], _REPEATS)
        self._write(*GifImagePlugin.getdata(picture, corner, duration=max(end - begin, _GIF_UNIT)))

    def _write(self, *blocks: bytes) -> None:
        try:
            if self._file is None:
                self._file = self._path.open("wb")
            self._file.writelines(blocks)
        except OSError as error:
            raise InputError("SK-CLI-053", f"cannot write {self._path}: {error.strerror}") from None
