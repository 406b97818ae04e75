"""Displays by the types of their messages, and what they use of a simulation."""

from __future__ import annotations

import html
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Pose
from simkit.errors import InputError, SimkitError
from simkit.extend import Diagnostics
from simkit.registry import Kinds
from simkit.scene import Mesh
from simkit_view.displays.display import Display
from simkit_view.displays.drawing import Arrays
from simkit_view.displays.frame_poses import FramePoses, Placement

if TYPE_CHECKING:
    from simkit import Simulation

DISPLAYS: Final[Mapping[str, type[Display]]] = Kinds(
    "simkit_view.displays", "simkit.displays", Display, lambda cls: cls.types
)
"""Class of the display of each type, in the folder `displays` of a pack."""
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
        self._meshes: dict[str, Arrays | SimkitError] = {}

    @property
    def find(self) -> Callable[[str], Placement | None]:
        """Function that returns the placement of a frame."""
        return self._frames.find

    @property
    def world_pose(self) -> Callable[[Placement], Pose]:
        """Function that returns the present pose of a placement in the world."""
        return self._frames.pose_of

    def read_mesh(self, uri: str) -> Arrays:
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
        mesh = self._meshes[uri]
        if isinstance(mesh, SimkitError):
            raise mesh
        return mesh

    def _read(self, uri: str) -> Arrays:
        from simkit.loaders.meshes.mesh_reader import load_mesh

        diagnostics = Diagnostics()
        model = self._sim.contents.models_reader(_MODEL.format(uri=html.escape(uri)), diagnostics)
        visuals = [visual for link in model.links for visual in link.visuals]
        mesh = visuals[0].geometry if visuals else None
        parts = [] if not isinstance(mesh, Mesh) or mesh.missing else load_mesh(mesh, diagnostics, visuals[0].where)
        if not parts:
            raise InputError(next((d.message for d in diagnostics), "it has no triangles"))
        if sum(len(part.faces) for part in parts) > _MOST_TRIANGLES:
            raise InputError(f"it has more than {_MOST_TRIANGLES} triangles")
        corners = np.concatenate([part.vertices[part.faces].reshape(-1, 3) for part in parts])
        colours = [
            np.broadcast_to(np.array(part.colour or (0.7, 0.7, 0.7, 1.0)), (3 * len(part.faces), 4)) for part in parts
        ]
        return {"corners": corners, "colours": np.round(255 * np.concatenate(colours)).astype(np.uint8)}
