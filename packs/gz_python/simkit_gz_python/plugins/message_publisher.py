"""Messages at given times: `vrx::PublisherPlugin` of VRX."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from simkit import Params, WorldPlugin
from simkit.extend import NEVER, Options, OptionsOf, SharedByCopies, blocks, text
from simkit.number_text import number_or_nan
from simkit_gz_python.msgs.message import Message
from simkit_gz_python.msgs.ros_conversion import to_ros
from simkit_gz_python.plugins.message_elements import message_kind, read_message, ros_type_of, topic_attribute

if TYPE_CHECKING:
    from simkit import Publisher, Simulation

_NANOSECONDS: Final = 1_000_000_000
_LATEST: Final = 1e9  # [s]


class PublishedMessageOptions(Options):
    """Options of a `<message>`, whose text is the message."""

    type_: str = text(element="@type")
    topic: str = text(element="@topic")
    at: str = text("0", element="@at")
    every: str = text("0", element="@every")


class PublisherOptions(Options):
    """Options of `PublisherPlugin`."""

    message: tuple[PublishedMessageOptions, ...] = blocks(PublishedMessageOptions)


@dataclass(frozen=True, eq=False)
class _Timed(SharedByCopies):
    """Message with its publisher, its ROS type, its first time [ns], and its period [ns]; 0 for a single message."""

    publisher: Publisher
    message: Message
    ros: str
    first: int
    period: int


class PublisherPlugin(WorldPlugin):
    """Publishes messages once or periodically, at times of the simulation.

    A `<message>` has the attributes `type`, `topic`, `at` and `every` [s]. Its text is the message in protobuf's text
    format.
    """

    options = OptionsOf(PublisherOptions)
    filenames = ("libPublisherPlugin.so",)
    names = ("vrx::PublisherPlugin",)

    def load(self, parent: Simulation, params: Params) -> None:
        timed_messages = [self._read(options) for options in self.options.message]
        self._messages = [timed for timed in timed_messages if timed is not None]
        self._due: list[int | None] = [timed.first for timed in self._messages]
        self._update_pace()

    def _read(self, options: PublishedMessageOptions) -> _Timed | None:
        element = options.params
        kind, topic = message_kind(element, "type"), topic_attribute(element)
        times = [_time(element, "at", options.at), _time(element, "every", options.every)]
        if kind is None or not topic:
            return None
        message = read_message(kind, element.value, element, "<message>")
        if message is None:
            return None
        ros = ros_type_of(self.sim, kind, topic)
        return _Timed(self.advertise(topic, ros), message, ros, *times)

    def before_step(self) -> None:
        """Publish the messages that are due."""
        now = self.sim.time_ns
        for index, (timed, due) in enumerate(zip(self._messages, self._due, strict=True)):
            if due is not None and due <= now:
                timed.publisher.publish(to_ros(timed.message, timed.ros))
                self._due[index] = due + timed.period if timed.period else None
        self._update_pace()

    def _update_pace(self) -> None:
        """Call `before_step` at every step while a message is pending, otherwise not at all."""
        self._set_before_step_rate(None if any(due is not None for due in self._due) else NEVER)


def _time(element: Params, attribute: str, written: str) -> int:
    """Return the time in an attribute [ns]; 0 after a reported error."""
    seconds = number_or_nan(written)
    if not 0 <= seconds <= _LATEST:
        element.error("SK-PARAM-002", f'found <message {attribute}="{written}">; expected 0 to {_LATEST:g} seconds')
        return 0
    return max(round(seconds * _NANOSECONDS), 1) if seconds > 0 else 0
