"""Small worlds for the tests of golden runs."""

from __future__ import annotations

from pathlib import Path

BALL = """<sdf version="1.9"><world name="w">
<model name="floor"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry></collision>
</link></model>
<model name="ball"><pose>0 0 0.3 0 0 0</pose><link name="l">
<collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>
<sensor name="imu" type="imu"><update_rate>100</update_rate><imu><linear_acceleration>
<x><noise type="gaussian"><mean>0</mean><stddev>0.1</stddev></noise></x></linear_acceleration></imu></sensor>
<sensor name="eye" type="gpu_lidar"><pose>0 0 0.2 0 0 0</pose><update_rate>10</update_rate><lidar><scan><horizontal>
<samples>36</samples><min_angle>-3</min_angle><max_angle>3</max_angle></horizontal></scan>
<range><min>0.05</min><max>5</max></range></lidar></sensor></link></model>
<model name="wall"><static>true</static><pose>2 0 0 0 0 0</pose><link name="l"><collision name="c"><geometry><box>
<size>0.1 4 4</size></box></geometry></collision></link></model>
</world></sdf>"""
"""World with a ball that falls on a floor in front of a wall; the ball has an IMU and a lidar."""


def ball(folder: Path, *changes: tuple[str, str]) -> Path:
    """Write the world to a file; replace some texts."""
    text = BALL
    for before, after in changes:
        assert before in text
        text = text.replace(before, after)
    path = folder / "ball.sdf"
    path.write_text(text)
    return path
