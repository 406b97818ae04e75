"""Images with a rolling shutter and an exposure time have the shapes that a hand computation gives."""

from __future__ import annotations

import pickle

import numpy as np
import numpy.typing as npt
import pytest

import simkit
from simkit.sensors.cameras.tone_curve import WHITE, light_table

SPEED, FOCAL, DISTANCE = 2.0, 100.0, 2.0  # bar [m/s] that moves to the left in the image, lens [px], bar [m]
PIXEL_SPEED = SPEED * FOCAL / DISTANCE  # [px/s]
WORLD = """
<sdf version="1.9" xmlns:simkit="simkit"><world name="w"><gravity>0 0 0</gravity>
  <physics type="ode"><max_step_size>0.002</max_step_size></physics>
  <scene><background>0 0 0</background><ambient>1 1 1</ambient></scene>
  <model name="eye"><static>true</static><link name="l">
    <sensor name="camera" type="camera"><update_rate>10</update_rate><camera>
      <image><width>120</width><height>80</height><anti_aliasing>0</anti_aliasing></image>
      <lens><intrinsics><fx>100</fx><fy>100</fy><cx>60</cx><cy>40</cy></intrinsics></lens></camera>{shutter}</sensor>
  </link></model>
  <model name="bar"><pose>2 {y} 0 0 0 0</pose><link name="l">
    <inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>
    <visual name="v"><geometry><box><size>0.002 0.2 4</size></box></geometry>
      <material><ambient>1 1 1 1</ambient><diffuse>1 1 1 1</diffuse><emissive>1 1 1 1</emissive></material></visual>
  </link></model>
</world></sdf>"""


def shutter(**options: object) -> str:
    texts = "".join(f"<{option}>{value}</{option}>" for option, value in options.items())
    return f"<simkit:shutter>{texts}</simkit:shutter>"


def load(element: str, speed: float = SPEED, y: float = -0.4) -> simkit.Simulation:
    sim = simkit.load(WORLD.format(shutter=element, y=y))
    if speed:
        sim.model("bar").set_velocity(linear=(0, speed, 0))
    return sim


def pixels(sim: simkit.Simulation) -> npt.NDArray[np.uint8]:
    message = sim.sensor("eye::l::camera").latest
    return np.asarray(message.data).reshape(message.height, message.width, 3)[..., 0]


def light(sim: simkit.Simulation) -> npt.NDArray[np.float64]:
    values = light_table()[pixels(sim)] / WHITE
    return values / values.max()


