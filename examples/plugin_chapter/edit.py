"""Step 4: a plugin that changes the world itself: its gravity and its light.

simkit run edit.sdf --plugin-path . --duration 2
"""

from __future__ import annotations

from dataclasses import replace

from simkit import Params, Simulation, WorldPlugin


class WorldEdit(WorldPlugin):
    """After `<at>` [s] gravity is `<gravity>` [m/s²], and `<light>` has `<share>` of its brightness left."""

    filenames = ("libworld_edit.so",)

    def load(self, parent: Simulation, params: Params) -> None:
        self.at = params.number("at", 1.0, minimum=0)
        self.gravity = params.vector3("gravity", (0.0, 0.0, -9.8))
        self.share = params.number("share", 1.0, minimum=0)
        self.lamp = parent.light(params.text("light", "sun"))
        self.is_done = False

    def after_step(self) -> None:
        if self.is_done or self.sim.time < self.at:
            return
        self.is_done = True
        self.sim.gravity = self.gravity
        self.lamp.change(replace(self.lamp.scene, intensity=self.lamp.scene.intensity * self.share))
