"""Sea in pictures: `vrx::WaveVisual` of VRX."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np

from simkit import Params
from simkit.extend import Options, OptionsOf, block, listens, without_effect
from simkit_water_and_air.plugins.fluids.wave_field import PARAMETERS, WavefieldOptions, WavesBase

if TYPE_CHECKING:
    from simkit import Visual
    from simkit.extend import SceneVisual, SpecBuilder, Vector

_SECTORS: Final = 64
_GROWTH: Final = 1.1  # ratio of the radii of neighbouring rings
_REACH: Final = 40.0  # radius of the drawn sea in heights of the camera above it
_NEAREST: Final = 0.1  # radius of the innermost ring in heights of the camera above it
_LOWEST: Final = 0.1  # [m] least height of the camera for the radii of the rings
_OVERLAP: Final = 1.05  # of neighbouring tiles, which hides the gaps between them
_THICKNESS: Final = 0.005  # [m]
_COLOUR: Final = np.array((0.05, 0.25, 0.4, 1.0), np.float32)
_SHINE: Final = (0.7, 0.4)  # strength and narrowness of highlights, in MuJoCo's units
_BOX, _NOTHING = int(mujoco.mjtGeom.mjGEOM_BOX), int(mujoco.mjtGeom.mjGEOM_NONE)
_GEOM: Final = int(mujoco.mjtObj.mjOBJ_GEOM)


class WaveVisualOptions(Options):
    """Options of `WaveVisual`."""

    wavefield: WavefieldOptions = block(WavefieldOptions)
    shader: bool = without_effect()


class WaveVisual(WavesBase):
    """Draws the waves in pictures and films of a run, in place of its visual.

    The waves are those of `<wavefield>` or of messages on its `<topic>`. Cameras and the page show the flat visual.
    """

    endpoints = (listens("/wavefield/parameters", PARAMETERS, named_by=("wavefield/topic",)),)
    options = OptionsOf(WaveVisualOptions)
    parent_kind = "visual"  # type: ignore[assignment]  # the base class is for models
    filenames = ("libWaveVisual.so",)
    names = ("vrx::WaveVisual",)
    lets_sleep = True

    def prepare(self, scene: SceneVisual, params: Params, builder: SpecBuilder) -> None:
        self.read_waves(self.options.read_all().wavefield)
        params.block("shader").mark_all_read()  # files and values of a shader of Gazebo

    def load(self, parent: Visual, params: Params) -> None:  # type: ignore[override]  # as `parent_kind`
        self._visual = parent
        self.listen_to_waves(self.options.wavefield)

    def draw_shapes(self, scene: mujoco.MjvScene, eye: Vector) -> None:
        """Add tiles of the surface, in rings around the camera, to the shapes of a picture."""
        own = set(self._visual.geoms)
        for geom in scene.geoms[: scene.ngeom] if own else ():
            if geom.objtype == _GEOM and geom.objid in own:
                geom.type = _NOTHING
        x, y, z = map(float, eye)
        level = float(self._visual.pose.position[2])
        height = max(abs(z - level), _LOWEST)
        radius, farthest, turn = _NEAREST * height, _REACH * height + 100.0, 2 * math.pi / _SECTORS
        position, axes = self._tile(x, y, 1.0, 0.0, level)
        self._add_tile(scene, np.array((radius, radius, _THICKNESS)), position, axes)
        while radius < farthest and scene.ngeom + _SECTORS < scene.maxgeom:
            middle = radius * (1 + _GROWTH) / 2
            size = np.array((radius * (_GROWTH - 1) / 2 * _OVERLAP, middle * turn / 2 * _OVERLAP, _THICKNESS))
            for sector in range(_SECTORS):
                c, s = math.cos(sector * turn), math.sin(sector * turn)
                position, axes = self._tile(x + middle * c, y + middle * s, c, s, level)
                self._add_tile(scene, size, position, axes)
            radius *= _GROWTH

    @staticmethod
    def _add_tile(scene: mujoco.MjvScene, size: Vector, position: Vector, axes: Vector) -> None:
        """Add a box with these half sizes [m]."""
        tile = scene.geoms[scene.ngeom]
        mujoco.mjv_initGeom(tile, _BOX, size, position, axes, _COLOUR)
        tile.specular, tile.shininess = _SHINE
        scene.ngeom += 1

    def _tile(self, x: float, y: float, c: float, s: float, level: float) -> tuple[Vector, Vector]:
        """Return the position of a tile, and its rotation matrix as nine numbers; its x axis points along (c, s)."""
        waves, time, step = self._waves, self.sim.time, 0.1
        here = waves.height(x, y, time)
        outwards = (waves.height(x + step * c, y + step * s, time) - here) / step
        across = (waves.height(x - step * s, y + step * c, time) - here) / step
        along = np.array((c, s, outwards)) / math.sqrt(1 + outwards * outwards)
        normal = np.array((-c * outwards + s * across, -s * outwards - c * across, 1.0))
        normal /= math.sqrt(1 + outwards * outwards + across * across)
        axes = np.stack((along, np.cross(normal, along), normal), axis=1)
        return np.array((x, y, level + here)), axes.reshape(9)
