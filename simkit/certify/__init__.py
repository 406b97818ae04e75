"""Determinism that can be shown: one scenario in fresh processes whose surroundings differ, and hashes side by side."""

from __future__ import annotations

from simkit.certify.certificate import Certificate, Difference, Row
from simkit.certify.runs import certify
from simkit.certify.variations import VARIATIONS, Variation

__all__ = ["VARIATIONS", "Certificate", "Difference", "Row", "Variation", "certify"]
