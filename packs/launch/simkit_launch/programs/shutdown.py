"""Program for the action `Shutdown` of a launch file: the run ends with it."""
