"""Displays by the types of their messages, and what they use of a simulation."""

from __future__ import annotations

import html
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit.bridges.view.displays.display import Display
from simkit.bridges.view.displays.frame_poses import FramePoses, Placement
from simkit.bridges.view.displays.grid_displays import GridCellsDisplay, GridDisplay
from simkit.bridges.view.displays.marker_display import MarkerDisplay
from simkit.bridges.view.displays.pose_displays import (
    OdometryDisplay,
    PathDisplay,
    PolygonDisplay,
    PoseArrayDisplay,
    PoseDisplay,
)
from simkit.diagnostics import Diagnostics
from simkit.errors import InputError, SimkitError
from simkit.pose import Pose
from simkit.scene import Mesh

if TYPE_CHECKING:
    from simkit.runtime import Simulation

DISPLAYS: Final[Mapping[str, type[Display]]] = {
    type_name: display
    for display in (
        PathDisplay,
        MarkerDisplay,
        GridDisplay,
        PoseArrayDisplay,
        PoseDisplay,
        OdometryDisplay,
        PolygonDisplay,
        GridCellsDisplay,
    )
    for type_name in display.types
}
"""Class of the display of each type; a new display is a class here."""
_MOST_MESHES: Final = 64
_MOST_TRIANGLES: Final = 300_000
_MODEL: Final = """<sdf version="1.9"><model name="marker"><static>true</static><link name="link"><visual name="visual">
<geometry><mesh><uri>{uri}</uri></mesh></geometry></visual></link></model></sdf>"""


class SimulationTools:
    """Frames and meshes of a simulation, for its displays; see `DisplayTools`.

    Args:
        sim: simulation.
        frames: poses of its frames.
    """

    def __init__(self, sim: Simulation, frames: FramePoses) -> None:
        self._sim, self._frames = sim, frames
        self._meshes: dict[str, Mapping[str, Any] | SimkitError] = {}

    @property
    def find(self) -> Callable[[str], Placement | None]:
        """Function that returns the placement of a frame."""
        return self._frames.find

    @property
    def world_pose(self) -> Callable[[Placement], Pose]:
        """Function that returns the present pose of a placement in the world."""
        return self._frames.pose_of

    def read_mesh(self, uri: str) -> Mapping[str, Any]:
        """Return corners and colours of a mesh file: the file is found as for a model that is spawned.

        Raises:
            SimkitError: the file cannot be used.
        """
        if uri not in self._meshes:
            if len(self._meshes) >= _MOST_MESHES:
                raise InputError(f"only {_MOST_MESHES} mesh files are read")
            try:
                self._meshes[uri] = self._read(uri)
            except SimkitError as error:
                self._meshes[uri] = error
        found = self._meshes[uri]
        if isinstance(found, SimkitError):
            raise found
        return found

    def _read(self, uri: str) -> Mapping[str, Any]:
        from simkit.compiler.meshes.mesh_reader import load_mesh

        found = Diagnostics()
        model = self._sim.contents.models_reader(_MODEL.format(uri=html.escape(uri)), found)
        visuals = [visual for link in model.links for visual in link.visuals]
        mesh = visuals[0].geometry if visuals else None
        parts = [] if not isinstance(mesh, Mesh) or mesh.missing else load_mesh(mesh, found, visuals[0].where)
        if not parts:
            raise InputError(next((d.message for d in found), "it has no triangles"))
        if sum(len(part.faces) for part in parts) > _MOST_TRIANGLES:
            raise InputError(f"it has more than {_MOST_TRIANGLES} triangles")
        corners = np.concatenate([part.vertices[part.faces].reshape(-1, 3) for part in parts])
        colours = [
            np.broadcast_to(np.array(part.colour or (0.7, 0.7, 0.7, 1.0)), (3 * len(part.faces), 4)) for part in parts
        ]
        return {"corners": corners, "colours": np.round(255 * np.concatenate(colours)).astype(np.uint8)}
