"""Pack verification: certificates of determinism, bundles that repeat a run, and grading of exercises."""
