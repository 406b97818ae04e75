"""Processes of the servers for Foxglove and rosbridge: their options, and their start by the simulation's process."""

from __future__ import annotations

import importlib.util
import os
import re
import secrets
from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Final

from simkit.bridges.bridge_process import BridgeCodes, BridgeProcess
from simkit.errors import InputError
from simkit.install_command import install_command
from simkit_view.web.access import is_loopback

TOKEN_VARIABLE: Final = "SIMKIT_WEB_TOKEN"
_TITLES: Final = MappingProxyType({"foxglove": "server for Foxglove", "rosbridge": "rosbridge server"})
_PORTS: Final = MappingProxyType({"foxglove": 8765, "rosbridge": 9090})
_PACKAGES: Final = MappingProxyType({"foxglove": ("websockets",), "rosbridge": ("websockets", "cbor2")})
_ADDRESS: Final = re.compile(r"(?:(?P<host>[^\s/:]+|\[[0-9A-Fa-f:]+\]):)?(?P<port>\d+)")
_MOST_PORT: Final = 65535


@dataclass(frozen=True)
class WebOptions:
    """Options of a server.

    Attributes:
        kind: `foxglove` or `rosbridge`.
        host: name or number of the address.
        port: port; 0 for a free one.
        token: token that clients must send; empty for none.
    """

    kind: str
    host: str
    port: int
    token: str

    @classmethod
    def parse(cls, kind: str, address: str) -> WebOptions:
        """Return the options for `[HOST:]PORT`; an empty address is the default port of this machine.

        The token is that of the environment. On an address that other machines reach, it is else a random one.

        Raises:
            InputError: SK-WEB-003 the address is invalid.
        """
        match = _ADDRESS.fullmatch(address or str(_PORTS[kind]))
        if match is None or int(match["port"]) > _MOST_PORT:
            text = f"--{kind}: found {address!r}; expected [HOST:]PORT with a port from 0 to {_MOST_PORT}"
            raise InputError("SK-WEB-003", text)
        host = (match["host"] or "127.0.0.1").strip("[]")
        token = os.environ.get(TOKEN_VARIABLE, "")
        return cls(kind, host, int(match["port"]), token or ("" if is_loopback(host) else secrets.token_urlsafe(12)))


_CODES = BridgeCodes("SK-WEB-002", "SK-WEB-004", "SK-WEB-005")


class WebBridge(BridgeProcess):
    """Process of a server.

    Args:
        options: options of the server.
        report: callback for a line to the user.

    Raises:
        InputError: SK-WEB-001 a package that the server needs is not installed.
    """

    def __init__(self, options: WebOptions, report: Callable[[str], None]) -> None:
        kind = options.kind
        missing = [name for name in _PACKAGES[kind] if importlib.util.find_spec(name) is None]
        if missing:
            text = f"--{kind} needs the package {missing[0]}, which is not installed"
            raise InputError("SK-WEB-001", text, help=install_command(kind))
        self._options = options
        settings = {"host": options.host, "port": options.port, "token": options.token}
        super().__init__(_TITLES[kind], _CODES, f"simkit_view.web.{kind}_server", settings, report)

    def _start_help(self, reason: str) -> str:
        if "cannot be used" not in reason:
            return ""
        return f"choose another port, such as --{self._options.kind} 0 for a free one"

    def _ready_text(self, line: Any) -> str:
        host = f"[{self._options.host}]" if ":" in self._options.host else self._options.host
        token = f"/?token={self._options.token}" if self._options.token else ""
        return f"{self._options.kind}: ws://{host}:{line}{token}"
