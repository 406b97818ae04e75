"""Films of runs and bags: `film` draws the frames."""
