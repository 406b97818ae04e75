"""States of tasks that programs publish with `diagnostic_updater`."""

from __future__ import annotations

from collections.abc import Callable

Run = Callable[..., list[str]]

START = """
    import rclpy
    from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
    from diagnostic_updater import *

    rclpy.init()
    node = rclpy.create_node("driver")
    updater = Updater(node, 0.5)
    updater.setHardwareID("none")

    def report(array):
        for status in array.status:
            values = [value.value for value in status.values][:1]
            text = f"{status.name} {status.level[0]} {status.message} {status.hardware_id} {values}"
            node.get_logger().info(text)
"""
SPIN = """
    node.create_subscription(DiagnosticArray, "/diagnostics", report, 10)
    rclpy.spin(node)
"""


def test_the_state_of_each_task_is_published_in_each_period(run_program: Run) -> None:
    lines = run_program(
        START
        + """
    def temperature(status):
        status.summary(DiagnosticStatus.WARN, "hot")
        status.add("celsius", "40")
        return status

    updater.add("temperature", temperature)
    updater.add(Heartbeat())
    updater.add("gone", temperature)
    updater.removeByName("gone")
"""
        + SPIN,
        duration=0.9,
    )
    assert lines == ["driver: temperature 1 hot none ['40']", "driver: Heartbeat 0 Alive none []"]


def test_the_summaries_of_several_tasks_are_merged_with_the_worst_level(run_program: Run) -> None:
    lines = run_program(
        START
        + """
    def task(level, text):
        return FunctionDiagnosticTask(text, lambda status: (status.summary(level, text), status)[1])

    both = CompositeDiagnosticTask("both")
    for level, text in ((DiagnosticStatus.OK, "fine"), (DiagnosticStatus.WARN, "hot"), (DiagnosticStatus.ERROR, "off")):
        both.addTask(task(level, text))
    updater.add(both)
"""
        + SPIN,
        duration=0.9,
    )
    assert lines == ["driver: both 2 hot; off none []"]


def test_a_publisher_reports_its_frequency(run_program: Run) -> None:
    lines = run_program(
        START
        + """
    from sensor_msgs.msg import Imu

    bounds = {"min": 10, "max": 10}
    publisher = DiagnosedPublisher(
        node.create_publisher(Imu, "imu", 1), updater, FrequencyStatusParam(bounds), TimeStampStatusParam()
    )

    def publish():
        message = Imu()
        message.header.stamp = node.get_clock().now().to_msg()
        publisher.publish(message)

    timer = node.create_timer(0.1, publish)
    node.create_timer(1.2, timer.cancel)
"""
        + SPIN,
        duration=4.2,
    )
    assert lines[0] == "driver: /imu topic status 1 Frequency too low. none ['4']", "four messages in 0.5 s"
    assert lines[1] == "driver: /imu topic status 0 Desired frequency met; Timestamps are reasonable. none ['9']"
    assert lines[-1] == "driver: /imu topic status 2 No events recorded.; No data since last update. none ['0']"
