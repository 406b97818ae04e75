"""Tests: services of programs of ROS 1, and calls of services of the simulation."""

from __future__ import annotations

from typing import Any

SERVER = """
    import rospy
    from example_interfaces.srv import AddTwoInts, AddTwoIntsResponse
    def add(request):
        rospy.loginfo("%d + %d", request.a, request.b)
        if request.a < 0:
            raise ValueError("too small")
        return {values}
    rospy.init_node("server")
    rospy.Service("add", AddTwoInts, add)
    rospy.spin()
"""
CLIENT = """
    import rospy
    from example_interfaces.srv import AddTwoInts, AddTwoIntsRequest
    rospy.init_node("client")
    rospy.wait_for_service("add")
    add = rospy.ServiceProxy("add", AddTwoInts)
    rospy.loginfo("%d %d %d", add(1, 2).sum, add(a=3, b=4).sum, add(AddTwoIntsRequest(5, 6)).sum)
"""


def test_a_client_gets_the_sum_of_a_server(sim: Any, add: Any, texts: Any) -> None:
    for number, values in enumerate(
        ("AddTwoIntsResponse(request.a + request.b)", "request.a + request.b", "[request.a + request.b]", "dict(sum=1)")
    ):
        add(SERVER.replace("{values}", values), f"server{number}", namespace=f"n{number}")
    clients = [add(CLIENT, f"client{number}", namespace=f"n{number}") for number in range(4)]
    sim.run(0.1)
    assert [texts(client) for client in clients] == [["3 7 11"]] * 3 + [["1 1 1"]]


def test_the_level_of_the_log_is_read_and_set_from_outside(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        rospy.init_node("speaker")
        while not rospy.is_shutdown():
            rospy.logdebug("details")
            rospy.sleep(0.1)
        """,
        "speaker",
    )
    sim.run(0.25)
    (logger,) = sim.call("/speaker/get_loggers").loggers
    assert (logger.name, logger.level, texts(node)) == ("rosout", "info", [])
    sim.call("/speaker/set_logger_level", {"logger": "rosout", "level": "debug"})
    sim.run(0.2)
    assert texts(node) == ["details"] * 2
    assert sim.call("/speaker/get_loggers").loggers[0].level == "debug"


def test_a_script_calls_a_service_of_a_program(sim: Any, add: Any) -> None:
    add(SERVER.replace("{values}", "request.a + request.b"))
    sim.run(0.01)
    assert sim.call("/add", {"a": 2, "b": 3}).sum == 5


def test_the_client_gets_the_text_of_an_exception_and_the_server_goes_on(sim: Any, add: Any, texts: Any) -> None:
    server = add(SERVER.replace("{values}", "request.a + request.b"), "server")
    client = add(
        """
        import rospy
        from example_interfaces.srv import AddTwoInts
        rospy.init_node("client")
        rospy.wait_for_service("/add", timeout=1)
        add = rospy.ServiceProxy("/add", AddTwoInts, persistent=True)
        for a in (-1, 1):
            try:
                rospy.loginfo("%d", add(a, 1).sum)
            except rospy.ServiceException as error:
                rospy.loginfo("%s", error)
        """,
        "client",
    )
    sim.run(0.1)
    assert texts(client) == ["service [/add] responded with an error: error processing request: too small", "2"]
    assert "Error processing request: too small" in texts(server)
    assert server.error is None


def test_a_handler_that_returns_none_is_an_error_of_the_client(sim: Any, add: Any, texts: Any) -> None:
    add(SERVER.replace("{values}", "None"), "server")
    client = add(CLIENT, "client")
    sim.run(0.1)
    text = "service [/add] responded with an error: error processing request: service handler returned None"
    assert str(client.error) == text


def test_a_missing_service_is_an_error_after_the_timeout_or_at_once(sim: Any, add: Any, texts: Any) -> None:
    client = add(
        """
        import rospy
        from std_srvs.srv import Empty
        rospy.init_node("client")
        try:
            rospy.wait_for_service("nothing", timeout=rospy.Duration(0.2))
        except rospy.ROSException as error:
            rospy.loginfo("%s", error)
        try:
            rospy.ServiceProxy("nothing", Empty)()
        except rospy.ServiceException as error:
            rospy.loginfo("%s", error)
        """
    )
    sim.run(0.5)
    assert texts(client) == [
        "timeout exceeded while waiting for service /nothing",
        "service [/nothing] unavailable",
    ]
    assert client.log[0].startswith("[INFO] [0.200000000]")


def test_a_handler_that_sleeps_does_not_stop_another_client(sim: Any, add: Any) -> None:
    add(
        """
        import rospy
        from std_srvs.srv import SetBool
        def handle(request):
            if request.data:
                rospy.sleep(1)
            return True, "slow" if request.data else "fast"
        rospy.init_node("server")
        rospy.Service("work", SetBool, handle)
        rospy.spin()
        """,
        "server",
    )
    client = """
        import rospy
        from std_srvs.srv import SetBool
        rospy.init_node("{name}")
        rospy.wait_for_service("work")
        rospy.loginfo(rospy.ServiceProxy("work", SetBool)({slow}).message)
    """
    slow = add(client.format(name="slow", slow=True), "slow")
    fast = add(client.format(name="fast", slow=False), "fast")
    sim.run(1.5)
    assert [line[:14] for line in (*fast.log, *slow.log)] == ["[INFO] [0.0020", "[INFO] [1.0020"]


def test_a_service_that_was_shut_down_is_gone(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        from std_srvs.srv import Empty, EmptyResponse
        rospy.init_node("a")
        service = rospy.Service("~work", Empty, lambda request: EmptyResponse())
        rospy.wait_for_service("~work")
        rospy.ServiceProxy("~work", Empty)()
        service.shutdown("done")
        try:
            rospy.wait_for_service("/a/work", 0.1)
        except rospy.ROSException:
            rospy.loginfo("gone")
        """
    )
    sim.run(0.5)
    assert texts(node) == ["gone"]


