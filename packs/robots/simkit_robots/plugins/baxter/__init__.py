"""Plugin of the two-armed robot Baxter in Gazebo Classic, with the robot's own topics."""
