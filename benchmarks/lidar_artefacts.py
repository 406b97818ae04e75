"""Cost of artefacts of lidars: a scan with each element, compared with the same scan without, timed in turn.

python benchmarks/lidar_artefacts.py [--rounds N]
"""

from __future__ import annotations

import statistics
import time

from measure import arguments

import simkit

GLASS = "<simkit:transmittance>0.9</simkit:transmittance>"
LIDARS = {"planar, 720 rays": (720, 1, 50), "16 layers, 14400 rays": (900, 16, 5)}
"""Samples of a layer, layers, and scans of one timing."""
ROWS = {
    "dropout": "<simkit:dropout><probability>0.25</probability></simkit:dropout>",
    "dropout, bursts": "<simkit:dropout><probability>0.25</probability><burst_length>4</burst_length></simkit:dropout>",
    "dropout by incidence": "<simkit:dropout><by_incidence><table>0 0 1.5 1</table></by_incidence></simkit:dropout>",
    "signal": "<simkit:signal><range>12</range><spread>0.1</spread></simkit:signal>",
    "range_error": "<simkit:range_error><stddev>0.01</stddev><resolution>0.001</resolution></simkit:range_error>",
    "intensity": "<simkit:intensity/>",
    "blind_zone": "<simkit:blind_zone><range>0.3</range></simkit:blind_zone>",
    "no_return": "<simkit:no_return><value>zero</value></simkit:no_return>",
    "sun": "<simkit:sun><azimuth>0</azimuth><elevation>0.5</elevation></simkit:sun>",
    "glass_and_mirrors": "<simkit:glass_and_mirrors/>",
    "beam, 7 parts": "<simkit:beam><divergence>0.003</divergence></simkit:beam>",
    "beam, 7 parts, dual": "<simkit:beam><divergence>0.003</divergence><returns>dual</returns></simkit:beam>",
}


def world(samples: int, layers: int, artefact: str) -> str:
    """Return a room with eight pillars, a pane, and a lidar in the middle."""
    parts = [("floor", "0 0 -1 0 0 0", "20 20 0.1", ""), ("pane", "2 0 0 0 0 0.3", "0.02 2 2", GLASS)]
    parts += [(f"wall{i}", f"{x} {y} 0 0 0 0", size, "") for i, (x, y, size) in enumerate(
        ((8, 0, "0.1 16 4"), (-8, 0, "0.1 16 4"), (0, 8, "16 0.1 4"), (0, -8, "16 0.1 4"))
    )]  # fmt: skip
    text = "".join(
        f'<model name="{name}"><static>true</static><pose>{pose}</pose><link name="l"><collision name="c"><geometry>'
        f"<box><size>{size}</size></box></geometry>{optics}</collision></link></model>"
        for name, pose, size, optics in parts
    )
    for i in range(8):
        pose = f"{3 + i % 3} {i - 3.5} 0 0 0 0"
        text += f"""<model name="pillar{i}"><static>true</static><pose>{pose}</pose><link name="l"><collision name="c">
          <geometry><cylinder><radius>0.2</radius><length>2</length></cylinder></geometry></collision></link></model>"""
    high = 0.26 if layers > 1 else 0.0
    return f"""<sdf version="1.9" xmlns:simkit="simkit"><world name="w">{text}<model name="m"><static>true</static>
      <link name="l"><sensor name="s" type="lidar"><update_rate>1000</update_rate><topic>s</topic><lidar><scan>
      <horizontal><samples>{samples}</samples><min_angle>-3.1</min_angle><max_angle>3.1</max_angle></horizontal>
      <vertical><samples>{layers}</samples><min_angle>{-high}</min_angle><max_angle>{high}
      </max_angle></vertical></scan><range><min>0.1</min><max>30</max></range></lidar>{artefact}</sensor></link>
      </model></world></sdf>"""


def seconds_a_scan(sim: simkit.Simulation, scans: int) -> float:
    """Return the CPU time [s] of a step with a scan and a callback."""
    begun = time.process_time()
    sim.step(scans)
    return (time.process_time() - begun) / scans


def main() -> None:
    rounds = arguments(__doc__, rounds=7).rounds
    for title, (samples, layers, scans) in LIDARS.items():
        for name, artefact in ROWS.items():
            with (
                simkit.load(world(samples, layers, "")) as plain,
                simkit.load(world(samples, layers, artefact)) as real,
            ):
                for sim in (plain, real):
                    sim.subscribe("/s", lambda _: None)
                    sim.step(scans)
                pairs = [(seconds_a_scan(plain, scans), seconds_a_scan(real, scans)) for _ in range(rounds)]
            before, after = (statistics.median(side) for side in zip(*pairs, strict=True))
            ratio = statistics.median(b / a for a, b in pairs)
            print(
                f"{title:24s} {name:22s} {before * 1e6:8.0f} us -> {after * 1e6:8.0f} us   ratio {ratio:5.2f}",
                flush=True,
            )


if __name__ == "__main__":
    main()
