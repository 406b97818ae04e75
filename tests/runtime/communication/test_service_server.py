"""Services: requests and responses with the types of ROS."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import simkit
from simkit import msgs
from simkit.errors import MessageError, PluginError, ServiceError, SubscriberError

EMPTY = '<sdf version="1.9"><world name="w"/></sdf>'


class Lamp(simkit.WorldPlugin):
    def load(self, parent: Any, params: simkit.Params) -> None:
        self.is_on = False
        self.offer("lamp/switch", "std_srvs/srv/SetBool", self.switch)

    def switch(self, request: Any) -> dict[str, Any]:
        self.is_on = request.data
        return {"success": True, "message": f"at {self.sim.time:g} s"}


def test_a_service_answers_at_once_with_its_response_message() -> None:
    with simkit.load(EMPTY, plugins=[lamp := Lamp()]) as sim:
        sim.run(0.5)
        response = sim.call("/lamp/switch", {"data": True})
        assert lamp.is_on
        assert msgs.type_name(response) == "std_srvs/srv/SetBool_Response"
        assert (response.success, response.message) == (True, "at 0.5 s")
        assert sim.communication.services.names()["/lamp/switch"] == "std_srvs/srv/SetBool"


def test_a_request_may_be_a_message_or_a_dict() -> None:
    with simkit.load(EMPTY, plugins=[lamp := Lamp()]) as sim:
        sim.call("lamp/switch", msgs.make("std_srvs/srv/SetBool_Request", data=True))
        assert lamp.is_on
        with pytest.raises(MessageError, match="needs std_srvs/srv/SetBool_Request, got std_msgs/msg/Bool"):
            sim.call("lamp/switch", msgs.make("std_msgs/msg/Bool"))
        with pytest.raises(MessageError, match="did you mean 'data'"):
            sim.call("lamp/switch", {"dta": True})


def test_the_error_for_an_unknown_service_suggests_the_closest_name() -> None:
    with simkit.load(EMPTY, plugins=[Lamp()]) as sim, pytest.raises(ServiceError, match="did you mean '/lamp/switch'"):
        sim.call("/lamp/swich")


def test_an_existing_service_cannot_be_offered_again() -> None:
    with simkit.load(EMPTY, plugins=[Lamp()]) as sim, pytest.raises(ServiceError, match="of plugin 'Lamp'"):
        sim.offer("/lamp/switch", "std_srvs/srv/SetBool", lambda request: None)


def test_an_exception_in_the_service_of_a_plugin_names_the_plugin() -> None:
    class Faulty(simkit.WorldPlugin):
        def load(self, parent: Any, params: simkit.Params) -> None:
            self.offer("break", "std_srvs/srv/Empty", lambda request: 1 / 0)

    with simkit.load(EMPTY, plugins=[Faulty()]) as sim, pytest.raises(PluginError, match="'Faulty'.*service /break"):
        sim.call("/break")


@pytest.mark.parametrize(
    ("response", "found"),
    [
        (3, r"or a dict of its fields; 3 \(int\) is not a message"),
        (False, r"or a dict of its fields; False \(bool\) is not a message"),
        ((True, "on"), r"or a dict of its fields; \(True, 'on'\) \(tuple\) is not a message"),
        (msgs.make("std_msgs/msg/String"), "got std_msgs/msg/String"),
    ],
)
def test_a_response_of_the_wrong_type_is_an_error_that_names_the_service(response: object, found: str) -> None:
    class Broken(Lamp):
        def switch(self, request: Any) -> Any:
            return response

    with simkit.load(EMPTY, plugins=[Broken()]) as sim:
        sim.offer("script", "std_srvs/srv/SetBool", lambda request: response)
        for name in ("/lamp/switch", "/script"):
            with pytest.raises(
                (MessageError, SubscriberError),
                match=f"response of '{name}' needs std_srvs/srv/SetBool_Response.*{found}",
            ):
                sim.call(name)


def test_a_service_is_removed_with_its_model_and_restored_with_it(tmp_path: Path) -> None:
    (tmp_path / "homing.py").write_text(
        "import simkit\n\n\nclass Homing(simkit.ModelPlugin):\n    filenames = ('libhoming.so',)\n\n"
        "    def load(self, parent, params):\n"
        "        self.offer('/robot/home', 'std_srvs/srv/Trigger', lambda request: {'success': True})\n"
    )
    plugin = '<plugin name="homing" filename="libhoming.so"/>'
    model = f'<sdf version="1.9"><model name="robot"><link name="base"/>{plugin}</model></sdf>'
    with simkit.load(EMPTY, plugin_paths=[tmp_path]) as sim:
        sim.spawn(model)
        before = sim.snapshot()
        assert sim.call("/robot/home").success
        sim.remove("robot")
        assert "/robot/home" not in sim.communication.services.names()
        sim.restore(before)
        assert sim.call("/robot/home").success
        sim.remove("robot")
        sim.spawn(model)
        assert sim.call("/robot/home").success


def test_an_unknown_service_is_reported_with_the_first_twenty_names() -> None:
    """A TIAGo has more than a hundred services; a message with all of them has forty lines."""
    with simkit.load("turtlebot3_world") as sim:
        names = sim.communication.services.names()
        with pytest.raises(ServiceError) as raised:
            sim.call("/plan_kinematic_path", {})
    listed = ", ".join(sorted(names)[:20])
    assert str(raised.value).endswith(f"there is {listed} and {len(names) - 20} more")
