"""Tests: actions of programs of ROS 1."""

from __future__ import annotations

from typing import Any

SERVER = """
    import actionlib, rospy
    from actionlib_tutorials.msg import FibonacciAction, FibonacciFeedback, FibonacciResult
    class Server:
        def __init__(self):
            self.server = actionlib.SimpleActionServer("fibonacci", FibonacciAction, self.execute, auto_start=False)
            self.server.start()
        def execute(self, goal):
            if goal.order < 0:
                raise ValueError("negative")
            feedback = FibonacciFeedback()
            feedback.sequence = [0, 1]
            for index in range(1, goal.order):
                if self.server.is_preempt_requested():
                    rospy.loginfo("preempted")
                    self.server.set_preempted()
                    return
                feedback.sequence.append(feedback.sequence[index] + feedback.sequence[index - 1])
                self.server.publish_feedback(feedback)
                rospy.sleep(0.1)
            self.server.set_succeeded(FibonacciResult(feedback.sequence), "all numbers")
    rospy.init_node("server")
    Server()
    rospy.spin()
"""
CLIENT = """
    import actionlib, rospy
    from actionlib_tutorials.msg import FibonacciAction, FibonacciGoal
    rospy.init_node("client")
    client = actionlib.SimpleActionClient("fibonacci", FibonacciAction)
    client.wait_for_server()
"""


def test_a_client_gets_feedback_and_the_result(sim: Any, add: Any, texts: Any) -> None:
    add(SERVER, "server")
    client = add(
        CLIENT
        + """
    client.send_goal(FibonacciGoal(order=4),
                     lambda state, result: rospy.loginfo("done %d", state),
                     lambda: rospy.loginfo("active"),
                     lambda feedback: rospy.loginfo("%s", list(feedback.sequence)))
    rospy.loginfo("%s", client.wait_for_result())
    rospy.loginfo("%s %s", list(client.get_result().sequence), client.get_goal_status_text())
    rospy.loginfo("%s", client.get_state() == actionlib.GoalStatus.SUCCEEDED)
""",
        "client",
    )
    sim.run(1.0)
    assert client.error is None
    sequences = ["[0, 1, 1]", "[0, 1, 1, 2]", "[0, 1, 1, 2, 3]"]
    assert texts(client) == ["active", *sequences, "done 3", "True", "[0, 1, 1, 2, 3] all numbers", "True"]


def test_a_cancelled_goal_ends_as_preempted(sim: Any, add: Any, texts: Any) -> None:
    server = add(SERVER, "server")
    client = add(
        CLIENT
        + """
    client.send_goal(FibonacciGoal(20))
    rospy.loginfo("%s", client.wait_for_result(rospy.Duration(0.25)))
    client.cancel_goal()
    rospy.loginfo("%s", client.wait_for_result(rospy.Duration(1)))
    rospy.loginfo("%d", client.get_state())
""",
        "client",
    )
    sim.run(2.0)
    assert texts(client) == ["False", "True", "2"]
    assert texts(server) == ["preempted"]


def test_a_new_goal_preempts_the_present_one(sim: Any, add: Any, texts: Any) -> None:
    add(SERVER, "server")
    client = add(
        CLIENT
        + """
    client.send_goal(FibonacciGoal(20), lambda state, result: rospy.loginfo("first %d", state))
    rospy.sleep(0.25)
    other = actionlib.SimpleActionClient("fibonacci", FibonacciAction)
    other.wait_for_server()
    rospy.loginfo("%d", other.send_goal_and_wait(FibonacciGoal(2)))
""",
        "client",
    )
    sim.run(2.0)
    assert texts(client) == ["first 2", "3"]


def test_an_exception_in_the_function_of_a_goal_aborts_it_and_the_server_goes_on(
    sim: Any, add: Any, texts: Any
) -> None:
    server = add(SERVER, "server")
    client = add(
        CLIENT
        + """
    rospy.loginfo("%d %s", client.send_goal_and_wait(FibonacciGoal(-1)), client.get_goal_status_text())
    rospy.loginfo("%d", client.send_goal_and_wait(FibonacciGoal(1)))
""",
        "client",
    )
    sim.run(1.0)
    assert texts(client) == ["4 Exception in execute callback: negative", "3"]
    assert texts(server)[0] == "Exception in your execute callback: negative"


