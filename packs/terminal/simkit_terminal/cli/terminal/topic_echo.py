"""Command `simkit topic echo`: print messages as they arrive."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from typer import Option

from simkit.cli.terminal import options
from simkit.cli.terminal.output import print_json, print_line, print_message
from simkit.cli.terminal.topic_sources import Feed, ReceivedMessage, Source, open_source
from simkit.errors import InputError, MessageError
from simkit.extend import argument, option
from simkit.msgs.definition_parser import FieldNode
from simkit.msgs.message_types import FieldValue, Message
from simkit_terminal.cli.terminal import completion
from simkit_terminal.cli.terminal.message_arguments import check_type
from simkit_terminal.cli.terminal.named_endpoints import find_topic, wait_for_topic

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

    from simkit.msgs.message_text import TextStyle

TRUNCATE = 128
MessageFilter = Callable[[Message], bool]
_SEPARATOR = "---"
_CLEAR = "\x1b[2J\x1b[;H"  # ECMA-48: erase the display, then move to the first line


def echo(
    topic: options.Topic,
    message_type: Annotated[
        str | None, argument("Type of the topic (optional).", "[TYPE]", completion.topic_types)
    ] = None,
    once: Annotated[bool, Option("--once", help="Exit after the first message.")] = False,
    field: Annotated[
        str | None,
        option("Field to print: pose.pose.position, ranges[0].", "FIELD", "--field", complete=completion.fields),
    ] = None,
    csv: Annotated[bool, Option("--csv", help="Print comma-separated values, one message per line.")] = False,
    no_arr: Annotated[bool, Option("--no-arr", help="Print arrays as type and length.")] = False,
    no_str: Annotated[bool, Option("--no-str", help="Print strings as their length.")] = False,
    flow_style: Annotated[bool, Option("--flow-style", help="Print one message per line.")] = False,
    full_length: Annotated[bool, Option("--full-length", "-f", help="Do not truncate arrays and strings.")] = False,
    truncate_length: Annotated[int, option("Length to truncate to.", "N", "--truncate-length", "-l", min=0)] = TRUNCATE,
    raw: Annotated[bool, Option("--raw", help="Print the bytes (CDR).")] = False,
    filter_: Annotated[str | None, option("Python condition on the message m: m.data > 2.", "EXPR", "--filter")] = None,
    info: Annotated[bool, Option("--include-message-info", help="Print the time of each message.")] = False,
    no_lost: Annotated[bool, Option("--no-lost-messages", help="Do not report lost messages.")] = False,
    clear: Annotated[bool, Option("--clear", "-c", help="Clear the terminal before each message.")] = False,
    timeout: Annotated[float | None, option("Exit after this wall time.", "S", "--timeout", min=0)] = None,
    sim: options.Sim = None,
    bag: options.Bag = None,
    json_: options.Json = False,
) -> None:
    """Print the messages of a topic; for a bag, all recorded messages."""
    from simkit.msgs.message_text import TextStyle

    style = TextStyle(None if full_length or json_ else truncate_length, no_arr, no_str, flow_style)
    until = None if timeout is None else time.monotonic() + timeout
    with open_source(sim, bag) as source:
        entry = find_topic(source, topic) if message_type is None else wait_for_topic(source, topic, until)
        check_type(message_type, entry.types, entry.name)
        show = _MessagePrinter(source, style, field, csv, raw, json_, info, compile_filter(filter_), clear)
        source.prepare(entry)
        _echo_field(source.feed([entry.name]), show, once=once, until=until, reports_lost=not no_lost)


def _echo_field(feed: Feed, show: _MessagePrinter, *, once: bool, until: float | None, reports_lost: bool) -> None:
    lost = 0
    while True:
        received = feed.take(None if until is None else max(0.0, until - time.monotonic()))
        if received is None:
            return
        if show(received) and once:
            return
        if reports_lost and feed.lost > lost:
            print_message(f"A message was lost!!!\n\ttotal count change:{feed.lost - lost}\n\ttotal count: {feed.lost}")
            lost = feed.lost


def compile_filter(expression: str | None) -> MessageFilter | None:
    """Compile `--filter`, a Python expression with the message as `m` (as in ROS 2), to a function.

    Raises:
        InputError: SK-CLI-033 the text is not a Python expression.
    """
    if expression is None:
        return None
    try:
        code = compile(expression, "--filter", "eval")
    except (SyntaxError, ValueError) as error:
        raise InputError("SK-CLI-033", f"--filter: {expression!r} is not a Python expression: {error}") from None

    def matches(message: Message) -> bool:
        try:
            return bool(eval(code, {"m": message}))
        except Exception as error:  # noqa: BLE001 - the user's expression may raise anything
            text = f"--filter: {expression!r} fails with this message: {error!r}"
            raise InputError("SK-CLI-033", text) from None

    return matches


@dataclass(frozen=True)
class _MessagePrinter:
    """Printer of messages; a call returns True if the message was printed."""

    source: Source
    style: TextStyle
    field: str | None
    csv: bool
    raw: bool
    json: bool
    info: bool
    message_filter: MessageFilter | None
    clears: bool = False

    def __call__(self, received: ReceivedMessage) -> bool:
        from simkit.msgs.message_text import field_at_path

        if self.raw:
            self._clear()
            if self.json:
                print_json(list(received.data))
            else:
                print_line(str(received.data))
                print_line(_SEPARATOR)
            return True
        store = self.source.store(received.type_name)
        message, node = self.source.decode(received), None
        if self.field is not None:
            try:
                message, node = field_at_path(message, self.field, store)
            except MessageError as error:
                raise InputError("SK-CLI-033", f"--field: {error}") from None
        if self.message_filter is not None and not self.message_filter(message):
            return False
        self._clear()
        self._print(received, message, node, store)
        return True

    def _clear(self) -> None:
        """Clear the terminal, as `rostopic echo -c`; a file or a pipe stays as it is."""
        if self.clears and sys.stdout.isatty():
            sys.stdout.write(_CLEAR)

    def _print(
        self, received: ReceivedMessage, message: FieldValue, node: FieldNode | None, store: Typestore | None
    ) -> None:
        from simkit.msgs.message_text import field_text, is_message, message_to_csv, message_to_yaml, to_plain_value

        style = self.style
        seconds = received.time_ns * 1e-9
        if self.json:
            value = to_plain_value(message, style, store)
            print_json({"time": seconds, "message": value} if self.info else value)
            return
        if not is_message(message):
            if self.info:
                print_line(f"---Got new message, print info:---\n{{'received_timestamp': {received.time_ns}}}")
                print_line("---Message data:---")
            print_line(field_text(message, node, store))
            print_line(_SEPARATOR)
        elif self.csv:
            text = message_to_csv(message, style, store)
            print_line(f"{received.time_ns},{text}" if self.info else text)
        else:
            if self.info:
                print_line(f"received_timestamp: {received.time_ns}")
                print_line(_SEPARATOR)
            print_line(message_to_yaml(message, style, store).rstrip("\n"))
            print_line(_SEPARATOR)
