"""Step 1: a plugin that says that it is there. It hangs on the world, as `hello.sdf` names it.

simkit run hello.sdf --plugin-path . --duration 1
"""

from __future__ import annotations

from simkit import Params, Simulation, WorldPlugin


class HelloWorld(WorldPlugin):
    """Says hello once. A world may go on calling it by the name of the library it was in Gazebo."""

    filenames = ("libgazebo_tutorials.so", "libhello_world.so")

    def load(self, parent: Simulation, params: Params) -> None:
        print(f"Hello, {params.text('who', 'World')}!")