def left_edges(picture: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return the column of the bar's left edge in each row [px], from the dark area on its left."""
    return np.argmax(picture > 0.5, axis=1).astype(float)


def centre_at(time: float) -> float:
    """Return the column of the bar's centre [px] at a time [s]."""
    return 60 - FOCAL / DISTANCE * (-0.4 + SPEED * time)


@pytest.mark.parametrize("direction", ["down", "up"])
def test_a_bar_that_moves_sideways_leans_by_its_speed_times_the_line_time(direction: str) -> None:
    line_time = 0.0005
    element = shutter(type="rolling", line_time=line_time, sub_frames=16, direction=direction)
    with load(element) as sim:
        sim.run(0.18)
        stamp = sim.sensor("eye::l::camera").latest.header.stamp
        edges = left_edges(light(sim))
    start = stamp.sec + stamp.nanosec * 1e-9
    assert start == pytest.approx(0.1)
    rows = np.arange(80.0)
    times = start + line_time * (rows if direction == "down" else rows[::-1])
    expected = np.array([centre_at(time) for time in times]) - FOCAL * 0.1 / (DISTANCE - 0.001)
    assert np.abs(edges - expected).max() <= 1.0
    lean = (edges[-1] - edges[0]) * (-1 if direction == "down" else 1)
    assert abs(lean - PIXEL_SPEED * line_time * 79) <= 1.0


def test_the_edge_of_a_moving_bar_is_blurred_over_speed_times_exposure() -> None:
    exposure = 0.06
    with load(shutter(exposure=exposure, sub_frames=60)) as sim:
        sim.run(0.18)
        row = light(sim)[40]
    blurred = np.count_nonzero((row > 0.02) & (row < 0.98)) / 2  # both edges
    assert abs(blurred - PIXEL_SPEED * exposure) <= 1.0
    # the light of all pixels is that of the bar, because it is the mean of the pictures
    assert abs(row.sum() - FOCAL * 0.2 / (DISTANCE - 0.001)) <= 0.6


def test_an_image_of_a_motionless_scene_equals_that_of_a_global_shutter() -> None:
    rolling = shutter(type="rolling", line_time=0.0005, exposure=0.01)
    with load(rolling, speed=0, y=0.1) as one, load("", speed=0, y=0.1) as other:
        one.run(0.15)
        other.run(0.15)
        assert (pixels(one) == pixels(other)).all()
        assert pixels(one).any()


def test_an_image_arrives_at_the_end_of_its_readout_with_the_stamp_of_its_beginning() -> None:
    arrivals: list[tuple[float, float]] = []
    with load(shutter(type="rolling", line_time=0.0005, exposure=0.01)) as sim:

        def note(message: simkit.msgs.Image) -> None:
            arrivals.append((message.header.stamp.sec + message.header.stamp.nanosec * 1e-9, sim.time))

        sim.subscribe(sim.sensor("eye::l::camera").topic, note)
        sim.run(0.36)
    assert [round(stamp, 6) for stamp, _ in arrivals] == [0.002, 0.1, 0.2, 0.3]
    assert all(abs(time - stamp - 0.05) < 1e-6 for stamp, time in arrivals)  # 79 lines and the exposure: 0.0495 s


def test_reset_and_snapshot_during_an_exposure_repeat_the_image() -> None:
    with load(shutter(type="rolling", line_time=0.0005, exposure=0.01)) as sim:
        sim.run(0.12)  # the exposure of the second image has begun at 0.1 s
        snapshot = sim.snapshot()
        sim.run(0.06)
        image = pixels(sim).copy()
        sim.run(0.1)
        assert (pixels(sim) != image).any()
        sim.restore(snapshot)
        sim.run(0.06)
        assert (pixels(sim) == image).all()
        sim.restore(snapshot)
        sim.reset()
        sim.model("bar").set_velocity(linear=(0, SPEED, 0))
        sim.run(0.18)
        assert (pixels(sim) == image).all()


def test_the_image_is_the_same_with_and_without_a_reader() -> None:
    element = shutter(type="rolling", line_time=0.0005, exposure=0.01)
    with load(element) as read, load(element) as unread:
        read.subscribe(read.sensor("eye::l::camera").topic, lambda message: None)
        read.run(0.18)
        unread.run(0.18)
        assert (pixels(read) == pixels(unread)).all()


def test_a_shutter_slower_than_the_images_is_an_error() -> None:
    with pytest.raises(simkit.errors.SimkitError, match="SK-SENSOR-239"):
        load(shutter(exposure=0.2))


def test_a_rolling_shutter_without_a_line_time_is_reported() -> None:
    with load(shutter(type="rolling"), speed=0) as sim:
        assert any(d.code == "SK-SENSOR-240" for d in sim.diagnostics)


def test_pictures_of_a_pickled_snapshot_and_of_the_software_renderer_are_the_same_in_a_second_run() -> None:
    element = shutter(type="rolling", line_time=0.0005, exposure=0.01)
    world = WORLD.format(shutter=element, y=-0.4).replace(
        "<scene>", "<scene><simkit:renderer>software</simkit:renderer>"
    )
    images = []
    for _ in range(2):
        with simkit.load(world) as sim:
            sim.model("bar").set_velocity(linear=(0, SPEED, 0))
            sim.run(0.12)
            snapshot = pickle.loads(pickle.dumps(sim.snapshot()))
            sim.run(0.06)
            images.append(pixels(sim).copy())
            sim.restore(snapshot)
            sim.run(0.06)
            images.append(pixels(sim).copy())
    assert all((image == images[0]).all() for image in images)
    assert images[0].any()


def test_colours_of_depth_cameras_and_of_each_camera_of_a_rig_have_the_shutter() -> None:
    element = shutter(type="rolling", line_time=0.0005, sub_frames=16)
    text = WORLD.format(shutter=element, y=-0.4)
    start, end = text.index("<camera>"), text.index("</camera>") + len("</camera>")
    block = text[start:end]
    depth = text.replace('type="camera"', 'type="rgbd_camera"')
    rig = text.replace('type="camera"', 'type="multicamera"')
    rig = rig.replace(
        block, block.replace("<camera>", '<camera name="a">') + block.replace("<camera>", '<camera name="b">')
    )
    images = []
    for world in (text, depth, rig):
        with simkit.load(world) as sim:
            sim.model("bar").set_velocity(linear=(0, SPEED, 0))
            sim.run(0.18)
            images.append(left_edges(light(sim)))
    assert abs(images[0][0] - images[0][-1]) > 3
    assert all(np.abs(edges - images[0]).max() <= 1 for edges in images)
