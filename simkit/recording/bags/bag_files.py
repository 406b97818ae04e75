"""Files of a bag: one file, or the files of a rosbag2 folder in the order of its metadata."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from simkit import hidden_text
from simkit.input_file import open_input, read_failure, read_input_text
from simkit.recording.bags.bag_contents import BagFile, unreadable
from simkit.recording.bags.mcap_file import McapFile
from simkit.recording.bags.sqlite_file import SqliteFile
from simkit.yaml_reader import NotYaml, read_yaml

_ZSTD: Final = b"\x28\xb5\x2f\xfd"
_SQLITE: Final = b"SQLite format 3\0"
_SMALL_FILE: Final = 64 << 20  # [bytes] that a compressed file may have uncompressed, whatever its size is
_HIGHEST_RATIO: Final = 100  # between the uncompressed and the compressed size of a larger file
_PIECE: Final = 1 << 20
_SUFFIXES: Final = (".mcap", ".db3", ".zstd")


@dataclass(frozen=True)
class BagLayout:
    """Files of a bag.

    Attributes:
        names: names of the files, relative to `folder`.
        distro: ROS distribution of the recorder, or `unknown`.
        problem: reason why the metadata of a folder is not used; empty otherwise.
        has_compressed_messages: True if each message is compressed with zstd.
        inside: folder out of which no link may lead; None for a file that the user names.
    """

    folder: Path
    names: list[str]
    distro: str = "unknown"
    problem: str = ""
    has_compressed_messages: bool = field(default=False)
    inside: Path | None = None


def bag_layout(path: Path) -> BagLayout:
    """Return the files of a bag.

    Raises:
        InputError: SK-CLI-035 the path does not exist or is not a bag.
    """
    try:
        exists, is_folder, is_file = path.exists(), path.is_dir(), path.is_file()
    except (OSError, ValueError) as error:  # an invalid file name, such as one that is too long
        raise unreadable(path, read_failure(error)) from None
    if is_folder:
        return _folder_layout(path)
    if not exists:
        raise unreadable(path, "it does not exist")
    if path.suffix not in (".mcap", ".db3"):
        raise unreadable(path, f"found the ending {path.suffix!r}; expected .mcap, .db3 or a rosbag2 folder")
    if not is_file:
        raise unreadable(path, "it is neither a file nor a folder")
    return BagLayout(path.parent, [path.name])


def _folder_layout(path: Path) -> BagLayout:
    metadata = path / "metadata.yaml"
    try:
        bag_names = sorted(file.name for file in path.iterdir() if file.suffix in _SUFFIXES)
        exists = metadata.exists()
    except OSError as error:
        raise unreadable(path, read_failure(error)) from None
    if not exists and not bag_names:
        raise unreadable(path, "it is not a bag: it has neither metadata.yaml nor an MCAP file")
    try:
        if not exists:
            return BagLayout(path, bag_names, problem="it has no metadata.yaml", inside=path)
        information = read_yaml(read_input_text(metadata, inside=path))["rosbag2_bagfile_information"]
        # older versions wrote paths that begin with the name of the folder
        names = [Path(name).name for name in information["relative_file_paths"]]
        distro = information.get("ros_distro")
        mode = str(information.get("compression_mode") or "").lower()
        return BagLayout(
            path,
            list(dict.fromkeys(names)),
            distro if isinstance(distro, str) and distro else "unknown",
            has_compressed_messages=mode == "message",
            inside=path,
        )
    except (NotYaml, KeyError, TypeError, AttributeError, ValueError) as error:
        if not bag_names:
            raise unreadable(path, f"its metadata.yaml is invalid ({error}), and it has no other files") from None
        problem = "its metadata.yaml is invalid" + ("" if hidden_text.is_hiding() else f" ({error})")
        return BagLayout(path, bag_names, problem=problem, inside=path)
    except OSError as error:
        raise unreadable(metadata, read_failure(error)) from None


def open_files(layout: BagLayout, stack: ExitStack) -> list[BagFile]:
    """Open the files of a bag; `stack` closes them.

    Raises:
        InputError: SK-CLI-035 a file is missing or unreadable.
    """
    files: list[BagFile] = []
    for name in layout.names:
        path = layout.folder / name
        if _first_bytes(path, layout.inside).startswith(_ZSTD):
            path = _extract(path, Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="simkit_bag_"))))
        is_database = _first_bytes(path).startswith(_SQLITE)
        if not is_database and name.removesuffix(".zstd").endswith(".db3"):
            raise unreadable(path, "it is not an SQLite database")
        file: BagFile = SqliteFile(path) if is_database else McapFile(path)
        stack.callback(file.close)
        files.append(file)
    return files


def _first_bytes(path: Path, inside: Path | None = None) -> bytes:
    try:
        with open_input(path, inside=inside) as file:
            return file.read(len(_SQLITE))
    except OSError as error:
        raise unreadable(path, read_failure(error)) from None


def _extract(path: Path, folder: Path) -> Path:
    """Decompress a file to a folder, and return its new path.

    Raises:
        InputError: SK-CLI-035 the file is damaged, or its content is much larger than the file.
    """
    target = folder / path.stem
    limit = max(_SMALL_FILE, _HIGHEST_RATIO * path.stat().st_size)
    size = 0
    try:
        with target.open("wb") as file:
            for piece in _pieces(path):
                size += len(piece)
                if size > limit:
                    hint = f"decompress it with `zstd -d {path}`, if you trust it"
                    raise unreadable(path, f"its content is more than {limit >> 20} MiB", hint)
                file.write(piece)
    except OSError as error:
        raise unreadable(path, read_failure(error)) from None
    return target


def _pieces(path: Path) -> Iterator[bytes]:
    import zstandard

    with open_input(path) as source:
        reader = zstandard.ZstdDecompressor().stream_reader(source, read_across_frames=True)
        try:
            while piece := reader.read(_PIECE):
                yield piece
        except zstandard.ZstdError as error:
            raise unreadable(path, f"it is damaged: {error}") from None
