"""Declared, undeclared and read-only parameters, their types, ranges and callbacks, with the texts of errors."""

import array
import json
import warnings

import rclpy
from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    ParameterType,
    SetParametersResult,
)
from rclpy.exceptions import ParameterException
from rclpy.parameter import Parameter, get_parameter_value, parameter_value_to_python


def error_of(function, *arguments, **keywords):
    try:
        return type(function(*arguments, **keywords)).__name__
    except Exception as error:
        return f"{type(error).__name__}: {error}".replace("simkit_nodes.ros_modules.", "")


def shown(parameter):
    value = parameter.value
    return [parameter.name, parameter.type_.name, list(value) if isinstance(value, (array.array, tuple)) else value]


def declared(node):
    values = [True, 3, 0.5, "text", [True, False], [1, 2], [0.5, 1.5], ["a", "b"], [b"x", b"y"], (1, 2)]
    values.append(array.array("d", [1.0]))
    return [shown(node.declare_parameter(f"p{index}", value))[1] for index, value in enumerate(values)]


def declaration_errors(node):
    node.declare_parameter("once", 1)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        node.declare_parameter("name_only")
    return {
        "again": error_of(node.declare_parameter, "once", 2),
        "empty name": error_of(node.declare_parameter, "", 1),
        "mixed list": error_of(node.declare_parameter, "mixed", [1, "a"]),
        "dict": error_of(node.declare_parameter, "dict", {"a": 1}),
        "descriptor only": error_of(node.declare_parameter, "nothing", None, ParameterDescriptor()),
        "not set": error_of(node.declare_parameter, "not_set", Parameter.Type.NOT_SET),
        "typed and dynamic": error_of(
            node.declare_parameter, "both", Parameter.Type.INTEGER, ParameterDescriptor(dynamic_typing=True)
        ),
        "tuple": error_of(node.declare_parameters, "", [("a", 1, ParameterDescriptor(), 5)]),
        "number as name": error_of(node.declare_parameters, "", [(5, 1)]),
        "no descriptor": error_of(node.declare_parameters, "", [("b", 1, "fast")]),
        "warning": [str(warning.message) for warning in caught if "name_only" in str(warning.message)],
        "namespace": [p.name for p in node.declare_parameters("robot", [("x", 1), ("y", 2.0, ParameterDescriptor())])],
    }


def values(node):
    node.declare_parameter("speed", 1.0)
    node.declare_parameter("typed", Parameter.Type.INTEGER)
    node.declare_parameter("free", 1, ParameterDescriptor(dynamic_typing=True))
    node.declare_parameter("fixed", 1, ParameterDescriptor(read_only=True))
    set_all = lambda *parameters: [[r.successful, r.reason] for r in node.set_parameters(parameters)]
    set_one = lambda name, value: set_all(Parameter(name, value=value))
    return {
        "unknown": error_of(node.get_parameter, "unknown"),
        "unknown type": error_of(node.get_parameter_type, "unknown"),
        "unknown to describe": error_of(node.describe_parameter, "unknown"),
        "without value": error_of(node.get_parameter, "typed"),
        "or": [
            p.value for p in (node.get_parameter_or("unknown"), node.get_parameter_or("typed", Parameter("t", value=7)))
        ],
        "set": [*set_one("speed", 2.0), node.get_parameter("speed").value],
        "wrong type": set_one("speed", 2),
        "free": [*set_one("free", "text"), node.get_parameter("free").value],
        "read-only": set_one("fixed", 2),
        "unset": [[r.successful, r.reason] for r in node.set_parameters([Parameter("speed")])],
        "undeclared": error_of(set_one, "unknown", 1),
        "no parameter": error_of(node.set_parameters, ["speed"]),
        "names": error_of(node.get_parameters, [1]),
        "undeclare": [error_of(node.undeclare_parameter, name) for name in ("free", "free", "fixed")],
        "has": [node.has_parameter(name) for name in ("speed", "free")],
        "atomic": [
            node.set_parameters_atomically([Parameter("speed", value=5.0), Parameter("fixed", value=5)]).successful,
            node.get_parameter("speed").value,
        ],
    }


def ranges(node):
    whole = ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=10, step=3)])
    real = ParameterDescriptor(floating_point_range=[FloatingPointRange(from_value=-1.0, to_value=1.0, step=0.25)])
    node.declare_parameter("whole", 3, whole)
    node.declare_parameter("real", 0.5, real)
    set_one = lambda name, value: node.set_parameters([Parameter(name, value=value)])[0].reason
    return {
        "whole": [set_one("whole", value) for value in (0, 6, 10, 4, 11, -1)],
        "real": [set_one("real", value) for value in (-1.0, 0.25, 1.0, 0.3, 1.5)],
        "at declaration": error_of(node.declare_parameter, "late", 5, whole),
        "wrong type at declaration": error_of(
            node.declare_parameter, "other", "text", ParameterDescriptor(type=ParameterType.PARAMETER_INTEGER)
        ),
        "alternative": parameter_value_to_python(
            node.set_descriptor(
                "whole",
                ParameterDescriptor(type=2, integer_range=[IntegerRange(from_value=20, to_value=30)]),
                Parameter("", value=25).get_parameter_value(),
            )
        ),
    }


