"""Topics, services, actions and live parameters of a simulation, as in ROS 2."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol

from simkit import msgs
from simkit.argument_checks import check_list, check_text, wrong_value
from simkit.diagnostics import NOWHERE, Diagnostics, name_hint
from simkit.errors import MessageError
from simkit.lifecycle import LifecycleStates
from simkit.msgs.message_arguments import checked_message
from simkit.msgs.message_types import named_type
from simkit.msgs.topic_names import TYPES_OF_DICTS, absolute_name
from simkit.runtime.communication.action_server import ActionTable
from simkit.runtime.communication.log_topic import LogTopic
from simkit.runtime.communication.name_remapping import type_conflict
from simkit.runtime.communication.parameter import Parameter
from simkit.runtime.communication.parameter_server import ParameterTable
from simkit.runtime.communication.script_callback import ScriptCallback
from simkit.runtime.communication.service_server import ServiceTable
from simkit.runtime.communication.topic_bus import LatestMessages
from simkit.runtime.communication.topic_relay import InputRelay, TopicRelay
from simkit.runtime.communication.transform_buffer import TransformBuffer

if TYPE_CHECKING:
    from simkit.msgs import Message
    from simkit.runtime.communication.publisher import Listener, Publisher
    from simkit.runtime.communication.subscription import Callback, CallbackPolicy, Subscription
    from simkit.runtime.communication.topic_bus import TopicBus
    from simkit.runtime.engine.engine import Engine
    from simkit.runtime.engine.scheduler import Phase, Scheduler, Task
    from simkit.runtime.engine.snapshot import Stateful


MessageMaker = Callable[[str], "Message"]
"""Function that makes the message of a topic."""


class Namespaced(Protocol):
    """Names of a plugin in ROS."""

    @property
    def namespace(self) -> str:
        """Namespace; empty for none."""


class NamedPlugin(Protocol):
    """Names of a plugin."""

    name: str
    scoped: str

    @property
    def ros(self) -> Namespaced:
        """Names in ROS."""


class OnDemandTasks:
    """Tasks of a simulation that are due only while they are needed.

    The class checks which tasks are needed when the schedule is made and when `look` is called. A task that is not
    needed does not change the schedule.

    Args:
        bus: topic bus, whose subscriptions decide which tasks are needed.
        reschedule: function that is called when other tasks are needed than before.
    """

    def __init__(self, bus: TopicBus, reschedule: Callable[[], None]) -> None:
        self._bus, self._reschedule = bus, reschedule
        self._tasks: list[tuple[Callable[[], bool], float | None, Task, Phase]] = []
        self._wanted: list[bool] = []

    def add(
        self, is_wanted: Callable[[], bool], rate: float | None, task: Task, phase: Phase = "after"
    ) -> Callable[[], None]:
        """Call `task(tick)` at a rate while `is_wanted()` is true.

        Args:
            is_wanted: condition; may depend on the state of the run and on the subscriptions.
            rate: rate [Hz]; None for every step.
            task: function to call.
            phase: before or after the step.

        Returns:
            Function that removes the task.
        """
        entry = (is_wanted, rate, task, phase)
        self._tasks.append(entry)
        self.look()

        def remove() -> None:
            if entry in self._tasks:
                self._tasks.remove(entry)
                self.look()

        return remove

    def broadcast(
        self, topics: dict[str, str], rate: float, make: MessageMaker, *, is_aside: bool = True, is_listed: bool = False
    ) -> dict[str, Publisher]:
        """Publish on topics at a rate while they have subscribers.

        Args:
            topics: ROS types by topic.
            rate: publishing rate [Hz].
            make: function that receives a topic and returns its message. Instead of the message, it may return a
                function, which is called when a subscriber reads the message.
            is_aside: True if recorders and counters ignore the topics unless the user names them.
            is_listed: True if the lists of topics contain these topics even without subscribers.

        Returns:
            Publishers by topic.
        """
        bus = self._bus
        if is_aside:
            names = [bus.name_of(topic) for topic in topics]
            bus.aside.update(names)
            bus.unlisted.update(() if is_listed else names)
        publishers = {topic: bus.advertise(topic, kind) for topic, kind in topics.items()}

        def publish(_: int) -> None:
            for topic, publisher in publishers.items():
                if publisher.wanted:
                    message = make(topic)
                    if callable(message):
                        publisher.publish_later(message)
                    else:
                        publisher.publish(message)

        for publisher in publishers.values():
            bus.on_readers_change(publisher.topic, self.look)
        self.add(lambda: any(publisher.wanted for publisher in publishers.values()), rate, publish)
        return publishers

    def wanted(self) -> list[bool]:
        """Return which tasks are needed now."""
        return [is_wanted() for is_wanted, _, _, _ in self._tasks]

    def look(self) -> None:
        """Reschedule if other tasks are needed than at the last check."""
        wanted = self.wanted()
        if wanted != self._wanted and any(wanted + self._wanted):
            self._reschedule()

    def fill(self, scheduler: Scheduler) -> None:
        """Schedule the tasks that are needed now."""
        self._wanted = self.wanted()
        for wanted, (_, rate, task, phase) in zip(self._wanted, self._tasks, strict=True):
            if wanted:
                scheduler.every(rate, task, phase)


class Communication:
    """Topics, services, actions and parameters of a simulation.

    Args:
        bus: topic bus.
        engine: engine of the simulation.

    Attributes:
        bus: topics.
        services: services.
        actions: actions, and the goals that were sent.
        live_parameters: parameters of all plugins.
        on_demand: tasks that are scheduled only while they are needed.
        transforms: transforms of `/tf` and `/tf_static`, received from their first use on.
        log_topic: topic `/rosout`.
        lifecycle_states: states of the lifecycle nodes of plugins and scripts.
        latest_messages: newest message of each subscription.
    """

    def __init__(self, bus: TopicBus, engine: Engine) -> None:
        self.bus, self._engine = bus, engine
        self.services: ServiceTable = ServiceTable(bus, engine)
        self.actions: ActionTable = ActionTable(bus, engine)
        self.live_parameters = ParameterTable(bus, engine)
        self.on_demand = OnDemandTasks(bus, engine.reschedule)
        self.transforms = TransformBuffer(bus, lambda: engine.time_ns)
        self.log_topic = LogTopic(bus, engine, self.live_parameters.node_with)
        self.lifecycle_states = LifecycleStates()
        self.latest_messages = LatestMessages(bus)
        self.log_topic.hear(engine.reports)

    def report_remapping(self, diagnostics: Diagnostics) -> None:
        """Report new names of `--remap` that join different types, and old names that the world does not have."""
        remapping = self.bus.remapping
        known = (*self.bus.topics(), *self.services.names(), *self.actions.names())
        olds_by_new: dict[str, list[str]] = {}
        for old, new in remapping.names.items():
            if old in remapping.used:
                olds_by_new.setdefault(new, []).append(old)
            else:
                text = f"--remap {old}:={new}: the loaded world has no topic, service or action {old}"
                diagnostics.warning("SK-TOPIC-008", text, NOWHERE, name_hint(old, known))
        for new, olds in olds_by_new.items():
            conflict = type_conflict(types for _, end, types, _ in self.bus.endpoints(new) if end.active)
            for table in (self.services, self.actions):
                if table.count(new) > 1:
                    conflict = f"the world has several {table.kind}s of this name"
            if conflict:
                text = f"--remap: {' and '.join(olds)} cannot have the name {new}: {conflict}"
                diagnostics.error("SK-TOPIC-007", text, NOWHERE, "choose another new name")

    def stateful(self) -> list[Stateful]:
        """Return every part with a state, in the order of restoring."""
        calls = (self.live_parameters, self.services, self.actions, self.transforms)
        return [*calls, self.lifecycle_states, self.latest_messages]

    def set_active(self, owners: Sequence[object]) -> None:
        """Enable the interfaces of these plugins and sensors and those without an owner; disable the others."""
        for table in (self.bus, self.services, self.actions, self.live_parameters):
            table.set_active(owners)

    def forget(self, owners: Sequence[object]) -> None:
        """Remove the interfaces of these plugins and sensors permanently."""
        for table in (self.bus, self.services, self.actions, self.live_parameters):
            table.forget(owners)

    def abandon(self, owner: object, reason: str) -> None:
        """End every call and every goal that a disabled plugin has not answered."""
        self.services.abandon(owner, reason)
        self.actions.abandon(owner, reason)

    def set_parameter(self, node: str, name: str, value: object) -> None:
        """Set a live parameter at once; a call from a hook or a callback takes effect before the next step.

        Raises:
            ParameterError: no parameter has that name, or the value is not allowed.
        """
        self._engine.check_open()
        self.live_parameters.set(node, name, value)

    def node_of_plugin(self, plugin: NamedPlugin) -> str:
        """Return the ROS node of a plugin: the first name that no other plugin's parameters or lifecycle node use."""
        plugin_node = f"{plugin.ros.namespace}/{plugin.name}"
        otherwise = "/" + "/".join(filter(None, (*plugin.scoped.split("::"), plugin.name)))
        # several plugins of a model may have the same class and name; their attribute `node` distinguishes them
        otherwise = getattr(plugin, "node", otherwise)
        return self.node_of(plugin, otherwise if "::" in plugin.name else plugin_node, otherwise)

    def node_of(self, owner: object, wanted: str, otherwise: str) -> str:
        """Return a name for a plugin's node: the first free name of `wanted`, `otherwise`, `otherwise_2` and so on."""
        names = itertools.chain((wanted, otherwise), (f"{otherwise}_{i}" for i in itertools.count(2)))
        return next(name for name in names if self._is_free(name, owner))

    def _is_free(self, node: str, owner: object) -> bool:
        has_lifecycle = node in self.lifecycle_states and f"{node}/get_state" not in self.services.endpoints_of(owner)
        return not has_lifecycle and self.live_parameters.is_free(node, owner)

    def publish(self, topic: str, message: Message) -> None:
        """Publish a message. A message object on an unknown topic opens the topic.

        A dict for a topic that only has subscriptions gets the first type that fits.

        Raises:
            MessageError: a dict is published on an unknown topic, or the message does not fit the topic's type.
        """
        topic = absolute_name(topic)
        if not self.bus.types_of(topic):
            if isinstance(message, Mapping):
                message = msgs.from_dict(TYPES_OF_DICTS, message) if self.bus.wanted(topic) else message
            else:
                message = checked_message(message, (), repr(topic))
                self.bus.advertise(topic, msgs.type_name(message))
        self.bus.publish(topic, message)

    def advertise(self, topic: str, type_name: str | type, *, latched: bool = False) -> Publisher:
        """Open a topic for messages of a script or of another process.

        Args:
            topic: name of the topic; a missing leading slash is added.
            type_name: ROS 2 type, such as `sensor_msgs/msg/Imu`.
            latched: send the last message to a later subscriber (transient local).

        Raises:
            MessageError: the type is unknown, or the topic has another type.
        """
        self._engine.check_open()
        return self.bus.advertise(topic, *self._checked_types(topic, type_name), latched=latched)

    def relay(self, source: str, target: str, type_name: str) -> TopicRelay:
        """Publish the messages of a topic on another one too, which may have another type with the same content.

        Args:
            source: topic of the messages; its publisher may be opened later.
            target: topic on which they are published.
            type_name: ROS 2 type of the target.

        Raises:
            MessageError: the type is unknown, or the target has another type.
        """
        self._engine.check_open()
        (name,) = self._checked_types(target, type_name)
        names = {"source": absolute_name(source), "target": absolute_name(target), "type_name": name}
        with self.bus.passing("relay", **names) as report:
            relay = TopicRelay(self.bus, lambda: self._engine.time_ns, **names)
            if report is not None:
                report(relay)
        return relay

    def relay_inputs(self, source: str, target: str, type_name: str) -> InputRelay:
        """Open a command input whose commands go to those of another topic, or give those of a topic a further type.

        Args:
            source: topic of the commands.
            target: topic with the command inputs; they may be opened later. It may be the source.
            type_name: ROS 2 type of the source.

        Raises:
            MessageError: the type is unknown, or the source has another type.
        """
        self._engine.check_open()
        source, target = absolute_name(source), absolute_name(target)
        name = msgs.full_name(type_name)
        msgs.type_of(name)
        if source != target:
            self._checked_types(source, name)
        with self.bus.passing("relay_inputs", source=source, target=target, type_name=name) as report:
            relay = InputRelay(self.bus, lambda: self._engine.time_ns, source, target, name)
            if report is not None:
                report(relay)
        return relay

    def subscribe(
        self,
        topic: str,
        callback: Callback | None,
        keep: int | None,
        on_error: CallbackPolicy,
        type_: str | type | None,
    ) -> Subscription:
        """Receive a topic, which must have the type `type_`, given by class or name; None for any type.

        Raises:
            MessageError: the type is unknown, or the topic has another type.
        """
        self._engine.check_open()
        if type_ is None:
            return self.bus.subscribe(topic, callback, keep, on_error)
        (expected,) = self._checked_types(topic, type_)
        subscription = self.bus.subscribe(topic, callback, keep, on_error)
        subscription.expected = expected
        return subscription

    def listen(
        self, topic: str, types: str | type | Sequence[str], callback: Callback, *, records: bool = True
    ) -> Listener:
        """Open a topic for commands to a script or to another process.

        Args:
            topic: name of the topic; a missing leading slash is added.
            types: accepted type or types; `topics` lists the first one.
            callback: function that receives each message between two steps.
            records: True if a journal records the calls that the callback makes into the simulation.

        Raises:
            MessageError: a type is unknown, or the topic has another type.
        """
        self._engine.check_open()
        name = absolute_name(topic)
        names = self._checked_types(name, types)
        called = ScriptCallback(self.bus, callback, "command input", name) if records else callback
        with self.bus.passing("listen", topic=name, types=names, callback=called) as report:
            listener = self.bus.listen(name, names, called)
            if report is not None:
                report(listener)
        return listener

    def _checked_types(self, topic: str, types: str | type | Sequence[str]) -> tuple[str, ...]:
        """Return the full names of types that may be used on a topic."""
        topic = absolute_name(topic)
        if isinstance(types, type):
            types = named_type(types)
        if not isinstance(types, (list, tuple)):
            check_text(types, "the type")
            types = (str(types),)
        check_list(types, str, "types", "a text such as 'std_msgs/msg/String'")
        if not types:
            raise wrong_value("types", "a list with at least one type", types)
        names = tuple(msgs.full_name(name) for name in types)
        for name in names:
            msgs.type_of(name)
        used = list(dict.fromkeys(self.bus.types_of(topic)))
        if used and not set(used) & set(names):
            raise MessageError(f"topic {topic!r} has type {' or '.join(used)}, got {' or '.join(names)}")
        return names

    @property
    def parameters(self) -> dict[str, dict[str, Parameter[Any]]]:
        """Live parameters by node and name."""
        return self.live_parameters.nodes()