def test_a_script_sends_a_goal_to_a_program(sim: Any, add: Any) -> None:
    add(SERVER)
    sim.run(0.1)
    goal = sim.send_goal("/fibonacci", {"order": 3})
    sim.run(1.0)
    assert list(goal.result.sequence) == [0, 1, 1, 2]


def test_wait_for_server_ends_after_its_timeout(sim: Any, add: Any, texts: Any) -> None:
    client = add(
        """
        import actionlib, rospy
        from actionlib_tutorials.msg import FibonacciAction
        rospy.init_node("client")
        client = actionlib.SimpleActionClient("nothing", FibonacciAction)
        rospy.loginfo("%s %s", client.wait_for_server(rospy.Duration(0.5)), client.get_state())
        try:
            actionlib.SimpleActionClient("nothing", int)
        except actionlib.ActionException as error:
            rospy.loginfo("%s", error)
        """
    )
    sim.run(1.0)
    assert texts(client) == ["False 9", "Type is not an action spec: <class 'int'>"]
    assert client.log[0].startswith("[INFO] [0.500000000]")


def test_a_server_with_callbacks_accepts_and_rejects_goals(sim: Any, add: Any, texts: Any) -> None:
    add(
        """
        import actionlib, rospy
        from actionlib_tutorials.msg import FibonacciAction, FibonacciResult
        def decide(handle):
            if handle.get_goal().order > 5:
                handle.set_rejected(None, "too many")
                return
            handle.set_accepted()
            handle.set_succeeded(FibonacciResult([7]))
        rospy.init_node("server")
        actionlib.ActionServer("fibonacci", FibonacciAction, decide)
        rospy.spin()
        """,
        "server",
    )
    client = add(
        CLIENT
        + """
    rospy.loginfo("%d %s", client.send_goal_and_wait(FibonacciGoal(6)), client.get_goal_status_text())
    rospy.loginfo("%d %s", client.send_goal_and_wait(FibonacciGoal(5)), list(client.get_result().sequence))
""",
        "client",
    )
    sim.run(1.0)
    assert texts(client) == ["5 too many", "3 [7]"]


def test_a_server_without_a_function_for_goals_accepts_them_itself(sim: Any, add: Any, texts: Any) -> None:
    server = add(
        """
        import actionlib, rospy
        from actionlib_tutorials.msg import FibonacciAction, FibonacciResult
        def on_goal():
            goal = server.accept_new_goal()
            rospy.loginfo("goal %d %s", goal.order, server.is_active())
        def on_preempt():
            rospy.loginfo("preempt")
            server.set_preempted(FibonacciResult([9]), "stopped")
        rospy.init_node("server")
        server = actionlib.SimpleActionServer("fibonacci", FibonacciAction, auto_start=False)
        server.register_goal_callback(on_goal)
        server.register_preempt_callback(on_preempt)
        server.start()
        rospy.spin()
        """,
        "server",
    )
    client = add(
        CLIENT
        + """
    client.send_goal(FibonacciGoal(3))
    rospy.sleep(0.2)
    client.cancel_all_goals()
    client.wait_for_result()
    rospy.loginfo("%d %s %s", client.get_state(), client.get_goal_status_text(), list(client.get_result().sequence))
""",
        "client",
    )
    sim.run(1.0)
    assert texts(server) == ["goal 3 True", "preempt"]
    assert texts(client) == ["2 stopped [9]"]


def test_a_client_with_handles_follows_each_goal(sim: Any, add: Any, texts: Any) -> None:
    add(SERVER, "server")
    client = add(
        """
        import actionlib, rospy
        from actionlib_tutorials.msg import FibonacciAction, FibonacciGoal
        def moved(handle):
            rospy.loginfo("%s", actionlib.CommState.to_string(handle.get_comm_state()))
        rospy.init_node("client")
        client = actionlib.ActionClient("fibonacci", FibonacciAction)
        client.wait_for_server()
        handle = client.send_goal(FibonacciGoal(2), moved)
        rospy.sleep(0.5)
        rospy.loginfo("%s", actionlib.TerminalState.to_string(handle.get_terminal_state()))
        """,
        "client",
    )
    sim.run(1.0)
    assert texts(client) == ["ACTIVE", "WAITING_FOR_RESULT", "DONE", "SUCCEEDED"]
