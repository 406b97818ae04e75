"""Films of runs and bags: `film` draws the frames, and `bag_motion` sets the state that a bag describes."""
