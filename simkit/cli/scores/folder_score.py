"""Table of the scores of all files of a folder, with what is missing and the first command to try."""

from __future__ import annotations

import re
import shlex
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from simkit.cli.scores.file_score import FileScore, Status
from simkit.cli.scores.folder_search import FolderFiles
from simkit.cli.terminal.output import JsonObject
from simkit.input_file import read_input
from simkit.loaders.resources.xml_reader import without_comments

_LARGEST_READ: Final = 1 << 22  # bytes of a file that may include others
_ROBOT: Final = re.compile(rb"<robot\b[^>]*>")
_NAME: Final = re.compile(rb"\sname\s*=")
_INCLUDES: Final = re.compile(rb"""<(?:xacro:)?include\s[^>]*?(?:filename|file)\s*=\s*["']([^"']+)["']""")


@dataclass(frozen=True)
class FolderScore:
    """Scores of the files of a folder.

    Attributes:
        folder: folder, as it was given.
        files: score of each file; their names are relative to the folder.
        found: files that were found.
        options: options of the command that a run needs too, such as `--package-path DIR`.
    """

    folder: str
    files: Sequence[FileScore]
    found: FolderFiles
    options: Sequence[str] = ()

    @property
    def whole(self) -> Sequence[FileScore]:
        """Files without those that are only parts of others."""
        return [score for score in self.files if score.status != "part"]

    @property
    def running(self) -> Sequence[FileScore]:
        """Files that run as they are."""
        return [score for score in self.files if score.status == "runs"]

    def missing(self, status: Status) -> list[tuple[str, int]]:
        """Return what files that run, or refused files, lack, with the number of files, the most frequent first."""
        counts = Counter(text for score in self.files if score.status == status for text in score.missing)
        return sorted(counts.items(), key=lambda item: (-item[1], item[0]))

    def first_command(self) -> str:
        """Return the command for the file that shows most; empty if no file runs.

        A file with a robot that follows commands comes first, then one with sensors, then the one with the best score.
        """
        best = max(self.running, key=_interest, default=None)
        return "" if best is None else shlex.join(["simkit", "run", *self.options, str(Path(self.folder, best.file))])

    def commands_of_others(self) -> list[tuple[str, int, str, str]]:
        """Return title, number, reason and the first command of each kind of files that are listed only."""
        rows = []
        for kind, files in self.found.others.items():
            first = shlex.quote(str(Path(self.folder, files[0])))
            title = kind.title if len(files) == 1 else f"{kind.title}s"
            rows.append((title, len(files), kind.reason, kind.command.replace("{file}", first)))
        return rows

    def as_dict(self) -> JsonObject:
        """Return the table as plain data."""
        return {
            "folder": self.folder,
            "runs": len(self.running),
            "of": len(self.whole),
            "parts": len(self.files) - len(self.whole),
            "refused_because": [{"what": what, "files": count} for what, count in self.missing("refused")],
            "missing": [{"what": what, "files": count} for what, count in self.missing("runs")],
            "first_command": self.first_command(),
            "others": [
                {"kind": kind.title, "reason": kind.reason, "files": files} for kind, files in self.found.others.items()
            ],
            "unreadable_folders": self.found.unreadable,
            "is_complete": self.found.is_complete,
            "files": [score.as_dict() for score in self.files],
        }


def with_parts(scores: Iterable[FileScore], folder: Path) -> list[FileScore]:
    """Return scores in which refused files that others include are parts, and not files that should run.

    A file is a part if another file includes it, or if it is a robot without a name that xacro cannot expand alone.
    """
    listed = list(scores)
    includers: dict[str, str] = {}
    nameless = set[str]()
    for score in listed:
        text = _text_of(folder / score.file)
        for match in _INCLUDES.finditer(text):
            includers.setdefault(match[1].decode("utf-8", "replace").rpartition("/")[2], score.file)
        root = _ROBOT.search(text)
        if root is not None and not _NAME.search(root[0]):
            nameless.add(score.file)
    return [_as_part(score, includers, is_nameless=score.file in nameless) for score in listed]


def _as_part(score: FileScore, includers: Mapping[str, str], *, is_nameless: bool) -> FileScore:
    """Return the score of a refused file as that of a part, if it is one."""
    includer = includers.get(score.file.rpartition("/")[2], score.file)
    needs_more = is_nameless and any(text.startswith("SK-XACRO-001") for text in score.missing)
    if score.status != "refused" or (includer == score.file and not needs_more):
        return score
    why = f"{includer} includes it" if includer != score.file else "a robot without a name, for other files to include"
    return replace(score, status="part", reason=f"{why}; alone: {score.reason}", missing=[], remedies=[])


def _text_of(path: Path) -> bytes:
    """Return the text of a file that may include others; empty for other files."""
    if not path.name.endswith((".xacro", ".xml", ".urdf")):
        return b""
    try:
        return without_comments(read_input(path, _LARGEST_READ, inside=path.parent))
    except (OSError, ValueError):
        return b""


def _interest(score: FileScore) -> tuple[bool, bool, bool, int, int, str]:
    """Return a key that is largest for the file that a newcomer should run first."""
    is_world = score.file.endswith((".world", ".sdf"))
    has_drive, has_sensor = score.has_working("drives"), score.has_working("sensors")
    return has_drive, has_sensor, is_world, score.score, -score.file.count("/"), _inverted(score.file)


def _inverted(text: str) -> str:
    """Return a text that sorts opposite to another one, so that the first name in order is the largest key."""
    return "".join(chr(0x10FFFF - ord(letter)) for letter in text)
