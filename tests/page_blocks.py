"""Blocks of code of all pages: their language, text, line and the file that the page names for them."""

from __future__ import annotations

import functools
import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Final, NamedTuple

ROOT: Final = Path(__file__).resolve().parents[1]
_NAME: Final = r"[\w./-]+\.(?:py|ya?ml|xml|sdf|world|urdf|xacro|launch|csv|toml|json|msg|srv|action)"
_FENCE: Final = re.compile(r"```(\w*)(.*)")
_LIST: Final = re.compile(r" *(?:[-*]|\d+\.) ")
_COMMAND: Final = re.compile(r"^(?:\$ |(?:simkit|python|pip|\.venv/bin/\w+) (?!(?:=| {2})))", re.MULTILINE)
_SYNOPSIS: Final = re.compile(r'(?<![\w$".{/-])[A-Z]{3,}\b|\[-')


class Block(NamedTuple):
    """Block of code of a page.

    Attributes:
        line: line of the page on which the code begins.
        language: word after the fence. Indented blocks are `xml`, `sh`, `prompt` (commands after `$`) or empty.
        title: rest of the line of the fence.
        file: name of the file that the page gives to the block; empty if the page gives none.
        text: the code.
    """

    line: int
    language: str
    title: str
    file: str
    text: str


def pages() -> list[Path]:
    """Return all pages of the repository."""
    files = [*ROOT.glob("*.md")]
    for folder in ("docs", "packs", "labs", "examples", "benchmarks"):
        files += (file for file in (ROOT / folder).rglob("*.md") if "node_modules" not in file.parts)
    return sorted(files)


def page_name(page: Path) -> str:
    """Return the path of a page in the repository."""
    return page.relative_to(ROOT).as_posix()


def blocks(page: Path, *languages: str) -> list[Block]:
    """Return the blocks of a page in some languages, in the order of the page."""
    return [block for block in _blocks(page) if block.language in languages]


@functools.cache
def _blocks(page: Path) -> tuple[Block, ...]:
    return tuple(_parse(page.read_text(encoding="utf-8").splitlines()))


def _parse(lines: list[str]) -> Iterator[Block]:
    """Yield the fenced blocks, and the indented blocks that are not parts of lists."""
    number, paragraph = 0, ""
    while number < len(lines):
        line = lines[number]
        if fence := _FENCE.match(line):
            end = next(n for n in range(number + 1, len(lines)) if lines[n].startswith("```"))
            text = "".join(f"{one}\n" for one in lines[number + 1 : end])
            yield Block(number + 2, fence[1], fence[2].strip(), _file_of(fence[2], text, paragraph), text)
            number, paragraph = end + 1, ""
        elif line.startswith("    ") and not lines[number - 1] and not _LIST.match(paragraph):
            end = next(
                (n for n in range(number, len(lines)) if lines[n] and not lines[n].startswith("    ")), len(lines)
            )
            text = "".join(f"{one[4:]}\n" for one in lines[number:end]).rstrip("\n") + "\n"
            yield Block(number + 1, _language_of(text), "", _file_of("", text, paragraph), text)
            number = end
        else:
            if line:
                paragraph = line if not lines[number - 1] or _LIST.match(line) else f"{paragraph}\n{line}"
            number += 1


def _language_of(text: str) -> str:
    """Return the language of an indented block."""
    if text.startswith("<"):
        return "xml"
    found = _COMMAND.search(text)
    if not found or (_SYNOPSIS.search(text) and found[0] != "$ "):
        return ""
    return "prompt" if found[0] == "$ " else "sh"


def _file_of(title: str, text: str, paragraph: str) -> str:
    """Return the file name in the title, in a comment on the first line, or at the end of the paragraph before."""
    for name in (
        re.search(rf'(?:title="|file=)({_NAME})', title),
        re.match(rf"(?:#|<!--) ({_NAME})(?: -->)?\n", text),
        re.search(rf"`({_NAME})`:?\Z", paragraph),
    ):
        if name:
            return name[1]
    return ""


def write_files(page: Path, folder: Path) -> None:
    """Write the files of a page into a folder, and those that pages take as given: a reader's own world or robot."""
    shutil.copytree(ROOT / "tests" / "page_files", folder, dirs_exist_ok=True)
    for block in blocks(page, "python", "yaml", "xml", "text"):
        if block.file:
            (folder / block.file).parent.mkdir(parents=True, exist_ok=True)
            (folder / block.file).write_text(block.text, encoding="utf-8")
