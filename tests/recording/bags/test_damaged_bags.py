"""Damaged bags, and bags that are made to do harm: what is refused, and what is recovered."""

from __future__ import annotations

import os
import resource
import sqlite3
import struct
import subprocess
import sys
from pathlib import Path

import pytest
from hostile_bags import END, FLOAT, HEADER, MAGIC, SECOND, Made, chunk_record, chunks, with_damaged_chunk, zeros

from simkit import msgs
from simkit.errors import InputError
from simkit.recording.bags.mcap_records import LARGEST_RECORD
from simkit.recording.bags.reader import open_bag_to_read
from simkit.recording.bags.recovery import recover_bag
from simkit.recording.bags.writer import Rosbag2Folder

BOMB = 3 << 30
LINE = "=" * 80 + "\n"
VIEW = "CREATE VIEW messages AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i FROM n) SELECT i FROM n"
UNKNOWN = "lab_msgs/msg/Reading"


def _values(path: Path) -> list[float]:
    with open_bag_to_read(path) as bag:
        return [bag.decode(message).data for message in bag.messages()]


def _write(path: Path, content: bytes) -> Path:
    path.write_bytes(content)
    return path


def _code(path: Path) -> str:
    with pytest.raises(InputError) as error:
        _values(path)
    return error.value.code


