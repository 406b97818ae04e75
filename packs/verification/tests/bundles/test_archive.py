"""Bundles from untrusted sources: the archive is validated before use, and its code runs only if allowed."""

from __future__ import annotations

import hashlib
import json
import stat
import warnings
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import simkit
from simkit.errors import InputError
from simkit_verification.testing.bundles import keep, open_bundle, replay, write_bundle
from simkit_verification.testing.bundles.archive import name_fault

WORLD = '<sdf version="1.9"><world name="w"><model name="m"><link name="l"/></model></world></sdf>'
Files = dict[str, bytes]


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> Path:
    with simkit.load(WORLD) as sim, keep(sim):
        sim.run(0.1)
        return write_bundle(sim, tmp_path_factory.mktemp("bundle") / "sound.zip")


def files_of(path: Path) -> Files:
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def write(target: Path, files: Files, page: Callable[[Any], Any] = lambda words: words, *, sums: bool = True) -> Path:
    """Write a bundle with these files; the manifest contains their hashes and sizes if `sums` is true."""
    words = json.loads(files["bundle.json"])
    if sums:
        words["files"] = {
            name: {"size": len(data), "sha256": hashlib.sha256(data).hexdigest()}
            for name, data in files.items()
            if name != "bundle.json"
        }
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(name, json.dumps(page(words)) if name == "bundle.json" else data)
    return target


def refused(path: Path, code: str, text: str = "") -> None:
    with pytest.raises(InputError, match=f"{code}.*{text}") as raised:
        replay(path, allow_code=True)
    assert raised.value.code == code


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("../escape.sdf", "leads out of its folder"),
        ("world/../../escape.sdf", "leads out of its folder"),
        ("/etc/passwd", "absolute"),
        ("world/a\\..\\b", "characters"),
        ("C:/windows", "characters"),
        ("world/a\nb", "characters"),
        ("world/" + "a" * 300, "too long"),
        ("world/" + "a/" * 600 + "b", "too long"),
        ("world//a", "leads out of its folder"),
        ("setup.py", "is not a file that a bundle can contain"),
        ("plugins/a.py", "is not a file that a bundle can contain"),
        ("world", "is not a file that a bundle can contain"),
    ],
)
def test_a_file_name_outside_the_folder_is_rejected(sound: Path, tmp_path: Path, name: str, why: str) -> None:
    assert why in name_fault(name)
    refused(write(tmp_path / "b.zip", {**files_of(sound), name: b"x"}), "SK-BUNDLE-003")


def test_a_symbolic_link_is_rejected(sound: Path, tmp_path: Path) -> None:
    path = write(tmp_path / "b.zip", files_of(sound))
    with zipfile.ZipFile(path, "a") as archive:
        info = zipfile.ZipInfo("world/link")
        info.create_system, info.external_attr = 3, (stat.S_IFLNK | 0o777) << 16
        archive.writestr(info, "/etc/passwd")
    refused(path, "SK-BUNDLE-003", "link")


def test_a_duplicate_file_name_is_rejected(sound: Path, tmp_path: Path) -> None:
    for other in ("world/world.sdf", "world/WORLD.sdf"):
        path = write(tmp_path / "b.zip", files_of(sound))
        with zipfile.ZipFile(path, "a") as archive, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            archive.writestr(other, WORLD)
        refused(path, "SK-BUNDLE-003", "duplicate")


def test_a_name_of_both_a_file_and_a_folder_is_rejected(sound: Path, tmp_path: Path) -> None:
    refused(write(tmp_path / "b.zip", {**files_of(sound), "world/world.sdf/x": b"x"}), "SK-BUNDLE-003", "folder")


def test_a_zip_bomb_is_rejected_before_unpacking(sound: Path, tmp_path: Path) -> None:
    path = write(tmp_path / "b.zip", {**files_of(sound), "world/zeros": bytes(200 << 20)})
    assert path.stat().st_size < 1 << 20
    refused(path, "SK-BUNDLE-004", "times its size")


