"""Parameters of a world identified from recordings: search, intervals, identifiability, cross-validation, report."""