def callbacks(node):
    calls = []

    def on_set(parameters):
        calls.append(["on", [shown(p) for p in parameters]])
        return SetParametersResult(successful=parameters[0].value != 13, reason="unlucky")

    def before(parameters):
        calls.append(["pre", [shown(p) for p in parameters]])
        return [] if parameters[0].value == 0 else [*parameters, Parameter("second", value=1)]

    node.declare_parameter("first", 1)
    node.declare_parameter("second", 0)
    node.add_pre_set_parameters_callback(before)
    node.add_on_set_parameters_callback(on_set)
    node.add_on_set_parameters_callback(lambda p: calls.append("newest first") or SetParametersResult(successful=True))
    node.add_post_set_parameters_callback(lambda parameters: calls.append(["post", [shown(p) for p in parameters]]))
    results = [node.set_parameters([Parameter("first", value=value)])[0] for value in (2, 13, 0)]
    rejected = error_of(node.declare_parameter, "third", 13)
    node.remove_on_set_parameters_callback(on_set)
    node.remove_pre_set_parameters_callback(before)
    node.set_parameters([Parameter("first", value=13)])
    removed = error_of(node.remove_on_set_parameters_callback, on_set)
    return [calls, [[r.successful, r.reason] for r in results], rejected, removed]


def lists(node):
    for name in ("a", "b.c", "b.d", "b.e.f", "g.h"):
        node.declare_parameter(name, 1)
    both = lambda result: [list(result.names), list(result.prefixes)]
    ask = lambda prefixes, depth: both(node.list_parameters(prefixes, depth))
    return {
        "all": ask([], 0),
        "one level": ask([], 1),
        "below b": ask(["b"], 0),
        "one level below b": ask(["b"], 1),
        "errors": [error_of(node.list_parameters, *arguments) for arguments in (("b", 0), ([1], 0), (["b"], -1))],
        "by prefix": {name: value.value for name, value in node.get_parameters_by_prefix("b").items()},
    }


def overrides():
    rules = ["a:=1", "b:=1.5", "c:=text", "d:=true", "e:='1'", "f:=[1, 2]", "g:=1e3", "h:=yes", "i:=0x10", "j:=[a, b]"]
    rules += ["k:=.inf", "n.o:=7", "nodes:l:=9", "other:l:=8"]
    words = ["--ros-args", *(word for rule in rules for word in ("-p", rule))]
    node = rclpy.create_node("nodes", cli_args=words, automatically_declare_parameters_from_overrides=True)
    declared = sorted([shown(p) for p in node.get_parameters_by_prefix("").values() if p.name in "abcdefghijkln.o"])
    node.destroy_node()
    node = rclpy.create_node("late", cli_args=words, parameter_overrides=[Parameter("z", value=4)])
    found = {
        "declared": shown(node.declare_parameter("a", 5)),
        "ignored": shown(node.declare_parameter("b", 5.0, ignore_override=True)),
        "wrong type": error_of(node.declare_parameter, "c", 5),
        "of the constructor": shown(node.declare_parameter("z", 1)),
        "typed": shown(node.declare_parameter("g", Parameter.Type.DOUBLE)),
        "not declared": error_of(node.get_parameter, "d"),
    }
    node.destroy_node()
    return {"automatic": [row for row in declared if row[2] != float("inf")], "count": len(declared), **found}


def undeclared():
    node = rclpy.create_node("free", allow_undeclared_parameters=True)
    found = [shown(node.get_parameter("x")), node.get_parameter_type("x").name]
    node.set_parameters([Parameter("x", value=1)])
    found += [shown(node.get_parameter("x")), node.describe_parameter("x").dynamic_typing]
    node.set_parameters([Parameter("x", value="text")])
    found += [shown(node.get_parameter("x"))]
    node.set_parameters([Parameter("x")])
    found += [node.has_parameter("x")]
    node.destroy_node()
    return found


def objects():
    values = (None, True, 1, 1.0, "a", [], [1], [1.0], ["a"], [True])
    again = lambda value: shown(Parameter.from_parameter_msg(Parameter("x", value=value).to_parameter_msg()))
    texts = ("1", "1.5", "a", "[1, 2]", "true", "[1, a]", "")
    return {
        "type and value": error_of(Parameter, "x", Parameter.Type.INTEGER, 1.5),
        "no type": error_of(Parameter, "x", "INTEGER", 1),
        "kinds": [Parameter("x", value=value).type_.name for value in values],
        "messages": [str(Parameter("x", value=value).get_parameter_value()) for value in (1, 0.5, "a", [1, 2])],
        "round trip": [again(value) for value in (1, "a", [0.5])],
        "guessed": [parameter_value_to_python(get_parameter_value(text)) for text in texts],
        "base": issubclass(ParameterException, Exception),
    }


def main():
    rclpy.init()
    found = {}
    for function in (declared, declaration_errors, values, ranges, callbacks, lists):
        node = rclpy.create_node(function.__name__)
        found[function.__name__] = function(node)
        node.destroy_node()
    found |= {"overrides": overrides(), "undeclared": undeclared(), "objects": objects()}
    print(json.dumps(found, indent=1))
    rclpy.shutdown()


if __name__ == "__main__":
    main()
