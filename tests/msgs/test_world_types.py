"""Messages and services about a world have the fields that their packages publish."""

from __future__ import annotations

import pytest

from simkit import msgs
from simkit.errors import MessageError

# Type hashes in the code that ROS 2 generated of the packages.
PUBLISHED = {
    "ros_gz_interfaces/msg/Light": "8efb44b207981d0c23827eae2490a4c4700c5e872f0151f0e6dd09aab4919f93",
    "ros_gz_interfaces/srv/ControlWorld_Request": "966e36121ac784a9f0bbab683a4bff9a1d502682d1e781e4381b7d7b29699c34",
    "gazebo_msgs/srv/GetModelProperties_Request": "ad18c002b84d335f82d9e1189b8d46f36b7da1b8dd2c4efe69bddfc9ae9a83a3",
    "gazebo_msgs/srv/GetModelProperties_Response": "b6046f6c1fd2fca24229f7f6351183af170d80808ea9810dd5b39e2d001bf1e2",
    "gazebo_msgs/srv/GetPhysicsProperties_Response": "6c527747a9058ee062cb15e9f6bb5150d6d473a05d13eb186e58abea9728e6a7",
    "gazebo_msgs/srv/GetModelList_Response": "3d808dbabd03c13c8f2973c97d99eb1076d791ad21f7e5ef73a6b4513162428c",
}


@pytest.mark.parametrize("name", PUBLISHED)
def test_a_type_has_the_hash_that_its_package_publishes(name: str) -> None:
    assert msgs.rihs(name) == "RIHS01_" + PUBLISHED[name]


def test_an_unknown_service_suggests_the_closest_even_before_its_first_use() -> None:
    with pytest.raises(MessageError, match="did you mean 'gazebo_msgs/srv/SpawnEntity_Request'"):
        msgs.full_name("gazebo_msgs/srv/SpawnEntiy_Request")
