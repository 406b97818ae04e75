"""Reports about the health of nodes of ROS 1: `diagnostic_updater`."""

from __future__ import annotations

from typing import Any

TEXT = """
    import diagnostic_updater, rospy
    from diagnostic_updater import FrequencyStatusParam, HeaderlessTopicDiagnostic
    rospy.init_node("driver")
    updater = diagnostic_updater.Updater()
    updater.setHardwareID("motor 1")
    def temperature(stat):
        stat.summary(1, "hot")
        stat.add("degrees", 80)
        return stat
    updater.add("temperature", temperature)
    both = diagnostic_updater.CompositeDiagnosticTask("both")
    both.addTask(diagnostic_updater.Heartbeat())
    both.addTask(diagnostic_updater.FunctionDiagnosticTask("t", temperature))
    updater.add(both)
    topic = HeaderlessTopicDiagnostic("scan", updater, FrequencyStatusParam({"min": 5.0, "max": 20.0}))
    rate = rospy.Rate(10)
    while not rospy.is_shutdown():
        topic.tick()
        updater.update()
        rate.sleep()
    """


def test_a_program_publishes_the_results_of_its_tasks_once_a_second(sim: Any, add: Any) -> None:
    node = add(TEXT)
    heard = sim.subscribe("/diagnostics")
    sim.run(2.55)
    assert node.error is None, "\n".join(node.log)
    reports = [message for message in heard.messages if message.status[0].hardware_id]
    assert len(reports) == 2
    statuses = reports[-1].status
    assert [(value.key, value.value) for value in statuses[0].values] == [("degrees", "80")]
    assert [(status.name, int(status.level), status.message, status.hardware_id) for status in statuses] == [
        ("driver: temperature", 1, "hot", "motor 1"),
        ("driver: both", 1, "hot", "motor 1"),
        ("driver: scan topic status", 0, "Desired frequency met", "motor 1"),
    ]
