"""Use a simulation with roslibpy; print one JSON object of what happened."""

from __future__ import annotations

import json
import sys
import threading

import roslibpy

TIMEOUT = 60


def main(port: int) -> dict[str, object]:
    """Return what a client of roslibpy has received."""
    ros = roslibpy.Ros("127.0.0.1", port)
    ros.run(timeout=TIMEOUT)
    found: dict[str, object] = {}

    scans: list[dict[str, object]] = []
    enough, moved = threading.Event(), threading.Event()
    speeds: list[float] = []

    def on_scan(message: dict[str, object]) -> None:
        scans.append(message)
        if len(scans) == 2:
            enough.set()

    def on_odometry(message: dict[str, dict[str, dict[str, dict[str, float]]]]) -> None:
        speeds.append(message["twist"]["twist"]["linear"]["x"])
        if speeds[-1] > 0.4:
            moved.set()

    scan = roslibpy.Topic(ros, "/scan", "sensor_msgs/LaserScan")
    scan.subscribe(on_scan)
    odometry = roslibpy.Topic(ros, "/odom", "nav_msgs/Odometry")
    odometry.subscribe(on_odometry)
    roslibpy.Topic(ros, "/cmd_vel", "geometry_msgs/Twist").publish(roslibpy.Message({"linear": {"x": 0.5}}))
    found["scans"], found["is_moved"] = enough.wait(TIMEOUT), moved.wait(TIMEOUT)
    found["ranges"] = scans[0]["ranges"]
    found["topic_type"] = ros.get_topic_type("/odom")
    found["topics"], found["nodes"] = ros.get_topics(), ros.get_nodes()
    found["parameters"] = ros.get_params()
    parameter = roslibpy.Param(ros, "/Counter:gain")
    parameter.set(1.5)
    found["gain"] = parameter.get()

    add = roslibpy.Service(ros, "/add", "example_interfaces/AddTwoInts")
    found["sum"] = add.call(roslibpy.ServiceRequest({"a": 2, "b": 3}), timeout=TIMEOUT)["sum"]
    try:
        add.call(roslibpy.ServiceRequest({"a": "two"}), timeout=TIMEOUT)
    except roslibpy.core.ServiceException as error:
        found["wrong"] = str(error)

    def answer(request: dict[str, bool], response: dict[str, object]) -> bool:
        response["message"] = f"got {request['data']}"
        response["success"] = True
        return True

    offered = roslibpy.Service(ros, "/of_script", "std_srvs/SetBool")
    offered.advertise(answer)
    caller = roslibpy.Ros("127.0.0.1", port)
    caller.run(timeout=TIMEOUT)
    for _ in range(100):
        if "/of_script" in caller.get_services():
            break
    service = roslibpy.Service(caller, "/of_script", "std_srvs/SetBool")
    found["own"] = dict(service.call(roslibpy.ServiceRequest({"data": True}), timeout=TIMEOUT))

    done = threading.Event()
    feedback: list[object] = []
    client = roslibpy.ActionClient(ros, "/count", "example_interfaces/Fibonacci")

    def end(name: str) -> object:
        def store(result: dict[str, object]) -> None:
            found[name] = {"status": int(result["status"].value), "values": result["values"]}
            done.set()

        return store

    client.send_goal(roslibpy.Goal({"order": 5}), end("goal"), feedback.append, end("failed"))
    done.wait(TIMEOUT)
    found["feedback"] = len(feedback)
    done.clear()
    goal = client.send_goal(roslibpy.Goal({"order": -1}), end("cancelled"), feedback.append, end("failed"))
    client.cancel_goal(goal)
    done.wait(TIMEOUT)
    done.clear()
    client.send_goal(roslibpy.Goal({"order": 99}), end("unused"), feedback.append, end("rejected"))
    done.wait(TIMEOUT)
    ros.terminate()
    return found


if __name__ == "__main__":
    print(json.dumps(main(int(sys.argv[1]))))  # noqa: T201 - the test reads it
