"""Command `simkit run`: run a world without a window, as fast as possible."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer
from typer import Option
from typer.core import TyperCommand

from simkit.bridges.teleop import KEY_TIMEOUT
from simkit.cli.failure_bundle import DEFAULT_FOLDER as BUNDLES
from simkit.cli.failure_bundle import FailureBundle
from simkit.cli.gazebo_options import remove_gazebo_options
from simkit.cli.run_display import RunDisplay
from simkit.cli.run_options import NONE_GIVEN, PARTS, GivenOptions, with_run_options
from simkit.cli.terminal import film_options, options, page_options, ros_options, web_options
from simkit.cli.terminal.blocked_plugins import BlockedPlugins
from simkit.cli.terminal.json_report import add_diagnostics, end_with_error, report_errors_and_json
from simkit.cli.terminal.options import option
from simkit.cli.terminal.output import print_diagnostics, print_status
from simkit.diagnostics import Diagnostic
from simkit.errors import LoadError
from simkit.garbage_collection import permanent_imports
from simkit.run_spec import Recording, RunSpec

_TOPIC = re.compile(r"/[A-Za-z0-9_/]*")


class RunCommand(TyperCommand):
    """Command that answers options of Gazebo, with options that work with or without a value.

    The latter are `--teleop`, `--bundle-on-failure`, `--foxglove`, `--rosbridge` and `--web`.

    The next word is the topic of `--teleop` if the word begins with a slash and is not a file. The next word is the
    folder of `--bundle-on-failure` if the folder exists, if the word ends with a slash, or if the world is the first
    argument.
    """

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Insert the default value of these options if the command line has the option without a value."""
        args = ros_options.join_ros_arguments(args) if "--ros" in args else args
        completed: list[str] = []
        for index, word in enumerate(args):
            if word == "--":
                completed += args[index:]
                break
            following = args[index + 1] if index + 1 < len(args) else ""
            if word == "--teleop" and (not _TOPIC.fullmatch(following) or Path(following).exists()):
                word = "--teleop="
            if word == "--web" and not page_options.PORT.fullmatch(following):
                word = "--web=0"
            if word in web_options.NAMES and not web_options.ADDRESS.fullmatch(following):
                word += "="
            if word == "--bundle-on-failure":
                is_folder = following.endswith("/") or Path(following or "-").is_dir() or args[0][0:1] != "-"
                if following.startswith("-") or not following or not is_folder:
                    word = f"--bundle-on-failure={BUNDLES}"
            completed.append(word)
        if not ctx.resilient_parsing:
            completed = self._without_gazebo_options(completed)
        return super().parse_args(ctx, completed)

    def _without_gazebo_options(self, args: list[str]) -> list[str]:
        """Remove options of Gazebo that need no action, with a note; for other options of Gazebo, end the command."""
        options_with_value = {
            name for each in self.params if not getattr(each, "is_flag", True) for name in each.opts if name[0] == "-"
        }
        try:
            remaining, notes = remove_gazebo_options(args, options_with_value)
        except LoadError as error:
            end_with_error(error, json_="--json" in args)
        for note in notes:
            print_status(f"note: {note}")
        return remaining


COMMAND = RunCommand


_KEY_TIMEOUT_HELP = "Simulated seconds without a key after which --teleop stops; inf: never."
_BUNDLE_HELP = "Write a bundle for simkit replay into this folder if the run fails; default: bundles/."

KeyTimeout = Annotated[float, option(_KEY_TIMEOUT_HELP, "S")]
BundleFolder = Annotated[Path | None, option(_BUNDLE_HELP, "[DIR]")]


