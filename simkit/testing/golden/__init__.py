"""Golden runs: what a scenario gave once, kept and compared with what it gives now."""
