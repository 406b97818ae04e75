"""The site of the documentation: its navigation, links between pages, and the reference that is made from the code.

`.ci/run` builds the site; these tests need no package of the extra `docs`.
"""

from __future__ import annotations

import importlib
import json
import re
import shutil
import subprocess
import sys
import types
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

import simkit

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="module")
def site_pages() -> Iterator[types.ModuleType]:
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(ROOT / "docs" / "site"))
        yield importlib.import_module("site_pages")
        for name in ("site_pages", "reference"):
            sys.modules.pop(name, None)


@pytest.fixture(scope="module")
def reference(site_pages: types.ModuleType) -> types.ModuleType:
    return importlib.import_module("reference")


def leaves(entry: object) -> Iterator[str]:
    """Yield the paths in a navigation."""
    if isinstance(entry, str):
        yield entry
    elif isinstance(entry, dict):
        for value in entry.values():
            yield from leaves(value)
    elif isinstance(entry, list):
        for value in entry:
            yield from leaves(value)


def test_each_page_is_in_the_navigation_once(site_pages: types.ModuleType) -> None:
    nav = yaml.safe_load((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))["nav"]
    count = Counter(path for path in leaves(nav) if not path.startswith("reference/"))
    assert not [path for path, number in count.items() if number > 1]
    assert set(count) - {"docs/diagnostics.md"} == set(site_pages.repository_pages())


def test_the_site_loads_nothing_from_the_network() -> None:
    config = yaml.safe_load((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))
    assert config["theme"]["font"] is False
    assert "repo_url" not in config  # the theme would ask GitHub for the number of stars
    assert "http" not in (ROOT / "docs" / "site" / "site.css").read_text(encoding="utf-8")


def test_a_link_leads_to_a_page_of_the_site_or_to_the_repository(site_pages: types.ModuleType) -> None:
    repository = site_pages.REPOSITORY
    text = (
        "[a](../packs/view/docs/view.md#keys) [b](../worlds/office.sdf) [c](../worlds) `[d](../x)` [e](#here)\n"
        f"[f]({repository}blob/main/docs/golden.md) [g](https://example.org/a.md)\n"
        "```\n[h](../worlds)\n```\n[of\ntwo lines](../worlds)\n"
    )
    on_site = {"docs/golden.md", "packs/view/docs/view.md"}
    assert site_pages.with_site_links(text, "docs/teleop.md", on_site) == (
        f"[a](../packs/view/docs/view.md#keys) [b]({repository}blob/main/worlds/office.sdf) "
        f"[c]({repository}tree/main/worlds) `[d](../x)` [e](#here)\n"
        "[f](golden.md) [g](https://example.org/a.md)\n"
        f"```\n[h](../worlds)\n```\n[of\ntwo lines]({repository}tree/main/worlds)\n"
    )


@pytest.mark.parametrize(
    "github, python",
    [
        ("text:\n- one\n- two\n", "text:\n\n- one\n- two\n"),
        ("- one\n  more\n  - inner\n\nend\n", "- one\n    more\n    - inner\n\nend\n"),
        (
            "1. one\n\n   ```sh\n   ls\n     x\n   ```\n2. two\n",
            "1. one\n\n    ```sh\n    ls\n      x\n    ```\n2. two\n",
        ),
        ("| `a\\|b` | c |\n", "| `a|b` | c |\n"),
        ("```\ntext\n- no list\n```\n", "```\ntext\n- no list\n```\n"),
        ("```yaml file=run.yaml\na: 1\n```\n", "```yaml\na: 1\n```\n"),
    ],
)
def test_lists_and_tables_of_github_become_those_of_the_site(
    site_pages: types.ModuleType, github: str, python: str
) -> None:
    assert site_pages.in_python_markdown(github) == python


def test_the_anchor_of_a_heading_is_that_of_github(site_pages: types.ModuleType) -> None:
    assert site_pages.github_anchor("Rates, noise & `<sensor>`", "-") == "rates-noise--sensor"


def test_each_public_name_is_on_one_page_of_the_reference(reference: types.ModuleType) -> None:
    texts = [text for _, text in reference.python_pages().values()]
    shown = Counter(name for text in texts for name in re.findall(r"^::: (\S+)$", text, re.MULTILINE))
    assert not [name for name, number in shown.items() if number > 1]
    public = {f"simkit.{name}" for name in simkit.__all__ if name != "__version__"}
    for module in simkit._PUBLIC_MODULES:
        public |= {f"simkit.{module}.{name}" for name in reference.public_names(f"simkit.{module}")}
    assert public <= set(shown)
    assert {"simkit.sensors.base.Sensor", "simkit.scene.world.SceneWorld"} <= set(shown)


