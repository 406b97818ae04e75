"""A box falls, tips over its edge and comes to rest: what its contact sensor feels, against weight and momentum."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import plots

import simkit

MASS, GRAVITY = 2.0, 9.8  # [kg], [m/s²]
STEP, DURATION = 0.001, 1.2  # [s]
WORLD = f"""<sdf version="1.9"><world name="w">
  <physics type="x"><max_step_size>{STEP}</max_step_size></physics>
  <model name="ground"><static>true</static><link name="link"><collision name="plane">
    <geometry><plane/></geometry></collision></link></model>
  <model name="box"><pose>0 0 0.5 0 0.25 0</pose><link name="body">
    <inertial><mass>{MASS}</mass><inertia><ixx>0.02</ixx><iyy>0.02</iyy><izz>0.02</izz></inertia></inertial>
    <collision name="shell"><geometry><box><size>0.25 0.25 0.25</size></box></geometry></collision>
    <sensor name="skin" type="contact"><contact><collision>shell</collision></contact></sensor>
  </link></model></world></sdf>"""


def main(out: Path) -> None:
    """Writes the plot to `out`."""
    rows = []
    with simkit.load(WORLD) as sim:
        skin, body = sim.sensor("box::body::skin"), sim.link("box::body")
        force = impulse = 0.0
        while sim.time < DURATION:
            sim.step()
            impulse += force * STEP  # the force of a reading acts in the step that follows it
            force = sum(w.body_1_wrench.force.z for c in skin.latest.contacts for w in c.wrenches)
            momentum = MASS * float(body.linear_velocity[2])
            rows.append((sim.time, force, impulse, momentum + MASS * GRAVITY * sim.time))
    time, felt, impulses, expected = np.array(rows).T

    fig, (above, below) = plots.figure("Contact sensor on a box that falls from 0.5 m", 2, sharex=True)
    above.plot(time, felt, label="sum of body_1_wrench, upwards")
    above.axhline(MASS * GRAVITY, color=plots.TRUTH, linestyle="--", label="weight")
    above.set_yscale("symlog", linthresh=MASS * GRAVITY)
    above.set(ylabel="force [N]", ylim=(-1, None))
    above.legend(loc="upper right")

    below.plot(time, impulses, label="impulse felt, ∫F dt")
    below.plot(time, expected, color=plots.TRUTH, linestyle="--", label="change of momentum + weight · t")
    below.set(xlabel="time [s]", ylabel="impulse [N·s]")
    below.legend(loc="upper left")
    plots.save(fig, out)


if __name__ == "__main__":
    plots.run(main, "contact.png")