def test_a_program_moves_a_model_with_gazebos_services(sim: Any, add: Any, texts: Any) -> None:
    box = "<sdf version='1.9'><model name='box'><static>true</static><link name='l'/></model></sdf>"
    sim.spawn(box, name="box")
    node = add(
        """
        import rospy
        from gazebo_msgs.msg import ModelState, ModelStates
        from gazebo_msgs.srv import GetModelState, SetModelState
        rospy.init_node("mover")
        rospy.wait_for_service("/gazebo/set_model_state")
        state = ModelState(model_name="box")
        state.pose.position.x = 3
        state.pose.orientation.w = 1
        rospy.ServiceProxy("/gazebo/set_model_state", SetModelState)(state)
        answer = rospy.ServiceProxy("/gazebo/get_model_state", GetModelState)("box", "world")
        rospy.loginfo("%s %s", answer.success, answer.pose.position.x)
        states = rospy.wait_for_message("/gazebo/model_states", ModelStates)
        rospy.loginfo("%s", states.pose[states.name.index("box")].position.x)
        """
    )
    sim.run(0.2)
    assert node.error is None
    assert texts(node) == ["True 3.0", "3.0"]


def test_a_program_moves_a_model_with_gazebos_topic(sim: Any, add: Any) -> None:
    sim.spawn("<sdf version='1.9'><model name='box'><static>true</static><link name='l'/></model></sdf>", name="box")
    add(
        """
        import rospy
        from gazebo_msgs.msg import ModelState
        rospy.init_node("mover")
        publisher = rospy.Publisher("/gazebo/set_model_state", ModelState, queue_size=1)
        rospy.sleep(0.1)
        state = ModelState(model_name="box", reference_frame="world")
        state.pose.position.y = 2
        publisher.publish(state)
        """
    )
    sim.run(0.2)
    assert sim.model("box").pose.position[1] == 2.0
