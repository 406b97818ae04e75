"""Waves of a Gazebo Classic world: `libWavefieldModelPlugin.so` of VRX and asv_wave_sim."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from simkit import ModelPlugin, Params, Plugin
from simkit.extend import Options, OptionsOf, block, choice, did_you_mean, number, without_effect
from simkit_water_and_air.plugins.fluids.wave_field import WaveField, WaveOptions

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder


class ClassicWaveOptions(WaveOptions):
    """Options of the `<wave>` block, with the defaults of Gazebo Classic's plugin."""

    model: str = choice(("PMS", "CWR"), "CWR")
    count: float = number(1, element="number", minimum=0, maximum=1000)
    scale: float = number(2.0, minimum=1e-3, maximum=1e3)
    angle: float = number(2 * math.pi / 10, "rad", minimum=-1e4, maximum=1e4)
    period: float = number(1.0, "s", minimum=1e-3, maximum=1e6)
    tau: float = number(0.0, "s", minimum=0)


class WavefieldModelOptions(Options):
    """Options of `WavefieldModelPlugin`."""

    static: bool = without_effect()
    update_rate: bool = without_effect()
    size: bool = without_effect()  # of the picture of the waves
    cell_count: bool = without_effect()
    wave: ClassicWaveOptions = block(ClassicWaveOptions)


class WavefieldModelPlugin(ModelPlugin):
    """Sets the waves of the world, which the plugins of boats look up by the name of this plugin's model.

    Attributes:
        field: Waves.
    """

    options = OptionsOf(WavefieldModelOptions)
    filenames = ("libWavefieldModelPlugin.so",)
    lets_sleep = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        parameters = self.options.read_all().wave.read()
        self.field = WaveField(parameters.waves(), parameters.tau)

    def load(self, parent: Model, params: Params) -> None:
        """Do nothing."""


def waves_of(plugin: Plugin, model: str) -> WaveField:
    """Return the waves that a model sets; calm water, with a warning, if there is no such model.

    Args:
        plugin: Plugin that needs the waves.
        model: Name of the model; empty for the only model with waves.
    """
    sim = plugin.sim

    def find() -> WaveField:
        fields = {p.scoped: p.field for p in sim.engine.structure.all_plugins() if isinstance(p, WavefieldModelPlugin)}
        if not model:
            return next(iter(fields.values()), WaveField())
        if model not in fields:
            message = f"there is no model {model!r} with waves, so the water is calm"
            plugin._once.warn("SK-PLUGIN-140", "waves", message, did_you_mean(model, fields))
        return fields.get(model, WaveField())

    return sim.engine.names.shared(f"waves of {model}", find)
