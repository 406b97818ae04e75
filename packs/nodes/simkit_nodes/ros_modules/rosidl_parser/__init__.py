"""Types of the fields of messages, as programs of ROS 2 read them in `SLOT_TYPES`."""

__all__: list[str] = []
