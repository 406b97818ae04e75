"""Deprecated names warn, are on the page, and go in time; the changelog and the upgrade notes follow the version."""

from __future__ import annotations

import ast
import importlib
import re
import subprocess
import sys
from datetime import date
from pathlib import Path

import pytest

import simkit
from simkit.cli.diagnostic_catalogue import catalogue
from simkit.deprecation import SimkitDeprecationWarning, removal_version
from simkit.errors import InputError
from simkit.testing.run_record import run_recorder

ROOT = Path(__file__).resolve().parents[1]
PAGE = (ROOT / "docs" / "deprecations.md").read_text(encoding="utf-8")
CHANGELOG = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
HEADINGS = re.findall(r"^## (.+)$", CHANGELOG, flags=re.MULTILINE)
MOVED = [
    line.split()
    for file in sorted(ROOT.glob("packs/*/simkit_*/moved_modules.txt"))
    for line in file.read_text(encoding="utf-8").splitlines()
]
PRESENT = tuple(int(number) for number in re.findall(r"\d+", simkit.__version__))


def deprecating_calls() -> list[str]:
    """Return the version of each call of `warn_deprecated` in simkit that names it."""
    files = [*(ROOT / "simkit").rglob("*.py"), *ROOT.glob("packs/*/simkit_*/**/*.py")]
    sources = [text for file in files if "warn_deprecated(" in (text := file.read_text(encoding="utf-8"))]
    return [
        keyword.value.value
        for source in sources
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "warn_deprecated"
        for keyword in node.keywords
        if keyword.arg == "since" and isinstance(keyword.value, ast.Constant)
    ]


def test_a_name_works_for_two_minor_versions() -> None:
    assert (removal_version("0.3"), removal_version("1.9")) == ("0.5", "1.11")


def test_no_deprecated_name_outlives_its_removal() -> None:
    versions = {since for _, _, since in MOVED} | set(deprecating_calls())
    assert versions
    assert all(tuple(map(int, removal_version(since).split("."))) > PRESENT[:2] for since in versions)


def test_the_page_lists_every_deprecated_name() -> None:
    table = PAGE.partition("## Deprecated today")[2].partition("\n## ")[0]
    rows = [row.split(" | ") for row in re.findall(r"^\| `(.+) \|$", table, flags=re.MULTILINE)]
    listed = {(old.strip("`"), new.strip("`"), since) for old, new, since, _ in rows}
    assert {(old, new, since) for old, new, since in MOVED} <= listed
    assert len(listed) == len(MOVED) + len(deprecating_calls())
    assert {removal_version(since) == removal for _, _, since, removal in rows} == {True}


def test_an_error_with_its_message_first_works_with_a_warning() -> None:
    with pytest.warns(
        SimkitDeprecationWarning, match=r"^InputError\(message, code\) is .*: use InputError\(code"
    ) as found:
        error = InputError("mine", "SK-X-001")
    assert (str(error), error.code) == ("mine", "SK-X-001")
    assert found[0].filename == __file__


def test_the_old_name_of_record_run_works_with_a_warning() -> None:
    with pytest.warns(SimkitDeprecationWarning, match=r"run_record is .* 0\.5: use simkit\.testing\.record_run$"):
        assert run_recorder.run_record is simkit.testing.record_run


def test_python_shows_the_warning_of_a_script(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text('import simkit\nsimkit.InputError("mine", "SK-X-001")\n', encoding="utf-8")
    ended = subprocess.run([sys.executable, "mine.py"], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert "mine.py:2: SimkitDeprecationWarning: InputError(message, code) is deprecated since" in ended.stderr


def test_versions_of_the_changelog_descend_from_the_present_one() -> None:
    assert HEADINGS[0] == "Unreleased"
    matches = [re.fullmatch(r"(\d+)\.(\d+)\.(\d+) - (\d{4}-\d\d-\d\d)", heading) for heading in HEADINGS[1:]]
    assert all(matches), HEADINGS
    versions = [tuple(map(int, match.groups()[:3])) for match in matches if match]
    days = [date.fromisoformat(match[4]) for match in matches if match]
    assert versions[0] == PRESENT
    assert versions == sorted(set(versions), reverse=True)
    assert days == sorted(days, reverse=True)
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {simkit.__version__}\ndate-released: {days[0]}\n" in citation


def test_sections_of_the_changelog_are_those_of_keep_a_changelog() -> None:
    allowed = ["Added", "Changed", "Deprecated", "Removed", "Fixed", "Security"]
    for section in re.split(r"^## .+$", CHANGELOG, flags=re.MULTILINE)[1:]:
        kinds = re.findall(r"^#+ (.+)$", section, flags=re.MULTILINE)
        assert kinds == [kind for kind in allowed if kind in kinds]
        entries = re.split(r"^### .+\n", section, flags=re.MULTILINE)[1:]
        assert all(re.match(r"\n- \S", entry) for entry in entries)


def test_no_entry_of_the_changelog_is_there_twice() -> None:
    entries = [" ".join(entry.split()) for entry in re.split(r"^(?:- |#)", CHANGELOG, flags=re.MULTILINE)]
    long = [entry for entry in entries if len(entry) > 30]
    assert sorted(long) == sorted(set(long))


def test_what_is_not_released_is_short() -> None:
    """A merge of branches keeps the lines of both sides: lines that one side removed must not come back."""
    unreleased = CHANGELOG.partition("## Unreleased")[2].partition("\n## ")[0]
    assert len(unreleased.split()) < 400


def test_every_entry_of_a_version_is_short() -> None:
    released = CHANGELOG.partition(f"## {simkit.__version__}")[2]
    assert not [entry for entry in re.split(r"^- ", released, flags=re.MULTILINE)[1:] if len(entry.split()) > 60]


def test_each_later_minor_version_has_upgrade_notes() -> None:
    noted = re.findall(r"^## Upgrade to (\d+\.\d+)$", PAGE, flags=re.MULTILINE)
    minor = list(dict.fromkeys(re.findall(r"^## (\d+\.\d+)\.", CHANGELOG, flags=re.MULTILINE)))
    assert noted == minor[:-1]
    assert noted[0] == simkit.__version__.rpartition(".")[0]


def test_codes_of_the_changelog_and_the_page_exist() -> None:
    named = set(re.findall(r"\bSK-[A-Z]+-\d{3}\b", CHANGELOG + PAGE))
    assert len(named) > 5 and named <= set(catalogue())


@pytest.mark.needs_packs
@pytest.mark.slow  # imports each command
def test_options_of_the_changelog_and_the_page_exist(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "docs" / "site"))
    pages = importlib.import_module("reference").command_pages().values()
    known = {option for _, text in pages for option in re.findall(r"--[a-z][\w-]+", text)} | {"--help", "--version"}
    named = {
        option
        for code in re.findall(r"`[^`]+`", CHANGELOG + PAGE)
        for option in re.findall(r"(?<![\w-])--[a-z][\w-]+", code)
    }
    assert len(named) > 20 and named <= known
