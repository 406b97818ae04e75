"""Parser of gz messages in protobuf's text format: `linear: {x: 0.2}, header { stamp { sec: 3 } }`."""

from __future__ import annotations

import math
import re
from typing import Final

from simkit.errors import MessageError
from simkit.extend import did_you_mean
from simkit_gz_python.msgs.message import MESSAGE_CLASSES, PLAIN_DEFAULTS, Message

_TOKEN: Final = re.compile(
    r"""
      "(?:[^"\\\n]|\\.)*" | '(?:[^'\\\n]|\\.)*'
    | [-+]?(?:0[xX][0-9a-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?[fF]?)(?![\w.])
    | -?[A-Za-z_][\w.]*
    | [{}<>\[\]:;,]
    """,
    re.VERBOSE,
)
_BETWEEN: Final = re.compile(r"\s*(?:#[^\n]*\n?\s*)*")
"""White space and comments."""
_ESCAPE: Final = re.compile(r"\\(x[0-9a-fA-F]{1,2}|[0-7]{1,3}|.)", re.DOTALL)
_ESCAPES: Final = {"n": "\n", "t": "\t", "r": "\r", "a": "\a", "b": "\b", "f": "\f", "v": "\v"}
_TRUE: Final = frozenset(("true", "True", "t", "1"))
_FALSE: Final = frozenset(("false", "False", "f", "0"))
_CLOSES: Final = {"{": "}", "<": ">"}
_DEEPEST: Final = 50


def parse_message(kind: type[Message], text: str) -> Message:
    """Parse a message; an empty text is a message with all defaults.

    Raises:
        MessageError: the text is invalid, or contains a field that the message class does not have.
    """
    reader = _TextReader(text)
    message = MESSAGE_CLASSES[kind.__name__]()
    reader.read_fields(message, "")
    return message


def parse_value(kind: str, text: str) -> object:
    """Parse the value of one field; for a repeated field, the text is `[…]` or one value, and the result is a list.

    Args:
        kind: kind of the field as in `Message.FIELDS`.
        text: text that follows `name:` in a message.

    Raises:
        MessageError: the text is not a value of this kind.
    """
    reader = _TextReader(text)
    values = reader.read_values(kind.removesuffix("[]"), is_repeated=kind.endswith("[]"))
    reader.expect_end()
    return values if kind.endswith("[]") else values[0]


class _TextReader:
    """Reader of the tokens of a text."""

    def __init__(self, text: str) -> None:
        self._text, self._position, self._depth = text, 0, 0
        self._next_token: str | None = None

    def _peek(self) -> str:
        """Return the next token without consuming it; empty at the end of the text."""
        if self._next_token is None:
            between = _BETWEEN.match(self._text, self._position)
            start = between.end() if between else self._position
            match = _TOKEN.match(self._text, start)
            if match is None and start < len(self._text):
                raise MessageError(f"found {_shorten(self._text[start:])}, which is not valid in a message's text")
            self._next_token, self._position = (match[0], match.end()) if match else ("", start)
        return self._next_token

    def _next(self) -> str:
        token, self._next_token = self._peek(), None
        if not token:
            raise MessageError("the text ends before the message is complete")
        return token

    def _skip(self, *tokens: str) -> bool:
        if self._peek() in tokens and self._peek():
            self._next_token = None
            return True
        return False

    def expect_end(self) -> None:
        if self._peek():
            raise MessageError(f"found {_shorten(self._peek())} after the value; expected one value")

    def read_fields(self, message: Message, end: str) -> None:
        """Read the fields up to the token `end` into the message."""
        self._depth += 1
        if self._depth > _DEEPEST:
            raise MessageError(f"the text has more than {_DEEPEST} nested levels")
        while self._peek() != end:
            name = self._next()
            kind = _kind_of(message, name)
            has_colon = self._skip(":")
            is_repeated, item_kind = kind.endswith("[]"), kind.removesuffix("[]")
            if not has_colon and item_kind in PLAIN_DEFAULTS:
                raise MessageError(f"found {name!r} without a colon; expected {name}: value")
            for value in self.read_values(item_kind, is_repeated=is_repeated):
                _set_field(message, name, value, is_repeated=is_repeated)
            self._skip(",", ";")
        self._depth -= 1

    def read_values(self, kind: str, *, is_repeated: bool) -> list[object]:
        """Read one value, or all values of a list `[…]`."""
        if not (is_repeated and self._skip("[")):
            return [self._read_value(kind)]
        values: list[object] = []
        while not self._skip("]"):
            values.append(self._read_value(kind))
            if not self._skip(",") and self._peek() != "]":
                raise MessageError(f"found {_shorten(self._peek())} in a list; expected a comma or ]")
        return values

    def _read_value(self, kind: str) -> object:
        token = self._next()
        if kind not in PLAIN_DEFAULTS:
            if token not in _CLOSES:
                raise MessageError(f"found {_shorten(token)}; expected {{ and the fields of a gz.msgs.{kind}")
            inner = MESSAGE_CLASSES[kind]()
            self.read_fields(inner, _CLOSES[token])
            self._next()
            return inner
        if kind in ("s", "y"):
            parts = [_unquote(token)]
            while self._peek()[:1] in ('"', "'"):
                parts.append(_unquote(self._next()))
            text = "".join(parts)
            return text if kind == "s" else text.encode("latin-1", "replace")
        return _parse_plain(kind, token)


