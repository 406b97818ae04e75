"""`<save>` of a camera that tells labels: samples of a data set, as Gazebo lays them out in folders."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from simkit.sensors.box_messages import TYPE_2D, TYPE_3D, as_csv
from simkit.sensors.saved_pictures import SavedPictures, as_png

if TYPE_CHECKING:
    from simkit.runtime import Simulation
    from simkit.scene import SceneSensor

IMAGE, COLOURS, LABELS, BOXES = "image", "colored", "labels", "boxes"
_FOLDERS: Final = {IMAGE: "images", COLOURS: "colored_maps", LABELS: "labels_maps", BOXES: "boxes"}


class SavedSamples(SavedPictures):
    """Writes `images/image_0000000.png`, `labels_maps/labels_0000000.png`, ..., `boxes/boxes_0000000.csv`.

    The numbers go on after those that lie in `images`, so that runs of several worlds make one data set.

    Args:
        folder: of the whole data set.
        what: IMAGE, COLOURS, LABELS or BOXES.
    """

    __slots__ = ()

    def __init__(self, sim: Simulation, sensor: SceneSensor, folder: Path, what: str) -> None:
        super().__init__(sim, sensor, folder / _FOLDERS[what], what, None)
        self._count = _files_in(folder / _FOLDERS[IMAGE])

    def _file(self, message: Any) -> tuple[str, bytes]:
        is_table = message.__msgtype__ in (TYPE_2D, TYPE_3D)
        data, ending = (as_csv(message), "csv") if is_table else (as_png(message), "png")
        return f"{self._name}_{self._count:07d}.{ending}", data


def _files_in(folder: Path) -> int:
    try:
        return sum(1 for _ in folder.iterdir())
    except OSError:
        return 0
