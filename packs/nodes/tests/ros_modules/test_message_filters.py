"""Filters of messages in programs: synchronizers and caches of `message_filters`."""

from __future__ import annotations

from collections.abc import Callable

Run = Callable[..., list[str]]

START = """
    import rclpy
    from message_filters import ApproximateTimeSynchronizer, Cache, Subscriber, TimeSynchronizer
    from rclpy.clock import ClockType
    from rclpy.time import Time
    from sensor_msgs.msg import Range
    from std_msgs.msg import String

    rclpy.init()
    node = rclpy.create_node("n")
    log = node.get_logger()
    publishers = [node.create_publisher(Range, topic, 10) for topic in ("left", "right")]
    inputs = [Subscriber(node, Range, topic) for topic in ("left", "right")]

    def send(index, seconds):
        message = Range(range=float(seconds))
        message.header.stamp = Time(seconds=seconds).to_msg()
        publishers[index].publish(message)

    def spin(count=20):
        for _ in range(count):
            rclpy.spin_once(node, timeout_sec=0.01)
"""


def test_messages_with_equal_stamps_belong_together(run_program: Run) -> None:
    lines = run_program(
        START
        + """
    synchronizer = TimeSynchronizer(inputs, 2)
    synchronizer.registerCallback(lambda a, b, text: log.info(f"{a.range} {b.range} {text}"), "extra")
    spin()
    for index, seconds in ((0, 1), (0, 2), (1, 3), (1, 2), (0, 3), (0, 4), (0, 5), (1, 4)):
        send(index, seconds)
        spin(3)
    """
    )
    assert lines == ["2.0 2.0 extra", "3.0 3.0 extra", "4.0 4.0 extra"]


def test_messages_with_similar_stamps_belong_together(run_program: Run) -> None:
    lines = run_program(
        START
        + """
    synchronizer = ApproximateTimeSynchronizer(inputs, 10, slop=0.1)
    synchronizer.registerCallback(lambda a, b: log.info(f"{a.range:.2f} {b.range:.2f}"))
    spin()
    for index, seconds in ((0, 1.0), (0, 1.06), (1, 1.05), (1, 2.0), (0, 2.2), (0, 2.05)):
        send(index, seconds)
        spin(3)
    """
    )
    assert lines == ["1.06 1.05", "2.05 2.00"]


def test_a_cache_has_the_newest_messages(run_program: Run) -> None:
    lines = run_program(
        START
        + """
    cache = Cache(inputs[0], 3)
    spin()
    for seconds in (1, 2, 3, 4):
        send(0, seconds)
        spin(3)
    early, middle, late = (Time(seconds=s, clock_type=ClockType.ROS_TIME) for s in (1, 2.5, 3))
    log.info(str([m.range for m in cache.getInterval(early, late)]))
    log.info(f"{cache.getElemAfterTime(middle).range} {cache.getElemBeforeTime(middle).range}")
    log.info(f"{cache.getOldestTime().nanoseconds} {cache.getLastestTime().nanoseconds} {cache.getLast().range}")
    """,
    )
    assert lines == ["[2.0, 3.0]", "3.0 2.0", "2000000000 4000000000 4.0"]


def test_a_message_without_a_header_needs_permission(run_program: Run) -> None:
    lines = run_program(
        START
        + """
    texts = node.create_publisher(String, "text", 10)
    source = Subscriber(node, String, "text")
    strict, tolerant = Cache(source), Cache(source, allow_headerless=True)
    spin()
    texts.publish(String(data="hello"))
    spin(3)
    log.info(f"{strict.getLast()} {tolerant.getLast().data} {source.getTopic()}")
    """,
    )
    assert lines[0].startswith("can not use message filters messages without timestamp information")
    assert lines[1] == "None hello text"
