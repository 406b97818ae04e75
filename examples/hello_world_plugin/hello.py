"""The smallest plugin: it hangs on the world, greets when it is loaded, and once a second of simulated time.

simkit run examples/hello_world_plugin/world.sdf --plugin-path examples/hello_world_plugin --duration 3
"""

from __future__ import annotations

from simkit import Params, Simulation, WorldPlugin


class Hello(WorldPlugin):
    """Greets `<who>`, the world where the file names nobody."""

    after_step_rate = 1.0

    def load(self, parent: Simulation, params: Params) -> None:
        self.who = params.text("who", "world")
        self.greetings = 0
        self.greet()

    def after_step(self) -> None:
        self.greet()

    def greet(self) -> None:
        self.greetings += 1
        print(f"hello, {self.who}! (t = {self.sim.time:g} s)")
