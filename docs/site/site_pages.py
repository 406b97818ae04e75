"""Pages of the repository for the site: which files are pages, where their links lead, and their dialect of Markdown.

On the site, a page has the same path as in the repository. Relative links between pages therefore work in both.
"""

from __future__ import annotations

import os
import posixpath
import re
from collections.abc import Callable, Collection, Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
REPOSITORY = "https://github.com/simkit-robotics/simkit/"
_PAGES = (
    *("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "benchmarks/README.md", "docs/**/*.md"),
    *("examples/*/README.md", "labs/*/README*.md", "packs/*/README.md", "packs/*/docs/**/*.md"),
)
_PICTURES = ("docs/**/*", "packs/*/docs/**/*", "labs/**/*")
_PICTURE_ENDINGS = {".css", ".gif", ".jpg", ".png", ".svg", ".webp"}
_OWN_TARGET = re.compile(rf"{re.escape(REPOSITORY)}(?:blob|tree|raw)/main/")
_LINK = re.compile(r"(!?\[(?:[^\[\]]|\[[^\]]*\])*\]\()([^)\s]+)((?:\s+\"[^\"]*\")?\))")
_FENCE = re.compile(r"^\s*(`{3,}|~{3,})")
_FENCE_WORDS = re.compile(r"^(\s*[`~]{3,}\w+) .*")
_ITEM = re.compile(r"^( *)([-*+]|\d+\.)( +)(?=\S)")
_CODE = re.compile(r"(`+)(.+?)\1")


def repository_pages() -> list[str]:
    """Return the path of each page in the repository, relative to its root. The catalogue of codes is not one."""
    found = {file.relative_to(ROOT).as_posix() for pattern in _PAGES for file in ROOT.glob(pattern)}
    return sorted(found - {"docs/diagnostics.md"})


def repository_pictures() -> list[str]:
    """Return the path of each picture and style sheet for the site, relative to the root of the repository."""
    files = (file for pattern in _PICTURES for file in ROOT.glob(pattern))
    return sorted({file.relative_to(ROOT).as_posix() for file in files if file.suffix in _PICTURE_ENDINGS})


def with_site_links(text: str, page: str, on_site: Collection[str]) -> str:
    """Return the text of a page with links for the site.

    A link to a file that is not on the site leads to the repository on the web. An absolute link to a page of the
    repository, as in the README, becomes a relative one.

    Args:
        text: Markdown.
        page: path of the page in the repository.
        on_site: paths of all pages and pictures of the site.
    """
    folder = posixpath.dirname(page)

    def replaced(match: re.Match[str]) -> str:
        target, hash_, anchor = match[2].partition("#")
        own = _OWN_TARGET.match(target)
        if not target or (re.match(r"[a-z]+:", target) and not own):
            return match[0]
        path = target[own.end() :] if own else posixpath.normpath(posixpath.join(folder, target))
        if path in on_site:
            target = posixpath.relpath(path, folder or ".")
        elif not own:
            target = f"{REPOSITORY}{'tree' if (ROOT / path).is_dir() else 'blob'}/main/{path}"
        return f"{match[1]}{target}{hash_}{anchor}{match[3]}"

    return outside_fences(text, lambda paragraph: _outside_code(paragraph, lambda part: _LINK.sub(replaced, part)))


def in_python_markdown(text: str) -> str:
    r"""Return Markdown of GitHub in the dialect of the package Markdown.

    That package wants an empty line before a list, items of inner lists indented by 4 spaces, and `|` instead of `\|`
    in the code of a table. It does not know words after the language of a block, such as `python skip`.
    """
    lines: list[str] = []
    columns: list[int] = []  # column of the text of each list item that is open
    fence = ""
    for line in text.splitlines():
        indentation = len(line) - len(line.lstrip())
        if fence:
            lines.append(_indented(line, columns))
            if line.strip().startswith(fence):
                fence = ""
            continue
        item = _ITEM.match(line)
        is_in_list = bool(columns)
        if line.strip() and not (columns and not item and lines[-1].strip() and indentation < columns[-1]):
            while columns and indentation < columns[-1]:
                columns.pop()
        if match := _FENCE.match(line):
            fence = match[1]
            line = _FENCE_WORDS.sub(r"\1", line)
        if item:
            if not is_in_list and lines and lines[-1].strip():
                lines.append("")
            lines.append(_indented(line, columns))
            columns.append(item.end())
            continue
        if line.startswith("|"):
            line = _CODE.sub(lambda match: match[0].replace("\\|", "|"), line)
        lines.append(_indented(line, columns) if line.strip() else "")
    return "\n".join(lines) + "\n"


def _indented(line: str, columns: list[int]) -> str:
    """Return a line of the innermost list item, indented by 4 spaces for each level."""
    if not columns:
        return line
    inner = columns[-1]
    rest = line[inner:] if not line[:inner].strip() else line.lstrip()
    return " " * 4 * len(columns) + rest


def outside_fences(text: str, change: Callable[[str], str]) -> str:
    """Apply a function to each paragraph of Markdown that is not a block of code; a link may span lines."""
    return "".join(_changed_paragraphs(text, change))


def _changed_paragraphs(text: str, change: Callable[[str], str]) -> Iterator[str]:
    fence = ""
    paragraph = ""
    for line in text.splitlines(keepends=True):
        match = _FENCE.match(line)
        if fence or match or not line.strip():
            yield change(paragraph)
            yield line
            paragraph = ""
        else:
            paragraph += line
        if fence:
            fence = "" if line.strip().startswith(fence) else fence
        elif match:
            fence = match[1]
    yield change(paragraph)


def _outside_code(text: str, change: Callable[[str], str]) -> str:
    """Apply a function to a text with its code spans hidden, because a code span may look like a link."""
    codes: list[str] = []

    def hide(match: re.Match[str]) -> str:
        codes.append(match[0])
        return f"\0{len(codes) - 1}\0"

    return re.sub(r"\0(\d+)\0", lambda match: codes[int(match[1])], change(_CODE.sub(hide, text)))


def github_anchor(heading: str, separator: str) -> str:
    """Return the anchor of a heading as on GitHub."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", separator)


def generated_nav(folder: str, titles: dict[str, str]) -> list[dict[str, str]]:
    """Return entries of the navigation for the generated pages of a folder, in the order of `titles`.

    Args:
        folder: folder of the pages, with `/` at its end.
        titles: title of each generated page by its path.
    """
    return [{title: page} for page, title in titles.items() if os.path.dirname(page) == folder.rstrip("/")]  # noqa: PTH120