@report_errors_and_json
@with_run_options(*PARTS, usual={"duration": "until Ctrl-C"})
def run(
    world: options.World,
    given: GivenOptions = NONE_GIVEN,
    record: Annotated[Path | None, option("Bag to write: NAME.mcap, else a rosbag2 folder.", "OUT")] = None,
    force: options.Force = False,
    teleop: Annotated[str | None, option("Drive with the keyboard, on this velocity topic.", "[TOPIC]")] = None,
    key_timeout: KeyTimeout = KEY_TIMEOUT,
    view: Annotated[bool, Option("--view", help="Show the run in a viewer window.")] = False,
    picture: Annotated[Path | None, option("Picture of the end to write, with path and scan.", "OUT.png")] = None,
    gif: film_options.Gif = None,
    video: film_options.Video = None,
    resolution: film_options.Resolution = None,
    fps: film_options.Fps = None,
    camera: film_options.FilmCamera = "auto",
    watch: Annotated[bool, Option("--watch", help="Reload a plugin when its file changes.")] = False,
    bundle_on_failure: BundleFolder = None,
    verbose: options.Verbose = False,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors_and_json` reads it)
    quiet: Annotated[bool, Option("--quiet", "-q", help="Print no table of topics at the end.")] = False,
    junit: Annotated[Path | None, option("JUnit XML report to write.", "FILE.xml")] = None,
    ros: ros_options.Ros = False,
    ros_python: ros_options.RosPython = None,
    ros_domain: ros_options.RosDomain = None,
    ros_namespace: ros_options.RosNamespace = None,
    ros_network: ros_options.RosNetwork = False,
    ros_args: ros_options.RosArguments = None,
    foxglove: web_options.Foxglove = None,
    rosbridge: web_options.Rosbridge = None,
    web: page_options.Web = None,
    host: page_options.Host = None,
    no_open: page_options.NoOpen = False,
) -> int:
    """Run a world without a window, as fast as possible."""
    spec = given.run_spec(world, duration=math.inf)
    spec = replace(
        spec,
        duration=spec.duration if math.isfinite(spec.duration) else math.inf,
        recording=None if record is None else Recording(record, overwrite=force),
        pace=highest_pace(spec.pace, is_watched=view or teleop is not None or web is not None),
    )
    key_timeout = _timeout(key_timeout)
    bridge = ros_options.run_ros_options(ros, ros_python, ros_domain, ros_namespace, ros_network, ros_args)
    servers = web_options.web_options(foxglove=foxglove, rosbridge=rosbridge)
    film = None
    if (gif, video, resolution, fps, camera) != (None, None, None, None, "auto"):
        from simkit.recording.films.film import film_options as read_film_options  # 7 ms

        film = read_film_options(gif, video, resolution, fps, camera)
    page = page_options.page_options(web, host, no_open=no_open)
    display = RunDisplay(
        view, picture, teleop, key_timeout, verbose, quiet, watch, junit, bundle_on_failure, bridge, servers, film, page
    )
    return execute(spec, display)


def _timeout(seconds: float) -> float:
    """Validate the value of --key-timeout."""
    if not seconds > 0:
        raise typer.BadParameter(f"{seconds} is not greater than 0", param_hint="--key-timeout")
    return seconds


def highest_pace(rtf: float | None, *, is_watched: bool) -> float | None:
    """Return the highest real-time factor; None for no limit.

    The default is 1 for runs with a viewer or teleop, else no limit.
    """
    if rtf is None:
        return 1.0 if is_watched else None
    return rtf if math.isfinite(rtf) else None


def _print_model_world(found: Iterable[Diagnostic]) -> None:
    """Print the note about the ground of a bare model, which a user may not expect."""
    for note in found:
        if note.code == "SK-SPAWN-005":
            print_status(f"note: {note.message} ({note.hint})")


def execute(spec: RunSpec, display: RunDisplay) -> int:
    """Run a specification and return the exit code.

    Raises:
        SimkitError: the run failed; the recording up to the failure is complete.
    """
    with permanent_imports():
        from simkit.bridges import viewer
        from simkit.build import load
        from simkit.cli.run_bridges import open_bridges
        from simkit.cli.run_session import Session, check_keyboard
        from simkit.cli.run_verdict import RunVerdict

    if spec.recording is not None:
        from simkit.recording.bags import writer  # 3 ms: the formats of bags

        writer.check_target(spec.recording.path, overwrite=spec.recording.overwrite)
    if display.picture is not None:
        from simkit.recording import run_picture

        run_picture.check_target(display.picture)
    if display.view:
        viewer.check_possible()
    check_keyboard(display)
    with (
        open_bridges(display) as bridges,
        RunVerdict(spec, display.junit) as verdict,
        BlockedPlugins(print_status) as blocked,
        FailureBundle(display.bundles, verdict, spec) as bundling,
    ):
        sim = load(spec.world, **spec.load_arguments())
        with sim:
            bundling.keep(sim)
            try:
                print_diagnostics(sim.diagnostics, verbose=display.verbose)
                if not display.verbose:
                    _print_model_world(sim.diagnostics)
                verdict.code = Session(spec, display, sim, blocked, verdict, bridges).execute()
            finally:
                add_diagnostics(sim.diagnostics)
    return verdict.code
