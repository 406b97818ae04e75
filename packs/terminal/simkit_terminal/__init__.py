"""Pack with the commands that talk to a running simulation or a bag, as those of ROS 2 do."""
