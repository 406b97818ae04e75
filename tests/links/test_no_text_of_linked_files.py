"""A link in a stranger's folder to a private file: no command prints, copies or stores the text of the file."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from linked_readers import ALL_TEXTS, FOUND, NAMED, NOTES, SECRET_WORDS, LinkedReader
from typer.testing import CliRunner

import simkit
from simkit import hidden_text, linked_files
from simkit.cli import app
from simkit.errors import LoadError


@pytest.fixture(autouse=True)
def _nothing_hidden_or_chosen() -> Iterator[None]:
    """Forget the files and folders of a test, which a process keeps."""
    chosen = dict(linked_files._chosen)
    linked_files._chosen.clear()
    yield
    hidden_text._files.clear()
    linked_files._chosen.clear()
    linked_files._chosen.update(chosen)


def _attack(folder: Path, reader: LinkedReader, text: str) -> str:
    """Run the command of a reader in a stranger's folder; return its output and all files that it wrote."""
    stranger, private = folder / "stranger", folder / "private"
    private.mkdir(parents=True)
    (private / "diary").write_text(text)
    (stranger / ".git").mkdir(parents=True)
    for name, content in reader.files.items():
        (stranger / name).parent.mkdir(parents=True, exist_ok=True)
        (stranger / name).write_text(content)
    link = stranger / reader.link
    link.parent.mkdir(parents=True, exist_ok=True)
    link.symlink_to(private / "diary")
    before = set(stranger.rglob("*"))
    found = CliRunner().invoke(app, reader.command.split())
    assert found.exception is None or isinstance(found.exception, SystemExit), repr(found.exception)
    written = [path for path in stranger.rglob("*") if path not in before and path.is_file()]
    return found.output + "".join(path.read_bytes().decode("latin-1") for path in written)


def _said(output: str) -> list[str]:
    return [word for word in SECRET_WORDS if word in output.lower()]


@pytest.mark.parametrize("reader", [*NAMED, *FOUND], ids=str)
def test_no_output_has_a_word_of_a_private_file(
    tmp_path: Path, reader: LinkedReader, monkeypatch: pytest.MonkeyPatch
) -> None:
    for number, text in enumerate((reader.text, NOTES)):
        folder = tmp_path / str(number)
        (folder / "stranger").mkdir(parents=True)
        monkeypatch.chdir(folder / "stranger")
        output = _attack(folder, reader, text)
        assert not _said(output), output


