"""Golden runs: reference runs of scenarios on disk, and the check of a new run against them.

The input is a scenario or the folder of a golden run. The output is a verdict and, on request, an updated golden run.
Files of earlier versions remain readable, and the same record always gives the same bytes. Records come from
`simkit.testing.run_record`. The subfolders for comparison, cause and report never import this package.
"""
