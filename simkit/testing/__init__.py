"""Complete runs: specify, check, record, compare and repeat them.

The inputs are a run specification (`simkit.run_spec.RunSpec`) or a running simulation. The results are check results,
records, reference runs, certificates, grades and bundles. Observing a simulation does not change any bit of it. The
command line calls this package; no other package imports it.
"""