def test_each_command_and_each_of_its_options_is_in_the_reference(reference: types.ModuleType) -> None:
    pages = reference.command_pages()
    assert {"reference/commands/run.md", "reference/commands/certify.md"} <= set(pages)
    text = pages["reference/commands/bag.md"][1]
    assert "\n## simkit bag export\n" in text
    assert "--cmd-vel" in pages["reference/commands/run.md"][1]
    assert "../../docs/commands/run.md" in pages["reference/commands/run.md"][1]


def test_the_page_of_a_command_links_to_its_options(reference: types.ModuleType) -> None:
    def link(path: str) -> str:
        return reference.with_options_link("# title\n\ntext", path, reference.command_pages()).split("\n\n")[1]

    assert link("docs/commands/run.md") == "[All options](../../reference/commands/run.md)"
    assert link("packs/x/docs/commands/grade.md") == "[All options](../../../../reference/commands/grade.md)"
    assert link("docs/commands/index.md") == link("docs/run.md") == "text"


def test_each_diagnostic_code_has_a_heading_in_the_reference(reference: types.ModuleType) -> None:
    from simkit.cli.diagnostic_catalogue import catalogue

    texts = "\n".join(text for _, text in reference.diagnostic_pages().values())
    headings = re.findall(r"^## (SK-\S+)$", texts, re.MULTILINE)
    assert sorted(headings) == sorted(catalogue())


def test_each_section_of_the_names_for_extensions_has_a_page_of_the_reference(reference: types.ModuleType) -> None:
    texts = [text for path, (_, text) in reference.python_pages().items() if "simkit.extend." in path]
    shown = [name for text in texts for name in re.findall(r"^::: simkit\.extend\.(\w+)$", text, re.MULTILINE)]
    assert sorted(shown) == sorted(set(reference.public_names("simkit.extend")))
    assert len(texts) > 5


@pytest.mark.slow
@pytest.mark.needs_packs
def test_each_plugin_has_its_elements_in_the_reference_and_links_to_them(reference: types.ModuleType) -> None:
    pages, anchors = reference.plugin_pages(), reference.plugin_anchors()
    text = pages["reference/plugins/gazebo_sim.md"][1].partition("\n## gz-sim-diff-drive-system\n")[2]
    assert "| `wheel_radius` | number | 0.2 | m | at least 1e-06 |" in text
    assert "| · `wheel_variance` | number | 0 |" in text
    for page, _, heading in (anchor.partition("#") for anchor in set(anchors.values())):
        headings = re.findall(r"^## (.+)$", pages[page][1], re.MULTILINE)
        assert heading in {reference.github_anchor(each, "-") for each in headings}
    kobuki = "[`libgazebo_ros_kobuki.so`](../reference/plugins/robots_gazebo_classic.md#gazebo_ros_kobuki)"

    def linked(text: str) -> str:
        return reference.with_plugin_links(text, "docs/drives.md", anchors)

    assert f"All elements and topics: {kobuki}\n" in linked("## Kobuki: `libgazebo_ros_kobuki.so`\n\ntext")
    assert linked("`libgazebo_ros_kobuki.so` or `libx.so`\n") == f"{kobuki} or `libx.so`\n"
    assert linked("[`libgazebo_ros_kobuki.so`](robots.md)") == "[`libgazebo_ros_kobuki.so`](robots.md)"
    assert linked("```xml\n`libgazebo_ros_kobuki.so`\n```\n") == "```xml\n`libgazebo_ros_kobuki.so`\n```\n"


@pytest.mark.slow
@pytest.mark.needs_packs
def test_each_published_message_has_its_fields_in_the_reference(reference: types.ModuleType) -> None:
    pages = reference.message_pages()
    scan = pages["reference/messages/sensor_msgs.md"][1].partition("\n## LaserScan\n")[2].partition("\n## ")[0]
    assert "Published by `GazeboRosLaser`, `GazeboRosRaySensor`, `gpu_lidar`, `lidar`." in scan
    assert "float32 angle_min  # [rad]" in scan
    assert "Received by" in pages["reference/messages/geometry_msgs.md"][1]


@pytest.mark.parametrize(
    ("typed", "query"),
    [
        ("--cmd-vel", "+cmd +vel* vel^10"),
        ("package://", "package^10 packag*"),
        ("the robot slides", "robot^10 robot* slides^10 slid*"),
        ("run_until", "+run +until* until^10"),
        ('"exact words"', '"exact words"'),
        ("is", "is^10 is*"),
        (
            "size 0 must be in geom 1",
            "text:size^10 text:size text:0^10 text:0 text:must^10 text:must text:geom^10 text:geom text:1^10 text:1",
        ),
    ],
)
def test_the_search_gets_what_people_type_as_a_query(typed: str, query: str) -> None:
    node = shutil.which("node")
    if node is None:
        pytest.skip("needs node, to run the program of the page")
    program = (ROOT / "docs/site/theme/search_query.js").read_text(encoding="utf-8")
    show = f"{program}\nconsole.log(searchQuery({json.dumps(typed)}))"
    done = subprocess.run([node, "-e", show], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == query
