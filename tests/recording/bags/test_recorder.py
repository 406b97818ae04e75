"""Recordings: complete, in ROS 2's own form, the same bytes for the same seed, readable after a kill."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from mcap.reader import make_reader
from mcap.records import Message
from mcap.stream_reader import StreamReader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader

import simkit
from simkit import msgs
from simkit.errors import InputError, MessageError
from simkit.recording.bags.recorder import Recorder, RecordError
from simkit.recording.bags.recovery import recover_bag

WORLD = """
<sdf version="1.9"><world name="w">
  <model name="ball"><pose>0 0 5 0 0 0</pose>
    <link name="body">
      <inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>
      <sensor name="imu" type="imu"><update_rate>100</update_rate><topic>imu</topic>
        <imu><linear_acceleration><z><noise type="gaussian"><stddev>0.1</stddev></noise></z></linear_acceleration></imu>
      </sensor>
    </link>
  </model>
</world></sdf>
"""


def record(path: Path, seconds: float = 2.5, seed: int = 0, **options: object) -> Path:
    with simkit.load(WORLD, seed=seed) as sim, Recorder(sim, path, **options):  # type: ignore[arg-type]
        sim.run(seconds)
    return path


@pytest.mark.parametrize("name", ["run.mcap", "folder"])
def test_rosbags_opens_a_recording_and_finds_every_message(tmp_path: Path, name: str) -> None:
    record(tmp_path / name)
    with AnyReader([tmp_path / name]) as reader:
        imu = [c for c in reader.connections if c.topic == "/imu"]
        assert [c.msgtype for c in imu] == ["sensor_msgs/msg/Imu"]
        times = []
        for connection, stamp, data in reader.messages(connections=imu):
            message = reader.deserialize(data, connection.msgtype)
            assert msgs.stamp_ns(message.header.stamp) == stamp
            times.append(stamp)
    assert times == [1_000_000, *(k * 10_000_000 for k in range(1, 251))]


def test_the_mcap_package_opens_a_recording_without_rosbags(tmp_path: Path) -> None:
    path = record(tmp_path / "run.mcap")
    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        assert reader.get_header().profile == "ros2"
        decoded = [m for _, _, _, m in reader.iter_decoded_messages(topics=["/imu"])]
        summary = reader.get_summary()
    assert len(decoded) == 251
    assert decoded[-1].header.stamp.sec == 2
    assert decoded[-1].header.stamp.nanosec == 500_000_000
    assert summary is not None
    assert all(s.encoding == "ros2msg" for s in summary.schemas.values())


def test_a_recording_has_the_messages_that_subscribers_receive(tmp_path: Path) -> None:
    with simkit.load(WORLD) as sim, Recorder(sim, tmp_path / "run.mcap"):
        live = sim.subscribe("/imu")
        sim.run(0.5)
    with AnyReader([tmp_path / "run.mcap"]) as reader:
        imu = [c for c in reader.connections if c.topic == "/imu"]
        recorded = [bytes(data) for _, _, data in reader.messages(connections=imu)]
    assert recorded == [msgs.serialize(m) for m in live.messages]


@pytest.mark.parametrize("seconds", [0.4, 1.6])
def test_log_times_continue_after_a_reset_and_stamps_begin_again(tmp_path: Path, seconds: float) -> None:
    path = tmp_path / "run.mcap"
    with simkit.load(WORLD) as sim, Recorder(sim, path, topics=["/imu", "/clock"]):
        sim.run(seconds)
        sim.reset()
        sim.run(0.2)
        middle = sim.snapshot()
        sim.run(0.2)
        sim.restore(middle)
        sim.run(0.1)
    with path.open("rb") as stream:
        found = make_reader(stream, decoder_factories=[DecoderFactory()]).iter_decoded_messages(topics=["/imu"])
        messages = [(m.log_time, msgs.stamp_ns(ros.header.stamp)) for _, _, m, ros in found]
    logged, stamps = zip(*messages, strict=True)
    samples = round(100 * seconds) + 1  # the first one is at the first step
    assert stamps == (*stamps[:samples], *stamps[:41], *stamps[21:31])
    assert logged[:samples] == stamps[:samples]
    # the first message of /clock after the reset and after the restore, 1 and 10 ms later, has the last log time
    assert logged[-1] == round((seconds + 0.5) * 1e9) - 11_000_000


def test_chunks_span_at_most_a_simulated_second(tmp_path: Path) -> None:
    path = record(tmp_path / "run.mcap", seconds=3.5)
    with path.open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    spans = [(c.message_start_time, c.message_end_time) for c in summary.chunk_indexes]
    assert len(spans) == 4
    assert all(end // 10**9 == start // 10**9 for start, end in spans)


def test_static_transforms_are_offered_as_transient_local(tmp_path: Path) -> None:
    path = record(tmp_path / "run.mcap", seconds=0.1)
    with path.open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    profiles = {c.topic: c.metadata["offered_qos_profiles"] for c in summary.channels.values()}
    assert "durability: volatile" in profiles["/imu"]
    latched = [t for t, text in profiles.items() if "durability: transient_local" in text]
    assert latched == [t for t in ("/tf_static",) if t in profiles]
    with AnyReader([path]) as reader:
        assert all(len(c.ext.offered_qos_profiles) == 1 for c in reader.connections)  # type: ignore[union-attr]


def test_two_processes_write_the_same_bytes(tmp_path: Path) -> None:
    here = record(tmp_path / "here.mcap", seed=3).read_bytes()
    code = (
        "import sys, simkit; from pathlib import Path; from simkit.recording.bags.recorder import Recorder\n"
        "sim = simkit.load(sys.stdin.read(), seed=3)\n"
        "with Recorder(sim, 'there.mcap'): sim.run(2.5)\n"
    )
    environment = {**os.environ, "PYTHONHASHSEED": "77", "PYTHONPATH": os.pathsep.join(sys.path)}
    subprocess.run([sys.executable, "-c", code], input=WORLD, text=True, check=True, cwd=tmp_path, env=environment)
    assert (tmp_path / "there.mcap").read_bytes() == here
    assert record(tmp_path / "other.mcap", seed=4).read_bytes() != here


def test_recording_changes_nothing_of_the_run(tmp_path: Path) -> None:
    with simkit.load(WORLD) as alone:
        alone.run(1.0)
        height = alone.model("ball").pose.position[2]
    with simkit.load(WORLD) as recorded, Recorder(recorded, tmp_path / "run.mcap"):
        recorded.run(1.0)
        assert recorded.model("ball").pose.position[2] == height


def test_only_selected_topics_are_recorded(tmp_path: Path) -> None:
    path = record(tmp_path / "run.mcap", topics=["/im*"])
    with AnyReader([path]) as reader:
        assert {c.topic for c in reader.connections} == {"/imu"}


def test_an_existing_recording_is_not_overwritten(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    path.write_bytes(b"precious")
    with simkit.load(WORLD) as sim, pytest.raises(InputError, match="--force") as error:
        Recorder(sim, path)
    assert error.value.code == "SK-BAG-001"
    assert path.read_bytes() == b"precious"
    assert record(path, overwrite=True).stat().st_size > 1000


def test_a_recording_that_replaces_one_still_being_written_is_complete(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    with simkit.load(WORLD) as first, simkit.load(WORLD) as second, Recorder(first, path):
        first.run(1.5)
        with Recorder(second, path, overwrite=True):
            second.run(0.5)
            first.run(1.0)
    with AnyReader([path]) as reader:
        assert {c.topic: c.msgcount for c in reader.connections}["/imu"] == 51


def test_a_folder_that_is_not_a_bag_is_not_replaced_even_with_overwrite(tmp_path: Path) -> None:
    (tmp_path / "notes").mkdir()
    (tmp_path / "notes" / "diary.txt").write_text("dear diary")
    with simkit.load(WORLD) as sim, pytest.raises(InputError, match="is not a bag"):
        Recorder(sim, tmp_path / "notes", overwrite=True)
    assert (tmp_path / "notes" / "diary.txt").exists()
    record(tmp_path / "bag", seconds=0.1)
    record(tmp_path / "bag", seconds=0.1, overwrite=True)


def test_an_unwritable_path_is_reported_before_the_run(tmp_path: Path) -> None:
    with simkit.load(WORLD) as sim, pytest.raises(InputError, match="missing does not exist") as error:
        Recorder(sim, tmp_path / "missing" / "run.mcap")
    assert error.value.code == "SK-BAG-002"


class _FullDisk:
    """A file that takes a few thousand bytes."""

    def __init__(self, file: object) -> None:
        self._file, self._room = file, 4000

    def __getattr__(self, name: str) -> object:
        return getattr(self._file, name)

    def write(self, data: bytes) -> int:
        self._room -= len(data)
        if self._room < 0:
            raise OSError(28, "No space left on device")
        return self._file.write(data)  # type: ignore[attr-defined, no-any-return]


def test_a_full_disk_stops_the_recording_and_not_the_publisher(tmp_path: Path) -> None:
    with simkit.load(WORLD) as sim:
        recorder = Recorder(sim, tmp_path / "run.mcap")
        writer = recorder._bag._writer  # type: ignore[union-attr]
        writer._file = _FullDisk(writer._file)
        sim.run(3.0)
        assert sim.time == 3.0
        with pytest.raises(RecordError, match="No space left") as error:
            recorder.check()
        recorder.close()
    assert error.value.exit_code == 1


def test_a_message_that_cannot_be_written_is_its_publishers_error(tmp_path: Path) -> None:
    with simkit.load(WORLD) as sim, Recorder(sim, tmp_path / "run.mcap"):
        publisher = sim.communication.bus.advertise("/broken", "std_msgs/msg/Float64")
        message = msgs.make("std_msgs/msg/Float64")
        message.data = "much"
        with pytest.raises(MessageError):
            publisher.publish(message)
        sim.run(0.1)


def _killed_recording(folder: Path, name: str) -> Path:
    """A process records as fast as it goes until some seconds are on disk, and is then killed."""
    code = (
        "import sys, simkit; from simkit.recording.bags.recorder import Recorder\n"
        "sim = simkit.load(sys.stdin.read()); recorder = Recorder(sim, sys.argv[1])\n"
        "while True:\n    sim.run(1.0); print(sim.time, flush=True)\n"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    process = subprocess.Popen(
        [sys.executable, "-c", code, name],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        cwd=folder,
        env=environment,
    )
    with process:
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(WORLD)
        process.stdin.close()
        deadline = time.monotonic() + 60
        for line in process.stdout:
            # at 6 s the first 5 s are on disk; at 5 s, the message that ends the fifth second may still be due
            if float(line) >= 6.0 or time.monotonic() > deadline:
                break
        process.send_signal(signal.SIGKILL)
    return folder / name


def _readable(path: Path) -> list[int]:
    times = []
    with path.open("rb") as file:
        try:
            times = []
            for found in StreamReader(file).records:
                if isinstance(found, Message):
                    times.append(found.log_time)
        except Exception:  # noqa: BLE001 - a torn file ends in any of the reader's errors
            pass
    return times


@pytest.mark.skipif(sys.platform == "win32", reason="there is no SIGKILL")
def test_after_a_kill_all_messages_up_to_the_last_second_can_be_recovered(tmp_path: Path) -> None:
    torn = _killed_recording(tmp_path, "torn.mcap")
    times = _readable(torn)
    assert max(times) >= 4_900_000_000
    found = recover_bag(torn, tmp_path / "whole.mcap")
    assert (found.messages, found.end, found.complete) == (len(times), max(times), False)
    with AnyReader([tmp_path / "whole.mcap"]) as reader:
        assert reader.message_count == len(times)
        stamps = [s for c, s, _ in reader.messages() if c.topic == "/imu"]
    assert stamps[:490] == [1_000_000, *(k * 10_000_000 for k in range(1, 490))]


@pytest.mark.skipif(sys.platform == "win32", reason="there is no SIGKILL")
def test_a_folder_of_a_killed_run_is_recovered_into_a_folder(tmp_path: Path) -> None:
    torn = _killed_recording(tmp_path, "torn")
    found = recover_bag(torn, tmp_path / "whole")
    with AnyReader([tmp_path / "whole"]) as reader:
        assert reader.message_count == found.messages


def test_recovering_a_complete_recording_gives_the_same_messages(tmp_path: Path) -> None:
    path = record(tmp_path / "run.mcap")
    found = recover_bag(path, tmp_path / "again.mcap")
    assert found.complete
    assert (tmp_path / "again.mcap").read_bytes() == path.read_bytes()


@pytest.mark.parametrize("content", [b"", b"not a bag at all", b"\x89MCAP0\r\n"])
def test_a_file_that_is_not_a_bag_cannot_be_recovered(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "bad.mcap").write_bytes(content)
    with pytest.raises(InputError) as error:
        recover_bag(tmp_path / "bad.mcap", tmp_path / "whole.mcap")
    assert error.value.code == "SK-BAG-004"
    assert not (tmp_path / "whole.mcap").exists()
