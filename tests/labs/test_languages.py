"""The French texts of the labs: the same structure, code, formulas and links, and a translation of each hint."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest
from typer.testing import CliRunner

from simkit.cli import app
from simkit_verification.testing.grading.exercise import read_exercise
from simkit_verification.testing.grading.report_words import read_words

ROOT = Path(__file__).parents[2] / "labs"
LABS = sorted(path.parent.name for path in ROOT.glob("*/exercise.yaml"))
ADDED = {("13_urdf", "caster")}
"""Lab and word of code that only the French text has, to explain an English name."""


def parts(text: str) -> dict[str, list[str]]:
    """Return what the texts of both languages have in common."""
    fenced = re.findall(r"^ *```.*?^ *```", text, re.MULTILINE | re.DOTALL)
    text = re.sub(r"^ *```.*?^ *```", "", text, flags=re.MULTILINE | re.DOTALL)
    indented = re.findall(r"^    \S.*$", text, re.MULTILINE)
    text = re.sub(r"^    \S.*$", "", text, flags=re.MULTILINE)
    displayed = [re.sub(r"\\text\{[a-zà-ÿ,.()' ]+\}", "", one) for one in re.findall(r"\$\$.*?\$\$", text, re.DOTALL)]
    text = re.sub(r"\$\$.*?\$\$", "", text, flags=re.DOTALL)
    prose = re.sub(r"\$[^$]+\$|`[^`]+`|\]\([^)]*\)", "", text)
    return {
        "headings": re.findall(r"^#+(?= )", text, re.MULTILINE),
        "commands": fenced + indented,
        "formulas": displayed,
        "rows": [str(row.count("|")) for row in re.findall(r"^ *\|.*$", text, re.MULTILINE)],
        "steps": re.findall(r"^\d+\.(?= )", text, re.MULTILINE),
        "links": sorted(re.findall(r"\]\(([^)]+)\)", text)),
        "numbers": sorted(re.findall(r"\d+(?:\.\d+)?", re.sub(r"(\d),(\d)", r"\1.\2", prose))),
        "code": sorted(re.sub(r"\s+", " ", code) for code in re.findall(r"`([^`]+)`", text)),
    }


@pytest.mark.parametrize("name", LABS)
def test_the_french_readme_has_the_parts_of_the_english_one(name: str) -> None:
    english, french = (parts((ROOT / name / file).read_text("utf-8")) for file in ("README.md", "README.fr.md"))
    added = Counter(french.pop("code")) - Counter(english.pop("code"))
    assert {(name, word) for word in added} <= ADDED
    assert french == english


def test_the_french_page_of_the_course_has_the_parts_of_the_english_one() -> None:
    french = (ROOT.parent / "docs" / "cours.md").read_text("utf-8")
    english = (ROOT.parent / "docs" / "course.md").read_text("utf-8")
    assert parts(french.replace("README.fr.md)", "README.md)").replace("(course.md)", "(cours.md)")) == parts(english)


@pytest.mark.parametrize("name", LABS)
def test_each_title_and_hint_has_a_translation_and_each_translation_a_text(name: str) -> None:
    texts = set()
    for file in sorted((ROOT / name).glob("exercise*.yaml")):
        exercise = read_exercise(file, allow_code=True)
        texts |= {exercise.title, *(run.name for run in exercise.runs if not re.fullmatch(r"run \d+", run.name))}
        for check in exercise.runs[0].scenario.checks:
            texts |= {check.title, check.hint} - {""}
    translations = read_words(ROOT / name, "fr").texts
    published = set(translations) - texts
    code = "".join(file.read_text("utf-8") for file in (ROOT / name).glob("*.py"))
    for sentence in published:  # of the referee
        words = set(re.findall(r"[a-z]{4,}", re.sub(r"\{\w+\}", "", sentence)))
        assert words and all(word in code for word in words), sentence
        fields = (sorted(re.findall(r"\{(\w+)\}", text)) for text in (sentence, translations[sentence]))
        assert len({tuple(names) for names in fields}) == 1, sentence
    assert texts <= set(translations)
    assert all(translations.values())
    assert (ROOT / name / "README.fr.md").is_file()


def test_the_language_is_that_of_the_option_or_of_the_environment(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lab(*arguments: object) -> str:
        return CliRunner().invoke(app, ["lab", *map(str, arguments)]).output

    assert f"read {tmp_path / 'a' / 'README.md'}, then" in lab("start", "1", tmp_path / "a")
    french = lab("start", "1", tmp_path / "b", "--lang", "fr")
    assert f"lisez {tmp_path / 'b' / 'README.fr.md'}, puis" in french and "--lang fr" in french
    monkeypatch.setenv("LANG", "fr_FR.UTF-8")
    assert f"lisez {tmp_path / 'c' / 'README.fr.md'}, puis" in lab("start", "1", tmp_path / "c")
    monkeypatch.setenv("LC_ALL", "de_DE.UTF-8")
    assert f"read {tmp_path / 'd' / 'README.md'}, then" in lab("start", "1", tmp_path / "d")
    assert "SK-CLI-018" in lab("start", "1", tmp_path / "e", "--lang", "de")


@pytest.mark.slow
def test_a_report_in_french_has_the_words_of_the_lab(tmp_path: Path) -> None:
    CliRunner().invoke(app, ["lab", "start", "1", str(tmp_path / "turtle")])
    (tmp_path / "turtle" / "square.py").write_text("this is no Python\n", "utf-8")
    report = CliRunner().invoke(app, ["lab", "grade", str(tmp_path / "turtle"), "--lang", "fr"]).output
    assert "Un carré avec une tortue" in report and "ÉCHEC   atteint le premier coin" in report
    assert "arrêt : " in report and "square.py:1: SyntaxError" in report and "indice" not in report
