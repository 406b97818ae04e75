"""Coloured panels of a buoy: `vrx::LightBuoyPlugin` of VRX."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit import Params, VisualPlugin
from simkit.extend import Options, OptionsOf, block, choice, did_you_mean, texts

if TYPE_CHECKING:
    from simkit import Visual

_COLOURS = {
    "red": (1.0, 0.0, 0.0),
    "green": (0.0, 1.0, 0.0),
    "blue": (0.0, 0.0, 1.0),
    "yellow": (1.0, 1.0, 0.0),
    "off": (0.0, 0.0, 0.0),
}
_NAMES = (*_COLOURS, *(name.upper() for name in _COLOURS), *(name.capitalize() for name in _COLOURS))


class PanelOptions(Options):
    """Options of the `<visuals>` block."""

    visual: tuple[str, ...] = texts(required=True)


class LightBuoyOptions(Options):
    """Options of `LightBuoyPlugin`."""

    color_1: str = choice(_NAMES, required=True)
    color_2: str = choice(_NAMES, required=True)
    color_3: str = choice(_NAMES, required=True)
    visuals: PanelOptions = block(PanelOptions)


class LightBuoy(VisualPlugin):
    """Shows three colours on the panels of a buoy, one second each, and then black for two seconds.

    `<color_1>` to `<color_3>` are red, green, blue, yellow or off. Each `<visual>` in `<visuals>` names a panel of the
    same link; names of models and links in front of it are ignored.
    """

    options = OptionsOf(LightBuoyOptions)
    filenames = ("libLightBuoyPlugin.so",)
    names = ("vrx::LightBuoyPlugin",)
    lets_sleep = True
    after_step_rate = 1.0

    def load(self, parent: Visual, params: Params) -> None:
        options = self.options.read_all()
        pattern = (options.color_1, options.color_2, options.color_3, "off", "off")
        self._pattern = tuple(_COLOURS[name.lower()] for name in pattern)
        panels = parent.link.visuals
        self._panels: list[Visual] = []
        for name in options.visuals.visual:
            short = name.replace("/", "::").rpartition("::")[2]
            if short in panels:
                self._panels.append(panels[short])
            else:
                message = f"plugin {self.name!r}: link {parent.link.scoped!r} has no visual {short!r}"
                params.warning("SK-PLUGIN-003", message, did_you_mean(short, panels))
        self._show(0)

    def reset(self) -> None:
        """Show the first colour."""
        self._show(0)

    def after_step(self) -> None:
        """Show the colour of this second."""
        self._show(round(self.sim.time))

    def _show(self, second: int) -> None:
        for panel in self._panels:
            panel.set_colour(*self._pattern[second % len(self._pattern)])
