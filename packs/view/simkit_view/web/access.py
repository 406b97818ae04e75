"""Rules about who may connect to a server: token, origin of the page, and name of the host."""

from __future__ import annotations

import hmac
import ipaddress
import logging
from typing import Final
from urllib.parse import SplitResult, parse_qs, urlsplit

_FOXGLOVE_PAGE: Final = "app.foxglove.dev"
_MOST_FIELDS: Final = 100  # in the query of an address


def is_loopback(host: str) -> bool:
    """Check whether only this machine reaches an address."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def is_token(text: str, token: str) -> bool:
    """Compare a token that a client has sent, in a time that does not depend on its letters."""
    return hmac.compare_digest(text.encode(errors="surrogatepass"), token.encode())


def has_token(path: str, token: str) -> bool | None:
    """Check the token in an address; None if the address has none."""
    address = split_address(path)
    try:
        tokens = parse_qs(address.query, max_num_fields=_MOST_FIELDS).get("token") if address else None
    except ValueError:  # too many fields
        return False
    return is_token(tokens[0], token) if tokens else None


def is_known_origin(origin: str | None) -> bool:
    """Check whether a page may connect without a token: a page of this machine or Foxglove's own, or no page at all."""
    if origin is None:
        return True
    parts = split_address(origin)
    if parts is None:
        return False
    if parts.scheme in ("http", "https"):
        return is_loopback(parts.hostname or "") or parts.hostname == _FOXGLOVE_PAGE
    return bool(parts.scheme)  # "null" may be any page; pages cannot choose another scheme, such as that of an app


def is_own_origin(origin: str | None, host: str) -> bool:
    """Check whether a request comes from a page of this server, or from no page.

    Args:
        origin: value of the header `Origin`; None without one.
        host: value of the header `Host`.
    """
    if origin is None:
        return True
    address = split_address(origin)
    return address is not None and address.netloc == host


def quiet_logger(name: str) -> logging.Logger:
    """Return a logger that drops the messages of websockets about clients that break the rules."""
    log = logging.getLogger(name)
    log.setLevel(logging.CRITICAL + 1)
    return log


def split_address(text: str) -> SplitResult | None:
    """Split an address of a request into its parts; None if it is malformed, such as `http://[::1`."""
    try:
        address = urlsplit(text)
        address.hostname, address.port  # noqa: B018 (both raise for a malformed address)
    except ValueError:
        return None
    return address if max(map(address.netloc.count, "[]")) <= 1 else None
