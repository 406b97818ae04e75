"""Step 3: a plugin of the world, which puts things into it while it runs, and takes them out again.

simkit run factory.sdf --plugin-path . --duration 5
"""

from __future__ import annotations

from simkit import Params, Pose, Simulation, WorldPlugin

BALL = """
<sdf version="1.9"><model name="ball"><link name="link">
  <inertial auto="true"/>
  <collision name="shape">
    <density>500</density>
    <geometry><sphere><radius>{radius}</radius></sphere></geometry>
  </collision>
  <visual name="shape"><geometry><sphere><radius>{radius}</radius></sphere></geometry></visual>
</link></model></sdf>
"""


class Factory(WorldPlugin):
    """Drops a ball every `<every>` [s] from `<from>` [m]; of more than `<most>` the oldest goes."""

    filenames = ("libfactory.so",)

    def load(self, parent: Simulation, params: Params) -> None:
        self.radius = params.number("radius", 0.1, minimum=0.01)
        self.start = params.vector3("from", (0.0, 0.0, 1.0))
        self.most = params.integer("most", 3, minimum=1)
        self.after_step_rate = 1.0 / params.number("every", 1.0, minimum=0.01)
        self.dropped = 0

    def after_step(self) -> None:
        self.sim.spawn(BALL.format(radius=self.radius), name=f"ball_{self.dropped}", pose=Pose(self.start))
        self.dropped += 1
        if self.dropped > self.most:
            self.sim.remove(f"ball_{self.dropped - self.most - 1}")
