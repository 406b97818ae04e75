"""Parameters of a node: the part of `rclpy.node.Node` that declares, sets and describes them."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

from simkit_nodes.interfaces import ROS2, interface_module
from simkit_nodes.ros_modules.rclpy.exceptions import (
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from simkit_nodes.ros_modules.rclpy.parameter import PARAMETER_SEPARATOR_STRING, Parameter, ParameterMsg, ParameterValue
from simkit_nodes.ros_modules.rclpy.validate_parameter_name import validate_parameter_name

if TYPE_CHECKING:
    from simkit_nodes.ros_modules.rclpy.clock import Clock

_messages: Any = interface_module("rcl_interfaces.msg", ROS2)
_SetResult: Any = _messages.SetParametersResult
_Descriptor: Any = _messages.ParameterDescriptor

PreSetCallback = Callable[[list[Parameter]], list[Parameter]]
OnSetCallback = Callable[[list[Parameter]], Any]
PostSetCallback = Callable[[list[Parameter]], None]

_TYPE_DESCRIPTION: Final = "start_type_description_service"
_NOT_SET: Final = Parameter.Type.NOT_SET
_EMPTY_LIST: Final = (
    "parameter list cannot be empty, this might be due to pre_set_parameters_callback modifying the original "
    "parameters list."
)


class NodeParameters:
    """Parameters of a node; a base class of `Node`.

    Errors have the texts of rclpy.
    """

    PARAM_REL_TOL = 1e-6
    _parameter_event_publisher: Any

    def _init_parameters(self, overrides: Mapping[str, Parameter], *, allow_undeclared: bool) -> None:
        """Begin without parameters.

        Args:
            overrides: values that replace those of declarations.
            allow_undeclared: True if parameters need no declaration.
        """
        self._parameters: dict[str, Parameter] = {}
        self._descriptors: dict[str, Any] = {}
        self._parameter_overrides = dict(overrides)
        self._allow_undeclared_parameters = allow_undeclared
        self._pre_set_parameters_callbacks: list[PreSetCallback] = []
        self._on_set_parameters_callbacks: list[OnSetCallback] = []
        self._post_set_parameters_callbacks: list[PostSetCallback] = []

    def _declare_overrides(self) -> None:
        """Declare all overrides as parameters (`automatically_declare_parameters_from_overrides`)."""
        declared = [(name, param.value, _Descriptor()) for name, param in self._parameter_overrides.items()]
        self.declare_parameters("", declared, ignore_override=True)

    def _declare_type_description(self) -> None:
        """Declare the parameter of the service `get_type_description`, which simkit does not offer."""
        if not self.has_parameter(_TYPE_DESCRIPTION):
            text = "If enabled, start the ~/get_type_description service."
            self.declare_parameter(_TYPE_DESCRIPTION, True, _Descriptor(description=text, read_only=True))

    def get_clock(self) -> Clock:
        """Return the clock of the node."""
        raise NotImplementedError

    def get_fully_qualified_name(self) -> str:
        """Return the name of the node with its namespace."""
        raise NotImplementedError

    # ------------------------------------------------------------------ declaration

    def declare_parameter(
        self, name: str, value: Any = None, descriptor: Any = None, ignore_override: bool = False
    ) -> Parameter:
        """Declare a parameter and return it.

        Args:
            name: name of the parameter.
            value: first value, or a `Parameter.Type`.
            descriptor: message `ParameterDescriptor`.
            ignore_override: True for the value of the program, whatever the command line says.

        Raises:
            ParameterAlreadyDeclaredException: the parameter is declared already.
            InvalidParameterException: the name is invalid.
            InvalidParameterTypeException, InvalidParameterValueException: the value is not accepted.
        """
        entry: tuple[Any, ...] = (name, value, _Descriptor() if descriptor is None else descriptor)
        if value is None and descriptor is None:
            entry = (name,)
        return self.declare_parameters("", [entry], ignore_override)[0]

    def declare_parameters(
        self, namespace: str, parameters: Sequence[tuple[Any, ...]], ignore_override: bool = False
    ) -> list[Parameter]:
        """Declare parameters and return them; see `declare_parameter`.

        Args:
            namespace: text in front of each name, with a dot between.
            parameters: name; name and value or type; or name, value and descriptor.
            ignore_override: True for the values of the program, whatever the command line says.
        """
        declared, descriptors = [], {}
        for index, entry in enumerate(parameters):
            parameter, descriptor = self._declaration(namespace, index, entry, ignore_override)
            declared.append(parameter)
            descriptors[parameter.name] = descriptor
        known = [parameter.name for parameter in declared if parameter.name in self._parameters]
        if known:
            raise ParameterAlreadyDeclaredException(known)
        for parameter in declared:
            result = self._set_all([parameter], descriptors, keeps_unset=True)
            if not result.successful:
                if result.reason.startswith("Wrong parameter type"):
                    expected = Parameter.Type(descriptors[parameter.name].type).name
                    raise InvalidParameterTypeException(parameter, expected)
                raise InvalidParameterValueException(parameter.name, parameter.value, result.reason)
        return [self._parameters[parameter.name] for parameter in declared]

    def _declaration(
        self, namespace: str, index: int, entry: tuple[Any, ...], ignore_override: bool
    ) -> tuple[Parameter, Any]:
        """Return the parameter and the descriptor of an entry of `declare_parameters`."""
        if not 1 <= len(entry) <= 3:
            text = f"Invalid parameter tuple length at index {index} in parameters list: {entry}; "
            raise TypeError(f"{text}expecting length between 1 and 3")
        name = entry[0]
        if not isinstance(name, str):
            raise TypeError(f"First element {name} at index {index} in parameters list is not a str.")
        name = f"{namespace}.{name}" if namespace else name
        validate_parameter_name(name)
        value = entry[1] if len(entry) > 1 else None
        descriptor = entry[2] if len(entry) > 2 else _Descriptor()
        if not isinstance(descriptor, _Descriptor):
            raise TypeError(
                f"Third element {descriptor} at index {index} in parameters list is not a ParameterDescriptor."
            )
        if len(entry) == 1:
            warnings.warn(_NAME_ONLY.format(name=name), stacklevel=4)
            descriptor.dynamic_typing = True
        if isinstance(value, Parameter.Type):
            if value is _NOT_SET:
                raise ValueError(f"Cannot declare parameter {{{name}}} as statically typed of type NOT_SET")
            if descriptor.dynamic_typing is True:
                raise ValueError(
                    f"When declaring parameter {{{name}}} passing a descriptor with"
                    "`dynamic_typing=True` is not allowed when the parameter type is provided"
                )
            descriptor.type, value = value.value, None
        elif not descriptor.dynamic_typing:
            if isinstance(value, ParameterValue):
                descriptor.type = value.type
            else:
                descriptor.type = Parameter.Type.from_parameter_value(value).value
            if descriptor.type == _NOT_SET.value:
                raise ValueError(
                    "Cannot declare a statically typed parameter with default value of type PARAMETER_NOT_SET"
                )
        if not ignore_override and name in self._parameter_overrides:
            value = self._parameter_overrides[name].value
        return Parameter(name, value=value), descriptor

    def undeclare_parameter(self, name: str) -> None:
        """Remove a parameter.

        Raises:
            ParameterNotDeclaredException: the parameter is not declared.
            ParameterImmutableException: the parameter is read-only.
        """
        if not self.has_parameter(name):
            raise ParameterNotDeclaredException(name)
        if self._descriptors[name].read_only:
            raise ParameterImmutableException(name)
        del self._parameters[name], self._descriptors[name]

    # ------------------------------------------------------------------ values

    def has_parameter(self, name: str) -> bool:
        """Check whether a parameter is declared."""
        return name in self._parameters

    def get_parameter_types(self, names: Sequence[str]) -> list[Any]:
        """Return the types of parameters; see `get_parameter_type`."""
        _check_names(names)
        return [self.get_parameter_type(name) for name in names]

    def get_parameter_type(self, name: str) -> Any:
        """Return the number of a parameter's type.

        Raises:
            ParameterNotDeclaredException: the parameter is not declared.
        """
        if name in self._parameters:
            return self._parameters[name].type_.value
        if self._allow_undeclared_parameters:
            return _NOT_SET
        raise ParameterNotDeclaredException(name)

    def get_parameters(self, names: Sequence[str]) -> list[Parameter]:
        """Return parameters; see `get_parameter`."""
        _check_names(names)
        return [self.get_parameter(name) for name in names]

    def get_parameter(self, name: str) -> Parameter:
        """Return a parameter.

        Raises:
            ParameterNotDeclaredException: the parameter is not declared.
            ParameterUninitializedException: the parameter was declared with a type only, and has no value.
        """
        parameter = self._parameters.get(name)
        if parameter is not None:
            if parameter.type_ is _NOT_SET and not self._descriptors[name].dynamic_typing:
                raise ParameterUninitializedException(name)
            return parameter
        if self._allow_undeclared_parameters:
            return Parameter(name, _NOT_SET, None)
        raise ParameterNotDeclaredException(name)

    def get_parameter_or(self, name: str, alternative_value: Parameter | None = None) -> Parameter:
        """Return a parameter, or the alternative if the parameter has no value."""
        parameter = self._parameters.get(name)
        if parameter is None or parameter.type_ is _NOT_SET:
            return Parameter(name, _NOT_SET) if alternative_value is None else alternative_value
        return parameter

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """Return the parameters below a prefix, by the rest of their names."""
        start = prefix + PARAMETER_SEPARATOR_STRING if prefix else ""
        return {name[len(start) :]: value for name, value in self._parameters.items() if name.startswith(start)}

    def set_parameters(self, parameter_list: Sequence[Parameter]) -> list[Any]:
        """Set parameters one after another and return their messages `SetParametersResult`.

        Raises:
            ParameterNotDeclaredException: a parameter is not declared; earlier ones of the list are set.
        """
        return [self.set_parameters_atomically([parameter]) for parameter in parameter_list]

    def set_parameters_atomically(self, parameter_list: Sequence[Parameter]) -> Any:
        """Set all parameters or none and return the message `SetParametersResult`.

        Raises:
            ParameterNotDeclaredException: a parameter is not declared.
        """
        parameters = list(parameter_list)
        if self._pre_set_parameters_callbacks:
            parameters = [p for callback in self._pre_set_parameters_callbacks for p in callback(parameters)]
            if not parameters:
                return _SetResult(successful=False, reason=_EMPTY_LIST)
        if not all(isinstance(parameter, Parameter) for parameter in parameters):
            raise TypeError(f"parameter must be instance of type '{Parameter!r}'")
        unknown = [parameter.name for parameter in parameters if parameter.name not in self._parameters]
        if unknown and not self._allow_undeclared_parameters:
            raise ParameterNotDeclaredException(unknown[1:])  # rclpy, too, has consumed the first name
        return self._set_all(parameters)

    def _set_all(
        self, parameters: list[Parameter], descriptors: Mapping[str, Any] | None = None, *, keeps_unset: bool = False
    ) -> Any:
        """Set all parameters or none, call the callbacks and publish the event.

        Args:
            parameters: parameters.
            descriptors: new descriptors by name; None for those of the declarations.
            keeps_unset: False if a parameter without a value is removed.
        """
        for parameter in parameters:
            descriptor = (self._descriptors if descriptors is None else descriptors).get(parameter.name)
            if descriptor is not None:
                result = self._checked(parameter, descriptor, checks_read_only=descriptors is None)
                if not result.successful:
                    return result
        for callback in tuple(self._on_set_parameters_callbacks):
            result = callback(parameters)
            if not result.successful:
                return result
        event = _messages.ParameterEvent(node=self.get_fully_qualified_name())
        for parameter in parameters:
            name = parameter.name
            if parameter.type_ is _NOT_SET and not keeps_unset:
                event.deleted_parameters.append(parameter.to_parameter_msg())
                self._parameters.pop(name, None)
                self._descriptors.pop(name, None)
                continue
            if descriptors is not None:
                self._descriptors[name] = descriptors[name]
            elif name not in self._descriptors:
                self._descriptors[name] = _Descriptor(dynamic_typing=True)
            is_new = self.get_parameter_or(name).type_ is _NOT_SET
            (event.new_parameters if is_new else event.changed_parameters).append(parameter.to_parameter_msg())
            self._parameters[name] = parameter
        event.stamp = self.get_clock().now().to_msg()
        self._parameter_event_publisher.publish(event)
        for after in tuple(self._post_set_parameters_callbacks):
            after(parameters)
        return _SetResult(successful=True)

    def list_parameters(self, prefixes: list[str], depth: int) -> Any:
        """Return the message `ListParametersResult` with the names below any of the prefixes.

        Args:
            prefixes: texts before the first dots; empty for all parameters.
            depth: largest number of levels below the prefix; 0 for any number.
        """
        if not isinstance(prefixes, list):
            raise TypeError("The prefixes argument must be a list")
        if not all(isinstance(prefix, str) for prefix in prefixes):
            raise TypeError("All prefixes must be instances of type str")
        if not isinstance(depth, int):
            raise TypeError("The depth must be instance of type int")
        if depth < 0:
            raise ValueError("The depth must be greater than or equal to zero")
        result = _messages.ListParametersResult()
        for name in self._parameters:
            if not _is_listed(name, prefixes, depth):
                continue
            result.names.append(name)
            prefix = name.rpartition(PARAMETER_SEPARATOR_STRING)[0]
            if prefix and prefix not in result.prefixes:
                result.prefixes.append(prefix)
        return result

    # ------------------------------------------------------------------ callbacks

    def add_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Add a callback that receives a list of parameters before it is set, and returns the list to set."""
        self._pre_set_parameters_callbacks.insert(0, callback)

    def add_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Add a callback that accepts or refuses a list of parameters with a message `SetParametersResult`."""
        self._on_set_parameters_callbacks.insert(0, callback)

    def add_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Add a callback that receives a list of parameters after it was set."""
        self._post_set_parameters_callbacks.insert(0, callback)

    def remove_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Remove a callback; ValueError if it was not added."""
        self._pre_set_parameters_callbacks.remove(callback)

    def remove_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Remove a callback; ValueError if it was not added."""
        self._on_set_parameters_callbacks.remove(callback)

    def remove_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Remove a callback; ValueError if it was not added."""
        self._post_set_parameters_callbacks.remove(callback)

    # ------------------------------------------------------------------ descriptors

    def describe_parameter(self, name: str) -> Any:
        """Return the message `ParameterDescriptor` of a parameter.

        Raises:
            ParameterNotDeclaredException: the parameter is not declared.
        """
        if name in self._descriptors:
            return self._descriptors[name]
        if self._allow_undeclared_parameters:
            return _Descriptor()
        raise ParameterNotDeclaredException(name)

    def describe_parameters(self, names: Sequence[str]) -> list[Any]:
        """Return the messages `ParameterDescriptor` of parameters; see `describe_parameter`."""
        return [self.describe_parameter(name) for name in names]

    def set_descriptor(self, name: str, descriptor: Any, alternative_value: Any = None) -> Any:
        """Replace the descriptor of a parameter and return the message `ParameterValue` that the parameter then has.

        Args:
            name: name of the parameter.
            descriptor: message `ParameterDescriptor`.
            alternative_value: message `ParameterValue` for a present value that the descriptor does not allow.

        Raises:
            ParameterNotDeclaredException: the parameter is not declared.
            ParameterImmutableException: the parameter is read-only.
            InvalidParameterValueException: the descriptor allows neither value.
        """
        if not self.has_parameter(name):
            if not self._allow_undeclared_parameters:
                raise ParameterNotDeclaredException(name)
            return self.get_parameter(name).get_parameter_value()
        if self.describe_parameter(name).read_only:
            raise ParameterImmutableException(name)
        present = self.get_parameter(name)
        other = present
        if alternative_value is not None:
            other = Parameter.from_parameter_msg(ParameterMsg(name=name, value=alternative_value))
        if self._checked(present, descriptor, checks_read_only=False).successful:
            self._parameters[name] = present
        else:
            result = self._checked(other, descriptor, checks_read_only=False)
            if not result.successful:
                raise InvalidParameterValueException(name, other.value, result.reason)
            self._parameters[name] = other
        self._descriptors[name] = descriptor
        return self.get_parameter(name).get_parameter_value()

    def _checked(self, parameter: Parameter, descriptor: Any, *, checks_read_only: bool) -> Any:
        """Check a parameter against a descriptor, which receives the name and the type of a dynamic parameter."""
        descriptor.name = parameter.name
        reason = ""
        if checks_read_only and descriptor.read_only:
            reason = f"Trying to set a read-only parameter: {parameter.name}."
        elif descriptor.dynamic_typing:
            descriptor.type = parameter.type_.value
        elif parameter.type_ is _NOT_SET:
            reason = "Static parameter cannot be undeclared" if self.has_parameter(parameter.name) else ""
        elif parameter.type_.value != descriptor.type:
            expected = Parameter.Type(descriptor.type)
            reason = f"Wrong parameter type, expected '{expected}' got '{parameter.type_}'"
        if not reason and parameter.type_ is Parameter.Type.INTEGER and descriptor.integer_range:
            reason = _integer_problem(parameter, descriptor.integer_range[0])
        if not reason and parameter.type_ is Parameter.Type.DOUBLE and descriptor.floating_point_range:
            reason = _double_problem(parameter, descriptor.floating_point_range[0], self.PARAM_REL_TOL)
        return _SetResult(successful=not reason, reason=reason)


_NAME_ONLY: Final = (
    "when declaring parameter named '{name}', declaring a parameter only providing its name is deprecated. "
    'You have to either:\n\t- Pass a name and a default value different to "PARAMETER NOT SET"'
    " (and optionally a descriptor).\n\t- Pass a name and a parameter type.\n"
    "\t- Pass a name and a descriptor with `dynamic_typing=True"
)


def _check_names(names: Sequence[str]) -> None:
    if not all(isinstance(name, str) for name in names):
        raise TypeError("All names must be instances of type str")


def _is_listed(name: str, prefixes: Sequence[str], depth: int) -> bool:
    """Check whether `list_parameters` returns a name; a depth of 0 stands for any number of levels."""
    if not prefixes:
        return not depth or name.count(PARAMETER_SEPARATOR_STRING) < depth
    for prefix in prefixes:
        rest = name.removeprefix(prefix + PARAMETER_SEPARATOR_STRING)
        if name == prefix or (rest != name and (not depth or rest.count(PARAMETER_SEPARATOR_STRING) < depth)):
            return True
    return False


def _integer_problem(parameter: Parameter, limits: Any) -> str:
    """Return why an integer is not in a range, or not on a step from its lower limit; empty if it is."""
    name, value = parameter.name, parameter.value
    low, high = sorted((limits.from_value, limits.to_value))
    if value in (low, high):
        return ""
    if not low < value < high:
        return f"Parameter {name} out of range. Min: {low}, Max: {high}, value: {value}"
    if limits.step and (value - low) % limits.step:
        text = f"Min: {low}, max: {high}, value: {value}, step: {limits.step}"
        return f"The parameter value for {name} is not a valid step. {text}"
    return ""


def _double_problem(parameter: Parameter, limits: Any, tolerance: float) -> str:
    """Return why a double is not in a range, or not near a step from its lower limit; empty if it is."""
    name, value = parameter.name, parameter.value
    low, high = sorted((limits.from_value, limits.to_value))
    if math.isclose(value, low, rel_tol=tolerance) or math.isclose(value, high, rel_tol=tolerance):
        return ""
    if not low < value < high:
        return f"Parameter {name} out of range Min: {low}, Max: {high}, value: {value}"
    if limits.step:
        nearest = low + round((value - low) / limits.step) * limits.step
        if not math.isclose(nearest, value, rel_tol=tolerance):
            text = f"Min: {low}, max: {high}, value: {value}, step: {limits.step}"
            return f"The parameter value for {name} is not close enough to a valid step. {text}"
    return ""
