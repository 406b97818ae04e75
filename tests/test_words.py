"""Rules for the words of the package: how docstrings begin, which metaphors and which module names are not used."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MODULES = sorted([*ROOT.glob("simkit/**/*.py"), *ROOT.glob("packs/*/simkit_*/**/*.py")])
PAGES = sorted(
    [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("packs/*/*.md"), *ROOT.glob("packs/*/docs/**/*.md")]
)

OPENINGS = re.compile(r"(What|Whether|Of|Who|Whose|Where|That|Which)\b")
QUOTED_OPENINGS = re.compile(rf"[\"'](\\\n)?{OPENINGS.pattern}")
METAPHORS = re.compile(r"\b(doors?|crews?|worn|promis(?:e|es|ed)|hearers?|audience)\b", re.IGNORECASE)
HOUSE = re.compile(r"\b(in|of|the) (the )?house\b(?! (?:world|from))", re.IGNORECASE)
HAS_REAL_DOORS = re.compile(r"elevator|packs/open_rmf/|rmf\.md|index\.md|movers\.md|catalogue\.md|CHANGELOG\.md")
HAS_A_REAL_HOUSE = re.compile(r"docs/(robots|physics|rendering)\.md|CHANGELOG\.md")
VAGUE_MODULE_NAMES = {
    *("asked", "beside", "doors", "ends", "heard", "made", "once", "parts", "place", "put_in", "taking"),
    *("text", "things", "together", "values", "words", "worn", "written"),
}


@cache
def docstrings(path: Path) -> tuple[tuple[int, str], ...]:
    """Return the docstrings of modules, classes, functions and attributes of a file, with their line numbers."""
    return tuple(_docstrings(ast.parse(path.read_text(encoding="utf-8"))))


def _docstrings(tree: ast.AST) -> Iterator[tuple[int, str]]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            for statement in node.body:
                if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant):
                    text = statement.value.value
                    if isinstance(text, str):
                        yield statement.lineno, text


def comments(path: Path) -> list[tuple[int, str]]:
    """Return the comments of a file, with their line numbers."""
    text = path.read_text(encoding="utf-8")
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    return [(token.start[0], token.string) for token in tokens if token.type == tokenize.COMMENT]


def _name(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def test_no_docstring_begins_with_a_relative_word() -> None:
    """A function begins with a verb, a class or an attribute with a noun."""
    candidates = [p for p in MODULES if QUOTED_OPENINGS.search(p.read_text(encoding="utf-8"))]  # the others are clean
    found = [
        f"{_name(p)}:{line}: {text[:60]}" for p in candidates for line, text in docstrings(p) if OPENINGS.match(text)
    ]
    assert not found, "\n".join(found)


def test_no_docstring_comment_or_page_has_a_metaphor() -> None:
    found = []
    for path in MODULES:
        if not any(_metaphors(_name(path), path.read_text(encoding="utf-8"))):  # to parse all files takes seconds
            continue
        for line, text in [*docstrings(path), *comments(path)]:
            found += [f"{_name(path)}:{line}: {word}" for word in _metaphors(_name(path), text)]
    for page in PAGES:
        text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
        found += [f"{_name(page)}: {word}" for word in _metaphors(_name(page), text)]
    assert not found, "\n".join(found)


def _metaphors(name: str, text: str) -> Iterator[str]:
    if not HAS_REAL_DOORS.search(name):
        yield from (match[0] for match in METAPHORS.finditer(text))
    if not HAS_A_REAL_HOUSE.search(name):
        yield from (match[0] for match in HOUSE.finditer(text))


def test_no_module_has_a_name_that_says_nothing() -> None:
    assert not [_name(p) for p in MODULES if p.stem in VAGUE_MODULE_NAMES or p.parent.name in VAGUE_MODULE_NAMES]
