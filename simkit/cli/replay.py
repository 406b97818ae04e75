"""The command `simkit replay`: repeat the run in a bundle."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Option

from simkit.cli.terminal import options
from simkit.cli.terminal.options import argument, option
from simkit.cli.terminal.output import JsonObject, report_errors, stdout_console
from simkit.errors import InputError

if TYPE_CHECKING:
    from simkit.testing.bundles import Bundle, ReplayResult

_MOST = 40  # commands that are listed
_DIFFERENT = 5


@report_errors
def replay(
    bundle: Annotated[Path, argument("A bundle.")],
    allow_code: Annotated[
        bool, Option("--allow-code", help="Lets the code of plugins in it run; it may do all that you may.")
    ] = False,
    list_: Annotated[bool, Option("--list", help="Prints what is in it; runs nothing.")] = False,
    extract: Annotated[Path | None, option("Writes its files into a new folder; runs nothing.", "DIR")] = None,
    record: Annotated[Path | None, option("Records all topics of the replay: OUT.mcap.", "OUT")] = None,
    as_json: options.Json = False,
) -> int:
    """Repeats the run in a bundle: exit 0 if it came out the same, bit by bit, exit 5 if not.

    A run that failed has come out the same when it fails again in the same way.
    """
    from simkit.testing.bundles import open_bundle
    from simkit.testing.bundles import replay as play

    if list_ or extract is not None:
        with open_bundle(bundle) as opened:
            if extract is not None:
                _extract(opened, extract)
            if list_:
                _print_contents(opened, as_json=as_json)
        return 0
    begun = time.perf_counter()
    found = play(bundle, allow_code=allow_code, record=record)
    if as_json:
        typer.echo(json.dumps(_result_dict(found)))
    else:
        _print_result(found, time.perf_counter() - begun)
    return 0 if found.is_same else _DIFFERENT


def _print_result(found: ReplayResult, seconds: float) -> None:
    from simkit.testing.bundles.manifest import CHECK

    said = found.manifest
    print_ = stdout_console().print
    print_(printable_text(f"{said.name}: replayed {found.time:g} s with {said.commands} commands in {seconds:.1f} s"))
    for text in said.missing:
        print_(printable_text(f"note: {text}"), style="yellow")
    for name, (there, here) in found.machine.items():
        print_(
            printable_text(f"note: {name} is {here or 'none'} here, was {there or 'none'}: the bits may be others"),
            style="yellow",
        )
    if found.failure is not None and found.is_same:
        print_(printable_text(f"it failed as it did: {found.failure.text}"))
    elif said.end.failure is not None and said.end.failure.kind == CHECK:
        print_(printable_text(f"what did not hold in the run: {said.end.failure.text}"))
    for text in found.differences:
        print_(printable_text(text), style="red")
    if found.is_same:
        print_(f"state {found.state}")
        print_(f"the same: state, and {found.messages} messages of the last seconds on {len(said.streams)} topics")
    else:
        for text in found.refused[:5]:
            print_(printable_text(f"not done: {text}"), style="yellow")
        print_(f"not the same: {len(found.differences)} differences", style="bold red")


def _result_dict(found: ReplayResult) -> JsonObject:
    return {
        "same": found.is_same,
        "differences": list(found.differences),
        "state": found.state,
        "state_in_bundle": found.manifest.end.state,
        "failure": None if found.failure is None else found.failure.text,
        "machine": {name: list(both) for name, both in found.machine.items()},
        "missing": list(found.manifest.missing),
        "refused": list(found.refused),
        "messages": found.messages,
    }


def _extract(bundle: Bundle, folder: Path) -> None:
    """Writes everything, code too: to be read, for nothing runs it."""
    try:
        if folder.exists() and any(folder.iterdir()):
            raise InputError(f"SK-CLI-016 {folder} is not an empty folder", "SK-CLI-016")
        folder.mkdir(parents=True, exist_ok=True)
        bundle.extract(folder, with_code=True)
    except OSError as error:
        raise InputError(f"SK-CLI-016 cannot write {folder}: {error.strerror or error}", "SK-CLI-016") from None
    stdout_console().print(f"{folder / bundle.manifest.world} and {len(bundle.manifest.files) - 1} other files")


def _print_contents(bundle: Bundle, *, as_json: bool) -> None:
    said = bundle.manifest
    if as_json:
        typer.echo(said.text())
        return
    print_ = stdout_console().print
    end = said.end
    print_(printable_text(f"{said.name}: {end.time_ns / 1e9:g} s, seed {said.seed}, {said.commands} commands"))
    print_(printable_text(f"world {said.world}" + "".join(f" --set {one}" for one in said.overrides)))
    print_(printable_text("made by " + ", ".join(f"{k} {v}" for k, v in said.fingerprint.items() if v)))
    print_(f"state {printable_text(end.state)}")
    if end.failure is not None:
        print_(printable_text(f"failed: {end.failure.text}"), style="red")
    for text in said.missing:
        print_(printable_text(f"note: {text}"), style="yellow")
    print_(f"{len(said.files)} files, {sum(f['size'] for f in said.files.values()) / 1000:.0f} kB")
    for name in said.code:
        print_(printable_text(f"code  {name}  ({said.files[name]['size']} bytes)"), style="yellow")
    for topic, one in said.streams.items():
        print_(printable_text(f"last seconds  {topic}  {one['count']} × {one['type']}"))
    for number, entry in enumerate(bundle.commands()):
        if number == _MOST:
            print_(f"… {said.commands - _MOST} more commands")
            break
        words = {k: v for k, v in entry.items() if k not in ("steps", "tick", "do", "served")}
        print_(printable_text(f"after {entry['steps']} steps  {entry['do']}  {json.dumps(words):.160}"))


def printable_text(text: str) -> str:
    """A text of a stranger as a terminal may have it: without what would move its cursor."""
    return "".join(c if c.isprintable() or c == "\n" else "\N{REPLACEMENT CHARACTER}" for c in text)
