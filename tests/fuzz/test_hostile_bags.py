"""Damaged bags are read or refused: no exception but InputError, no crash, no hang, no endless memory."""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path

import pytest
from campaign import MOST, several_readers, try_many
from hostile_bags import Made, mutated
from mutation import shuffled_bytes
from reader import FINE, Reader
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore
from test_broken_files import SECONDS, SEED, complaint

SOME, MANY = 200, 20_000
NAMES = ("zstd", "lz4", "none", "plain", "sqlite", "folder", "compressed")


@pytest.fixture(scope="module")
def readers() -> Iterator[list[Reader]]:
    yield from several_readers([])


@pytest.fixture(scope="module")
def reader(readers: list[Reader]) -> Reader:
    return readers[0]


@pytest.fixture(scope="module")
def bags(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, bytes]]:
    """Return the files of a bag of each kind; the first one is opened."""
    found = {name: {"input.mcap": Made(name).content()} for name in ("zstd", "lz4", "none", "plain")}
    top = tmp_path_factory.mktemp("bags")
    for name in ("sqlite", "folder", "compressed"):
        _write_folder(
            top / name, StoragePlugin.MCAP if name == "folder" else StoragePlugin.SQLITE3, name == "compressed"
        )
        files = {file.name: file.read_bytes() for file in sorted((top / name).iterdir(), reverse=True)}
        found[name] = {"input.db3": files["sqlite.db3"]} if name == "sqlite" else files
    return found


def _write_folder(path: Path, storage: StoragePlugin, is_compressed: bool) -> None:
    store = get_typestore(Stores.ROS2_JAZZY)
    kind = "std_msgs/msg/Float64"
    writer = Writer(path, version=9, storage_plugin=storage)
    if is_compressed:
        writer.set_compression(CompressionMode.FILE, CompressionFormat.ZSTD)
    with writer:
        connection = writer.add_connection("/number", kind, typestore=store)
        for i in range(5):
            writer.write(connection, i, store.serialize_cdr(store.types[kind](float(i)), kind))


def _damaged(files: dict[str, bytes], chance: random.Random) -> dict[str, bytes]:
    name = chance.choice(sorted(files))
    change = mutated if name.endswith(".mcap") else shuffled_bytes
    return {**files, name: change(files[name], chance)}


def _problem(reader: Reader, bags: dict[str, dict[str, bytes]], index: int, seed: str, folder: Path) -> str:
    chance = random.Random(f"{seed} {index}")
    name = NAMES[0] if index % 4 == 0 else chance.choice(NAMES)  # zstd is what ROS 2 and simkit write
    files = _damaged(bags[name], chance)
    answer = reader.read(next(iter(files)), files, f"{name} {index}")
    return "" if answer["outcome"] in FINE else complaint(next(iter(files)), files, answer, folder)


@pytest.mark.parametrize("name", NAMES)
def test_a_bag_that_is_not_damaged_is_read(name: str, reader: Reader, bags: dict[str, dict[str, bytes]]) -> None:
    answer = reader.read(next(iter(bags[name])), bags[name])
    has_mcap = name not in ("sqlite", "compressed")  # `recover` takes MCAP files only
    assert (answer["outcome"], answer.get("code")) == (("loaded", None) if has_mcap else ("refused", "SK-BAG-004"))


@pytest.mark.slow
def test_damaged_bags_are_read_or_refused(reader: Reader, bags: dict[str, dict[str, bytes]], tmp_path: Path) -> None:
    assert not list(filter(None, (_problem(reader, bags, index, "bags", tmp_path) for index in range(SOME))))


@pytest.mark.fuzz
def test_many_damaged_bags_are_read_or_refused(
    readers: list[Reader], bags: dict[str, dict[str, bytes]], tmp_path: Path
) -> None:
    def one(reader: Reader, index: int) -> str:
        return _problem(reader, bags, index, f"{SEED} many bags", tmp_path)

    try_many("bags", one, readers, SECONDS, min(MANY, MOST))
