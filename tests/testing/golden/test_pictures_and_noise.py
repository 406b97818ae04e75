"""Pictures, point clouds and noise in golden runs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from falling import ball

from simkit import msgs
from simkit.run_spec import RunSpec, Tolerance
from simkit.testing.golden.store import read_golden, write_golden
from simkit.testing.run_record.message_recorder import message_recorder_for, pixels_of_image, points_of_cloud
from simkit.testing.run_record.record import Stream
from simkit.testing.run_record.run_recorder import record_run


def picture(number: int) -> object:
    data = np.full((48, 64, 3), number, np.uint8)
    return msgs.make(
        "sensor_msgs/msg/Image", height=48, width=64, encoding="rgb8", step=192, data=data.reshape(-1)
    )  # fmt: skip


@pytest.mark.parametrize(("count", "every"), [(5, 1), (32, 1), (33, 2), (100, 4)])
def test_every_second_or_fourth_of_many_pictures_is_stored(count: int, every: int) -> None:
    taker = message_recorder_for(RunSpec("", picture=16), None, "/image", "sensor_msgs/msg/Image")  # type: ignore[arg-type]
    for number in range(count):
        taker.take(picture(number))
    stream = Stream("/image", "sensor_msgs/msg/Image", np.arange(count))
    taker.fill(stream)
    found = stream.pictures
    assert found is not None and found.hashes is not None
    kept = np.arange(0, count, every)
    assert found.small.shape == (len(kept), 12, 16, 3)
    assert found.small[:, 0, 0, 0].tolist() == kept.tolist()
    assert found.kept is None if every == 1 else found.kept.tolist() == kept.tolist()  # type: ignore[union-attr]
    assert len(set(found.hashes.tolist())) == len(found.hashes) == count


def test_pixels_are_read_with_padding_and_both_byte_orders() -> None:
    rows = np.zeros((2, 10), np.uint8)
    rows[:, :6] = np.arange(6)
    image = msgs.make(
        "sensor_msgs/msg/Image", height=2, width=3, encoding="16UC1", step=10, is_bigendian=1, data=rows.reshape(-1)
    )
    assert pixels_of_image(image)[0, :, 0].tolist() == [1, 0x0203, 0x0405]
    assert pixels_of_image(msgs.make("sensor_msgs/msg/Image", height=9, width=9, encoding="rgb8", step=27)) is None
    assert pixels_of_image(msgs.make("sensor_msgs/msg/Image", encoding="made_up")) is None


def test_points_are_read_by_their_fields() -> None:
    fields = [{"name": n, "offset": o, "datatype": 7, "count": 1} for n, o in (("x", 0), ("y", 4), ("z", 8))]
    data = np.arange(8, dtype=np.float32).tobytes()
    cloud = msgs.make(
        "sensor_msgs/msg/PointCloud2", height=1, width=2, fields=fields, point_step=16, row_step=32,
        data=np.frombuffer(data, np.uint8),
    )  # fmt: skip
    assert points_of_cloud(cloud)["y"].tolist() == [1.0, 5.0]


def test_statistics_replace_samples(tmp_path: Path) -> None:
    scenario = RunSpec(
        str(ball(tmp_path)), duration=3.0, topics=("*imu*",),
        tolerances=(Tolerance("*imu.linear_acceleration.x", statistics=True),),
    )  # fmt: skip
    record = record_run(scenario)
    record.simulation.close()
    (stream,) = record.streams.values()
    assert "linear_acceleration.x" not in stream.columns and "linear_acceleration.y" in stream.columns
    noise = stream.statistics["linear_acceleration.x"]
    assert noise.count == 301
    # the deviation of 301 samples is known to 4 %; the tolerance is four standard errors
    assert noise.deviation[0] == pytest.approx(0.1, rel=4 / np.sqrt(2 * 301))
    assert abs(noise.mean[0]) < 4 * 0.1 / np.sqrt(301)
    write_golden(tmp_path / "g", record)
    back = read_golden(tmp_path / "g").streams[stream.topic].statistics["linear_acceleration.x"]
    assert back.count == noise.count and np.array_equal(back.quantiles, noise.quantiles)
