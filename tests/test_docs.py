"""The documents say what the code does: every link, no path of somebody's machine."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
REPOSITORY = "https://github.com/simkit-robotics/simkit/"
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
PACK_PAGES = sorted(page for page in ROOT.glob("packs/**/*.md") if "node_modules" not in page.parts)
DOCUMENTS = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("benchmarks/*.md"), *PACK_PAGES])
TEXTS = [
    path
    for folder in ("simkit", "packs", "docs", "worlds", "assets", "examples", "benchmarks", "tests")
    for path in sorted((ROOT / folder).rglob("*"))
    if path.suffix in {".py", ".md", ".sdf", ".yaml", ".config", ".obj", ".world"} and "node_modules" not in path.parts
]


def test_links_lead_somewhere() -> None:
    missing = []
    for path in DOCUMENTS:
        text = re.sub(r"```.*?```", "", path.read_text(encoding="utf-8"), flags=re.DOTALL)
        for target in LINK.findall(text):
            if re.match(r"[a-z]+:", target) or target.startswith("#"):
                continue
            if not (path.parent / target.split("#")[0]).exists():
                missing.append(f"{path.relative_to(ROOT)}: {target}")
    assert not missing


def test_links_of_the_readme_work_on_the_package_index() -> None:
    """Links are absolute there, and those into the repository name a file of it."""
    targets = LINK.findall((ROOT / "README.md").read_text(encoding="utf-8"))
    assert not [target for target in targets if not target.startswith("https://")]
    own = [
        re.sub(r"^(blob|tree|raw)/main/", "", t.removeprefix(REPOSITORY)) for t in targets if t.startswith(REPOSITORY)
    ]
    assert len(own) > 20
    assert not [target for target in own if not (ROOT / target).exists()]


def test_the_readme_has_at_most_150_lines() -> None:
    assert len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()) <= 150


def test_every_page_is_named_by_an_index() -> None:
    """A page is linked from an index of its folder, the README of its pack, a start page or the index of all pages."""
    indexes = [
        *ROOT.glob("packs/*/README.md"),
        *ROOT.glob("docs/start/*.md"),
        ROOT / "docs" / "index.md",
        ROOT / "docs" / "sensors" / "index.md",
    ]
    linked = {
        (index.parent / target.split("#")[0]).resolve()
        for index in indexes
        for target in LINK.findall(index.read_text(encoding="utf-8"))
    }
    pages = [
        page
        for page in (*PACK_PAGES, *(ROOT / "docs").rglob("*.md"))
        if page.name not in {"index.md", "diagnostics.md"}
    ]
    assert not [page.relative_to(ROOT).as_posix() for page in sorted(pages) if page.resolve() not in linked]


def test_links_to_headings_lead_to_one() -> None:
    wrong = []
    for path in DOCUMENTS:
        for target in LINK.findall(path.read_text(encoding="utf-8")):
            name, _, anchor = target.partition("#")
            if not anchor or re.match(r"[a-z]+:", target):
                continue
            page = (path.parent / name) if name else path
            headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), flags=re.MULTILINE)
            anchors = {re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in headings}
            if anchor not in anchors:
                wrong.append(f"{path.relative_to(ROOT)}: {target}")
    assert not wrong


def test_no_file_holds_a_path_of_somebodys_machine() -> None:
    foreign = re.compile(r"(?<![\w.:])/(home|Users|root|work)/|\b[A-Z]:\\Users")
    holders = [str(p.relative_to(ROOT)) for p in TEXTS if foreign.search(p.read_text(encoding="utf-8"))]
    assert not holders


def test_every_command_has_its_page() -> None:
    """One page for each file of the command line, named alike."""
    files = [*ROOT.glob("simkit/cli/*.py"), *ROOT.glob("packs/*/simkit_*/cli/*.py")]
    commands = {p.stem for p in files if not p.stem.startswith("_")}
    pages = {p.stem for p in (*ROOT.glob("docs/commands/*.md"), *ROOT.glob("packs/*/docs/commands/*.md"))}
    assert pages, "docs/commands has no page"
    assert {c for c in commands if c in pages} == pages, f"pages without a command: {sorted(pages - commands)}"


def test_each_command_that_installs_simkit_names_the_repository() -> None:
    """No package index has the distribution; remove this test when one has it."""
    command = re.compile(r"pip install[^`\n]*?simkit-robotics(?P<rest>[^`\n]*)")
    repository = re.compile(r"(\[[\w,{}-]+\])? @ git\+")
    texts = [*TEXTS, ROOT / "README.md", *(ROOT / "labs").rglob("*.md"), *(ROOT / "docs").rglob("*.yml")]
    texts += [*(ROOT / "simkit").rglob("*.toml"), *(ROOT / "packs").rglob("*.toml")]
    wrong = []
    found = 0
    for path in texts:
        if "tests" in path.relative_to(ROOT).parts:
            continue
        for line in path.read_text(encoding="utf-8").replace('\\"', '"').splitlines():
            for one in command.finditer(line):
                found += 1
                if not repository.match(one["rest"]) and "{extras}" not in one["rest"]:
                    wrong.append(f"{path.relative_to(ROOT)}: {one[0]}")
    assert found > 20
    assert not wrong
