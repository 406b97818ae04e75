"""Messages in response to messages, as in Gazebo's `gz::sim::systems::TriggeredPublisher`."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from simkit import Params, WorldPlugin
from simkit.errors import MessageError
from simkit.extend import NEVER, Options, OptionsOf, blocks, did_you_mean, integer, text
from simkit.msgs import valid_topic
from simkit.number_text import number_or_nan
from simkit.plugins.gz.performer_detector import DETAILS, STATUS
from simkit_gz_python.msgs.message import MESSAGE_CLASSES, Message
from simkit_gz_python.msgs.message_matcher import TOLERANCE, MessageMatcher
from simkit_gz_python.msgs.ros_conversion import SERVICE_REQUEST_TYPES, call_service, from_ros, to_ros, twins_of
from simkit_gz_python.plugins.message_elements import (
    message_kind,
    read_message,
    ros_type_of,
    shortened,
    topic_attribute,
)

if TYPE_CHECKING:
    from simkit import Publisher, Simulation
    from simkit.msgs import PerformerStatus

_MS: Final = 1_000_000  # [ns]


@dataclass(frozen=True)
class _Output:
    """Message to publish, with its publisher and its ROS type."""

    publisher: Publisher
    message: Message
    ros: str


@dataclass(frozen=True)
class _Request:
    """Service to call, with its request and Gazebo's type of its response."""

    service: str
    message: Message
    answer: type[Message]


class TriggeredPublisherOutputOptions(Options):
    """Options of an `<output>` block."""

    type_: str = text(element="@type")
    topic: str = text(element="@topic")


class TriggeredPublisherServiceOptions(Options):
    """Options of a `<service>` block."""

    name: str = text(element="@name")
    req_msg: str = text(element="@reqMsg")
    timeout: str = text(element="@timeout")
    req_type: str = text(element="@reqType")
    rep_type: str = text(element="@repType")


class TriggeredPublisherOptions(Options):
    """Options of `TriggeredPublisher`."""

    delay_ms: int = integer(0, maximum=10**12)
    output: tuple[TriggeredPublisherOutputOptions, ...] = blocks(TriggeredPublisherOutputOptions)
    service: tuple[TriggeredPublisherServiceOptions, ...] = blocks(TriggeredPublisherServiceOptions)
    input: str = text(required=True)


