"""Map server of ROS 1: publishes the map of a file on `map`, and answers `static_map`."""

import sys
from pathlib import Path

import rospy
from nav_msgs.msg import MapMetaData, OccupancyGrid
from nav_msgs.srv import GetMap, GetMapResponse

from simkit_navigation.plugins.maps.map_server import MapFileError, read_map


def main():
    """Run the node."""
    rospy.init_node("map_server")
    words = rospy.myargv()[1:]
    if not words:
        sys.exit("Usage: map_server <map.yaml>")
    try:
        if not Path(words[0]).is_file():
            sys.exit(f"map_server could not open {words[0]}.")
        occupancy = read_map(Path(words[0]), is_ros_1=True)
    except MapFileError as error:
        sys.exit(str(error))
    message, (rows, columns) = OccupancyGrid(), occupancy.cells.shape
    message.header.frame_id = rospy.get_param("~frame_id", "map")
    message.header.stamp = message.info.map_load_time = rospy.Time.now()
    message.info.resolution, message.info.width, message.info.height = occupancy.resolution, columns, rows
    position, turn = message.info.origin.position, message.info.origin.orientation
    position.x, position.y, position.z = map(float, occupancy.origin.position)
    turn.w, turn.x, turn.y, turn.z = map(float, occupancy.origin.quaternion)
    message.data = occupancy.cells.reshape(-1).tolist()
    rospy.loginfo("Read a %d X %d map @ %.3f m/cell", columns, rows, occupancy.resolution)
    publisher = rospy.Publisher("map", OccupancyGrid, queue_size=1, latch=True)
    metadata = rospy.Publisher("map_metadata", MapMetaData, queue_size=1, latch=True)
    rospy.Service("static_map", GetMap, lambda _: GetMapResponse(map=message))
    publisher.publish(message)
    metadata.publish(message.info)
    rospy.spin()


if __name__ == "__main__":
    main()
