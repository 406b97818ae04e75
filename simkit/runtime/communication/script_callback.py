"""Functions of a script that answer something: a command input, a service, an action or a parameter."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from simkit.argument_checks import check_function
from simkit.errors import InputError, SimkitError, SubscriberError, callback_name
from simkit.in_process import InProcess

if TYPE_CHECKING:
    from simkit.runtime.communication.topic_bus import TopicBus


class ScriptCallback(InProcess):
    """Function of a script that simkit calls with a message, a goal or a value.

    A journal records the calls that the function makes into the simulation, and its result. A replay therefore needs no
    code of the script.

    Args:
        bus: topic bus with the journal.
        function: function of the script.
        kind: what the function answers, such as `service`.
        name: name of the topic, service, action or parameter.
        convert: conversion and check of the result; None if the result is not used.

    Raises:
        ArgumentTypeError: `function` is not a function.
    """

    __slots__ = ("__weakref__", "_bus", "_convert", "_kind", "_name", "function")

    def __init__(
        self,
        bus: TopicBus,
        function: Callable[[Any], object],
        kind: str,
        name: str,
        convert: Callable[[Any], object] | None = None,
    ) -> None:
        check_function(function, "callback")
        self._bus, self.function, self._kind, self._name, self._convert = bus, function, kind, name, convert

    def __call__(self, value: object) -> Any:
        """Call the function.

        Raises:
            SubscriberError: the function raised, or its result does not fit; the original exception is `__cause__`.
        """
        journal = self._bus.journal
        if journal is None:
            return self._result(value)
        with journal.called_back(self) as store_result:
            result = self._result(value)
            if store_result is not None and self._convert is not None:
                store_result(result)
            return result

    def _result(self, value: object) -> Any:
        try:
            result = self.function(value)
            return None if self._convert is None else self._convert(result)
        except Exception as error:
            if isinstance(error, SimkitError) and not isinstance(error, InputError):
                raise
            reason = str(error) if isinstance(error, InputError) else repr(error)
            now = self._bus.failures.now()
            raise SubscriberError(self._name, callback_name(self.function), now, reason, self._kind) from error
