"""Video of a camera as H.264 by UDP to a program of the same machine."""

from __future__ import annotations

import contextlib
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit.extend import SharedByCopies

if TYPE_CHECKING:
    import numpy.typing as npt


LOOPBACK: Final = "127.0.0.1"
_SETTINGS: Final = {"preset": "veryfast", "tune": "zerolatency", "g": "10", "b": "800k"}
"""Those of x264 with low latency; a program that connects late waits for at most ten images."""


_RATES: Final = (0.01, 1000.0)  # [Hz] slowest and fastest stream


class StreamError(Exception):
    """The encoder does not take the images; the message has its reason."""


class VideoStream(SharedByCopies):
    """Sender of images. A snapshot shares the stream, because a program that watches cannot go back in time.

    Args:
        port: UDP port of this machine.
        rate: images per second [Hz].
        is_rtp: True sends RTP, False an MPEG transport stream.

    Attributes:
        source: subscription whose images are sent; None while the stream is closed.
    """

    def __init__(self, port: int, rate: float, is_rtp: bool) -> None:
        self._format = "rtp" if is_rtp else "mpegts"
        self._address = f"rtp://{LOOPBACK}:{port}" if is_rtp else f"udp://{LOOPBACK}:{port}?pkt_size=1316"
        slowest, fastest = _RATES
        self._rate = Fraction(min(max(rate, slowest), fastest)).limit_denominator(1000) if rate > 0 else Fraction(30)
        self._av: Any = None
        self._container: Any = None
        self._stream: Any = None
        self._count = 0
        self.source: Any = None

    def open(self) -> None:
        """Load the encoder.

        Raises:
            ImportError: the package `av` is not installed.
        """
        import av

        self._av = av

    def send(self, image: npt.NDArray[np.uint8]) -> None:
        """Send an image, shape (height, width, 3), without an odd last row or column.

        Raises:
            StreamError: the encoder does not take the image; the stream is closed.
        """
        height, width = (size - size % 2 for size in image.shape[:2])
        if not (width and height):
            self.close()
            raise StreamError("it needs images of at least 2 x 2 pixels")
        try:
            if self._container is None:
                self._begin(width, height)
            frame = self._av.VideoFrame.from_ndarray(np.ascontiguousarray(image[:height, :width]), format="rgb24")
            frame.pts, frame.time_base = self._count, 1 / self._rate
            self._count += 1
            self._send(self._stream.encode(frame))
        except self._av.FFmpegError as error:
            self._container = None
            self.close()
            raise StreamError(f"{width} x {height} pixels, {float(self._rate):g} Hz: {error}") from None

    def close(self) -> None:
        """Send the last images and end the stream."""
        if self.source is not None:
            self.source.close()
            self.source = None
        if self._container is not None:
            self._send(self._stream.encode())
            self._container.close()
            self._container = None

    def _begin(self, width: int, height: int) -> None:
        self._container = self._av.open(self._address, "w", format=self._format)
        self._stream = self._container.add_stream("libx264", rate=self._rate, options=_SETTINGS)
        self._stream.width, self._stream.height, self._stream.pix_fmt = width, height, "yuv420p"

    def _send(self, packets: Any) -> None:
        for packet in packets:
            with contextlib.suppress(OSError):  # nobody listens at the port
                self._container.mux(packet)
