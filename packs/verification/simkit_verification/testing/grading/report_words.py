"""Words of the report of a grade in English and French, and the translations of a lab's titles and hints."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

from simkit.errors import InputError
from simkit.input_file import TEXT_LIMIT, read_input
from simkit.yaml_reader import NotYaml, read_yaml

LANGUAGES: Final = ("en", "fr")
"""Languages of the labs; English is the language of their exercises."""


@dataclass(frozen=True)
class ReportWords:
    """Words of a report.

    Attributes:
        run: First line of a run, with the fields name, time [s] and seed.
        stopped: Word before the reason of an early end.
        passed_sign: Sign of a check that passed.
        failed_sign: Sign of a check that failed.
        points: Points of a check, with the fields points and worth.
        required: Word before the condition that did not hold.
        hint: Word before a hint.
        printed: Word before the printed output.
        result: Last line, with the fields points, worth, share, needed and verdict.
        passed: Verdict of an exercise with enough points.
        not_passed: Verdict of an exercise with too few points.
        texts: Translation of each title and hint of the exercises by its English text.
    """

    run: str = "{name}: {time:g} s simulated, seed {seed}"
    stopped: str = "stopped:"
    passed_sign: str = "pass"
    failed_sign: str = "FAIL"
    points: str = "{points:g} of {worth:g}"
    required: str = "required:"
    hint: str = "hint:"
    printed: str = "printed output:"
    result: str = "{points:g} of {worth:g} points ({share:.0%}), {needed:.0%} needed: {verdict}"
    passed: str = "passed"
    not_passed: str = "not passed"
    texts: Mapping[str, str] = field(default_factory=dict)

    def translated(self, text: str) -> str:
        """Return the translation of a title or hint; a text without one stays in English."""
        return self.texts.get(text, text)


ENGLISH: Final = ReportWords()
_FRENCH: Final = ReportWords(
    run="{name} : {time:g} s simulées, graine {seed}",
    stopped="arrêt :",
    passed_sign="réussi",
    failed_sign="ÉCHEC ",
    points="{points:g} sur {worth:g}",
    required="exigé :",
    hint="indice :",
    printed="texte affiché :",
    result="{points:g} points sur {worth:g} ({share:.0%}), {needed:.0%} exigés : {verdict}",
    passed="réussi",
    not_passed="non réussi",
)


def default_language() -> str:
    """Return the language of the environment, as gettext finds it: the first of LC_ALL, LC_MESSAGES and LANG."""
    names = (os.environ.get(name, "") for name in ("LC_ALL", "LC_MESSAGES", "LANG"))
    code = next((name for name in names if name), "")[:2]
    return code if code in LANGUAGES else "en"


def read_words(folder: Path, language: str) -> ReportWords:
    """Return the words of a language with the translations of a lab.

    Args:
        folder: Folder of the lab; its file `messages.fr.yaml` has the translations. It may be missing.
        language: One of LANGUAGES.

    Raises:
        InputError: SK-SCEN-001 the file is not a mapping from texts to texts.
    """
    if language == "en":
        return ENGLISH
    file = folder / f"messages.{language}.yaml"
    if not file.is_file():
        return _FRENCH
    try:
        texts = read_yaml(read_input(file, TEXT_LIMIT, inside=folder).decode("utf-8", "replace"))
    except NotYaml as error:
        raise InputError("SK-SCEN-001", f"{file}: {error}", help="write ENGLISH TEXT: FRENCH TEXT") from None
    if not isinstance(texts, dict) or not all(isinstance(text, str) for pair in texts.items() for text in pair):
        raise InputError("SK-SCEN-001", f"{file}: not a mapping from texts to texts", help="write ENGLISH: FRENCH")
    return replace(_FRENCH, texts=texts)
