"""Command `simkit replay`: repeat the run in a bundle."""

from __future__ import annotations

import json
import shutil
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Option

from simkit.cli.terminal import options
from simkit.cli.terminal.options import argument, option
from simkit.cli.terminal.output import JsonObject, printable, report_errors, stdout_console
from simkit.errors import InputError
from simkit.writers.atomic_output import current_umask, remove_abandoned, unfinished_folder

if TYPE_CHECKING:
    from simkit.testing.bundles import Bundle, ReplayResult

_MOST = 40  # commands that --list prints
_DIFFERENT = 5


@report_errors
def replay(
    bundle: Annotated[Path, argument("Bundle to repeat.")],
    allow_code: Annotated[
        bool, Option("--allow-code", help="Run the plugin code in the bundle, with all your rights.")
    ] = False,
    list_: Annotated[bool, Option("--list", help="Print the content of the bundle and run nothing.")] = False,
    extract: Annotated[Path | None, option("Extract the files into a new folder and run nothing.", "DIR")] = None,
    record: Annotated[Path | None, option("Bag of the replay to write: OUT.mcap.", "OUT")] = None,
    as_json: options.Json = False,
) -> int:
    """Repeat the run in a bundle and compare the results bit by bit.

    Exit code 0 if the results are bit-identical, 5 if not. A failed run must fail again in the same way.
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

    manifest = found.manifest
    print_ = stdout_console().print
    title = f"{manifest.name}: replayed {found.time:g} s"
    print_(printable(f"{title} with {manifest.commands} commands in {seconds:.1f} s"))
    for text in manifest.missing:
        print_(printable(f"note: {text}"), style="yellow")
    for name, (recorded, current) in found.machine.items():
        text = f"note: {name} is {current or 'none'} here, was {recorded or 'none'}: the bits may differ"
        print_(printable(text), style="yellow")
    if found.failure is not None and found.is_same:
        print_(printable(f"failed as in the bundle: {found.failure.text}"))
    elif manifest.end.failure is not None and manifest.end.failure.kind == CHECK:
        print_(printable(f"failed in the recorded run: {manifest.end.failure.text}"))
    for text in found.differences:
        print_(printable(text), style="red")
    if found.is_same:
        print_(f"state {found.state}")
        print_(f"identical: state, and {found.messages} messages of the last seconds on {len(manifest.streams)} topics")
    else:
        for text in found.refused[:5]:
            print_(printable(f"refused: {text}"), style="yellow")
        print_(f"not identical: {len(found.differences)} differences", style="bold red")


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
    """Write all files, including code. Extracted code is only for reading; it is not run."""
    try:
        if folder.exists() and any(folder.iterdir()):
            raise InputError(f"SK-CLI-016 {folder} is not an empty folder", "SK-CLI-016")
        _extract_whole(bundle, folder.absolute())
    except OSError as error:
        raise InputError(f"SK-CLI-016 cannot write {folder}: {error.strerror or error}", "SK-CLI-016") from None
    text = f"{folder / bundle.manifest.run.world} and {len(bundle.manifest.files) - 1} other files"
    stdout_console().print(printable(text))


def _extract_whole(bundle: Bundle, folder: Path) -> None:
    """Write the files to a temporary folder and move them to an empty or new folder at the end."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    remove_abandoned(folder.parent, folder.name)
    stage = unfinished_folder(folder.parent, folder.name)
    try:
        bundle.extract(stage, with_code=True)
        stage.chmod(0o777 & ~current_umask())
        if folder.exists():  # it may be the folder of the user's shell, so it stays
            for item in sorted(stage.iterdir()):
                item.rename(folder / item.name)
        else:
            stage.rename(folder)
    finally:
        shutil.rmtree(stage, ignore_errors=True)


def _print_contents(bundle: Bundle, *, as_json: bool) -> None:
    manifest = bundle.manifest
    if as_json:
        typer.echo(manifest.text())
        return
    print_ = stdout_console().print
    end = manifest.end
    title = f"{manifest.name}: {end.time_ns / 1e9:g} s, seed {manifest.run.seed}"
    print_(printable(f"{title}, {manifest.commands} commands"))
    print_(printable(f"world {manifest.run.world}" + "".join(f" --set {one}" for one in manifest.run.overrides)))
    print_(printable("created by " + ", ".join(f"{k} {v}" for k, v in manifest.fingerprint.items() if v)))
    print_(f"state {printable(end.state)}")
    if end.failure is not None:
        print_(printable(f"failed: {end.failure.text}"), style="red")
    for text in manifest.missing:
        print_(printable(f"note: {text}"), style="yellow")
    print_(f"{len(manifest.files)} files, {sum(f['size'] for f in manifest.files.values()) / 1000:.0f} kB")
    for name in manifest.code:
        print_(printable(f"code  {name}  ({manifest.files[name]['size']} bytes)"), style="yellow")
    for topic, stream in manifest.streams.items():
        print_(printable(f"last seconds  {topic}  {stream['count']} × {stream['type']}"))
    for number, entry in enumerate(bundle.commands()):
        if number == _MOST:
            print_(f"… {manifest.commands - _MOST} more commands")
            break
        arguments = {k: v for k, v in entry.items() if k not in ("steps", "tick", "do", "served")}
        print_(printable(f"after {entry['steps']} steps  {entry['do']}  {json.dumps(arguments):.160}"))
