"""Sentences of the grader in English and French, and the translations of a lab's titles and hints.

The code of the grader has its sentences in English. The file `messages.fr.yaml` beside this module has the French ones,
as the file of the same name in a lab has its titles and hints. A finished message, with its values, is translated by
the English sentence that fits it.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Final

from simkit.errors import InputError
from simkit.input_file import TEXT_LIMIT, read_input
from simkit.yaml_reader import NotYaml, read_yaml

LANGUAGES: Final = ("en", "fr")
"""Languages of the labs; English is the language of their exercises."""

_NESTED: Final = ("values", "nearest", "reason")  # fields with a message of the grader; others stay as they are
_FIELD: Final = re.compile(r"\{(\w+)(:g)?\}")
_NUMBER: Final = r"[-+.\deinfa]+"
_ITEM: Final = "{expression}"  # begin of a sentence about one value of a list
_NAMES: Final = ("run {number:g}", "until {condition}")  # titles that simkit gives


@dataclass(frozen=True)
class ReportWords:
    """Sentences of a report in one language.

    Attributes:
        sentences: Translation of each sentence of the grader by its English text, with the same fields. A field
            `{name:g}` is a number.
        texts: Translation of each title and hint of the exercises by its English text, and of the sentences that the
            lab's own modules publish as strings, with fields.
        language: One of LANGUAGES.
    """

    sentences: Mapping[str, str] = field(default_factory=dict)
    texts: Mapping[str, str] = field(default_factory=dict)
    language: str = "en"

    def say(self, sentence: str, **values: object) -> str:
        """Return a sentence of the grader with the values of its fields."""
        if sentence not in self.sentences:
            return sentence.format(**values)
        numbers = {name: f"{value:g}" for name, value in values.items() if isinstance(value, float)}
        return self.sentences[sentence].format(**{**values, **numbers})

    def translated(self, text: str) -> str:
        """Return the translation of a title or hint; a text without one stays in English, except names of simkit."""
        if text in self.texts:
            return self.texts[text]
        named = (self._fit(sentence, text) for sentence in _NAMES if self.sentences)
        return next(filter(None, named), text)

    def message(self, text: str) -> str:
        """Return the translation of a finished message, line by line; a line that no sentence fits stays in English."""
        return self._by_line(text, has_values=False)

    def result(self, text: str) -> str:
        """Return the translation of the message of a check, which can have a list of values, such as `f(x) was 3`."""
        return self._by_line(text, has_values=True)

    def _by_line(self, text: str, *, has_values: bool) -> str:
        if not self.sentences:
            return text
        stripped = [(line, line.lstrip()) for line in text.split("\n")]
        return "\n".join(
            line.removesuffix(content) + self._translated_line(content, has_values) for line, content in stripped
        )

    @contextmanager
    def translated_errors(self) -> Iterator[None]:
        """Translate the errors of the grader that are raised in the block; those of a loaded file stay in English."""
        try:
            yield
        except InputError as error:
            if not self.sentences or type(error) is not InputError:
                raise
            shows_code = str(error).startswith(error.code)
            message, help = self.message(error.message), self.message(error.help)
            raise InputError(error.code, message, help=help, shows_code=shows_code) from None

    def _translated_line(self, line: str, has_values: bool) -> str:
        if line in self.sentences:
            return self.sentences[line]
        whole = self._filled(line, has_values, is_item=False)
        if whole is not None or not has_values:
            return line if whole is None else whole
        items = list(_items(line))
        if len(items) > 1:
            return ", ".join(self._translated_line(item, has_values) for item in items)
        item = self._filled(line, has_values, is_item=True)
        return line if item is None else item

    def _filled(self, line: str, has_values: bool, *, is_item: bool) -> str | None:
        """Return the translation by the first sentence that fits; None if there is none."""
        fits = (
            self._fit(sentence, line, has_values)
            for sentence in self.sentences
            if sentence.startswith(_ITEM) == is_item
        )
        return next(filter(None, fits), None)

    def _fit(self, sentence: str, line: str, has_values: bool = False) -> str | None:
        """Return the translation of a line that an English sentence fits; None if it does not fit."""
        match = _pattern(sentence).fullmatch(line)
        if match is None:
            return None
        fields = {
            name: self._translated_line(value, has_values) if name in _NESTED else value
            for name, value in match.groupdict().items()
        }
        if has_values and "value" in fields:
            fields["value"] = self._translated_value(fields["value"])
        return self.sentences[sentence].format(**fields)

    def _translated_value(self, value: str) -> str:
        """Return the value of a string field of a topic with the translations of the lab; other values stay."""
        quote, content = value[:1], value[1:-1]
        if quote not in ("'", '"') or value[-1] != quote:
            return value
        items = content.split("; ")
        translated = [self._published(item) for item in items]
        whole = None if all(translated) else self._published(content)  # a sentence can contain a semicolon
        if whole is None:
            whole = " ; ".join(french or item for french, item in zip(translated, items, strict=True))
        return f'"{whole}"' if "'" in whole else f"{quote}{whole}{quote}"

    def _published(self, text: str) -> str | None:
        """Return the translation of a sentence that a module of the lab publishes; None if there is none."""
        for english, french in self.texts.items():
            match = _pattern(english).fullmatch(text)
            if match is not None:
                return french.format(**match.groupdict())
        return None


ENGLISH: Final = ReportWords()


@cache
def _pattern(sentence: str) -> re.Pattern[str]:
    """Return the pattern of all texts that a sentence gives with the values of its fields."""
    pieces, at = [], 0
    for match in _FIELD.finditer(sentence):
        pieces += [re.escape(sentence[at : match.start()]), f"(?P<{match[1]}>{_NUMBER if match[2] else '.+?'})"]
        at = match.end()
    return re.compile("".join(pieces) + re.escape(sentence[at:]))


def _items(line: str) -> Iterator[str]:
    """Yield the items of a list with commas; commas in parentheses and quoted texts separate nothing."""
    depth, quote, begin = 0, "", 0
    for at, sign in enumerate(line):
        if quote:
            quote = "" if sign == quote else quote
        elif sign in "\"'":
            quote = sign
        elif sign in "([{":
            depth += 1
        elif sign in ")]}":
            depth -= 1
        elif depth == 0 and line.startswith(", ", at):
            yield line[begin:at]
            begin = at + 2
    yield line[begin:]


def default_language() -> str:
    """Return the language of the environment, as gettext finds it: the first of LC_ALL, LC_MESSAGES and LANG."""
    names = (os.environ.get(name, "") for name in ("LC_ALL", "LC_MESSAGES", "LANG"))
    code = next((name for name in names if name), "")[:2]
    return code if code in LANGUAGES else "en"


def read_words(folder: Path | None, language: str) -> ReportWords:
    """Return the sentences of a language with the translations of a lab.

    Args:
        folder: Folder of the lab; its file `messages.fr.yaml` has the translations. Both may be missing.
        language: One of LANGUAGES.

    Raises:
        InputError: SK-SCEN-001 the file is not a mapping from texts to texts.
    """
    if language == "en":
        return ENGLISH
    name = f"messages.{language}.yaml"
    own = Path(__file__).parent
    texts = {} if folder is None else _read_texts(folder / name, folder)
    return ReportWords(_read_texts(own / name, own), texts, language)


def _read_texts(file: Path, folder: Path) -> dict[str, str]:
    """Return the translations of a file by their English texts; none if there is no file."""
    if not file.is_file():
        return {}
    try:
        texts = read_yaml(read_input(file, TEXT_LIMIT, inside=folder).decode("utf-8", "replace"))
    except NotYaml as error:
        raise InputError("SK-SCEN-001", f"{file}: {error}", help="write ENGLISH TEXT: FRENCH TEXT") from None
    if not isinstance(texts, dict) or not all(isinstance(text, str) for pair in texts.items() for text in pair):
        raise InputError("SK-SCEN-001", f"{file}: not a mapping from texts to texts", help="write ENGLISH: FRENCH")
    return texts
