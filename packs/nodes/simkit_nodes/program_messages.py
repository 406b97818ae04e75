"""Classes of messages in the flavour of ROS of the program that runs, for libraries that both flavours have."""

from __future__ import annotations

from simkit_nodes.host import current_program
from simkit_nodes.interfaces import ROS2, ProgramMessage


def message_class(type_name: str) -> type[ProgramMessage]:
    """Return the class of a message type for the present program; that of ROS 2 outside programs."""
    try:
        flavour = current_program().flavour
    except RuntimeError:
        flavour = ROS2
    return flavour.message_class(type_name)


def new_message(type_name: str) -> ProgramMessage:
    """Return a new message for the present program; see `message_class`."""
    return message_class(type_name)()
