"""gz's wings: `gz::sim::systems::LiftDrag`."""

from __future__ import annotations

from simkit.plugins.fluids.wing import Wing


class LiftDrag(Wing):
    """Lift, drag and pitching moment of a wing, fin or blade, by straight lines over the angle of attack with a stall.

    `<cp>` is in the link's frame. The air moves with the world's wind. Without `<reversible>` a stream from behind does
    nothing.
    """

    filenames = ("gz-sim-lift-drag-system",)
    names = ("gz::sim::systems::LiftDrag",)
