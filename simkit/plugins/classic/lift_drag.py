"""Wings of Gazebo Classic: `libLiftDragPlugin.so`."""

from __future__ import annotations

from simkit.plugins.fluids.wing import Wing


class LiftDragPlugin(Wing):
    """Lift and drag of a wing, fin or blade, from whichever side the stream comes; it makes no pitching moment.

    `<cp>` is seen from the link's centre of mass.
    """

    filenames = ("libLiftDragPlugin.so",)
    has_moment = False
    is_about_mass = True
