"""Cost of the artefacts of colour cameras: time of the processor for an image of 640×480 px.

Run: python benchmarks/colour_artefacts.py
"""

from __future__ import annotations

import time

import simkit

WORLD = """<sdf version="1.9" xmlns:simkit="simkit"><world name="w"><gravity>0 0 0</gravity>
  <scene><background>0.5 0.5 0.5</background></scene>
  <model name="robot"><static>true</static><link name="l"><sensor name="eye" type="camera"><update_rate>10</update_rate>
    <camera><image><width>640</width><height>480</height></image></camera>{artefacts}</sensor></link></model>
  <model name="ball"><pose>3 0 0 0 0 0</pose><link name="l">
    <inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>
    <visual name="v"><geometry><sphere><radius>0.5</radius></sphere></geometry></visual></link></model>
</world></sdf>"""
SHUTTER = (
    "<simkit:shutter><type>rolling</type><line_time>0.00003</line_time><exposure>0.01</exposure>"
    "<sub_frames>{}</sub_frames></simkit:shutter>"
)
LIGHT = {
    "vignetting": "<simkit:vignetting/>",
    "exposure control, `auto`": "<simkit:exposure_control><mode>auto</mode></simkit:exposure_control>",
    "image sensor": "<simkit:image_sensor><read_noise>5</read_noise></simkit:image_sensor>",
    "white balance": "<simkit:white_balance><gains>0.9 1 1.1</gains></simkit:white_balance>",
}
IMAGES = 20


def cost(artefacts: str, is_moving: bool) -> float:
    """Return the time of the processor for an image [ms], with the steps between two images."""
    with simkit.load(WORLD.format(artefacts=artefacts)) as sim:
        if is_moving:
            sim.model("ball").set_velocity(linear=(0, 0.2, 0))
        sim.subscribe(sim.sensor("robot::l::eye").topic, lambda message: None)
        sim.run(0.15)
        start = time.process_time()
        sim.run(0.1 * IMAGES)
        return 1000 * (time.process_time() - start) / IMAGES


def main() -> None:
    """Print the rows of a table in Markdown."""
    print(f"| no artefact | {cost('', True):.1f} |")
    for count in (4, 8, 16, 32):
        print(f"| rolling shutter, {count} sub-frames | {cost(SHUTTER.format(count), True):.1f} |")
    print(f"| rolling shutter, 8 sub-frames, nothing moves | {cost(SHUTTER.format(8), False):.1f} |")
    for name, element in LIGHT.items():
        print(f"| {name} | {cost(element, True):.1f} |")
    print(f"| all artefacts of light | {cost(''.join(LIGHT.values()), True):.1f} |")


if __name__ == "__main__":
    main()
