"""Nodes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any, Final
from weakref import ref

from simkit.runtime.communication.log_topic import log_message
from simkit_nodes.host import current_host, current_program
from simkit_nodes.interfaces import ROS2, type_name_of
from simkit_nodes.names import RosArguments, expand_name, join_name, namespace_error, node_name_error
from simkit_nodes.parameter_overrides import parameter_overrides as overrides_of
from simkit_nodes.qos import Qos
from simkit_nodes.ros_modules.rclpy.callback_groups import (
    CallbackGroup,
    MutuallyExclusiveCallbackGroup,
    ReentrantCallbackGroup,
)
from simkit_nodes.ros_modules.rclpy.clock import Clock, ROSClock
from simkit_nodes.ros_modules.rclpy.constants import S_TO_NS
from simkit_nodes.ros_modules.rclpy.context import parse_arguments
from simkit_nodes.ros_modules.rclpy.event_handler import (
    EventSource,
    PublisherEventCallbacks,
    SubscriptionEventCallbacks,
)
from simkit_nodes.ros_modules.rclpy.exceptions import InvalidHandle, NotInitializedException
from simkit_nodes.ros_modules.rclpy.guard_condition import GuardCondition
from simkit_nodes.ros_modules.rclpy.impl.implementation_singleton import Handle, NodeNameNonExistentError, RCLError
from simkit_nodes.ros_modules.rclpy.impl.rcutils_logger import RcutilsLogger, log_state
from simkit_nodes.ros_modules.rclpy.logging import get_logger
from simkit_nodes.ros_modules.rclpy.logging_service import LoggingService
from simkit_nodes.ros_modules.rclpy.node_parameters import NodeParameters
from simkit_nodes.ros_modules.rclpy.node_queries import NodeQueries
from simkit_nodes.ros_modules.rclpy.node_services import NodeServices
from simkit_nodes.ros_modules.rclpy.parameter import Parameter
from simkit_nodes.ros_modules.rclpy.parameter_service import ParameterService
from simkit_nodes.ros_modules.rclpy.publisher import Publisher
from simkit_nodes.ros_modules.rclpy.qos import QoSProfile, graph_qos, qos_profile_parameter_events
from simkit_nodes.ros_modules.rclpy.qos_overriding_options import QoSOverridingOptions, declare_qos_parameters
from simkit_nodes.ros_modules.rclpy.subscription import Subscription, callback_type_of
from simkit_nodes.ros_modules.rclpy.time_source import TimeSource
from simkit_nodes.ros_modules.rclpy.timer import Rate, Timer
from simkit_nodes.ros_modules.rclpy.type_support import check_is_valid_msg_type
from simkit_nodes.ros_modules.rclpy.utilities import get_default_context
from simkit_nodes.ros_modules.rclpy.validate_full_topic_name import validate_full_topic_name
from simkit_nodes.ros_modules.rclpy.validate_namespace import validate_namespace
from simkit_nodes.ros_modules.rclpy.validate_node_name import validate_node_name
from simkit_nodes.ros_modules.rclpy.validate_topic_name import validate_topic_name

if TYPE_CHECKING:
    from simkit_nodes.ros_modules.rclpy.client import Client
    from simkit_nodes.ros_modules.rclpy.context import Context
    from simkit_nodes.ros_modules.rclpy.executors import Executor
    from simkit_nodes.ros_modules.rclpy.service import Service
    from simkit_nodes.ros_modules.rclpy.waitable import ExecutorEntity, Waitable

__all__ = ["HIDDEN_NODE_PREFIX", "Node", "NodeNameNonExistentError"]

HIDDEN_NODE_PREFIX = "_"

_LOG: Final = "rcl_interfaces/msg/Log"
_ROSOUT_QOS: Final = Qos(is_transient_local=True, depth=1000, lifespan_ns=10 * S_TO_NS)


class Node(NodeParameters, NodeServices, NodeQueries):
    """Node: publishers, subscriptions, services, timers and parameters under one name.

    Args:
        node_name: name, without the namespace.
        context: context; None for the default one.
        cli_args: arguments for this node only, such as `["--ros-args", "-r", "a:=b"]`.
        namespace: namespace of the node and of its relative names.
        use_global_arguments: False to ignore the command line of the program.
        enable_rosout: False to publish no log messages on `/rosout`.
        start_parameter_services: False for no parameter services.
        parameter_overrides: values that replace those of declarations.
        allow_undeclared_parameters: True if parameters need no declaration.
        automatically_declare_parameters_from_overrides: True to declare all values of `parameter_overrides` and of
            the command line.
        enable_logger_service: True opens the services for the levels of loggers.

    Raises:
        NotInitializedException: `rclpy.init` was not called.
        InvalidNodeNameException, InvalidNamespaceException: a name is invalid.
    """

    def __init__(
        self,
        node_name: str,
        *,
        context: Context | None = None,
        cli_args: Sequence[str] | None = None,
        namespace: str | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        start_parameter_services: bool = True,
        parameter_overrides: Sequence[Parameter] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
    ) -> None:
        self._context = get_default_context() if context is None else context
        self._publishers: list[Publisher] = []
        self._subscriptions: list[Subscription] = []
        self._clients: list[Client] = []
        self._services: list[Service] = []
        self._timers: list[Timer] = []
        self._guards: list[GuardCondition] = []
        self._waitables: list[Waitable] = []
        self._default_callback_group: CallbackGroup = MutuallyExclusiveCallbackGroup()
        self._rate_group = ReentrantCallbackGroup()
        self._executor: Callable[[], Executor | None] = lambda: None
        self._handle = Handle()
        if not self._context.is_valid:
            raise NotInitializedException("cannot create node")
        self._arguments = self._read_arguments(cli_args, use_global_arguments)
        self._name, self._namespace = self._checked_names(node_name, namespace or "")
        program = current_program()
        self._graph_node = current_host().graph.open_node(program, self.get_fully_qualified_name())
        self._logger = get_logger(self.get_fully_qualified_name().strip("/").replace("/", "."))
        if enable_rosout and self._arguments.is_rosout_enabled:
            self._open_rosout()
        params = program.options.params if use_global_arguments else {}
        values = overrides_of(self.get_fully_qualified_name(), self._arguments, params)
        overrides = {name: Parameter(name, value=value) for name, value in values.items()}
        overrides |= {parameter.name: parameter for parameter in parameter_overrides or ()}
        self._init_parameters(overrides, allow_undeclared=allow_undeclared_parameters)
        self._clock = ROSClock()
        events = ROS2.message_class("rcl_interfaces/msg/ParameterEvent")
        self._parameter_event_publisher = self.create_publisher(
            events, "/parameter_events", qos_profile_parameter_events
        )
        if automatically_declare_parameters_from_overrides:
            self._declare_overrides()
        self._time_source = TimeSource(node=self)
        self._time_source.attach_clock(self._clock)
        if start_parameter_services:
            self._parameter_service = ParameterService(self)
        if enable_logger_service:
            self._logger_service = LoggingService(self)
        self._declare_type_description()

    def _read_arguments(self, cli_args: Sequence[str] | None, use_global_arguments: bool) -> RosArguments:
        """Return the arguments of the node: its own ones before those of the program."""
        own = parse_arguments(["--ros-args", *cli_args] if cli_args else [])
        if not use_global_arguments:
            return own
        all_of_program = self._context.arguments
        return RosArguments(
            rules=own.rules + all_of_program.rules,
            parameters=all_of_program.parameters + own.parameters,
            parameter_files=all_of_program.parameter_files + own.parameter_files,
            is_rosout_enabled=own.is_rosout_enabled and all_of_program.is_rosout_enabled,
        )

    def _checked_names(self, name: str, namespace: str) -> tuple[str, str]:
        """Return the name and the namespace of the node after remapping."""
        if not namespace.startswith("/"):
            namespace = "/" + namespace
        validate_node_name(name)
        validate_namespace(namespace)
        namespace = self._arguments.namespace(name, namespace)
        name = self._arguments.node_name(name)
        if node_name_error(name) or namespace_error(namespace):
            raise RCLError(f"rclpy_create_node failed: {join_name(namespace, name)!r} is no valid name of a node")
        return name, namespace

    def _open_rosout(self) -> None:
        publisher = self._graph_node.advertise("/rosout", _LOG, _ROSOUT_QOS)
        full_name = self.get_fully_qualified_name()
        host = current_host()

        def publish(level: int, name: str, text: str, file: str, function: str, line: int) -> None:
            message = log_message(full_name, host.now_ns(), level, text, file, function, line)
            message.name = name
            publisher.publish(message)

        log_state().rosout[self._logger.name] = publish

    # ------------------------------------------------------------------ for executors

    @property
    def publishers(self) -> Iterator[Publisher]:
        """Publishers of the node."""
        yield from self._publishers

    @property
    def subscriptions(self) -> Iterator[Subscription]:
        """Subscriptions of the node."""
        yield from self._subscriptions

    @property
    def clients(self) -> Iterator[Client]:
        """Clients of the node."""
        yield from self._clients

    @property
    def services(self) -> Iterator[Service]:
        """Services of the node."""
        yield from self._services

    @property
    def timers(self) -> Iterator[Timer]:
        """Timers of the node."""
        yield from self._timers

    @property
    def guards(self) -> Iterator[GuardCondition]:
        """Guard conditions of the node."""
        yield from self._guards

    @property
    def waitables(self) -> Iterator[Waitable]:
        """Waitables of the node, such as action servers and events."""
        yield from self._waitables

    def _callback_entities(self) -> Iterator[ExecutorEntity]:
        """Return what has callbacks, except waitables, in the order in which executors call them."""
        return chain(self._timers, self._subscriptions, self._guards, self._clients, self._services)

    @property
    def executor(self) -> Executor | None:
        """Executor of the node; None without one."""
        return self._executor()

    @executor.setter
    def executor(self, new_executor: Executor | None) -> None:
        current = self._executor()
        if current is new_executor:
            return
        if current is not None:
            current.remove_node(self)
        if new_executor is None:
            self._executor = lambda: None
            return
        self._executor = ref(new_executor)
        new_executor.add_node(self)

    def _wake_executor(self) -> None:
        executor = self._executor()
        if executor is not None:
            executor.wake()

    @property
    def context(self) -> Context:  # type: ignore[override]
        """Context of the node."""
        return self._context

    @property
    def default_callback_group(self) -> CallbackGroup:  # type: ignore[override]
        """Callback group of callbacks without another one; one of them runs at a time."""
        return self._default_callback_group

    @property
    def handle(self) -> Handle:
        """State of the node."""
        return self._handle

    # ------------------------------------------------------------------ names, clock and logger

    def get_name(self) -> str:
        """Return the name without the namespace."""
        with self._handle:
            return self._name

    def get_namespace(self) -> str:
        """Return the namespace."""
        with self._handle:
            return self._namespace

    def get_fully_qualified_name(self) -> str:
        """Return the name with the namespace."""
        with self._handle:
            return join_name(self._namespace, self._name)

    def get_clock(self) -> Clock:
        """Return the clock of the node."""
        return self._clock

    def get_logger(self) -> RcutilsLogger:
        """Return the logger of the node."""
        return self._logger

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Return the absolute name of a topic.

        Args:
            topic: name as the program writes it.
            only_expand: True to ignore remapping.
        """
        return self._resolve(topic, only_expand, is_service=False)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return the absolute name of a service; see `resolve_topic_name`."""
        return self._resolve(service, only_expand, is_service=True)

    def _resolve(self, name: str, only_expand: bool, *, is_service: bool) -> str:
        with self._handle:
            validate_topic_name(name, is_service=is_service)
            try:
                full = expand_name(name, self._name, self._namespace)
            except ValueError as error:
                raise RCLError(f"failed to resolve name: {error}, at ./src/rcl/expand_topic_name.c:163") from None
            if not only_expand:
                full = self._arguments.remap(full, self._name, self._namespace, is_service=is_service)
            validate_full_topic_name(full, is_service=is_service)
            return full

    # ------------------------------------------------------------------ publishers, subscriptions, timers

    def create_publisher(
        self,
        msg_type: object,
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: PublisherEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        publisher_class: type[Publisher] = Publisher,
    ) -> Publisher:
        """Create a publisher.

        Args:
            msg_type: class of the messages.
            topic: name of the topic.
            qos_profile: quality of service, or the depth of the queue.
            callback_group: callback group of the event callbacks.
            event_callbacks: callbacks for events.
            qos_overriding_options: policies that parameters may replace.
            publisher_class: class of the publisher.
        """
        profile = _checked_profile(qos_profile)
        group = callback_group or self.default_callback_group
        full_name = self.resolve_topic_name(topic)
        if qos_overriding_options is not None:
            declare_qos_parameters(self, "publisher", full_name, profile, qos_overriding_options)
        check_is_valid_msg_type(msg_type)
        type_name, events = type_name_of(msg_type), EventSource()
        callbacks = event_callbacks or PublisherEventCallbacks()
        handlers = callbacks.create_event_handlers(group, events, topic, self._logger.name)
        graph_publisher = self._graph_node.advertise(full_name, type_name, graph_qos(profile), events.report)
        publisher = publisher_class(
            graph_publisher, msg_type, topic, profile, handlers, self._context, self._logger.name
        )
        self._publishers.append(publisher)
        for handler in handlers:
            handler._wake = self._wake_executor
            self.add_waitable(handler)
        return publisher

    def create_subscription(
        self,
        msg_type: object,
        topic: str,
        callback: Callable[..., object],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
    ) -> Subscription:
        """Create a subscription.

        Args:
            msg_type: class of the messages.
            topic: name of the topic.
            callback: function or coroutine function that receives a message, or a message and a dict about it.
            qos_profile: quality of service, or the depth of the queue.
            callback_group: callback group.
            event_callbacks: callbacks for events.
            qos_overriding_options: policies that parameters may replace.
            raw: True for bytes instead of messages.
        """
        profile = _checked_profile(qos_profile)
        group = callback_group or self.default_callback_group
        full_name = self.resolve_topic_name(topic)
        if qos_overriding_options is not None:
            declare_qos_parameters(self, "subscription", full_name, profile, qos_overriding_options)
        check_is_valid_msg_type(msg_type)
        type_name = type_name_of(msg_type)
        callback_type_of(callback)
        events = EventSource()
        callbacks = event_callbacks or SubscriptionEventCallbacks()
        handlers = callbacks.create_event_handlers(group, events, topic, self._logger.name)
        graph_subscription = self._graph_node.subscribe(
            full_name, type_name, graph_qos(profile), events.report, self._wake_executor
        )
        subscription = Subscription(
            graph_subscription, msg_type, topic, callback, group, profile, raw, handlers, self._logger.name
        )
        group.add_entity(subscription)
        self._subscriptions.append(subscription)
        self._wake_executor()
        for handler in handlers:
            handler._wake = self._wake_executor
            self.add_waitable(handler)
        return subscription

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[[], object] | None,
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> Timer:
        """Create a timer.

        Args:
            timer_period_sec: period [s].
            callback: function or coroutine function without arguments.
            callback_group: callback group.
            clock: clock of the period; None for the clock of the node.
            autostart: False for a timer that begins with `reset`.
        """
        group = callback_group or self.default_callback_group
        period_ns = int(float(timer_period_sec) * S_TO_NS)
        timer = Timer(callback, group, period_ns, clock or self._clock, context=self._context, autostart=autostart)
        timer._wake = self._wake_executor
        group.add_entity(timer)
        self._timers.append(timer)
        self._wake_executor()
        return timer

    def create_guard_condition(
        self, callback: Callable[[], object], callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """Create a guard condition, whose callback is called after `trigger`."""
        group = callback_group or self.default_callback_group
        guard = GuardCondition(callback, group, context=self._context)
        guard._wake = self._wake_executor
        group.add_entity(guard)
        self._guards.append(guard)
        self._wake_executor()
        return guard

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Create a rate; an executor has to spin in another thread.

        Args:
            frequency: rate [Hz].
            clock: clock; None for the clock of the node.
        """
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        timer = self.create_timer(1.0 / frequency, None, self._rate_group, clock)
        return Rate(timer, context=self._context)

    def add_waitable(self, waitable: Waitable) -> None:
        """Add a waitable, such as an action server."""
        self._waitables.append(waitable)
        self._wake_executor()

    def remove_waitable(self, waitable: Waitable) -> None:
        """Remove a waitable."""
        self._waitables.remove(waitable)
        self._wake_executor()

    # ------------------------------------------------------------------ end

    def _destroy(self, items: list[Any], item: Any) -> bool:
        if item not in items:
            return False
        items.remove(item)
        for handler in getattr(item, "event_handlers", ()):
            self._waitables.remove(handler)
        try:
            item.destroy()
        except InvalidHandle:
            return False
        self._wake_executor()
        return True

    def destroy_publisher(self, publisher: Publisher) -> bool:
        """Destroy a publisher; return False if it is not one of this node."""
        return self._destroy(self._publishers, publisher)

    def destroy_subscription(self, subscription: Subscription) -> bool:
        """Destroy a subscription; return False if it is not one of this node."""
        return self._destroy(self._subscriptions, subscription)

    def destroy_timer(self, timer: Timer) -> bool:
        """Destroy a timer; return False if it is not one of this node."""
        return self._destroy(self._timers, timer)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        """Destroy a guard condition; return False if it is not one of this node."""
        return self._destroy(self._guards, guard)

    def destroy_rate(self, rate: Rate) -> bool:
        """Destroy a rate; return False if it is not one of this node."""
        success = self.destroy_timer(rate._timer)
        rate.destroy()
        return success

    def destroy_node(self) -> None:
        """Destroy the node and everything that it has created."""
        for items in (self._publishers, self._subscriptions, self._timers, self._guards):
            while items:
                self._destroy(items, items[0])
        while self._clients:
            self.destroy_client(self._clients[0])
        while self._services:
            self.destroy_service(self._services[0])
        self._handle.is_destroyed = True
        self._graph_node.close()
        self._wake_executor()

    def __enter__(self) -> Node:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy_node()


def _checked_profile(qos_or_depth: object) -> QoSProfile:
    if isinstance(qos_or_depth, QoSProfile):
        return qos_or_depth
    if isinstance(qos_or_depth, int):
        if qos_or_depth < 0:
            raise ValueError("history depth must be greater than or equal to zero")
        return QoSProfile(depth=qos_or_depth)
    raise TypeError(f"Expected QoSProfile or int, but received {type(qos_or_depth)!r}")
