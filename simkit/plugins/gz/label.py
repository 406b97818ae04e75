"""gz's labels: `gz::sim::systems::Label`."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from simkit.params import Params
from simkit.plugins.base import Plugin
from simkit.plugins.options import Options, OptionsOf, integer
from simkit.runtime.handles.visual_properties import MAX_LABEL

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model, Visual
    from simkit.scene import SceneModel, SceneVisual


class LabelOptions(Options):
    """Options of `Label`."""

    label: int = integer(minimum=0, maximum=MAX_LABEL, required=True)


class Label(Plugin):
    """Gives its model, or its one visual, the number that segmentation and bounding box cameras tell.

    A visual's own counts more than its model's, a nested model's more than the outer one's. Of two on one element the
    later counts.
    """

    options = OptionsOf(LabelOptions)
    parent_kind = ("model", "visual")
    lets_sleep = True
    gives_labels: ClassVar[bool] = True
    filenames = ("gz-sim-label-system",)
    names = ("gz::sim::systems::Label",)

    def prepare(self, scene: SceneModel | SceneVisual, params: Params, builder: SpecBuilder) -> None:
        self._label = self.options.label
        self._is_lost = self.scoped != scene.scoped
        if self._is_lost:
            message = f"plugin {self.name!r} labels a model or a visual, it hangs on {self.scoped!r}; it has no effect"
            params.diagnostics.warning("SK-PLUGIN-007", message, self.where, "move it into the <model> or a <visual>")

    def load(self, parent: Model | Visual, params: Params) -> None:
        if not self._is_lost:
            self.sim.contents.labels[parent.scoped] = self._label
