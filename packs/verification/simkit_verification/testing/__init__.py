"""Verification of runs: certificates, bundles and grades. Observing a simulation does not change any bit of it."""
