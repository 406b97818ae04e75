"""URLs of Fuel servers, and the cache folders in which Gazebo and `simkit fetch` store what they download."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from urllib.parse import quote, unquote

from simkit.diagnostics import Diagnostic
from simkit.errors import LoadError
from simkit.home_folder import home_folder
from simkit.input_file import read_failure, read_input_text
from simkit.json_reader import parse_json
from simkit.loaders.resources.uris import is_small_integer

TIP = "tip"
KINDS = ("models", "worlds")
LOCK_NAME = "simkit.lock"
_CACHE_VARIABLES = ("GZ_FUEL_CACHE_PATH", "IGN_FUEL_CACHE_PATH")
_FORMER_SERVER, _SERVER = "fuel.ignitionrobotics.org", "fuel.gazebosim.org"
_HOST = re.compile(r"([A-Za-z0-9][A-Za-z0-9.-]{0,252}|\[[0-9A-Fa-f:]{2,39}\])(:[0-9]{1,5})?")
_API_VERSION = re.compile(r"[0-9]{1,4}(\.[0-9]{1,4})?")
_UNUSABLE = re.compile(r"[\x00-\x1f\x7f\\]")
_SHA256 = re.compile(r"[0-9a-f]{64}")
_LOCK_LIMIT = 8 << 20  # [bytes]


@dataclass(frozen=True)
class FuelUrl:
    """URL of a model or world on a Fuel server, or of a file in it.

    Attributes:
        scheme: `http` or `https`.
        host: name of the server, with its port if the URL has one.
        api: version of the server's interface.
        owner, kind, name: user, `models` or `worlds`, and name of the resource.
        version: number of the version, or `tip` for the newest.
        inside: path of a file in the resource; empty for the resource itself.
    """

    scheme: str
    host: str
    api: str
    owner: str
    kind: str
    name: str
    version: str = TIP
    inside: str = ""

    @property
    def resource(self) -> FuelUrl:
        """URL of the model or world, without a file in it."""
        return replace(self, inside="")

    @property
    def key(self) -> str:
        """Text that is equal for all spellings of a resource: Fuel ignores upper and lower case."""
        version = "" if self.version == TIP else f"/{self.version}"
        return f"{self.host}/{self.owner}/{self.kind}/{self.name}".lower() + version

    @property
    def title(self) -> str:
        """Short name for messages."""
        return f"{self.owner}/{self.kind}/{self.name}"

    def __str__(self) -> str:
        version = "" if self.version == TIP and not self.inside else f"/{self.version}"
        inside = f"/files/{self.inside}" if self.inside else ""
        return f"{self.scheme}://{self.host}/{self.api}/{self.owner}/{self.kind}/{self.name}{version}{inside}"

    def address(self, server: str = "", version: str = "") -> str:
        """Return the address of the ZIP archive.

        Args:
            server: another server, such as `https://example.org`; default: the URL's own server.
            version: version to request; default: the URL's own version.
        """
        host = _SERVER if self.host.lower() == _FORMER_SERVER else self.host
        path = (self.api, self.owner, self.kind, self.name, version or self.version, f"{self.name}.zip")
        return "/".join((server or f"{self.scheme}://{host}", *(quote(part, safe="") for part in path)))

    def folders(self, cache: Path) -> list[Path]:
        """Return the folders of the resource in a cache, first the one in which new versions are stored."""
        host = self.host.lower()
        hosts = dict.fromkeys((host, *((_SERVER, _FORMER_SERVER) if host in (_SERVER, _FORMER_SERVER) else ())))
        spellings = ((self.owner.lower(), self.name.lower()), (self.owner, self.name))
        return list(
            dict.fromkeys(cache / name / owner / self.kind / model for name in hosts for owner, model in spellings)
        )


@dataclass(frozen=True)
class LockEntry:
    """Entry of `simkit.lock`: the archive of one resource.

    Attributes:
        name: short name, for readers.
        url: URL of the resource, as it was first named.
        version: version number of the resource.
        sha256: SHA-256 of the ZIP archive, as hexadecimal text.
        size: size of the ZIP archive [bytes].
    """

    name: str
    url: str
    version: int
    sha256: str
    size: int


def parse_fuel_url(uri: str) -> FuelUrl | None:
    """Parse the URL of a model, a world or a file on a Fuel server; return None for any other URI."""
    scheme, separator, rest = uri.strip().partition("://")
    host, _, path = rest.partition("/")
    parts = [unquote(part) for part in path.split("/") if part]
    if scheme.lower() not in ("http", "https") or not separator or not _HOST.fullmatch(host):
        return None
    if any(part in (".", "..") or _UNUSABLE.search(part) or "/" in part or len(part.encode()) > 240 for part in parts):
        return None
    api = parts.pop(0) if parts and _API_VERSION.fullmatch(parts[0]) else "1.0"
    if len(parts) < 3 or parts[1] not in KINDS:
        return None
    owner, kind, name, *tail = parts
    version = tail.pop(0) if tail and tail[0] != "files" else TIP
    if version != TIP and not (is_small_integer(version) and int(version)):
        return None
    if tail and (tail[0] != "files" or len(tail) == 1):
        return None
    version = version if version == TIP else str(int(version))
    return FuelUrl(scheme.lower(), host, api, owner, kind, name, version, "/".join(tail[1:]))


def fuel_caches() -> list[Path]:
    """Return the cache folders; `simkit fetch` stores in the first one."""
    named = [Path(p) for v in _CACHE_VARIABLES for p in os.environ.get(v, "").split(os.pathsep) if p]
    home = home_folder()
    return [*named, home / ".gz" / "fuel", home / ".ignition" / "fuel"]


def cached_versions(url: FuelUrl, locked: int | None = None) -> Iterator[Path]:
    """Yield the cached folders of a resource, the newest version first.

    Args:
        url: resource; if the URL has a version, only folders of this version are yielded.
        locked: version that `simkit.lock` lists; it replaces the newest version of a URL without a version.
    """
    wanted = str(locked) if locked is not None and url.version == TIP else url.version
    for cache in fuel_caches():
        for folder in url.folders(cache):
            numbers = sorted((int(p.name) for p in folder.glob("*") if is_small_integer(p.name)), reverse=True)
            names = [str(number) for number in numbers if wanted in (TIP, str(number))]
            yield from (folder / name for name in names or ([] if numbers else [wanted]))


def read_lock(path: Path) -> dict[str, LockEntry]:
    """Read `simkit.lock`; return its entries by `FuelUrl.key`, and no entry if the file does not exist.

    Raises:
        LoadError: SK-FETCH-007 the file is not a lock file of simkit.
    """
    try:
        content = parse_json(read_input_text(path, _LOCK_LIMIT, inside=path.parent))
    except FileNotFoundError:
        return {}
    except (OSError, UnicodeDecodeError) as error:
        raise _invalid_lock(path, f"it cannot be read: {read_failure(error)}") from None
    except ValueError as error:
        raise _invalid_lock(path, f"it is not JSON: {error}") from None
    if not isinstance(content, Mapping) or content.get("format") != 1 or not isinstance(content.get("entries"), list):
        raise _invalid_lock(path, 'it has no {"format": 1, "entries": [...]}')
    entries = {}
    for number, item in enumerate(content["entries"]):
        url = parse_fuel_url(item["url"]) if isinstance(item, Mapping) and isinstance(item.get("url"), str) else None
        if url is None or not _is_entry(item):
            raise _invalid_lock(path, f"entry {number} needs name, url, version, sha256 and size")
        entries[url.key] = LockEntry(str(item["name"]), item["url"], item["version"], item["sha256"], item["size"])
    return entries


def _is_entry(item: Mapping[str, object]) -> bool:
    version, size, digest = item.get("version"), item.get("size"), item.get("sha256")
    are_numbers = type(version) is int and type(size) is int and 0 < version < 10**9 and 0 <= size < 1 << 53
    return are_numbers and isinstance(digest, str) and bool(_SHA256.fullmatch(digest)) and "name" in item


def _invalid_lock(path: Path, reason: str) -> LoadError:
    hint = "delete the file, and `simkit fetch` writes a new one"
    message = f"this is not a lock file of simkit fetch: {reason:.300}"
    return LoadError([Diagnostic("SK-FETCH-007", "error", message, str(path), hint=hint)])
