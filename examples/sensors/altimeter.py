"""A ball that is dropped from 20 m and bounces, as its altimeter tells it: `python altimeter.py [OUT.png]`."""

from __future__ import annotations

from pathlib import Path

import plots

import simkit

WORLD = """<sdf version="1.9"><world name="hall">
  <include><uri>model://ground_plane</uri></include>
  <model name="ball"><pose>0 0 20 0 0 0</pose><link name="hull">
    <collision name="c"><geometry><sphere><radius>0.2</radius></sphere></geometry>
      <surface><bounce><restitution_coefficient>0.7</restitution_coefficient><threshold>0</threshold></bounce></surface>
    </collision>
    <sensor name="altimeter" type="altimeter"><update_rate>50</update_rate><altimeter>
      <vertical_position><noise type="gaussian"><stddev>0.3</stddev></noise></vertical_position>
      <vertical_velocity><noise type="gaussian"><stddev>0.5</stddev></noise></vertical_velocity>
    </altimeter></sensor></link></model></world></sdf>"""


def main(out: Path) -> None:
    with simkit.load(WORLD, seed=1) as sim:
        sensor = sim.sensor("ball::hull::altimeter")
        readings, truths = [], []
        for _ in range(400):
            sim.run(0.02)
            readings.append(sensor.latest)
            truths.append(sensor.truth)
    times = plots.stamps(readings)
    figure, axes = plots.figure("Altimeter: a ball dropped from 20 m", rows=2, sharex=True)
    for ax, field, unit in zip(axes, ("vertical_position", "vertical_velocity"), ("m", "m/s"), strict=True):
        ax.plot(times, [getattr(m, field) for m in readings], ".", markersize=3, label="reading")
        ax.plot(times, [getattr(m, field) for m in truths], color=plots.TRUTH, label="truth")
        ax.set_ylabel(f"{field} [{unit}]")
        ax.legend(loc="upper right")
    axes[1].set_xlabel("time [s]")
    plots.save(figure, out)


if __name__ == "__main__":
    plots.run(main, "altimeter.png")
