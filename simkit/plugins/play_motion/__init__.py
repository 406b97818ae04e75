"""play_motion: motions that a robot knows by name, and what is looked at before one is played."""
