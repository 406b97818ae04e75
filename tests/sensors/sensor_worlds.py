"""Small worlds for sensor tests."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt


def sensor(
    kind: str, block: str, *, rate: float = 100, pose: str = "0 0 0 0 0 0", extra: str = "", name: str = "s"
) -> str:
    head = f'<sensor name="{name}" type="{kind}"><pose>{pose}</pose><update_rate>{rate}</update_rate>'
    return f"{head}{block}{extra}</sensor>"


def world(
    sensors: str, *, others: str = "", static: bool = True, pose: str = "0 0 1 0 0 0", body: str = "", top: str = ""
) -> str:
    """Return a world with other models and a model `m`, whose link `l` contains the sensors and `body`."""
    return f"""<sdf version="1.9"><world name="w">{top}
      <model name="m"><static>{str(static).lower()}</static><pose>{pose}</pose>
      <link name="l">{body}{sensors}</link></model>
      {others}</world></sdf>"""


def box(
    name: str,
    pose: str,
    size: str,
    *,
    colour: str = "1 1 1",
    collision: bool = True,
    visual: bool = True,
    retro: float = 0,
) -> str:
    shape = f"<geometry><box><size>{size}</size></box></geometry>"
    material = f"<material><ambient>{colour} 1</ambient><diffuse>{colour} 1</diffuse></material>"
    reflects = f"<laser_retro>{retro}</laser_retro>"
    parts = f'<collision name="c">{shape}{reflects}</collision>' if collision else ""
    parts += f'<visual name="v">{shape}{material}{reflects}</visual>' if visual else ""
    return f'<model name="{name}"><static>true</static><pose>{pose}</pose><link name="l">{parts}</link></model>'


def noise(stddev: float, mean: float = 0.0, more: str = "") -> str:
    return f'<noise type="gaussian"><mean>{mean}</mean><stddev>{stddev}</stddev>{more}</noise>'


def xyz(message: Any) -> npt.NDArray[np.float64]:
    return np.array((message.x, message.y, message.z))


def colours(message: Any) -> npt.NDArray[np.uint8]:
    """Return the pixels of an image, shape (h, w, 3), or (h, w) for a grey image."""
    shape = (message.height, message.width, 3) if message.step == 3 * message.width else (message.height, message.width)
    return np.asarray(message.data, dtype=np.uint8).reshape(shape)


def depths(message: Any) -> npt.NDArray[np.float32]:
    """Return the pixels of a depth image [m], shape (h, w)."""
    assert message.encoding == "32FC1"
    return np.asarray(message.data).view(np.float32).reshape(message.height, message.width)


def cloud(message: Any) -> npt.NDArray[Any]:
    """Return the points of a cloud as a structured array, shape (height, width)."""
    formats = {2: "u1", 4: "<u2", 7: "<f4"}
    dtype = np.dtype(
        {
            "names": [f.name for f in message.fields],
            "formats": [formats[f.datatype] for f in message.fields],
            "offsets": [f.offset for f in message.fields],
            "itemsize": message.point_step,
        }
    )
    return np.frombuffer(np.asarray(message.data).tobytes(), dtype).reshape(message.height, message.width)
