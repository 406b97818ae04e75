"""Determinism that can be shown: one scenario in fresh processes whose surroundings differ, and hashes side by side."""

from __future__ import annotations

from simkit.testing.certify.certificate import Certificate, Difference, Row
from simkit.testing.certify.certification import certify
from simkit.testing.certify.variations import VARIATIONS, Variation

__all__ = ["VARIATIONS", "Certificate", "Difference", "Row", "Variation", "certify"]
