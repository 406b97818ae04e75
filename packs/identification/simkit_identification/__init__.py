"""Pack that compares recordings with runs, and fits parameters of a world to a recording."""
