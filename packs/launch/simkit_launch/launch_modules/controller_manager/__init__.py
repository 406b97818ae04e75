"""Package `controller_manager`, of which launch files import `launch_utils`."""
