"""Fields of a client's request, checked when they are read, and the texts of errors for clients.

A client gets a code and plain English. The texts of Python's own exceptions stay inside.
"""

from __future__ import annotations

import json
import logging
import re
import sys
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Final, TypeVar, cast

from simkit.argument_checks import shown
from simkit.errors import InputError

T = TypeVar("T")
H = TypeVar("H")
CODE: Final = "SK-LIVE-008"
FAULT: Final = "SK-LIVE-010"
_KINDS: Final[Mapping[type, str]] = MappingProxyType(
    {
        str: "a text",
        bool: "true or false",
        int: "a whole number",
        float: "a finite number",
        list: "a list",
        dict: "an object",
    }
)
_REQUIRED: Final = object()
_LOGGED: Final[set[str]] = set()
_MOST_LOGGED: Final = 100
_HAS_CODE: Final = re.compile(r"SK-[A-Z]+-\d{3}")


class RequestRefused(InputError):
    """Error for a request that a server refuses; the message has the reason."""

    code = CODE


def find_handler(handlers: Mapping[str, H], name: str, kind: str = "request") -> H:
    """Return the handler of a request from the table of a server.

    Args:
        handlers: handlers by the name that clients send.
        name: name in the request.
        kind: word of the server's protocol for a request.

    Raises:
        RequestRefused: no request has this name.
    """
    if name not in handlers:
        raise RequestRefused(f"unknown {kind} {name!r:.80}; expected {', '.join(handlers)}")
    return handlers[name]


def read_field(fields: Mapping[str, object], name: str, kind: type[T], default: object = _REQUIRED) -> T:
    """Return a field of a request.

    Args:
        fields: request.
        name: name of the field.
        kind: class of its value: str, bool, int, float (any finite number), list or dict.
        default: value if the field is missing or null.

    Raises:
        RequestRefused: the field is missing or has a value of another kind.
    """
    value = fields.get(name)
    if value is None and default is not _REQUIRED:
        return default  # type: ignore[return-value]  # the caller chooses a value of the kind
    if name not in fields:
        raise RequestRefused(f"{name!r} is missing; expected {_KINDS[kind]}")
    return checked_value(value, f"{name!r}", kind)


def checked_value(value: object, name: str, kind: type[T]) -> T:
    """Return a value of a request if it has a kind; see `read_field`.

    Raises:
        RequestRefused: the value has another kind.
    """
    checked: Any = value
    if kind is float and type(checked) is int and abs(checked) <= sys.float_info.max:
        checked = float(checked)  # JSON has integers that no float can hold
    if type(checked) is not kind or (kind is float and not abs(cast("float", checked)) <= sys.float_info.max):
        raise RequestRefused(f"{name} must be {_KINDS[kind]}, got {shown(value)}")
    return checked


def read_items(fields: Mapping[str, object], name: str, kind: type[T]) -> list[T]:
    """Return a field that is a list of values of one kind.

    Raises:
        RequestRefused: the field is missing or has another value.
    """
    return [checked_value(item, f"an item of {name!r}", kind) for item in read_field(fields, name, list)]


def read_identifier(fields: Mapping[str, object], name: str = "id") -> str | int | float | None:
    """Return the name or number that a client has given to a request; None without one.

    Raises:
        RequestRefused: it is neither a text nor a finite number.
    """
    identifier = fields.get(name)
    if identifier is None or isinstance(identifier, str):
        return identifier
    if (
        isinstance(identifier, bool)
        or not isinstance(identifier, (int, float))
        or not abs(identifier) <= sys.float_info.max
    ):
        raise RequestRefused(f"{name!r} must be a text or a number, got {shown(identifier)}")
    return identifier


def read_json(data: str | bytes) -> Any:
    """Return the value of a JSON text.

    Raises:
        RequestRefused: the text is not JSON, or is nested too deeply.
    """
    try:
        return json.loads(data)
    except json.JSONDecodeError as error:
        raise RequestRefused(f"the message is not JSON: {error}") from None
    except UnicodeDecodeError:
        raise RequestRefused("the message is not JSON: it is not valid UTF-8") from None
    except ValueError:  # Python refuses to read very long integers
        raise RequestRefused("the message has a number with too many digits") from None
    except RecursionError:
        raise RequestRefused("the message is nested too deeply") from None


def client_text(error: BaseException) -> str:
    """Return the text of an error for a client, with its code.

    An error without a code of simkit is not shown to the client: it is a fault of simkit and is logged once.
    """
    code = getattr(error, "code", "")
    if isinstance(code, str) and code.startswith("SK-"):
        text = str(error)
        return text if code in text else f"{code} {text}"
    if isinstance(error, RecursionError):
        return f"{CODE} the request is nested too deeply"
    _log_fault(error)
    return f"{CODE} the request cannot be executed: a field is missing or has a value that is not allowed"


def _log_fault(error: BaseException) -> None:
    """Log an unexpected exception with the place that raised it, once for each place; without values of the client."""
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    place = f"{trace.tb_frame.f_code.co_filename}:{trace.tb_lineno}" if trace is not None else "an unknown place"
    fault = f"{type(error).__name__} at {place}"
    if fault not in _LOGGED and len(_LOGGED) < _MOST_LOGGED:
        _LOGGED.add(fault)
        text = "warning %s the request of a client met a fault of simkit: %s\n    help: %s"
        logging.getLogger("simkit").warning(text, FAULT, fault, "report it with the request of the client")


def with_code(text: str) -> str:
    """Return the text of an error for a client, with a code if it has none."""
    return text if _HAS_CODE.search(text) else f"{CODE} {text}"
