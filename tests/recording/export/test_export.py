"""A bag's numbers, pictures and clouds come out as they went in."""

from __future__ import annotations

import csv
import json
import math
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simkit import msgs
from simkit.errors import InputError
from simkit.recording.bags.writer import McapBag
from simkit.recording.export import ExportOptions, export_bag

SECOND = 1_000_000_000


def written(path: Path, *rows: tuple[float, str, Any]) -> Path:
    """A bag with messages of (time, topic, message)."""
    bag = McapBag(path)
    for time, topic, message in rows:
        channel = bag.channel(topic, msgs.type_name(message), latched=False)
        bag.write_raw(channel, msgs.serialize(message), round(time * SECOND))
    bag.close()
    return path


def table(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def image(values: Any, encoding: str, pad: int = 0, *, big: bool = False) -> Any:
    values = np.ascontiguousarray(values)
    height, width = values.shape[:2]
    swapped = values.astype(values.dtype.newbyteorder(">" if big else "<"))
    rows = swapped.reshape(height, -1).view(np.uint8)
    data = np.concatenate((rows, np.full((height, pad), 99, np.uint8)), axis=1).ravel()
    step = rows.shape[1] + pad
    return msgs.make(
        "sensor_msgs/msg/Image",
        height=height, width=width, encoding=encoding, step=step, is_bigendian=int(big), data=data,
    )  # fmt: skip


SCANS = [
    (0.5, "/scan", msgs.make("sensor_msgs/msg/LaserScan", ranges=[0.1, math.inf, math.nan], angle_min=-0.1)),
    (1.5, "/scan", msgs.make("sensor_msgs/msg/LaserScan", ranges=[3.3])),
]
FRAMES = [
    (
        t,
        "/tf",
        msgs.make(
            "tf2_msgs/msg/TFMessage",
            transforms=[
                {"child_frame_id": f"link_{i}", "transform": {"translation": {"x": t + i}}} for i in range(2)
            ],
        ),
    )
    for t in (0.0, 2.0)
]  # fmt: skip


def test_a_table_has_one_line_per_message_and_exact_numbers(tmp_path: Path) -> None:
    bag = written(tmp_path / "a.mcap", *SCANS, *FRAMES)
    export_bag(str(bag), str(tmp_path / "out"), ExportOptions())
    first, second = table(tmp_path / "out" / "scan.csv")
    assert first["time"] == "0.500000000" and second["time"] == "1.500000000"
    assert [first[f"ranges[{i}]"] for i in range(3)] == ["0.1", "inf", "nan"]
    assert [second[f"ranges[{i}]"] for i in range(3)] == ["3.3", "", ""]
    assert np.float32(first["angle_min"]) == np.float32(-0.1)
    assert [r["transforms[1].transform.translation.x"] for r in table(tmp_path / "out" / "tf.csv")] == ["1.0", "3.0"]
    index = json.loads((tmp_path / "out" / "index.json").read_text(encoding="utf-8"))
    assert [(t["topic"], t["messages"], t["file"]) for t in index["topics"]] == [
        ("/scan", 2, "scan.csv"),
        ("/tf", 2, "tf.csv"),
    ]


def test_arrays_equal_the_messages_and_lists_of_different_length_have_offsets(tmp_path: Path) -> None:
    bag = written(tmp_path / "a.mcap", *SCANS, *FRAMES)
    export_bag(bag, tmp_path / "out", ExportOptions(format="npz"))
    scan = np.load(tmp_path / "out" / "scan.npz", allow_pickle=False)
    assert scan["time_ns"].tolist() == [SECOND // 2, 3 * SECOND // 2]
    assert scan["ranges.offsets"].tolist() == [0, 3, 4] and scan["ranges"].dtype == np.float32
    assert scan["ranges"][[0, 3]].tolist() == np.array([0.1, 3.3], np.float32).tolist()
    frames = np.load(tmp_path / "out" / "tf.npz", allow_pickle=False)
    assert frames["transforms[].child_frame_id"].tolist() == [["link_0", "link_1"]] * 2
    assert frames["transforms[].transform.translation.x"].tolist() == [[0.0, 1.0], [2.0, 3.0]]


def test_parquet_keeps_lists(tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet", reason="Parquet is an extra")
    export_bag(written(tmp_path / "a.mcap", *SCANS), tmp_path / "out", ExportOptions(format="parquet"))
    rows = parquet.read_table(tmp_path / "out" / "scan.parquet").to_pylist()
    assert [len(r["ranges"]) for r in rows] == [3, 1] and rows[1]["ranges"][0] == np.float32(3.3)


def test_lists_in_lists_lose_nothing(tmp_path: Path) -> None:
    contact = msgs.make(
        "ros_gz_interfaces/msg/Contact",
        positions=[msgs.make("geometry_msgs/msg/Vector3", x=float(i)) for i in range(3)],
    )
    both = msgs.make("ros_gz_interfaces/msg/Contacts", contacts=[contact, msgs.make("ros_gz_interfaces/msg/Contact")])
    none = msgs.make("ros_gz_interfaces/msg/Contacts")
    bag = written(tmp_path / "a.mcap", (0.0, "/touch", both), (1.0, "/touch", none))
    export_bag(bag, tmp_path / "out", ExportOptions(format="npz"))
    found = np.load(tmp_path / "out" / "touch.npz")
    assert found["contacts[].positions[].x"].tolist() == [0.0, 1.0, 2.0]
    assert found["contacts[].positions[].x.count"].tolist() == [3, 0]
    assert found["contacts[].positions[].x.count.offsets"].tolist() == [0, 2, 2]
    export_bag(bag, tmp_path / "text", ExportOptions())
    assert len(table(tmp_path / "text" / "touch.csv")) == 2


COLOURS = np.arange(5 * 4 * 3, dtype=np.uint8).reshape(5, 4, 3)


@pytest.mark.parametrize(
    ("values", "encoding", "wanted"),
    [
        (COLOURS, "rgb8", COLOURS[:, :, ::-1]),
        (COLOURS, "bgr8", COLOURS),
        (COLOURS[:, :, 0], "mono8", COLOURS[:, :, 0]),
        (COLOURS[:, :, 0].astype(np.uint16) * 1000, "mono16", COLOURS[:, :, 0].astype(np.uint16) * 1000),
        (
            np.array([[0.0005, 1.5, np.inf, np.nan, 99.0]] * 2, np.float32),
            "32FC1",
            np.array([[0, 1500, 0, 0, 65535]] * 2, np.uint16),
        ),
    ],
)
@pytest.mark.parametrize(("pad", "big"), [(0, False), (3, True)])
def test_an_exported_image_has_the_recorded_values(
    values: Any, encoding: str, wanted: Any, pad: int, big: bool, tmp_path: Path
) -> None:
    import cv2

    bag = written(tmp_path / "a.mcap", (0.0, "/camera/image", image(values, encoding, pad, big=big)))
    export_bag(bag, tmp_path / "out", ExportOptions())
    (row,) = table(tmp_path / "out" / "camera_image.csv")
    assert row["file"] == "camera_image/000000.png" and row["encoding"] == encoding and "data" not in row
    found = cv2.imread(str(tmp_path / "out" / row["file"]), cv2.IMREAD_UNCHANGED)
    assert np.array_equal(found, wanted)
    export_bag(bag, tmp_path / "raw", ExportOptions(images="npz"))
    raw = np.load(tmp_path / "raw" / "camera_image" / "000000.npz")["pixels"]
    assert np.array_equal(raw, values, equal_nan=raw.dtype.kind == "f")


def test_a_compressed_image_is_copied_unchanged(tmp_path: Path) -> None:
    import cv2

    data = cv2.imencode(".jpg", COLOURS)[1].ravel()
    message = msgs.make("sensor_msgs/msg/CompressedImage", format="jpeg", data=data)
    export_bag(written(tmp_path / "a.mcap", (0.0, "/image", message)), tmp_path / "out", ExportOptions())
    assert (tmp_path / "out" / "image" / "000000.jpg").read_bytes() == data.tobytes()


def test_a_video_has_the_timing_of_the_bag(tmp_path: Path) -> None:
    import cv2

    frames = [image(np.full((48, 64, 3), 20 * k, np.uint8), "rgb8") for k in range(12)]
    times = [k * 0.1 for k in range(6)] + [1.0 + k * 0.1 for k in range(6)]  # half a second without
    rows = [(t, "/image", f) for t, f in zip(times, frames, strict=True)]
    found = export_bag(written(tmp_path / "a.mcap", *rows), tmp_path / "out", ExportOptions(images="mp4"))
    assert found[0].beside == "image.mp4"
    film = cv2.VideoCapture(str(tmp_path / "out" / "image.mp4"))
    levels = []
    while (frame := film.read())[0]:
        levels.append(float(frame[1].mean()))
    film.release()
    assert film.isOpened() is False and len(levels) == 16
    assert levels[7] == pytest.approx(100, abs=4) and levels[-1] == pytest.approx(220, abs=4)


def test_invalid_images_are_reported_and_the_others_are_written(tmp_path: Path) -> None:
    odd = msgs.make("sensor_msgs/msg/Image", height=9, width=9, encoding="rgb8", step=27, data=np.zeros(5, np.uint8))
    strange = msgs.make("sensor_msgs/msg/Image", height=1, width=1, encoding="yuv9", step=1, data=np.zeros(1, np.uint8))
    bag = written(tmp_path / "a.mcap", (0.0, "/a", odd), (0.0, "/b", strange), (1.0, "/a", image(COLOURS, "rgb8")))
    for images in ("png", "mp4", "npz"):
        a, b = export_bag(bag, tmp_path / images, ExportOptions(images=images))
        assert "has 5 bytes" in a.notes[0] and "unknown encoding 'yuv9'" in b.notes[0]
        assert [bool(r["file"]) for r in table(tmp_path / images / "a.csv")] == [False, True]


def cloud() -> Any:
    layout = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("rgb", "<u4"), ("ring", "<u2"), ("pad", "<u2")])
    data = np.zeros(3, layout)
    data["x"], data["rgb"], data["ring"] = [1.0, np.nan, 3.0], 0x102030, [4, 5, 6]
    fields = [
        msgs.make("sensor_msgs/msg/PointField", name=n, offset=o, datatype=k, count=1)
        for n, o, k in (("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("rgb", 12, 6), ("ring", 16, 4))
    ]
    return msgs.make(
        "sensor_msgs/msg/PointCloud2",
        height=1, width=3, fields=fields, point_step=20, row_step=60, data=data.view(np.uint8),
    )  # fmt: skip


def test_a_cloud_has_its_fields(tmp_path: Path) -> None:
    import trimesh

    bag = written(tmp_path / "a.mcap", (0.0, "/points", cloud()))
    export_bag(bag, tmp_path / "npz", ExportOptions())
    found = np.load(tmp_path / "npz" / "points" / "000000.npz")
    assert found["ring"].tolist() == [4, 5, 6] and np.isnan(found["x"][1])
    export_bag(bag, tmp_path / "ply", ExportOptions(clouds="ply"))
    points = trimesh.load(tmp_path / "ply" / "points" / "000000.ply")
    assert points.vertices[:, 0].tolist() == [1.0, 3.0]
    assert points.colors[0][:3].tolist() == [16, 32, 48]


def test_two_exports_of_one_bag_are_equal(tmp_path: Path) -> None:
    bag = written(tmp_path / "a.mcap", *SCANS, (0.0, "/points", cloud()), (0.0, "/image", image(COLOURS, "rgb8")))
    for wish in (ExportOptions(), ExportOptions(format="npz", images="npz", clouds="ply")):
        trees = []
        for name in (f"{wish.format}_1", f"{wish.format}_2"):
            export_bag(bag, tmp_path / name, wish)
            files = sorted(p for p in (tmp_path / name).rglob("*") if p.is_file())
            trees.append([(str(p.relative_to(tmp_path / name)), p.read_bytes()) for p in files])
        assert trees[0] == trees[1] and len(trees[0]) == 6


def test_topics_whose_file_names_are_equal_get_different_files(tmp_path: Path) -> None:
    text = msgs.make("std_msgs/msg/String", data='a,\n"b"')
    bag = written(tmp_path / "a.mcap", *((0.0, t, text) for t in ("/a/b", "/a_b", "/A_b", "/index", "/../../x")))
    found = export_bag(bag, tmp_path / "out", ExportOptions())
    assert len({f.file.lower() for f in found}) == 5
    assert all((tmp_path / "out" / f.file).resolve().parent == (tmp_path / "out").resolve() for f in found)
    assert table(tmp_path / "out" / found[0].file)[0]["data"] == 'a,\n"b"'


def test_only_selected_topics_are_exported(tmp_path: Path) -> None:
    bag = written(tmp_path / "a.mcap", *SCANS, *FRAMES)
    assert [f.topic for f in export_bag(bag, tmp_path / "1", ExportOptions(skip=("/t*",)))] == ["/scan"]
    assert export_bag(bag, tmp_path / "2", ExportOptions(topics=("/tf",), start=1.0))[0].count == 1
    assert export_bag(bag, tmp_path / "3", ExportOptions(topics=("/scan",), end=1.0))[0].count == 1
    with pytest.raises(InputError, match="SK-CLI-030"):
        export_bag(bag, tmp_path / "4", ExportOptions(topics=("/skan",)))
    with pytest.raises(InputError, match="SK-BAG-011"):
        export_bag(bag, tmp_path / "4", ExportOptions(skip=("*",)))
    assert not (tmp_path / "4").exists()


def test_lists_too_wide_for_a_spreadsheet_are_left_out_and_reported(tmp_path: Path) -> None:
    grid = msgs.make("nav_msgs/msg/OccupancyGrid", data=np.zeros(20_000, np.int8))
    bag = written(tmp_path / "a.mcap", (0.0, "/map", grid))
    (found,) = export_bag(bag, tmp_path / "out", ExportOptions())
    assert "20000 items" in found.notes[0]
    export_bag(bag, tmp_path / "all", ExportOptions(format="npz"))
    assert np.load(tmp_path / "all" / "map.npz")["data"].shape == (1, 20_000)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_a_folder_whose_index_is_a_pipe_is_not_replaced_and_does_not_block(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    os.mkfifo(tmp_path / "out" / "index.json")
    with pytest.raises(InputError, match="SK-BAG-013"):
        export_bag(written(tmp_path / "a.mcap", *SCANS), tmp_path / "out", ExportOptions(overwrite=True))


def test_an_export_replaces_only_an_export_and_only_with_overwrite(tmp_path: Path) -> None:
    bag = written(tmp_path / "a.mcap", *SCANS)
    export_bag(bag, tmp_path / "out", ExportOptions())
    with pytest.raises(InputError, match="SK-BAG-013"):
        export_bag(bag, tmp_path / "out", ExportOptions())
    export_bag(bag, tmp_path / "out", ExportOptions(format="npz", overwrite=True))
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["index.json", "scan.npz"]
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.txt").write_text("all of it", encoding="utf-8")
    for name in ("mine", "mine/thesis.txt", "x" * 300):
        with pytest.raises(InputError, match="SK-BAG-013"):
            export_bag(bag, tmp_path / name, ExportOptions(overwrite=True))
    assert (tmp_path / "mine" / "thesis.txt").read_text(encoding="utf-8") == "all of it"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.mcap", "mine", "out"]


@pytest.mark.skipif(os.name == "nt", reason="no such signals there")
def test_a_killed_export_leaves_no_partial_folder_and_the_next_export_cleans_up(tmp_path: Path) -> None:
    bag = written(tmp_path / "a.mcap", *((float(t), "/image", image(COLOURS, "rgb8")) for t in range(30)))
    program = (
        "import os, signal, sys\nfrom pathlib import Path\n"
        "from simkit.recording.export import ExportOptions, export_bag, images\n"
        "usual, count = images.PngFiles.take, []\n"
        "def take(self, *given):\n    count.append(1)\n"
        "    if len(count) == 20:\n        os.kill(os.getpid(), signal.SIGKILL)\n    return usual(self, *given)\n"
        "images.PngFiles.take = take\nexport_bag(Path(sys.argv[1]), Path(sys.argv[2]), ExportOptions())\n"
    )
    ended = subprocess.run([sys.executable, "-c", program, bag, tmp_path / "out"], check=False, timeout=60)
    assert ended.returncode == -signal.SIGKILL
    assert not (tmp_path / "out").exists() and len(list(tmp_path.iterdir())) == 2
    export_bag(bag, tmp_path / "out", ExportOptions())
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.mcap", "out"]
    assert len(list((tmp_path / "out" / "image").iterdir())) == 30


@pytest.mark.skipif(os.name == "nt", reason="who is over cannot be asked there")
def test_an_export_killed_during_the_replacement_keeps_the_old_export(tmp_path: Path) -> None:
    bag = written(tmp_path / "a.mcap", *SCANS)
    export_bag(bag, tmp_path / "out", ExportOptions())
    over = subprocess.Popen([sys.executable, "-c", ""])
    over.wait()
    aside = tmp_path / f".out.unfinished-{over.pid}-x"
    aside.mkdir()
    (tmp_path / "out").rename(aside / "old")
    with pytest.raises(InputError, match="SK-BAG-013"):
        export_bag(bag, tmp_path / "out", ExportOptions())
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.mcap", "out"]
