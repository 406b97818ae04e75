"""Pack view: a simulation in a browser, in Foxglove, for clients of rosbridge, and in a viewer window."""
