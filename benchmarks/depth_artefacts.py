"""Artefacts of depth cameras: a depth image of 640 x 480 with each of them beside the same image without.

python benchmarks/depth_artefacts.py [--rounds N]
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

from measure import arguments, report

import simkit
from simkit.cli.bench_figures import Figure, time_interleaved

_PICTURES = 3  # of each side at a time
ROOM = """<sdf version="1.9" xmlns:simkit="simkit"><world name="w">{others}
  <model name="m"><static>true</static><pose>0 0 0.5 0 0 0</pose><link name="l">
  <sensor name="s" type="depth_camera"><update_rate>30</update_rate><topic>c</topic><camera>
  <horizontal_fov>1.2</horizontal_fov><image><width>640</width><height>480</height></image>
  <clip><near>0.1</near><far>20</far></clip>{camera}</camera>{artefact}</sensor></link></model></world></sdf>"""
BOX = """<model name="b{0}"><static>true</static><pose>{1}</pose><link name="l"><visual name="v"><geometry><box>
  <size>{2}</size></box></geometry></visual></link></model>"""
BOXES = (
    ("4 0 1 0 0 0", "0.1 8 4"), ("0 0 -0.05 0 0 0", "20 20 0.1"), ("2 0.6 0.4 0 0 0.5", "0.4 0.4 0.8"),
    ("2.5 -0.7 0.3 0 0 0.2", "0.5 0.5 0.6"), ("1.2 -0.3 0.5 0 0 0", "0.1 0.1 1.0"),
)  # fmt: skip
ERROR = "<stddev>0.002</stddev><coefficient>0.0019</coefficient><exponent>2.36</exponent>"
HOLES = "<probability>0.1</probability><correlation_length>5</correlation_length>"
ARTEFACTS = {
    "disparity noise of the file, for comparison": "",
    "depth_error": f"<simkit:depth_error><scale>-0.012</scale>{ERROR}</simkit:depth_error>",
    "depth_error, noise of windows of 5 px": "<simkit:depth_error><correlation_length>5</correlation_length>"
    f"{ERROR}</simkit:depth_error>",
    "depth_error, noise by angle": "<simkit:depth_error><incidence_exponent>1</incidence_exponent>"
    f"{ERROR}</simkit:depth_error>",
    "depth_holes, by chance": f"<simkit:depth_holes>{HOLES}</simkit:depth_holes>",
    "depth_holes, that stay for 0.5 s": f"<simkit:depth_holes>{HOLES}<correlation_time>0.5</correlation_time>"
    "</simkit:depth_holes>",
    "depth_holes, by angle, wedge and vignetting": f"<simkit:depth_holes>{HOLES}<vignetting>0.5</vignetting><incidence>"
    "<start>1.1</start><end>1.4</end></incidence><wedge><start>0.6</start><end>0.3</end></wedge></simkit:depth_holes>",
    "depth_holes, by brightness": f"<simkit:depth_holes>{HOLES}<brightness><start>0.2</start><end>0.1</end>"
    "</brightness></simkit:depth_holes>",
    "depth_holes, by named surface": f"<simkit:depth_holes>{HOLES}<surface><name>b1</name></surface>"
    "</simkit:depth_holes>",
    "occlusion_shadow": "<simkit:occlusion_shadow><baseline>0.05</baseline></simkit:occlusion_shadow>",
    "flying_pixels": "<simkit:flying_pixels/>",
    "multipath": "<simkit:multipath/>",
    "phase_wrap": "<simkit:phase_wrap><range>3.75</range></simkit:phase_wrap>",
    "lost_depth": "<simkit:lost_depth><value>nan</value></simkit:lost_depth>",
}
NOISE = "<simkit:disparity_noise><stddev>0.08</stddev><baseline>0.05</baseline></simkit:disparity_noise>"


def loaded(stack: ExitStack, artefact: str, camera: str = "") -> Any:
    """Return a depth camera whose image has a reader."""
    others = "".join(BOX.format(i, *box) for i, box in enumerate(BOXES))
    text = ROOM.format(others=others, artefact=artefact, camera=camera)
    sim = stack.enter_context(simkit.load(text, render_thread=False))
    sim.run(0.1)
    sim.engine.physics.fresh_accelerations()
    sim.communication.bus.tap("/c", lambda message: None)
    return sim, sim.sensor("m::l::s")


def rows(rounds: int) -> Iterator[Figure]:
    """Yield the time of an image with each artefact, and of one without."""

    def sample(sim: Any, camera: Any) -> None:
        for _ in range(_PICTURES):
            camera.sample(sim.tick)

    for name, artefact in ARTEFACTS.items():
        with ExitStack() as stack:
            plain = loaded(stack, "")
            changed = loaded(stack, artefact, "" if artefact else NOISE)
            times = time_interleaved([lambda: sample(*changed), lambda: sample(*plain)], rounds)  # noqa: B023
        yield Figure(f"depth 640x480: {name}", "picture", times[0] / _PICTURES, times[1] / _PICTURES)


if __name__ == "__main__":
    report(rows(arguments(__doc__, 15).rounds))
