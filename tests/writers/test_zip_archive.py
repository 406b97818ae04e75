"""ZIP archives of strangers: the list of files is bounded before it is read, whatever the end records say."""

from __future__ import annotations

import io
import struct
import zipfile
from collections.abc import Sequence
from pathlib import Path

import pytest

from simkit.errors import InputError
from simkit.writers.zip_archive import MAX_FILES, MAX_INDEX_BYTES, RefusedArchiveError, open_archive
from simkit_verification.testing.bundles import open_bundle
from tests.limited_memory import run_limited

ENTRY = struct.Struct("<4s4B4HL2L5H2L")


def entry(name: bytes, offset: int = 0, extra: bytes = b"") -> bytes:
    """Return an entry of the list of files, for an empty file."""
    sizes = (len(name), len(extra), 0, 0, 0)
    return ENTRY.pack(b"PK\1\2", 20, 3, 20, 0, 0, 0, 0, 0, 0, 0, 0, *sizes, 0, offset) + name + extra


def zip64(entries: bytes, stated: int) -> bytes:
    """Return an archive whose end record tells one file, and whose ZIP64 end record tells another number."""
    start = struct.pack("<4s5H3L2H", b"PK\3\4", 20, 0, 0, 0, 0, 0, 0, 0, 8, 0) + b"00000000"
    end = len(start) + len(entries)
    return (
        start
        + entries
        + struct.pack("<4sQ2H2L4Q", b"PK\6\6", 44, 45, 45, 0, 0, stated, stated, len(entries), len(start))
        + struct.pack("<4sLQL", b"PK\6\7", 0, end, 1)
        + struct.pack("<4s4H2LH", b"PK\5\6", 0, 0, 1, 1, 60, 0, 0)
    )


def archive_of(names: Sequence[str]) -> io.BytesIO:
    target = io.BytesIO()
    with zipfile.ZipFile(target, "w") as archive:
        for name in names:
            archive.writestr(name, b"")
    return target


def refusal(content: bytes) -> tuple[str, str]:
    with pytest.raises(RefusedArchiveError) as raised:
        open_archive(io.BytesIO(content), 1 << 30)
    return raised.value.kind, str(raised.value)


@pytest.mark.parametrize("stated", [0, 1, MAX_FILES + 1, 1 << 60])
def test_the_files_in_the_list_count_and_not_the_numbers_in_the_end_records(stated: int) -> None:
    entries = b"".join(entry(b"%08x" % i) for i in range(MAX_FILES + 1))
    assert refusal(zip64(entries, stated)) == ("large", f"has more than {MAX_FILES} files")


def test_an_archive_may_have_the_largest_number_of_files() -> None:
    with open_archive(archive_of([str(i) for i in range(MAX_FILES)]), 1 << 30) as archive:
        assert len(archive.infolist()) == MAX_FILES
    assert refusal(archive_of([str(i) for i in range(MAX_FILES + 1)]).getvalue())[0] == "large"


def test_a_list_of_few_files_has_a_largest_size_in_bytes() -> None:
    padding = struct.pack("<HH", 0xCAFE, 65000) + bytes(65000)
    count = MAX_INDEX_BYTES // len(entry(b"a" * 8, extra=padding)) + 1
    assert refusal(zip64(b"".join(entry(b"%08x" % i, extra=padding) for i in range(count)), count))[0] == "large"


@pytest.mark.slow
def test_a_million_entries_behind_a_zip64_record_take_no_memory(tmp_path: Path) -> None:
    (tmp_path / "z.zip").write_bytes(zip64(entry(b"00000000") * 1_200_000, 1_200_000))
    result = run_limited(["replay", "--list", str(tmp_path / "z.zip")], 400)
    assert result.returncode == 2 and "SK-BUNDLE-004" in result.stderr, result.stderr[-500:]


def test_files_that_share_bytes_of_the_archive_are_refused() -> None:
    target = archive_of(["a"])
    with zipfile.ZipFile(target, "a") as archive:
        archive.writestr("b", b"x" * 100)
    content = target.getvalue()
    at = content.rindex(b"PK\1\2")
    first_offset = content[: at + 42] + struct.pack("<L", 0) + content[at + 46 :]
    assert "overlaps" in refusal(first_offset)[1]
    beyond = content[: at + 20] + struct.pack("<2L", 101, 101) + content[at + 28 :]
    assert "overlaps" in refusal(beyond)[1]


def test_a_file_without_a_name_is_refused() -> None:
    assert refusal(zip64(entry(b""), 1)) == ("name", "the file '' has no name")


def test_the_folders_of_an_archive_are_counted_too() -> None:
    deep = "/".join("a" * 400)
    with open_archive(archive_of([f"{i}/{deep}" for i in range(40)]), 1 << 30):
        pass
    assert "folders" in refusal(archive_of([f"{i}/{deep}" for i in range(60)]).getvalue())[1]


@pytest.mark.parametrize("size", [1 << 63, (1 << 64) - 1, 1 << 62, 1 << 31])
def test_a_zip64_record_with_impossible_sizes_is_damaged(tmp_path: Path, size: int) -> None:
    content = bytearray(zip64(entry(b"00000000"), 1))
    at = content.index(b"PK\6\6")
    for field in (40, 48):
        lying = bytes(content[: at + field]) + struct.pack("<Q", size) + bytes(content[at + field + 8 :])
        (tmp_path / "z.zip").write_bytes(lying)
        with pytest.raises(InputError, match="SK-BUNDLE-00[134]"):
            open_bundle(tmp_path / "z.zip")


def test_an_archive_in_an_archive_stays_one_file() -> None:
    inner = archive_of([str(i) for i in range(100)]).getvalue()
    target = io.BytesIO()
    with zipfile.ZipFile(target, "w") as archive:
        archive.writestr("inner.zip", inner)
    with open_archive(target, 1 << 30) as opened:
        assert opened.namelist() == ["inner.zip"] and opened.read("inner.zip") == inner