def test_a_false_file_size_is_detected(sound: Path, tmp_path: Path) -> None:
    path = write(tmp_path / "b.zip", {**files_of(sound), "world/zeros": bytes(1 << 20)})
    data = path.read_bytes()
    size = (1 << 20).to_bytes(4, "little")
    assert data.count(size) >= 2
    path.write_bytes(data.replace(size, (1 << 10).to_bytes(4, "little")))
    refused(path, "SK-BUNDLE-001")


def test_too_many_files_are_rejected(sound: Path, tmp_path: Path) -> None:
    many = {f"world/{number}": b"" for number in range(20_001)}
    refused(write(tmp_path / "b.zip", {**files_of(sound), **many}), "SK-BUNDLE-004", "files")


@pytest.mark.parametrize("name", ["world/world.sdf", "commands.jsonl", "last_seconds.mcap"])
def test_a_changed_file_is_detected(sound: Path, tmp_path: Path, name: str) -> None:
    files = files_of(sound)
    refused(write(tmp_path / "b.zip", {**files, name: files[name] + b" "}, sums=False), "SK-BUNDLE-001")


def test_a_truncated_bundle_causes_no_traceback(sound: Path, tmp_path: Path) -> None:
    data = sound.read_bytes()
    path = tmp_path / "b.zip"
    for length in range(0, len(data), max(1, len(data) // 60)):
        path.write_bytes(data[:length])
        with pytest.raises(InputError, match="SK-BUNDLE-001"):
            open_bundle(path)


def test_changed_bundle_bytes_cause_no_traceback(sound: Path, tmp_path: Path) -> None:
    data = sound.read_bytes()
    path = tmp_path / "b.zip"
    for at in range(0, len(data), max(1, len(data) // 80)):
        path.write_bytes(data[:at] + bytes([data[at] ^ 0x55]) + data[at + 1 :])
        try:
            with open_bundle(path) as bundle:
                list(bundle.commands())
                for name in bundle.manifest.files:
                    bundle.read(name)
        except InputError as error:
            if not error.code.startswith("SK-BUNDLE-"):
                raise


def _with(**changes: Any) -> Callable[[Any], Any]:
    return lambda words: {**words, **changes}


@pytest.mark.parametrize(
    ("page", "text"),
    [
        (_with(world="../outside.sdf"), "which is not a file in"),
        (_with(world="commands.jsonl"), "which is not a file in"),
        (_with(spawn=[{"file": "/etc/passwd", "place": None, "name": None}]), "which is not a file in"),
        (_with(models={"ball": "world/none.sdf"}), "which is not a file in"),
        (_with(seed="1"), "seed"),
        (_with(seed=-1), "seed"),
        (_with(seed=1e300), "seed"),
        (_with(overrides=[1]), "overrides"),
        (_with(end={}), "end.steps"),
        (_with(end=None), "end"),
        (_with(marks=[["a", 1]]), "marks"),
        (_with(streams={"/a": 1}), "streams"),
        (_with(fingerprint={"a": 1}), "fingerprint"),
        (_with(code=["code/0/a.py"]), "which is not a file in"),
        (lambda words: [words], "is not a simkit bundle"),
        (lambda words: {"format": 1}, "name"),
    ],
)
def test_a_manifest_that_does_not_match_is_rejected(
    sound: Path, tmp_path: Path, page: Callable[[Any], Any], text: str
) -> None:
    refused(write(tmp_path / "b.zip", files_of(sound), page), "SK-BUNDLE-001", text)


def test_a_newer_format_is_reported(sound: Path, tmp_path: Path) -> None:
    refused(write(tmp_path / "b.zip", files_of(sound), _with(format=99)), "SK-BUNDLE-002", "99")


def test_code_missing_in_the_manifest_is_rejected(sound: Path, tmp_path: Path) -> None:
    path = write(tmp_path / "b.zip", {**files_of(sound), "code/0/boom.py": b"raise SystemExit(7)"})
    refused(path, "SK-BUNDLE-001", "code")


@pytest.mark.parametrize(
    "line",
    [
        b"nonsense",
        b"[]",
        b"1",
        b'{"do": "publish"}',
        b'{"do": 1, "steps": 0}',
        b'{"do": "publish", "steps": -1}',
        b'{"do": "publish", "steps": 1e9}',
        b'{"do": "restore", "steps": 0, "number": []}',
        b'{"do": "hear", "steps": 0, "number": {}}',
        b'{"do": "hear", "steps": 0, "in": 3}',
        b"[" * 100_000,
        b'{"do": "publish", "steps": ' + b"9" * 5000 + b"}",
    ],
)
def test_an_invalid_journal_entry_is_rejected(sound: Path, tmp_path: Path, line: bytes) -> None:
    refused(write(tmp_path / "b.zip", {**files_of(sound), "commands.jsonl": line + b"\n"}), "SK-BUNDLE-001")


@pytest.mark.parametrize(
    "words",
    [
        {"do": "publish", "topic": "/none", "message": {"type": "std_msgs/msg/String", "fields": []}},
        {"do": "publish", "topic": 3, "message": None},
        {"do": "publish", "topic": "/a", "message": {"type": "os/msg/System", "fields": {}}},
        {"do": "publish", "topic": "/a", "message": {"type": "std_msgs/msg/String"}},
        {"do": "call", "service": "/none", "request": {"type": "std_srvs/srv/Trigger_Request", "fields": {}}},
        {"do": "__class__"},
        {"do": "close", "number": 4},
        {"do": "cancel", "goal": 4},
        {"do": "set", "node": "/a", "name": "b", "value": {}},
        {"do": "spawned", "models": [{"source": "/etc/passwd", "name": None, "pose": None}]},
        {"do": "spawned", "models": [{"source": "model://ground_plane", "name": None, "pose": None}]},
        {"do": "spawned", "models": 3},
        {"do": "clone", "name": "m", "new_name": "n", "pose": [1]},
        {"do": "add_sensor", "name": "m::l", "sensor": {"dtype": "object", "base64": ""}},
        {"do": "by_hand", "state": {"size": 1, "at": [5], "values": [1]}},
        {"do": "by_hand", "fields": {"__class__": {"size": 1, "at": [0], "values": [0]}}},
        {"do": "restore", "number": 3},
        {"do": "reset", "seed": "x"},
    ],
)
def test_an_entry_that_cannot_be_played_is_reported(sound: Path, tmp_path: Path, words: dict[str, Any]) -> None:
    line = json.dumps({"steps": 0, **words}).encode()
    found = replay(write(tmp_path / "b.zip", {**files_of(sound), "commands.jsonl": line + b"\n"}))
    assert len(found.refused) == 1


def test_opening_and_extracting_runs_nothing(sound: Path, tmp_path: Path) -> None:
    code = b"open('was_run', 'w')"
    files = {**files_of(sound), "code/0/boom.py": code}
    path = write(tmp_path / "b.zip", files, _with(code=["code/0/boom.py"]))
    with open_bundle(path) as bundle:
        assert bundle.brings_code
        bundle.extract(tmp_path / "out")
        assert not (tmp_path / "out" / "code").exists()
        bundle.extract(tmp_path / "all", with_code=True)
        assert (tmp_path / "all" / "code" / "0" / "boom.py").read_bytes() == code
    assert not Path("was_run").exists()


def test_the_reason_for_a_damaged_archive_has_at_most_300_characters(tmp_path: Path) -> None:
    """A header that claims a name of 20 000 bytes makes zipfile print all of them."""
    file = tmp_path / "b.zip"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("bundle.json", b"\xff" * 30_000)
    content = bytearray(file.read_bytes())
    content[26:28] = (20_000).to_bytes(2, "little")  # length of the name in the local header
    file.write_bytes(content)
    with pytest.raises(InputError, match="SK-BUNDLE-001") as raised:
        open_bundle(file)
    assert len(str(raised.value)) < 500 + len(str(file))
