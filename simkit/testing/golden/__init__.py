"""Golden runs: the reference run of a scenario on disk, and the check of today's run against it.

A scenario or the folder of a golden run enters; a verdict, and on request a changed golden run, leave. Files that
earlier versions wrote are read, and the same record always gives the same bytes. Records come from
`simkit.testing.run_record`; comparison, cause and report lie in the folders below, which never import this one.
"""
