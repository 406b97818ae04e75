"""Connect a running simulation to ROS 2 until the simulation ends, or until Ctrl-C."""

from __future__ import annotations

from typing import Annotated, Any

import typer
from typer.core import TyperCommand

from simkit.cli.run_loop import Interrupts
from simkit.cli.terminal import completion, options
from simkit.cli.terminal.output import print_message, without_interrupt_message
from simkit.extend import add_to_report, argument, report_errors
from simkit_ros.cli.run_parts import ros as ros_options


class RosCommand(TyperCommand):
    """Command that accepts the arguments of ROS after `--ros-args`."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Join the arguments of ROS to one value and parse all options."""
        return super().parse_args(ctx, ros_options.join_ros_arguments(args))


COMMAND = RosCommand
Simulation = Annotated[
    str | None, argument("Name of the running simulation, if several run.", "[SIM]", completion.simulations)
]


@report_errors
@without_interrupt_message
def ros(
    simulation: Simulation = None,
    ros_python: ros_options.RosPython = None,
    ros_domain: ros_options.RosDomain = None,
    ros_namespace: ros_options.RosNamespace = None,
    ros_network: ros_options.RosNetwork = False,
    ros_args: ros_options.RosArguments = None,
    sim: options.Sim = None,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors` reads it)
) -> int:
    """Connect a running simulation to ROS 2 until the simulation ends, or until Ctrl-C."""
    from simkit.bridges.live.discovery import find_socket
    from simkit_ros.bridge_process import RosBridge

    if simulation is not None and sim is not None and simulation != sim:
        raise typer.BadParameter(f"found {simulation!r} and --sim {sim}; expected one name", param_hint="SIM")
    bridge_options = ros_options.ros_options(ros_python, ros_domain, ros_namespace, ros_network, ros_args)
    socket = find_socket(simulation or sim)
    add_to_report(socket=str(socket))
    with Interrupts() as interrupts, RosBridge(bridge_options, print_message) as bridge:
        bridge.start(socket)
        code = bridge.wait(lambda: bool(interrupts.exit_code))
    return interrupts.exit_code or code
