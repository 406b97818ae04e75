"""Certificates of determinism: one run in several fresh processes with different environments, compared by hashes.

The input is a run specification. The result is a `Certificate` with the first difference and the plugin or sensor that
caused it. Messages and states are stored as hashes only.
"""

from __future__ import annotations

from simkit_verification.testing.certify.certificate import Certificate, Difference, Row
from simkit_verification.testing.certify.certification import certify
from simkit_verification.testing.certify.variations import VARIATIONS, Variation

__all__ = ["VARIATIONS", "Certificate", "Difference", "Row", "Variation", "certify"]
