"""gz's wind: `gz::sim::systems::WindEffects`."""

from __future__ import annotations

from simkit.plugins.fluids.blowing import Blowing


class WindEffects(Blowing):
    """The world's wind, as it rises, turns, swells and flutters; it pushes links with `<enable_wind>`.

    `<force_approximation_scaling_factor>` [1/s] is a number, or a sum of polynomials by `<when>`.
    """

    filenames = ("gz-sim-wind-effects-system",)
    names = ("gz::sim::systems::WindEffects",)
