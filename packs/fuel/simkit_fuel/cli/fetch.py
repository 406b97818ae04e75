"""Download the models that a world names on Fuel servers."""

from __future__ import annotations

import os
from typing import Annotated
from urllib.parse import urlsplit

from typer import Option

from simkit.cli.run_options import NONE_GIVEN
from simkit.cli.terminal import completion, options
from simkit.cli.terminal.output import print_diagnostics, print_line, print_note
from simkit.errors import InputError
from simkit.extend import GivenOptions, add_to_report, argument, option, report_errors, with_run_options

LISTED_AFTER = "vendor"

_SERVER = "GZ_FUEL_SERVER"


@report_errors
@with_run_options("file", without={"base": "models do not depend on the base"})
def fetch(
    world: Annotated[
        str, argument("World or model file, bare name, or Fuel URL.", "WORLD", complete=completion.worlds)
    ],
    dry_run: Annotated[bool, Option("--dry-run", help="List what would be downloaded, with sizes.")] = False,
    update: Annotated[
        bool, Option("--update", help="Take the newest versions, and write them to simkit.lock.")
    ] = False,
    server: Annotated[
        str | None, option(f"Server to use instead of those in the URLs; default: ${_SERVER}.", "URL", "--server")
    ] = None,
    max_size: Annotated[float, option("Largest archive in MB.", "MB", "--max-size", min=0)] = 2000.0,
    max_total: Annotated[float, option("Largest sum of all archives in MB.", "MB", "--max-total", min=0)] = 10000.0,
    timeout: Annotated[
        float, option("Longest time in seconds for an answer, and for each 100 kB.", "S", "--timeout", min=0.001)
    ] = 30.0,
    max_time: Annotated[
        float, option("Longest time in seconds for everything.", "S", "--max-time", min=0.001)
    ] = 21600.0,
    allow_http: Annotated[
        bool, Option("--allow-http", help="Allow servers without encryption on other computers.")
    ] = False,
    given: GivenOptions = NONE_GIVEN,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors` reads it)
) -> int:
    """Download the models that a world names on Fuel servers."""
    from simkit_fuel.download import Connection
    from simkit_fuel.fetch import FetchOptions, FetchReport
    from simkit_fuel.fetch import fetch as run

    chosen = FetchOptions(
        server=_server(server),
        connection=Connection(timeout, allow_http),
        max_size=_bytes(max_size, "--max-size"),
        max_total=_bytes(max_total, "--max-total"),
        max_time=max_time,
        update=update,
        dry_run=dry_run,
    )
    source = given.source_options()
    report: FetchReport = run(
        world,
        chosen,
        resource_paths=source.get("resource_paths", ()),
        package_paths=source.get("package_paths", ()),
        xacro_args=source.get("xacro_args"),
    )
    keys = ("state", "url", "version", "size")
    add_to_report(
        resources=[{key: getattr(resource, key) for key in keys} for resource in report.resources],
        problems=[diagnostic.as_dict() for diagnostic in report.diagnostics],
        lock=None if report.lock is None else str(report.lock),
    )
    for resource in report.resources:
        version = f", version {resource.version}" if resource.version else ""
        size = f", {resource.size / 1e6:.3g} MB" if resource.size is not None else ""
        print_line(f"{resource.state}: {resource.url}{version}{size}")
    print_diagnostics(report.diagnostics, verbose=True)
    new = [resource for resource in report.resources if resource.state in ("fetched", "to fetch")]
    if report.resources:
        what = "to fetch, and what these name" if dry_run else "fetched"
        total = sum(resource.size or 0 for resource in new) / 1e6
        print_note(f"{len(new)} {what} ({total:.3g} MB), {len(report.resources) - len(new)} were there")
    elif not report.exit_code:
        print_note(f"{world} names nothing on a Fuel server")
    if report.lock is not None:
        print_note(f"wrote {report.lock}")
    return report.exit_code


def _bytes(megabytes: float, name: str) -> int:
    if not megabytes < 1e9:  # also NaN
        raise InputError("SK-CLI-018", f"{name}: found {megabytes}; expected a number of MB below 1e9")
    return int(megabytes * 1e6)


def _server(address: str | None) -> str:
    """Return the server of the option or of the environment variable, without a slash at its end."""
    name, text = ("--server", address) if address is not None else (_SERVER, os.environ.get(_SERVER, ""))
    try:
        parts = urlsplit(text)
        is_server = parts.scheme in ("http", "https") and parts.hostname and parts.username is None
        is_server = bool(is_server) and parts.port != 0 and not parts.query and not parts.fragment
    except ValueError:
        is_server = False
    if text and not is_server:
        message = f"{name}: found {text!r:.200}; expected a URL such as https://fuel.gazebosim.org"
        raise InputError("SK-CLI-018", message)
    return text.rstrip("/")
