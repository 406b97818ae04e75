"""Step 2: a plugin of a model, which keeps it moving.

simkit run push.sdf --plugin-path . --duration 2
"""

from __future__ import annotations

from simkit import Model, ModelPlugin, Params


class ModelPush(ModelPlugin):
    """Gives its model a velocity at every step, whatever is in the way: `<velocity>` [m/s] in the world."""

    filenames = ("libmodel_push.so",)

    def load(self, parent: Model, params: Params) -> None:
        self.model = parent
        self.velocity = params.vector3("velocity", (0.3, 0.0, 0.0))

    def before_step(self) -> None:
        self.model.set_velocity(self.velocity)