@pytest.mark.slow
@pytest.mark.parametrize("text", ALL_TEXTS, ids=range(len(ALL_TEXTS)))
def test_no_reader_prints_a_word_of_a_private_file_in_another_format(
    tmp_path: Path, text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    leaks = []
    for number, reader in enumerate((*NAMED, *FOUND)):
        folder = tmp_path / str(number)
        (folder / "stranger").mkdir(parents=True)
        monkeypatch.chdir(folder / "stranger")
        output = _attack(folder, reader, text)
        # the results of a sweep that the user names contain its expressions
        if _said(output) and not reader.command.startswith("sweep L.yaml"):
            leaks.append(f"{reader}\n{output}")
    assert not leaks, "\n".join(leaks)


def test_a_message_about_a_named_link_has_the_line_the_code_and_the_remedy(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    reader = next(one for one in NAMED if one.command.startswith("certify L.yaml"))
    (tmp_path / "stranger").mkdir()
    monkeypatch.chdir(tmp_path / "stranger")
    output = _attack(tmp_path, reader, "world: empty\nzebrafish: 1\n")
    assert "L.yaml:2: error SK-SCEN-002: the text of L.yaml is not shown" in output
    assert f"SIMKIT_RESOURCE_PATH={tmp_path / 'private'}" in output and "simkit explain SK-SCEN-002" in output
    monkeypatch.setenv("SIMKIT_RESOURCE_PATH", str(tmp_path / "private"))
    shown = CliRunner().invoke(app, ["certify", "L.yaml"]).output
    assert "a scenario has no key 'zebrafish'" in shown


def test_a_python_call_reads_a_named_link_and_its_error_shows_no_text(tmp_path: Path) -> None:
    (tmp_path / "private").mkdir()
    (tmp_path / "own").mkdir()
    (tmp_path / "private" / "w.sdf").write_text(FOUND[15].text)
    link = tmp_path / "own" / "w.sdf"
    link.symlink_to(tmp_path / "private" / "w.sdf")
    with pytest.raises(LoadError) as caught:
        simkit.load(link)
    assert not _said(str(caught.value))
    assert all(problem.code.startswith("SK-") and problem.line for problem in caught.value.diagnostics)
    with pytest.raises(LoadError, match="wombat"):
        simkit.load(link, resource_paths=[tmp_path / "private"])
    with pytest.raises(LoadError, match="<zzz>"):  # messages about other files are complete
        simkit.load("<zzz/>")


def test_a_named_folder_that_is_a_link_is_read_and_messages_show_no_text_of_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "private" / "msg").mkdir(parents=True)
    (tmp_path / "private" / "msg" / "B.msg").write_text("int64 a\n")
    (tmp_path / "stranger" / ".git").mkdir(parents=True)
    (tmp_path / "stranger" / "linked").symlink_to(tmp_path / "private")
    monkeypatch.chdir(tmp_path / "stranger")
    show = ["interface", "show", "private/msg/B", "--interfaces", "linked"]
    assert "int64 a" in CliRunner().invoke(app, show).output
    (tmp_path / "private" / "msg" / "B.msg").write_text("zebrafish 5x\n")
    output = CliRunner().invoke(app, show).output
    assert "SK-INTERFACE-" in output and not _said(output)


@pytest.mark.parametrize("marker", [".git", "pyproject.toml"])
def test_links_inside_a_project_hide_nothing(tmp_path: Path, marker: str, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / marker).mkdir()
    (tmp_path / "data").mkdir()
    (tmp_path / "msg").mkdir()
    (tmp_path / "data" / "B.msg").write_text("int64 quokka\n")
    (tmp_path / "msg" / "B.msg").symlink_to(tmp_path / "data" / "B.msg")
    (tmp_path / "data" / "s.yaml").write_text("world: empty\nzebrafish: 1\n")
    (tmp_path / "msg" / "s.yaml").symlink_to("../data/s.yaml")
    monkeypatch.chdir(tmp_path / "msg")
    show = ["interface", "show", f"{tmp_path.name}/msg/B", "--interfaces", "."]
    assert "int64 quokka" in CliRunner().invoke(app, show).output
    assert "'zebrafish'" in CliRunner().invoke(app, ["certify", "s.yaml"]).output


def test_a_link_of_a_built_workspace_hides_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    source, installed = tmp_path / "ws" / "src" / "p", tmp_path / "ws" / "install" / "p" / "share" / "p"
    for folder in (source / "msg", installed / "msg"):
        folder.mkdir(parents=True)
    for name, text in (("package.xml", "<package><name>p</name></package>"), ("msg/B.msg", "int64 quokka\n")):
        (source / name).write_text(text)
        (installed / name).symlink_to(source / name)
    (source / "s.yaml").write_text("world: empty\nzebrafish: 1\n")
    (installed / "s.yaml").symlink_to(source / "s.yaml")
    monkeypatch.chdir(tmp_path)
    show = ["interface", "show", "p/msg/B", "--interfaces", str(installed)]
    assert "int64 quokka" in CliRunner().invoke(app, show).output
    assert "'zebrafish'" in CliRunner().invoke(app, ["certify", str(installed / "s.yaml")]).output


def test_the_links_of_the_users_home_folder_hide_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "disk" / "ws").mkdir(parents=True)
    (tmp_path / "disk" / "ws" / "s.yaml").write_text("world: empty\nzebrafish: 1\n")
    (tmp_path / "home").mkdir()
    (tmp_path / "home" / "ws").symlink_to(tmp_path / "disk" / "ws")
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    found = CliRunner().invoke(app, ["certify", str(tmp_path / "home" / "ws" / "s.yaml")])
    assert "'zebrafish'" in found.output


def test_a_folder_after_a_link_is_the_one_that_the_system_opens(tmp_path: Path) -> None:
    (tmp_path / "private" / "inner").mkdir(parents=True)
    (tmp_path / "private" / "diary").write_text("zebrafish")
    (tmp_path / "stranger").mkdir()
    (tmp_path / "stranger" / "in").symlink_to(tmp_path / "private" / "inner")
    assert linked_files.leads_outside(str(tmp_path / "stranger" / "in" / ".." / "diary"))
    assert not linked_files.leads_outside(os.path.join("/dev/fd", "0"))  # noqa: PTH118


def test_a_command_shows_text_although_its_process_has_read_a_linked_file_before(tmp_path: Path) -> None:
    (tmp_path / "w.sdf").write_text('<sdf version="1.9"><world name="w"><modell name="m"/></world></sdf>')
    hidden_text.hide(str(tmp_path / "linked.yaml"), str(tmp_path))
    output = CliRunner().invoke(app, ["check", str(tmp_path / "w.sdf")]).output
    assert "modell" in output and "not shown" not in output
    assert hidden_text.is_hiding()
