"""Page of all plugin names, which matches the classes, and the reasons for unsupported plugins."""

from __future__ import annotations

from pathlib import Path

import simkit
from simkit.plugins.discovery.find_plugin_class import UNSUPPORTED_REASONS, plugin_kinds
from simkit_authoring.catalogue_page import page

PAGE = Path(__file__).resolve().parents[3] / "docs" / "catalogue.md"


def test_the_page_is_up_to_date_with_the_classes() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(), (
        "write it anew: python -m simkit_authoring.catalogue_page > docs/catalogue.md"
    )


def test_no_plugin_is_both_supported_and_unsupported() -> None:
    assert sorted(set(UNSUPPORTED_REASONS) & set(plugin_kinds())) == []


def test_an_unsupported_plugin_is_reported_with_the_reason() -> None:
    text = """<sdf version="1.9"><world name="w">
      <plugin filename="gz-sim-breadcrumbs-system" name="gz::sim::systems::Breadcrumbs"/>
      <plugin filename="mine.so" name="ignition::gazebo::systems::LensFlare"/>
    </world></sdf>"""
    with simkit.load(text) as sim:
        found = [d for d in sim.diagnostics if d.code == "SK-PLUGIN-002"]
    assert [d.line for d in found] == [2, 3]
    assert UNSUPPORTED_REASONS["gz-sim-breadcrumbs-system"] in found[0].message
    assert "renderer" in found[1].message