def _kind_of(message: Message, name: str) -> str:
    kind = type(message).FIELDS.get(name)
    if kind is None:
        fields = type(message).FIELDS
        hint = did_you_mean(name, fields) or f"its fields are {', '.join(fields)}"
        raise MessageError(f"gz.msgs.{type(message).__name__} has no field {_shorten(name)}; {hint}")
    return kind


def _set_field(message: Message, name: str, value: object, *, is_repeated: bool) -> None:
    if is_repeated:
        getattr(message, name).append(value)
    elif isinstance(value, Message):
        getattr(message, name).CopyFrom(value)
    elif isinstance(value, _EnumWord):
        setattr(message, name, _number_of_word(type(message), value))
    else:
        setattr(message, name, value)


class _EnumWord(str):
    """Name of an enumeration value, such as `REVOLUTE`."""


def _number_of_word(kind: type[Message], word: str) -> int:
    number = getattr(kind, word, None)
    if not isinstance(number, int):
        known = [name for name in vars(kind) if name.isupper() and isinstance(getattr(kind, name), int)]
        allowed = " or ".join(("a whole number", *known))
        raise MessageError(f"found {_shorten(word)}; expected {allowed}")
    return number


def _parse_plain(kind: str, token: str) -> object:
    if kind == "b":
        if token in _TRUE or token in _FALSE:
            return token in _TRUE
        raise MessageError(f"found {_shorten(token)}; expected true or false")
    number = _number(token)
    if kind == "i" and number is None and re.fullmatch(r"[A-Za-z_]\w*", token):
        return _EnumWord(token)
    if number is None or (kind == "i" and number != number // 1):
        raise MessageError(f"found {_shorten(token)}; expected a {'whole ' if kind == 'i' else ''}number")
    return int(number) if kind == "i" else float(number)


def _number(token: str) -> float | int | None:
    sign, bare = (-1, token[1:]) if token[:1] == "-" else (1, token.removeprefix("+"))
    if bare.lower() in ("inf", "infinity"):
        return sign * math.inf
    if bare.lower() == "nan":
        return math.nan
    try:
        if bare[:2].lower() == "0x":
            return sign * int(bare, 16)
        if re.fullmatch(r"0[0-7]+", bare):
            return sign * int(bare, 8)
        if bare.isdigit():
            return sign * int(bare)
        return sign * float(bare.rstrip("fF"))
    except ValueError:
        return None


def _unquote(token: str) -> str:
    if token[:1] not in ('"', "'"):
        raise MessageError(f"found {_shorten(token)}; expected a text in quotes")

    def unescape(match: re.Match[str]) -> str:
        code = match[1]
        if code[0] == "x" and len(code) > 1:
            return chr(int(code[1:], 16))
        return chr(int(code, 8) & 0xFF) if code[0] in "01234567" else _ESCAPES.get(code, code)

    return _ESCAPE.sub(unescape, token[1:-1])


def _shorten(text: str) -> str:
    text = text.strip()
    return repr(text if len(text) <= 40 else text[:37] + "...") if text else "the end of the text"
