"""Traffic light and level crossing of TurtleBot3's AutoRace course."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import simkit

COLOURS = {"red": (200, 0, 0), "yellow": (200, 200, 0), "green": (0, 200, 0)}


def write_world(folder: Path, top: str = "") -> Path:
    """Write a world with a camera in front of a traffic light, whose materials are beside it.

    Args:
        folder: folder of the files.
        top: further elements of the world.
    """
    for name in ("scripts", "textures"):
        (folder / "materials" / name).mkdir(parents=True, exist_ok=True)
    script = ""
    for name, colour in COLOURS.items():
        Image.new("RGB", (4, 4), colour).save(folder / "materials" / "textures" / f"traffic_light_{name}.png")
        script += f"material traffic_light_{name} {{ technique {{ pass {{ texture_unit {{\n"
        script += f"texture traffic_light_{name}.png\n}} }} }} }}\n"
    script = script.replace("{ ", "{\n").replace(" }", "\n}")
    (folder / "materials" / "scripts" / "traffic_light.material").write_text(script)
    material = """<material><script><uri>materials/scripts</uri><uri>materials/textures</uri>
      <name>traffic_light_red</name></script></material>"""
    world = folder / "w.sdf"
    world.write_text(f"""<sdf version="1.6"><world name="w">{top}<scene><ambient>1 1 1 1</ambient></scene>
      <model name="light"><pose>1 0 0 0 0 0</pose><static>1</static><link name="l"><visual name="v"><geometry><box>
      <size>0.1 1 1</size></box></geometry>{material}</visual></link>
      <plugin name="p" filename="libtraffic_light_plugin.so"/></model>
      <model name="eye"><static>1</static><link name="l"><sensor name="camera" type="camera">
      <update_rate>2</update_rate><camera><horizontal_fov>0.6</horizontal_fov><image><width>8</width><height>8</height></image>
      <clip><near>0.05</near><far>10</far></clip></camera></sensor></link></model></world></sdf>""")
    return world


@pytest.fixture
def light_world(tmp_path: Path) -> Path:
    return write_world(tmp_path)


def colour_seen(sim: simkit.Simulation) -> str:
    """Return the colour of the middle of the camera's last picture."""
    picture = np.frombuffer(sim.sensor("eye::l::camera").truth.data, np.uint8)
    pixel = picture.reshape(8, 8, 3)[4, 4].astype(int)
    return min(COLOURS, key=lambda name: int(np.abs(pixel / max(1, pixel.max()) * 200 - COLOURS[name]).sum()))


def test_the_light_is_red_for_5_s_yellow_for_1_s_and_green_for_5_s(light_world: Path) -> None:
    with simkit.load(light_world) as sim:
        seen = []
        for seconds in (4.6, 1.0, 1.0, 4.0, 1.0):  # to 4.6, 5.6, 6.6, 10.6 and 11.6 s
            sim.run(seconds)
            seen.append(colour_seen(sim))
        assert seen == ["red", "yellow", "green", "green", "red"]


def test_a_snapshot_and_a_spawned_model_keep_the_light(light_world: Path) -> None:
    with simkit.load(light_world) as sim:
        sim.run(7.0)
        saved = sim.snapshot()
        sim.run(5.0)
        assert colour_seen(sim) == "red"
        sim.restore(saved)
        sim.spawn("""<sdf version="1.9"><model name="box"><pose>0 5 0 0 0 0</pose><static>1</static><link name="l">
          <visual name="v"><geometry><box><size>1 1 1</size></box></geometry><material><diffuse>1 0 1 1</diffuse>
          <specular>1 1 1 1</specular></material></visual></link></model></sdf>""")
        sim.run(1.0)
        assert colour_seen(sim) == "green"


def test_a_light_without_its_textures_says_so() -> None:
    with simkit.load("""<sdf version="1.6"><world name="w"><model name="light"><static>1</static><link name="l"/>
      <plugin name="p" filename="libtraffic_light_plugin.so"/></model></world></sdf>""") as sim:
        assert "SK-PLUGIN-003" in {d.code for d in sim.diagnostics}
        sim.run(6.0)


def test_the_bar_opens_after_10_s_and_closes_after_20_s_without_falling() -> None:
    with simkit.load("""<sdf version="1.6"><world name="w"><model name="bar"><pose>-0.8 1.26 0.125 0 0 -1.57</pose>
      <link name="l"><collision name="c"><geometry><box><size>0.3 0.02 0.05</size></box></geometry></collision></link>
      <plugin name="p" filename="libtraffic_bar_plugin.so"/></model></world></sdf>""") as sim:
        bar = sim.model("bar")
        sim.run(9.9)
        assert bar.pose.position == pytest.approx((-0.8, 1.26, 0.125), abs=1e-9)
        sim.run(1.0)
        assert bar.pose.position == pytest.approx((-0.75, 1.11, 0.275), abs=1e-9)
        sim.run(10.0)
        assert bar.pose.position == pytest.approx((-0.85, 1.26, 0.125), abs=1e-9)
