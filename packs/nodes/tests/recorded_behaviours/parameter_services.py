"""Services and events of parameters, as another node uses them."""

import json

import rclpy
from rcl_interfaces.msg import ParameterDescriptor
from rcl_interfaces.srv import SetParameters
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.parameter_event_handler import ParameterEventHandler


def main():
    rclpy.init()
    server, node = rclpy.create_node("server", namespace="/robot"), rclpy.create_node("asking")
    executor = SingleThreadedExecutor()
    executor.add_node(server)
    executor.add_node(node)
    server.declare_parameters("", [("speed", 1.5), ("gain.p", 2), ("gain.i", [1.0, 2.0]), ("name", "cart")])
    server.declare_parameter("fixed", True, ParameterDescriptor(read_only=True, description="fixed value"))
    server.declare_parameter("free", "a", ParameterDescriptor(dynamic_typing=True))
    client = AsyncParameterClient(node, "/robot/server")

    def answer(future):
        executor.spin_until_future_complete(future, timeout_sec=10.0)
        return future.result()

    def read(*names):
        return [parameter_value_to_python(value) for value in answer(client.get_parameters(list(names))).values]

    events = []
    handler = ParameterEventHandler(node)
    handler.add_parameter_callback("speed", "/robot/server", lambda p: events.append(["speed", p.value.double_value]))

    def on_event(event):
        if event.node == "/robot/server":
            kinds = (event.new_parameters, event.changed_parameters, event.deleted_parameters)
            events.append([[p.name for p in parameters] for parameters in kinds])

    handle = handler.add_parameter_event_callback(on_event)
    found = {"ready": client.wait_for_services(timeout_sec=10.0)}
    while not server.count_subscribers("/parameter_events") or not node.count_publishers("/parameter_events"):
        executor.spin_once(timeout_sec=0.1)
    executor.spin_once(timeout_sec=0.5)
    found["names"] = [name for name in answer(client.list_parameters()).result.names if name != "use_sim_time"]
    found["below gain"] = list(answer(client.list_parameters(["gain"], 1)).result.names)
    found["values"] = read("speed", "gain.p", "gain.i", "name", "fixed")
    found["one unknown"] = read("speed", "unknown")
    found["types"] = list(answer(client.get_parameter_types(["speed", "gain.i", "name"])).types)
    described = answer(client.describe_parameters(["fixed", "speed"])).descriptors
    found["descriptors"] = [[d.name, d.type, d.read_only, d.description] for d in described]
    found["unknown descriptor"] = len(answer(client.describe_parameters(["unknown"])).descriptors)
    changes = [Parameter("speed", value=3.0), Parameter("fixed", value=False), Parameter("unknown", value=1)]
    changes += [Parameter("gain.p", value=0.5).to_parameter_msg()]
    found["set"] = [[r.successful, r.reason] for r in answer(client.set_parameters(changes)).results]
    result = answer(
        client.set_parameters_atomically([Parameter("speed", value=4.0), Parameter("name", value=1)])
    ).result
    found["atomically"] = [result.successful, result.reason]
    found["after"] = read("speed", "name")
    found["deleted"] = [[r.successful, r.reason] for r in answer(client.delete_parameters(["free", "speed"])).results]
    executor.spin_once(timeout_sec=0.5)
    executor.spin_once(timeout_sec=0.5)
    handler.remove_parameter_event_callback(handle)
    found["events"] = events
    services = node.get_service_names_and_types_by_node("server", "/robot")
    found["services"] = [name for name, _ in services if "parameter" in name]
    found["clients"] = len(node.get_client_names_and_types_by_node("asking", "/"))
    name = "/robot/server/get_parameters"
    found["counts"] = [node.count_services(name), node.count_clients(name)]
    setter = node.create_client(SetParameters, "/robot/server/set_parameters")
    setter.wait_for_service(timeout_sec=5.0)
    empty = answer(setter.call_async(SetParameters.Request()))
    found["no parameters"] = len(empty.results)
    print(json.dumps(found, indent=1))
    rclpy.shutdown()


if __name__ == "__main__":
    main()
