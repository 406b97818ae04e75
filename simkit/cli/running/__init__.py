"""How a run is asked for, goes on and ends: what is behind `simkit run`."""
