"""Topics, services, actions and parameters of a simulation, as a script uses them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar, overload

from simkit.argument_checks import check_function
from simkit.msgs.message_types import F, M, R
from simkit.runtime.communication.parameter import Parameter, checked_parameter
from simkit.runtime.communication.script_callback import ScriptCallback

if TYPE_CHECKING:
    from simkit.deferred_response import DeferredResponse
    from simkit.msgs import Message
    from simkit.msgs.message_classes import ActionGoal, ServiceRequest
    from simkit.runtime.communication.action_server import Action, CancelCallback, EndCallback, GoalHandle
    from simkit.runtime.communication.communication import Communication
    from simkit.runtime.communication.publisher import Listener, Publisher
    from simkit.runtime.communication.service_server import CallEnd, Service, ServiceCall, ServiceHandler
    from simkit.runtime.communication.subscription import Callback, CallbackPolicy, Subscription
    from simkit.runtime.communication.transform_buffer import TransformBuffer
    from simkit.runtime.engine.engine import Engine

T = TypeVar("T", bound="bool | int | float | str | tuple[float, ...]")

SCRIPT_NODE = "/script"
"""Node of the parameters that a script declares without a node."""


class ScriptGraph:
    """Topics, services, actions and parameters: the base class of a simulation.

    Attributes:
        engine: physics, step loop, servos, random streams, plugin faults.
        communication: topics, services, actions and live parameters.
    """

    engine: Engine
    communication: Communication

    # ------------------------------------------------------------------ topics

    @overload
    def advertise(self, topic: str, type_name: type[M], latched: bool = False) -> Publisher[M]: ...

    @overload
    def advertise(self, topic: str, type_name: str, latched: bool = False) -> Publisher[Any]: ...

    def advertise(self, topic: str, type_name: str | type, latched: bool = False) -> Publisher[Any]:
        """Open a topic for publishing.

        Args:
            topic: name of the topic; a missing leading slash is added.
            type_name: ROS 2 type, such as `std_msgs/msg/String` or `msgs.String`.
            latched: send the last message to a later subscriber (transient local).

        Raises:
            MessageError: the type is unknown, or the topic has another type.
        """
        return self.communication.advertise(topic, type_name, latched=latched)

    @overload
    def listen(self, topic: str, types: type[M], callback: Callable[[M], object]) -> Listener: ...

    @overload
    def listen(self, topic: str, types: str | Sequence[str], callback: Callback) -> Listener: ...

    def listen(self, topic: str, types: str | type | Sequence[str], callback: Callback) -> Listener:
        """Open a topic for commands: `callback(message)` is called between two steps for each message.

        Use `subscribe` for messages that a sensor or a plugin publishes.

        Args:
            topic: name of the topic; a missing leading slash is added.
            types: accepted type or types, or the class of the messages.
            callback: function that receives each message.

        Raises:
            MessageError: a type is unknown, or the topic has another type.
        """
        return self.communication.listen(topic, types, callback)

    def publish(self, topic: str, message: Message) -> None:
        """Publish a message object, or a dict of its fields; command inputs receive it before the next step.

        A message object on an unknown topic opens the topic.

        Args:
            topic: name of the topic; a missing leading slash is added.
            message: message, or dict of its fields such as `{"linear": {"x": 0.2}}`; other fields are zero.

        Raises:
            MessageError: a dict is published on an unknown topic, or the message does not fit the topic's type.
        """
        self.engine.check_open()
        self.communication.publish(topic, message)

    @overload
    def subscribe(
        self,
        topic: str,
        callback: Callable[[M], object] | None = None,
        keep: int | None = None,
        on_error: CallbackPolicy = "stop",
        *,
        type: type[M],
    ) -> Subscription[M]: ...

    @overload
    def subscribe(
        self,
        topic: str,
        callback: Callback | None = None,
        keep: int | None = None,
        on_error: CallbackPolicy = "stop",
        *,
        type: str | None = None,
    ) -> Subscription[Any]: ...

    def subscribe(
        self,
        topic: str,
        callback: Callback | None = None,
        keep: int | None = None,
        on_error: CallbackPolicy = "stop",
        *,
        type: str | type | None = None,
    ) -> Subscription[Any]:
        """Receive a topic; its publisher may be opened later.

        Args:
            topic: name of the topic.
            callback: function that receives each message.
            keep: number of newest messages to keep; None for a million.
            on_error: policy for a callback that raises: "stop" ends the run with a SubscriberError, "drop" closes the
                subscription.
            type: class that the messages must have, such as `msgs.LaserScan`, or its type name; None for any. Type
                checkers then know the class of `latest` and `messages`.

        Raises:
            MessageError: the type is unknown, or the topic has another type. A publisher of another type that is opened
                later gets the same error.
        """
        return self.communication.subscribe(topic, callback, keep, on_error, type)

    def topics(self) -> dict[str, str]:
        """Return the ROS type names by topic, sorted; "" for a topic that only has subscriptions."""
        self.engine.check_open()
        bus = self.communication.bus
        return dict(sorted(({s.topic: "" for s in bus.subscriptions()} | bus.topics()).items()))

    @property
    def tf(self) -> TransformBuffer:
        """Poses of frames in other frames, from `/tf` and `/tf_static`; transforms are kept from the first use on."""
        self.engine.check_open()
        return self.communication.transforms.open()

    # ------------------------------------------------------------------ services

    @overload
    def call(self, service: str, request: ServiceRequest[M, R], timeout: float = 10.0, on_done: None = None) -> R: ...

    @overload
    def call(
        self,
        service: str,
        request: Mapping[str, object] | None = None,
        timeout: float = 10.0,
        on_done: None = None,
        *,
        type: type[ServiceRequest[M, R]],
    ) -> R: ...

    @overload
    def call(
        self,
        service: str,
        request: ServiceRequest[M, R],
        timeout: float = 10.0,
        *,
        on_done: Callable[[ServiceCall[R]], object],
    ) -> ServiceCall[R]: ...

    @overload
    def call(
        self,
        service: str,
        request: Mapping[str, object] | None = None,
        timeout: float = 10.0,
        *,
        on_done: Callable[[ServiceCall[R]], object],
        type: type[ServiceRequest[M, R]],
    ) -> ServiceCall[R]: ...

    @overload
    def call(
        self,
        service: str,
        request: Mapping[str, object] | None = None,
        timeout: float = 10.0,
        on_done: None = None,
        *,
        type: str | None = None,
    ) -> Any: ...

    @overload
    def call(
        self,
        service: str,
        request: Mapping[str, object] | None = None,
        timeout: float = 10.0,
        *,
        on_done: CallEnd,
        type: str | None = None,
    ) -> ServiceCall[Any]: ...

    def call(
        self,
        service: str,
        request: Message = None,
        timeout: float = 10.0,
        on_done: CallEnd | None = None,
        *,
        type: str | type | None = None,
    ) -> Any:
        """Send a request to a service and return the response.

        Args:
            service: name of the service; a missing leading slash is added.
            request: message, dict of its fields, or None for a message with default fields.
            timeout: longest wait for a service of another process [s], wall time.
            on_done: function that receives the call before the step after the response has arrived; its `response` is
                None if its `error` is not. With `on_done`, the method returns at once, with the `ServiceCall`.
            type: type that the service must have, or the class of its requests, such as `msgs.SetBool_Request`; None
                for any. Type checkers then know the class of the response, as for a request that is a message.

        Raises:
            ServiceError: no such service; the message suggests the closest name. Or: another process does not answer, a
                callback would wait for it (SK-SERVICE-011), or the service answers in a later step (SK-SERVICE-012).
            MessageError: the request does not fit the type, or the service has another one.
            PluginError: the service of a plugin raised.
            SubscriberError: the function of a script that answers raised.
        """
        return self.communication.services.call(service, request, timeout, on_done, type)

    @overload
    def offer(
        self,
        service: str,
        type_name: type[ServiceRequest[M, R]],
        handler: Callable[[M], R | Mapping[str, object] | DeferredResponse | None],
    ) -> Service: ...

    @overload
    def offer(self, service: str, type_name: str, handler: ServiceHandler) -> Service: ...

    def offer(self, service: str, type_name: str | type, handler: ServiceHandler) -> Service:
        """Open a service.

        Args:
            service: name of the service; a missing leading slash is added.
            type_name: service type, such as `std_srvs/srv/Trigger`, or the class of its requests:
                `msgs.Trigger_Request`.
            handler: function that receives a request and returns the response: a message, a dict of its fields, None
                for a message whose fields are all zero, or a `simkit.DeferredResponse` to answer in a later step.

        Raises:
            ServiceError: a service of that name exists.
            MessageError: the type is unknown.
        """
        return self.communication.services.offer(service, type_name, handler)

    # ------------------------------------------------------------------ actions

    @overload
    def act(
        self,
        action: str,
        type_name: type[ActionGoal[M, R, F]],
        callback: Callable[[GoalHandle[M]], R | Mapping[str, object] | None],
        on_cancel: Callable[[GoalHandle[M]], bool | None] | None = None,
    ) -> Action: ...

    @overload
    def act(
        self,
        action: str,
        type_name: str,
        callback: Callable[[GoalHandle], Message],
        on_cancel: CancelCallback | None = None,
    ) -> Action: ...

    def act(
        self,
        action: str,
        type_name: str | type,
        callback: Callable[[GoalHandle], Message],
        on_cancel: CancelCallback | None = None,
    ) -> Action:
        """Open an action.

        Args:
            action: name of the action; a missing leading slash is added.
            type_name: action type, such as `example_interfaces/action/Fibonacci`, or the class of its goals:
                `msgs.Fibonacci_Goal`.
            callback: function that receives each new goal between two steps. It may reject the goal, or return the
                result: a message or a dict of its fields. Otherwise the goal is active until its method `succeed`,
                `abort` or `canceled` is called.
            on_cancel: function that receives a goal that a client cancels; it returns False to continue the goal.
                Without a function, every goal continues.

        Raises:
            ActionError: an action of that name exists.
            MessageError: the type is unknown.
        """
        return self.communication.actions.act(action, type_name, callback, on_cancel)

    @overload
    def send_goal(
        self,
        action: str,
        goal: ActionGoal[M, R, F],
        on_feedback: Callable[[F], object] | None = None,
        on_done: Callable[[GoalHandle[M]], object] | None = None,
    ) -> GoalHandle[M]: ...

    @overload
    def send_goal(
        self,
        action: str,
        goal: Mapping[str, object] | None = None,
        on_feedback: Callable[[F], object] | None = None,
        on_done: Callable[[GoalHandle[M]], object] | None = None,
        *,
        type: type[ActionGoal[M, R, F]],
    ) -> GoalHandle[M]: ...

    @overload
    def send_goal(
        self,
        action: str,
        goal: Mapping[str, object] | None = None,
        on_feedback: Callback | None = None,
        on_done: EndCallback | None = None,
        *,
        type: str | None = None,
    ) -> GoalHandle[Any]: ...

    def send_goal(
        self,
        action: str,
        goal: Message = None,
        on_feedback: Callback | None = None,
        on_done: EndCallback | None = None,
        *,
        type: str | type | None = None,
    ) -> GoalHandle[Any]:
        """Send a goal; the plugin receives it before the next step.

        Args:
            action: name of the action.
            goal: message, dict of its fields, or None for a message with default fields.
            on_feedback: function that receives each feedback message.
            on_done: function that receives the handle after the end of the goal.
            type: type that the action must have, or the class of its goals, such as `msgs.Fibonacci_Goal`; None for
                any. Type checkers then know the classes of feedback and result, as for a goal that is a message.

        Raises:
            ActionError: no such action; the message suggests the closest name.
            MessageError: the goal does not fit the type, or the action has another one.
        """
        return self.communication.actions.send(action, goal, on_feedback, on_done, type_=type)

    # ------------------------------------------------------------------ parameters

    def declare(
        self,
        name: str,
        value: T,
        *,
        node: str = SCRIPT_NODE,
        minimum: float | None = None,
        maximum: float | None = None,
        choices: Sequence[object] = (),
        description: str = "",
        on_change: Callable[[T], object] | None = None,
    ) -> Parameter[T]:
        """Declare a live parameter: `.value` is always the current value.

        Args:
            name: name of the parameter, such as `p_gain`.
            value: first value. Later values have its type: bool, int, float, str or tuple of numbers.
            node: ROS node of the parameter; the six parameter services have its name in front.
            minimum: lower bound of the number, or of each number of a tuple.
            maximum: upper bound of the number, or of each number of a tuple.
            choices: allowed values; empty for no restriction.
            description: meaning of the parameter, with its unit.
            on_change: function that receives each new value between two steps. Resets and restores do not call it.

        Raises:
            ParameterError: the node has a parameter of that name, or the value is not allowed.
        """
        self.engine.check_open()
        if on_change is not None:
            check_function(on_change, "on_change")
        parameter = checked_parameter(
            node,
            name,
            value,
            minimum=minimum,
            maximum=maximum,
            choices=choices,
            description=description,
            on_change=None
            if on_change is None
            else ScriptCallback(self.communication.bus, on_change, "parameter", name),
        )
        self.communication.live_parameters.declare(self.communication.services, parameter)
        return parameter

    def set_parameter(self, node: str, name: str, value: object) -> None:
        """Set a live parameter.

        Args:
            node: node of the parameter, such as `/diff_drive`; `/script` for those of a script.
            name: name of the parameter.
            value: new value.

        Raises:
            ParameterError: the parameter is unknown, or the value is not allowed.
        """
        self.communication.set_parameter(node, name, value)