@pytest.mark.parametrize("compression", ["zstd", "lz4", "none"])
def test_a_damaged_chunk_is_an_error_of_its_own_and_only_it_is_lost(compression: str, tmp_path: Path) -> None:
    content = Made(compression).content()
    path = _write(tmp_path / "run.mcap", with_damaged_chunk(content, 1))
    assert _code(path) == "SK-CLI-035"
    found = recover_bag(path, tmp_path / "saved.mcap")
    ((name, loss),) = found.losses
    assert (name, loss.position, loss.size) == ("run.mcap", *chunks(content)[1])
    assert loss.is_chunk and not found.complete and found.state == "the bag was damaged"
    with open_bag_to_read(tmp_path / "saved.mcap") as saved:
        times = [message.time_ns // SECOND for message in saved.messages()]
    if compression == "none":  # its messages can be told apart, whatever their bytes are
        assert times == list(range(20)) and loss.saved >= 4
        return
    missing = sorted(set(range(20)) - set(times))
    assert missing == list(range(missing[0], missing[0] + len(missing))) and 1 <= len(missing) <= 6
    assert (loss.start, loss.end) == (missing[0] * SECOND, missing[-1] * SECOND)


def test_messages_of_an_uncompressed_chunk_are_saved_up_to_the_damage(tmp_path: Path) -> None:
    content = bytearray(Made("none").content())
    at, _ = chunks(bytes(content))[1]
    record = content.index(b"\x05" + struct.pack("<Q", 34), at)  # the first message of the chunk: 22 + 12 bytes
    content[record + 43] = 0  # the opcode of the second message
    path = _write(tmp_path / "run.mcap", bytes(content))
    found = recover_bag(path, tmp_path / "saved.mcap")
    values = _values(tmp_path / "saved.mcap")
    first = next(i for i in range(20) if i not in values)
    assert found.losses[0][1].saved == 1 and values[:first] == [float(i) for i in range(first)] and 19.0 in values


def test_a_chunk_with_a_lying_length_hides_no_other_chunk(tmp_path: Path) -> None:
    content = bytearray(Made().content())
    at, _ = chunks(bytes(content))[1]
    content[at + 1 : at + 9] = struct.pack("<Q", 1 << 40)
    found = recover_bag(_write(tmp_path / "run.mcap", bytes(content)), tmp_path / "saved.mcap")
    assert 14 <= found.messages < 20 and max(_values(tmp_path / "saved.mcap")) == 19.0


def test_a_chunk_without_content_has_no_times_and_a_short_reason(tmp_path: Path) -> None:
    content = Made().content()
    at, _ = chunks(content)[0]
    path = _write(tmp_path / "run.mcap", content[:at] + struct.pack("<BQ", 6, 0) + content[at:])
    found = recover_bag(path, tmp_path / "saved.mcap")
    assert found.loss_lines() == [
        f"run.mcap: lost a chunk of 9 bytes at byte {at} (a record of 0 bytes is too short for its fields)"
    ]


def test_the_channels_of_a_damaged_first_chunk_come_from_the_end_of_the_file(tmp_path: Path) -> None:
    path = _write(tmp_path / "run.mcap", with_damaged_chunk(Made().content(), 0))
    recover_bag(path, tmp_path / "saved.mcap")
    assert _values(tmp_path / "saved.mcap")[-1] == 19.0


def test_a_type_that_simkit_does_not_know_is_recovered_with_its_definition(tmp_path: Path) -> None:
    content = Made(type_name=UNKNOWN, text="float64 data").content()
    for source in (_write(tmp_path / "run.mcap", content), _write(tmp_path / "cut.mcap", content[:-40])):
        for target in (tmp_path / f"{source.stem}_file.mcap", tmp_path / f"{source.stem}_folder"):
            recover_bag(source, target)
            assert _values(target) == [float(i) for i in range(20)]


@pytest.mark.parametrize("claim", [BOMB, 1000, LARGEST_RECORD + 1])
@pytest.mark.parametrize("end", [END, b""], ids=["complete", "cut"])
def test_a_chunk_of_3_gib_is_refused_before_it_fills_the_memory(claim: int, end: bytes, tmp_path: Path) -> None:
    content = MAGIC + HEADER + chunk_record(zeros(BOMB), claim) + end
    assert len(content) < 100_000
    path = _write(tmp_path / "bomb.mcap", content)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    assert _code(path) == "SK-CLI-035"
    with pytest.raises(InputError, match="SK-BAG-004"):
        recover_bag(path, tmp_path / "saved.mcap")
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 50_000  # [KiB]
    assert [p.name for p in tmp_path.iterdir()] == ["bomb.mcap"]


@pytest.mark.skipif(not hasattr(os, "SEEK_DATA"), reason="holes of files cannot be found there")
@pytest.mark.parametrize("is_begun", [False, True])
def test_a_sparse_file_of_50_gb_ends_where_its_data_ends(is_begun: bool, tmp_path: Path) -> None:
    path = _write(tmp_path / "sparse.mcap", Made().content()[:700] if is_begun else MAGIC)
    os.truncate(path, 50 << 30)
    if is_begun:
        assert _values(path)[:4] == [0.0, 1.0, 2.0, 3.0]
        assert recover_bag(path, tmp_path / "saved.mcap").messages >= 4
        return
    assert _code(path) == "SK-CLI-035"
    with pytest.raises(InputError, match="SK-BAG-004"):
        recover_bag(path, tmp_path / "saved.mcap")


@pytest.mark.parametrize(
    "text",
    [
        *("lab_msgs/Reading again\nfloat64 data", "string[1000000000] names", "uint8[99999999999] data", "float64"),
        "lab_msgs/Missing x",
        "uint8 a\n" * 20_000,
        "A a\n" + "".join(f"{LINE}MSG: lab_msgs/{a}\n{b}[10] x\n" for a, b in ("AB", "BC", "CD", "DE", "EF"))
        + f"{LINE}MSG: lab_msgs/F\nfloat64 x",
    ],
    ids=["recursive", "many strings", "huge array", "no name", "missing", "long", "nested"],
)  # fmt: skip
def test_a_definition_without_end_is_refused(text: str, tmp_path: Path) -> None:
    path = _write(tmp_path / "run.mcap", Made(type_name=UNKNOWN, text=text).content())
    assert _code(path) == "SK-CLI-036"


def test_data_that_does_not_fit_its_definition_is_refused(tmp_path: Path) -> None:
    for number, data in enumerate((b"", b"\0\1\0\0", b"\0\1\0\0abc", b"\xff" * 12, b"\0\1\0\0" + b"\0" * 80)):
        assert _code(_write(tmp_path / f"{number}.mcap", Made(data=data).content())) == "SK-CLI-036"
    text = b"\0\1\0\0" + struct.pack("<I", (1 << 32) - 1) + b"a"
    made = Made(type_name="std_msgs/msg/String", data=text)
    assert _code(_write(tmp_path / "text.mcap", made.content())) == "SK-CLI-036"
    assert _code(_write(tmp_path / "json.mcap", Made(encoding="json").content())) == "SK-CLI-036"


def test_a_time_after_that_of_ros_is_refused(tmp_path: Path) -> None:
    latest = (1 << 63) - 1
    assert _code(_write(tmp_path / "late.mcap", Made(first=latest + 1, count=1).content())) == "SK-CLI-035"
    assert _values(_write(tmp_path / "last.mcap", Made(first=latest, count=1).content())) == [0.0]


def test_an_index_that_lies_is_not_used(tmp_path: Path) -> None:
    content = bytearray(Made().content())
    content[-12:-8] = b"\1\1\1\1"  # the checksum of the index
    path = _write(tmp_path / "run.mcap", bytes(content))
    with open_bag_to_read(path) as bag:
        assert "its index is damaged" in bag.broken and bag.count == 20
    assert _values(path) == [float(i) for i in range(20)]


def _database(path: Path, *statements: str) -> Path:
    database = sqlite3.connect(path)
    topics = "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT)"
    messages = "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB)"
    for statement in statements or (topics, messages):
        database.execute(statement.format(topics=topics, messages=messages))
    database.commit()
    database.close()
    return path


TOPIC = f"INSERT INTO topics VALUES (1, '/number', '{FLOAT}', 'cdr')"


@pytest.mark.parametrize(
    "statements",
    [
        ("{topics}",),
        ("{topics}", VIEW),
        ("{topics}", "CREATE TABLE messages(topic_id, timestamp, data GENERATED ALWAYS AS (zeroblob(500000000)))"),
        ("{topics}", "{messages}", TOPIC, "INSERT INTO messages VALUES (1, 1, 'soon', x'00')"),
        ("{topics}", "{messages}", TOPIC, "INSERT INTO messages VALUES (1, 1, -5, x'00')"),
        ("{topics}", "{messages}", TOPIC, "INSERT INTO messages VALUES (1, 1, 5, 'text')"),
        ("{topics}", "{messages}", "INSERT INTO topics VALUES (1, x'00', 5, NULL)"),
    ],
    ids=["no messages", "view", "generated", "no time", "negative time", "no bytes", "no names"],
)  # fmt: skip
def test_an_unusual_database_is_refused(statements: tuple[str, ...], tmp_path: Path) -> None:
    assert _code(_database(tmp_path / "run.db3", *statements)) == "SK-CLI-035"


@pytest.mark.parametrize(
    "names, code",
    [
        ('["../run_0.mcap"]', ""),
        ('["run_0.mcap", "run_0.mcap"]', ""),
        ('["/etc/passwd"]', "SK-CLI-035"),
        ('[".."]', "SK-CLI-035"),
        ('["missing.mcap"]', "SK-CLI-035"),
        ("[5]", ""),
        ("5", ""),
    ],
)
def test_metadata_names_files_of_the_folder_only(names: str, code: str, tmp_path: Path) -> None:
    bag = Rosbag2Folder(tmp_path / "run")
    bag.write_raw(bag.channel("/number", FLOAT, False), msgs.serialize(msgs.make(FLOAT, data=1.0)), 0)
    bag.close()
    text = "rosbag2_bagfile_information: {storage_identifier: sqlite3, message_count: 99, relative_file_paths: "
    (tmp_path / "run" / "metadata.yaml").write_text(text + names + "}")
    if code:
        assert _code(tmp_path / "run") == code
    else:
        assert _values(tmp_path / "run") == [1.0]


def test_a_compressed_file_with_much_more_content_is_refused(tmp_path: Path) -> None:
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "run.db3.zstd").write_bytes(zeros(BOMB))
    with pytest.raises(InputError, match="zstd -d"):
        _values(tmp_path / "run")


@pytest.mark.skipif(sys.platform == "win32", reason="there are no limits of file sizes")
def test_a_recovery_that_cannot_be_written_leaves_the_older_bag(tmp_path: Path) -> None:
    source = _write(tmp_path / "run.mcap", Made("none", count=500, data=b"\0\1\0\0" + os.urandom(8)).content()[:-50])
    target = _write(tmp_path / "saved.mcap", Made().content())
    # without -B, Python 3.11 leaves byte code of simkit that is cut off at the limit
    code = "import resource, sys; resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))\n"
    code += "from simkit.cli import main; sys.argv[0] = 'simkit'; main()"
    command = [sys.executable, "-B", "-c", code, "bag", "recover", str(source), str(target), "--force"]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 2 and "SK-BAG-002" in done.stderr and "Traceback" not in done.stderr
    assert target.read_bytes() == Made().content()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["run.mcap", "saved.mcap"]
    assert recover_bag(source, target, overwrite=True).messages == 500
