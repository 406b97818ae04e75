"""Certificates of determinism: one run in several fresh processes whose surroundings differ, and hashes side by side.

A run specification enters, a `Certificate` leaves: what differed first, and which plugin or sensor began it. Messages
and states are kept as hashes only.
"""

from __future__ import annotations

from simkit.testing.certify.certificate import Certificate, Difference, Row
from simkit.testing.certify.certification import certify
from simkit.testing.certify.variations import VARIATIONS, Variation

__all__ = ["VARIATIONS", "Certificate", "Difference", "Row", "Variation", "certify"]
