"""The wind of Gazebo Classic: `libWindPlugin.so`."""

from __future__ import annotations

from simkit.plugins.fluids.blowing import Blowing


class WindPlugin(Blowing):
    """The world's wind, as it rises, turns, swells and flutters; it pushes links with `<enable_wind>`.

    What is asked for is a wind over the ground and a vertical one, each of its own strength.
    """

    filenames = ("libWindPlugin.so",)
    has_field = False