class TriggeredPublisher(WorldPlugin):
    """Publishes messages and calls services for each input message that satisfies every `<match>`.

    Messages are written in protobuf's text format, with Gazebo's type names. Inputs are checked between two steps.
    Outputs are published at once, or with `<delay_ms>` in the first step after this delay in simulated time.
    """

    options = OptionsOf(TriggeredPublisherOptions)
    filenames = ("gz-sim-triggered-publisher-system",)
    names = ("gz::sim::systems::TriggeredPublisher",)

    def load(self, parent: Simulation, params: Params) -> None:
        self._due: deque[int] = deque()  # [ns]
        self.before_step_rate = NEVER
        self._delay = max(0, self.options.delay_ms) * _MS
        self._outputs = [out for element in params.all("output") if (out := self._read_output(element)) is not None]
        self._requests = [r for element in params.all("service") if (r := self._read_request(element)) is not None]
        if not params.all("output") and not params.all("service"):
            params.error("SK-PARAM-001", f"plugin {self.name!r} needs an <output> or a <service>")
        inputs = params.all("input")
        if not inputs:
            _ = self.options.input
        for extra in inputs[1:]:
            message = f"plugin {self.name!r} uses only its first <input>; this <input> is not used"
            params.diagnostics.warning("SK-PLUGIN-124", message, extra.where, "add one plugin for each input")
            extra.mark_all_read()
        if inputs:
            self._read_input(inputs[0])

    # ------------------------------------------------------------------ parameters

    def _read_input(self, element: Params) -> None:
        kind, topic = message_kind(element, "type"), topic_attribute(element)
        matchers = element.all("match")
        if kind is None or not topic:
            for match in matchers:
                match.mark_all_read()
            return
        self._input_kind = kind
        self._matchers = [m for match in matchers if (m := self._read_match(kind, match)) is not None]
        if matchers and not any(match.value for match in matchers):
            element.error(
                "SK-PARAM-002", "every <match> is empty; write the expected value into one of them, or remove them all"
            )
            return
        if kind is MESSAGE_CLASSES["Pose"] and any(
            match.attributes.get("field", "").startswith("header.") for match in matchers
        ):
            # ROS's stamped pose has no fields for Gazebo's header data, so listen to the detailed status
            self.listen(topic + DETAILS, STATUS, self._on_status)
            return
        known, twins = self.sim.communication.bus.topics().get(topic), [twin.ros for twin in twins_of(kind)]
        self.listen(topic, sorted(twins, key=lambda ros: ros != known), self._on_message)

    def _read_match(self, kind: type[Message], element: Params) -> MessageMatcher | None:
        field, logic = element.attribute("field"), element.attribute("logic_type", "positive")
        tolerance = _tolerance(element)
        if logic not in ("positive", "negative"):
            element_text = f'<match logic_type="{logic}">'
            element.error("SK-PARAM-002", f"found {element_text}; expected positive or negative")
            return None
        if not element.value:
            element.warning("SK-PLUGIN-124", f"plugin {self.name!r}: a <match> without a text has no effect")
            return None
        try:
            return MessageMatcher(kind, element.value, field, tolerance, logic == "positive")
        except MessageError as error:
            element.error("SK-PLUGIN-121", f"<match>{shortened(element.value)}</match>: {error}")
            return None

    def _read_output(self, element: Params) -> _Output | None:
        kind, topic = message_kind(element, "type"), topic_attribute(element)
        if kind is None or not topic:
            return None
        message = read_message(kind, element.value, element, "<output>")
        if message is None:
            return None
        ros = ros_type_of(self.sim, kind, topic)
        return _Output(self.advertise(topic, ros), message, ros)

    def _read_request(self, element: Params) -> _Request | None:
        name, text = element.attribute("name"), element.attribute("reqMsg")
        element.attribute("timeout")  # [ms], unused: services respond at once
        kind = message_kind(element, "reqType", SERVICE_REQUEST_TYPES)
        answer = message_kind(element, "repType", MESSAGE_CLASSES)
        if not name:
            element.error("SK-PARAM-001", '<service> needs name="...", the name of the service')
        if kind is None or answer is None or not name:
            return None
        message = read_message(kind, text, element, "reqMsg")
        return None if message is None else _Request(valid_topic(name), message, answer)

    # ------------------------------------------------------------------ messages

    def _on_message(self, message: object) -> None:
        self._check(from_ros(self._input_kind, message) if self._matchers else None)

    def _on_status(self, message: PerformerStatus) -> None:
        self._check(_pose_of_status(message))

    def _check(self, message: Message | None) -> None:
        if message is not None and not all(matcher.meets(message) for matcher in self._matchers):
            return
        if self._delay == 0:
            self._respond()
            return
        self._due.append(self.sim.time_ns + self._delay)
        self._set_pace()

    def before_step(self) -> None:
        while self._due and self._due[0] <= self.sim.time_ns:
            self._due.popleft()
            self._respond()
        self._set_pace()

    def _set_pace(self) -> None:
        """Call `before_step` at every step while a delayed output is pending, otherwise not at all."""
        self._set_before_step_rate(None if self._due else NEVER)

    def _respond(self) -> None:
        for out in self._outputs:
            if out.publisher.wanted:
                out.publisher.publish(to_ros(out.message, out.ros))
        for request in self._requests:
            was_called, answer = call_service(self.sim, request.service, request.message, request.answer)
            if not was_called:
                hint = did_you_mean(request.service, self.sim.communication.services.names())
                message = f"there is no service {request.service!r} for this request type"
                self._once.warn("SK-PLUGIN-122", request.service, message, hint)
            elif "data" in request.answer.FIELDS and answer.data is False:
                message = f"service {request.service!r} was called and reported failure"
                self._once.warn("SK-PLUGIN-122", f"{request.service} failed", message)


def _tolerance(element: Params) -> float:
    text = element.attribute("tol", str(TOLERANCE))
    tolerance = number_or_nan(text)
    if not tolerance >= 0.0:
        element.error("SK-PARAM-002", f'found <match tol="{text}">; expected a number of at least 0')
        return TOLERANCE
    return tolerance


def _pose_of_status(status: PerformerStatus) -> Message:
    """Return the `gz.msgs.Pose` that Gazebo's detector publishes for a status, with Gazebo's header data."""
    message: Any = MESSAGE_CLASSES["Pose"](name=status.name)
    for ours, theirs in ((message.position, status.pose.position), (message.orientation, status.pose.orientation)):
        for axis in ours.FIELDS:
            if axis != "header":
                setattr(ours, axis, getattr(theirs, axis))
    message.header.stamp.sec, message.header.stamp.nsec = status.header.stamp.sec, status.header.stamp.nanosec
    header_data = (
        ("frame_id", status.header.frame_id),
        ("state", str(int(status.state))),
        ("count", str(status.count)),
    )
    for key, value in (*header_data, *zip(status.keys, status.values, strict=True)):
        message.header.data.add(key=key, value=[value])
    return message  # type: ignore[no-any-return]
