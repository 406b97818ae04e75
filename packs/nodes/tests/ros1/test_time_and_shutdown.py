"""Tests: time, timers, log and shutdown of programs of ROS 1."""

from __future__ import annotations

from typing import Any


def test_time_is_simulated_time_and_counts_with_durations(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        try:
            rospy.Time.now()
        except rospy.ROSInitException:
            pass
        rospy.init_node("a")
        rospy.sleep(1.5)
        start = rospy.Time.now()
        rospy.sleep(rospy.Duration(0, 250000000))
        passed = rospy.Time.now() - start
        rospy.loginfo("%r %r %s", start, passed, rospy.get_time())
        rospy.loginfo("%d %d %s", start.secs, start.nsecs, (start + passed * 2).to_sec())
        rospy.loginfo("%s %s", rospy.Duration.from_sec(0.5) > rospy.Duration(0), rospy.Time(3) == rospy.Time(3.0))
        """
    )
    sim.run(2.0)
    assert texts(node) == ["rospy.Time[1500000000] genpy.Duration[250000000] 1.75", "1 500000000 2.0", "True True"]


def test_time_before_init_node_is_an_error(sim: Any, add: Any) -> None:
    node = add("import rospy\nrospy.Time.now()")
    sim.run(0.01)
    assert str(node.error) == "time is not initialized. Have you called init_node()?"


def test_a_rate_keeps_its_grid_and_begins_anew_after_a_long_stall(sim: Any, add: Any) -> None:
    node = add(
        """
        import rospy
        rospy.init_node("a")
        rate = rospy.Rate(10)
        for turn in range(9):
            rospy.sleep({2: 0.15, 5: 0.55}.get(turn, 0.01))
            rate.sleep()
            rospy.loginfo("%d", turn)
        """
    )
    sim.run(3.0)
    times = [float(line.split("[")[2].split("]")[0]) for line in node.log]
    assert times == [0.1, 0.2, 0.35, 0.4, 0.5, 1.05, 1.15, 1.25, 1.35]


def test_a_timer_calls_its_function_each_period(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        def tick(event):
            last = event.last_real.to_sec() if event.last_real else None
            rospy.loginfo("%s %s %s", event.current_expected.to_sec(), event.current_real.to_sec(), last)
            if event.current_real.to_sec() > 0.55:
                timer.shutdown()
        rospy.init_node("a")
        timer = rospy.Timer(rospy.Duration(0.2), tick)
        rospy.Timer(rospy.Duration(0.3), lambda event: rospy.loginfo("once"), oneshot=True)
        rospy.spin()
        """
    )
    sim.run(1.5)
    assert texts(node) == ["0.2 0.2 None", "once", "0.4 0.4 0.2", "0.6 0.6 0.4"]


def test_time_sleep_waits_in_simulated_time(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import time, rospy
        rospy.init_node("a")
        time.sleep(0.5)
        rospy.loginfo("%s", rospy.get_time())
        """
    )
    sim.run(1.0)
    assert texts(node) == ["0.5"]


def test_log_lines_have_level_time_and_name(sim: Any, add: Any) -> None:
    node = add(
        """
        import rospy
        rospy.init_node("a", log_level=rospy.DEBUG)
        rospy.logdebug("debug")
        rospy.loginfo("%s of %d", "one", 2)
        rospy.logwarn("100 %")
        rospy.logerr("two\\nlines")
        rospy.logfatal("%(x)s", {"x": 5})
        rospy.loginfo("named", logger_name="part")
        """,
        namespace="robot",
    )
    sim.run(0.01)
    start = "[0.000000000] [robot.a"
    assert node.log == [
        f"[DEBUG] {start}]: debug",
        f"[INFO] {start}]: one of 2",
        f"[WARN] {start}]: 100 %",
        f"[ERROR] {start}]: two",
        "lines",
        f"[FATAL] {start}]: 5",
        f"[INFO] {start}.part]: named",
    ]


def test_lines_are_logged_once_or_at_most_once_in_a_period(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        rospy.init_node("a")
        for count in range(6):
            rospy.loginfo_once("first %d", count)
            rospy.logwarn_throttle(1, f"throttled {count}")
            rospy.loginfo_throttle_identical(10, f"identical {count // 3}")
            rospy.logdebug("hidden")
            rospy.sleep(0.6)
        """
    )
    sim.run(5.0)
    assert texts(node) == [
        "first 0",
        "throttled 0",
        "identical 0",
        "throttled 2",
        "identical 1",
        "throttled 4",
    ]


def test_the_log_is_published(sim: Any, add: Any) -> None:
    messages: list[Any] = []
    sim.subscribe("/rosout", messages.append)
    add(
        """
        import rospy
        rospy.init_node("a")
        def main():
            rospy.sleep(0.1)
            rospy.logwarn("look")
            rospy.sleep(0.1)
        main()
        """
    )
    sim.run(0.3)
    (message,) = [message for message in messages if message.name == "a"]
    assert (message.msg, message.level, message.function, message.stamp.nanosec) == ("look", 30, "main", 100_000_000)


def test_the_end_of_the_run_shuts_the_node_down(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        def stop():
            rospy.loginfo("stop %s", rospy.is_shutdown())
            rospy.sleep(1)
            rospy.loginfo("stopped")
        rospy.init_node("a")
        rospy.on_shutdown(stop)
        try:
            rospy.sleep(10)
        except rospy.ROSInterruptException as error:
            rospy.loginfo("%s %s", error, rospy.is_shutdown())
        """
    )
    sim.run(1.0)
    sim.close()
    assert texts(node) == ["stop False", "stopped", "ROS shutdown request True"]
    assert node.error is None


def test_a_loop_over_is_shutdown_ends_with_the_run(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        rospy.init_node("a")
        count = 0
        while not rospy.is_shutdown():
            count += 1
        rospy.loginfo("%s", count > 10)
        """
    )
    sim.run(0.01)
    sim.close()
    assert texts(node) == ["True"]


def test_spin_ends_when_the_program_shuts_itself_down(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        rospy.init_node("a")
        rospy.on_shutdown(lambda: rospy.loginfo("bye"))
        rospy.Timer(rospy.Duration(0.2), lambda event: rospy.signal_shutdown("enough"))
        rospy.spin()
        rospy.loginfo("after spin")
        """
    )
    sim.run(0.5)
    assert texts(node) == ["bye", "after spin"]
    assert node.done


def test_a_program_ends_with_its_main_function_although_it_has_subscribers(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        from std_msgs.msg import String
        rospy.init_node("a")
        rospy.Subscriber("chatter", String, lambda message: rospy.loginfo("heard"))
        rospy.on_shutdown(lambda: rospy.loginfo("shutdown"))
        rospy.sleep(0.1)
        """
    )
    publisher = sim.advertise("/chatter", "std_msgs/msg/String")
    sim.run(0.2)
    publisher.publish({"data": "late"})
    sim.run(0.1)
    assert node.done
    assert texts(node) == ["shutdown"]


def test_an_uncaught_interrupt_at_the_end_of_the_run_is_no_error(sim: Any, add: Any) -> None:
    node = add(
        """
        import rospy
        rospy.init_node("a")
        rate = rospy.Rate(10)
        while True:
            rate.sleep()
        """
    )
    sim.run(0.2)
    sim.close()
    assert node.error is None
    assert node.log == []
