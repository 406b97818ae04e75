"""How the pictures of the sensor pages look, and how their scripts are started: `python imu.py [OUT.png]`."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

try:
    import matplotlib as mpl
except ModuleNotFoundError:
    sys.exit("the pictures of the sensors need matplotlib: pip install matplotlib")

mpl.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

DPI = 110
_COLOURS = 96
BLUE, ORANGE, GREEN, RED, SKY, PURPLE = "#0072b2", "#e69f00", "#009e73", "#d55e00", "#56b4e9", "#cc79a7"
"""Told apart by those who see no red or no green (Okabe and Ito); `TRUTH` is for what a sensor is compared with."""
TRUTH = "#222222"

_STYLE = {
    "axes.prop_cycle": mpl.cycler(color=[BLUE, ORANGE, GREEN, RED, SKY, PURPLE]),
    "axes.grid": True,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlesize": "medium",
    "axes.titlelocation": "left",
    "figure.titlesize": "large",
    "font.size": 10,
    "grid.alpha": 0.3,
    "legend.framealpha": 0.85,
    "lines.linewidth": 1.3,
    "path.simplify_threshold": 0.5,
}


def figure(title: str, rows: int = 1, columns: int = 1, **options: Any) -> tuple[Any, Any]:
    """An empty picture of 880 x 495 pixels.

    Args:
        title: above the whole picture.
        options: of `matplotlib.pyplot.subplots`, such as `sharex=True`.

    Returns:
        The figure, and its axes: one, or an array as `subplots` gives it.
    """
    mpl.rcParams.update(_STYLE)
    options = {"figsize": (8.0, 4.5), "dpi": DPI, "layout": "constrained", **options}
    fig, axes = plt.subplots(rows, columns, **options)
    fig.suptitle(title)
    for ax in np.ravel(axes):
        ax.set_axisbelow(True)
    return fig, axes


def save(fig: Any, out: Path | str, colours: int = _COLOURS) -> None:
    """Writes the picture as a PNG of a few colours, at most 256, and says where.

    It shows in no plot, and the file is a third as large.
    """
    from PIL import Image

    out = Path(out)
    fig.canvas.draw()
    pixels = Image.fromarray(np.asarray(fig.canvas.buffer_rgba())).convert("RGB")
    plt.close(fig)
    few = pixels.quantize(colours, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    few.save(out, format="PNG", optimize=True, dpi=(DPI, DPI))
    print(f"wrote {out}")


def stamps(messages: Iterable[Any]) -> np.ndarray:
    """Times of messages with a header [s]."""
    return np.array([m.header.stamp.sec + m.header.stamp.nanosec * 1e-9 for m in messages])


def run(main: Callable[[Path], None], default_name: str) -> None:
    """Calls `main` with the file that the command line names, or with `default_name` in the working directory."""
    if len(sys.argv) > 2:
        sys.exit(f"usage: python {Path(sys.argv[0]).name} [OUT.png]")
    main(Path(sys.argv[1] if len(sys.argv) == 2 else default_name))
