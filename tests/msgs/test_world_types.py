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
    "example_interfaces/srv/AddTwoInts": "e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a",
    "turtlesim/msg/Pose": "739beba26bcba6920404ba722b7b8321348512f92ea5be235c47251940dd8aa9",
    "nav2_msgs/msg/Costmap": "d51bf7aecafdbb3f8f98215de648abe6d53f8db69156d6e143125d2ad2bf0027",
    "nav2_msgs/msg/CostmapMetaData": "1a41ec8428d50c3b4cd3f9055e1adb0eaec72fb39ae11686b59218f6e0884cbd",
    "map_msgs/msg/OccupancyGridUpdate": "c4095b0be2e4363f8978a1570e0293ee093436f1e1c61d99b48502ac317025e8",
    "octomap_msgs/msg/Octomap": "9891a19a05b70ec20aa8f45db3f8300b9ab80afff32c61c549d25087da9625b0",
    "geographic_msgs/msg/GeoPose": "8052786d7663e225e38926f7d05716046c931572c25e557d4f70dca55b972626",
    "simulation_interfaces/msg/EntityState": "2e0464a85eb80a939025075d6c20761eca6a4cb9d6baf2c0ba373467c8b598d0",
    "simulation_interfaces/msg/EntityFilters": "8e7b12e8ea062f14c55de4877221fe1b7cd9749665a7ad8a4ab855fc4b148303",
    "simulation_interfaces/srv/SpawnEntity": "66860313e11009faddbfc8568e5d410d1a11607fe75eeb1308671dc0406fe3a7",
    "simulation_interfaces/srv/ResetSimulation": "4ce285d7ff9b8ac70dcc95161f32bf54c05a6f4b13427990e41ab40c36c39646",
    "std_srvs/srv/SetBool": "abe9e4bb6b41b40e6789712c00ec8871923e089af3f667a79992a428cff2da0a",
    "rcl_interfaces/srv/SetLoggerLevels": "3ff86cb4e91fbf9abae15c234ecc874448de6ece8e193401c077cf116e4f6d78",
    "rcl_interfaces/msg/Log": "e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac",
    "lifecycle_msgs/srv/ChangeState": "356fe34f0475a43acf54542013af4167b0e729f77ea22ffb045c6ad8e20668e5",
    "diagnostic_msgs/srv/SelfTest": "df1e4e54a814a16ccc77471e9239618d46818e8d0e3b45ad6f8c34c6e2abfef6",
    "visualization_msgs/srv/GetInteractiveMarkers": "bfdfaa861f4a8422b4ec3bd02c6681e4a45a83bdc2913d8facdf923d8ad1376a",
    "action_msgs/srv/CancelGoal": "573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a",
    "nav_msgs/srv/GetMap": "c8ae77c9995b3554b5ba80e4d4d443f970ac65143102a1d893ec24fc07b31147",
    "sensor_msgs/srv/SetCameraInfo": "a10cca5d33dc637c8d49db50ab288701a3592bb9cd854f2f16a0659613b68984",
    "service_msgs/msg/ServiceEventInfo": "41bcbbe07a75c9b52bc96bfd5c24d7f0fc0a08c0cb7921b3373c5732345a6f45",
}


@pytest.mark.parametrize("name", PUBLISHED)
def test_a_type_has_the_hash_that_its_package_publishes(name: str) -> None:
    assert msgs.rihs(name) == "RIHS01_" + PUBLISHED[name]


def test_an_unknown_service_suggests_the_closest_even_before_its_first_use() -> None:
    with pytest.raises(MessageError, match="did you mean 'gazebo_msgs/srv/SpawnEntity_Request'"):
        msgs.full_name("gazebo_msgs/srv/SpawnEntiy_Request")
