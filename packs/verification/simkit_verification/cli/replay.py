"""Repeat the run in a bundle and compare the results bit by bit."""

from __future__ import annotations

import json
import shutil
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Option

from simkit.cli.terminal import options
from simkit.cli.terminal.output import JsonObject, print_json, printable, stdout_console
from simkit.errors import InputError
from simkit.extend import add_to_report, argument, counted, option, report_errors
from simkit.writers.atomic_output import current_umask, remove_abandoned, unfinished_folder

if TYPE_CHECKING:
    from simkit_verification.testing.bundles import Bundle, ReplayResult

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
    json_: options.Json = False,
) -> int:
    """Repeat the run in a bundle and compare the results bit by bit.

    Exit code 0 if the results are bit-identical, 5 if not. A failed run must fail again in the same way.
    """
    from simkit_verification.testing.bundles import open_bundle
    from simkit_verification.testing.bundles import replay as play

    if list_ or extract is not None:
        with open_bundle(bundle) as opened:
            if extract is not None:
                _extract(opened, extract)
            if list_:
                _print_contents(opened, json_=json_)
        return 0
    begun = time.perf_counter()
    result = play(bundle, allow_code=allow_code, record=record)
    if json_:
        print_json(_result_dict(result))
    else:
        _print_result(result, time.perf_counter() - begun)
    return 0 if result.is_same else _DIFFERENT


def _print_result(result: ReplayResult, seconds: float) -> None:
    from simkit_verification.testing.bundles.manifest import CHECK

    manifest = result.manifest
    print_ = stdout_console().print
    title = f"{manifest.name}: replayed {result.time:g} s"
    print_(printable(f"{title} with {counted(manifest.commands, 'command')} in {seconds:.1f} s"))
    for text in manifest.missing:
        print_(printable(f"note: {text}"), style="yellow")
    for name, (recorded, current) in result.machine.items():
        text = f"note: {name} is {current or 'none'} here, was {recorded or 'none'}: the bits may differ"
        print_(printable(text), style="yellow")
    if result.failure is not None and result.is_same:
        print_(printable(f"failed as in the bundle: {result.failure.text}"))
    elif manifest.end.failure is not None and manifest.end.failure.kind == CHECK:
        print_(printable(f"failed in the recorded run: {manifest.end.failure.text}"))
    for text in result.differences:
        print_(printable(text), style="red")
    if result.is_same:
        print_(f"state {result.state}")
        print_(
            f"identical: state, and {counted(result.messages, 'message')} of the last seconds "
            f"on {counted(len(manifest.streams), 'topic')}"
        )
    else:
        for text in result.refused[:5]:
            print_(printable(f"refused: {text}"), style="yellow")
        print_(f"not identical: {counted(len(result.differences), 'difference')}", style="bold red")


def _result_dict(result: ReplayResult) -> JsonObject:
    return {
        "same": result.is_same,
        "differences": list(result.differences),
        "state": result.state,
        "state_in_bundle": result.manifest.end.state,
        "failure": None if result.failure is None else result.failure.text,
        "machine": {name: list(both) for name, both in result.machine.items()},
        "missing": list(result.manifest.missing),
        "refused": list(result.refused),
        "messages": result.messages,
    }


def _extract(bundle: Bundle, folder: Path) -> None:
    """Write all files, including code. Extracted code is only for reading; it is not run."""
    try:
        if folder.exists() and any(folder.iterdir()):
            raise InputError("SK-CLI-016", f"{folder} is not an empty folder")
        _extract_whole(bundle, folder.absolute())
    except OSError as error:
        raise InputError("SK-CLI-016", f"cannot write {folder}: {error.strerror or error}") from None
    world, count = folder / bundle.manifest.run.world, len(bundle.manifest.files)
    add_to_report(world=str(world), files=count)
    stdout_console().print(printable(f"{world} and {counted(count - 1, 'other file')}"))


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


def _print_contents(bundle: Bundle, *, json_: bool) -> None:
    manifest = bundle.manifest
    if json_:
        print_json(json.loads(manifest.text()), indent=1)
        return
    print_ = stdout_console().print
    end = manifest.end
    title = f"{manifest.name}: {end.time_ns / 1e9:g} s, seed {manifest.run.seed}"
    print_(printable(f"{title}, {manifest.commands} commands"))
    print_(
        printable(f"world {manifest.run.world}" + "".join(f" --set {override}" for override in manifest.run.overrides))
    )
    print_(printable("created by " + ", ".join(f"{k} {v}" for k, v in manifest.fingerprint.items() if v)))
    print_(f"state {printable(end.state)}")
    if end.failure is not None:
        print_(printable(f"failed: {end.failure.text}"), style="red")
    for text in manifest.missing:
        print_(printable(f"note: {text}"), style="yellow")
    print_(f"{counted(len(manifest.files), 'file')}, {sum(f['size'] for f in manifest.files.values()) / 1000:.0f} kB")
    for name in manifest.code:
        print_(printable(f"code  {name}  ({counted(manifest.files[name]['size'], 'byte')})"), style="yellow")
    for topic, stream in manifest.streams.items():
        print_(printable(f"last seconds  {topic}  {stream['count']} × {stream['type']}"))
    for number, entry in enumerate(bundle.commands()):
        if number == _MOST:
            print_(f"… {counted(manifest.commands - _MOST, 'more command')}")
            break
        arguments = {k: v for k, v in entry.items() if k not in ("steps", "tick", "do", "served")}
        print_(printable(f"after {counted(entry['steps'], 'step')}  {entry['do']}  {json.dumps(arguments):.160}"))
