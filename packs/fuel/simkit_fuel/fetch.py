"""Download of everything that a world names on Fuel servers, with a lock file beside the world."""

from __future__ import annotations

import hashlib
import json
import os
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from io import BufferedRandom
from itertools import islice
from pathlib import Path
from urllib.parse import urlsplit

from simkit import file_lock, progress
from simkit.errors import InputError
from simkit.extend import Diagnostics, Where
from simkit.loaders import Resolver, find_document
from simkit.loaders.resources.bundled_models import bundled_folders
from simkit.loaders.resources.fuel_cache import (
    LOCK_NAME,
    TIP,
    FuelUrl,
    LockEntry,
    cached_versions,
    fuel_caches,
    parse_fuel_url,
    read_lock,
)
from simkit.loaders.sdf.load_context import MAX_INCLUDE_DEPTH
from simkit.run_files import FilePath, PackagePaths
from simkit.run_values import NamedValues
from simkit.writers.atomic_output import write_atomically
from simkit_fuel.cache_entry import STAGE, Record, archive_record, exclusive_file, read_record, store
from simkit_fuel.download import (
    MISSING,
    NETWORK,
    TOO_LARGE,
    Connection,
    Download,
    DownloadError,
    remote_size,
)
from simkit_fuel.references import Reference, ReferenceSearch

OTHER_CONTENT, NO_LOCK, PRIVATE = "SK-FETCH-005", "SK-FETCH-009", "SK-FETCH-010"
_UNPACKED_RATIO = 4  # the files of an archive may have this many times the limit of the archive
_MOST_RESOURCES = 2000
_MOST_REFERENCES = 100_000  # places in files that name a resource
_MOST_LISTED = 30


@dataclass(frozen=True)
class FetchOptions:
    """Options of a download.

    Attributes:
        server: server to use instead of the servers in the URLs; empty for these.
        connection: rules for connections.
        max_size: largest archive [bytes].
        max_total: largest sum of all archives of one run [bytes].
        max_time: longest time of the whole run [s].
        update: replaces locked and cached resources by the newest versions of the server.
        dry_run: downloads and writes nothing.
    """

    server: str = ""
    connection: Connection = field(default_factory=Connection)
    max_size: int = 2 * 10**9
    max_total: int = 10 * 10**9
    max_time: float = 6 * 3600.0
    update: bool = False
    dry_run: bool = False


@dataclass(frozen=True)
class FetchedResource:
    """One model or world that a world names.

    Attributes:
        url: its URL, as it was first named.
        state: `fetched`, `in the cache`, `on this machine` (a folder of the search path) or `to fetch` (a dry run).
        version: version number, if it is known.
        size: size of the archive [bytes], if it is known.
        folder: its folder on this machine; None in a dry run.
        record: checksum of its archive; None if simkit did not download it.
    """

    url: FuelUrl
    state: str
    version: int | None = None
    size: int | None = None
    folder: Path | None = None
    record: Record | None = None


@dataclass
class FetchReport:
    """Result of a download.

    Attributes:
        resources: every resource that was found, in the order of the files.
        diagnostics: problems.
        lock: lock file that was written; None if it did not change.
    """

    resources: list[FetchedResource] = field(default_factory=list)
    diagnostics: Diagnostics = field(default_factory=Diagnostics)
    lock: Path | None = None

    @property
    def exit_code(self) -> int:
        """0 if all is there; 2 if something is missing or refused; 1 if only the network failed."""
        codes = {d.code for d in self.diagnostics if d.severity == "error"}
        return 0 if not codes else 1 if codes == {NETWORK} else 2


def fetch(
    source: str,
    options: FetchOptions,
    *,
    resource_paths: Sequence[FilePath] = (),
    package_paths: PackagePaths = (),
    xacro_args: NamedValues | None = None,
) -> FetchReport:
    """Download the models, worlds and files that a world names into the cache, and write `simkit.lock` beside it.

    Args:
        source: file or bundled name of a world or model, or a Fuel URL.
        options: server, limits and kind of the download.
        resource_paths: search folders for URIs.
        package_paths: ROS package -> folder as `NAME=DIR`, or workspaces.
        xacro_args: arguments of a xacro file.

    Raises:
        LoadError: the source cannot be read, or SK-FETCH-007 the lock file is invalid.
        InputError: SK-CLI-016 the cache is not writable.
    """
    options = replace(options, connection=replace(options.connection, end=time.monotonic() + options.max_time))
    report = FetchReport()
    resolver = Resolver(resource_paths, missing_meshes=True, package_paths=package_paths)
    search = ReferenceSearch(resolver, report.diagnostics)
    lock_folder = Path.cwd()
    url = parse_fuel_url(source)
    if url is not None:
        first: Iterable[Reference] = [Reference(url.resource, Where(source))]
    else:
        document, _ = find_document(source, resolver, report.diagnostics, xacro_args)
        report.diagnostics.raise_if_errors()
        assert document is not None
        if document.folder is not None and not _is_bundled(document.folder):
            lock_folder = document.folder
        search.resolver = resolver.around(document.folder)
        first = search.of_document(document)
    fetcher = _Fetcher(options, search, report, read_lock(lock_folder / LOCK_NAME))
    try:
        fetcher.run(first)
        if not options.dry_run:
            report.lock = fetcher.write_lock(lock_folder / LOCK_NAME)
    except OSError as error:
        place = error.filename or fuel_caches()[0]
        raise InputError("SK-CLI-016", f"cannot write {place}: {error.strerror or error}") from None
    return report


def _is_bundled(folder: Path) -> bool:
    return any(folder.is_relative_to(place) for kind in ("worlds", "assets") for place in bundled_folders(kind))


class _Fetcher:
    """Download of resources and of the resources that these name."""

    def __init__(
        self, options: FetchOptions, search: ReferenceSearch, report: FetchReport, lock: Mapping[str, LockEntry]
    ) -> None:
        self.options, self.search, self.report, self.lock = options, search, report, lock
        self.cache = fuel_caches()[0]
        self._found: dict[str, FetchedResource | None] = {}
        self._asked = 0
        self._left = options.max_total
        self._unreachable: dict[str, tuple[DownloadError, list[Reference]]] = {}

    def run(self, references: Iterable[Reference]) -> None:
        """Fetch the references, and what the fetched files name."""
        waiting = deque((reference, 0) for reference in islice(references, _MOST_REFERENCES + 1))
        count = len(waiting)
        with progress.task("fetching models", count) as task:
            while waiting:
                reference, depth = waiting.popleft()
                key = reference.url.resource.key
                if problem := self._limit_problem(depth, count, is_new=key not in self._found):
                    self._error(reference, DownloadError(TOO_LARGE, problem))
                    break
                if key not in self._found:
                    self._asked += 1
                    task.item = reference.url.title
                    resource = self._found[key] = self._resource(reference)
                    if resource is not None:
                        self.report.resources.append(resource)
                        self._found.setdefault(replace(resource.url, version=str(resource.version)).key, resource)
                        named = () if resource.folder is None else self.search.of_folder(resource.folder)
                        added = [(name, depth + 1) for name in islice(named, _MOST_REFERENCES + 1 - count)]
                        waiting.extend(added)
                        count += len(added)
                self._check_file(reference, self._found[key])
                task.advance()
                task.total = task.done + len(waiting)
        self._report_unreachable()

    def write_lock(self, path: Path) -> Path | None:
        """Add the checksums of the resources to the lock file; return its path if it changed."""
        before = read_lock(path)  # another process may have written it since
        entries = dict(before)
        for item in self.report.resources:
            if item.record is not None and item.version is not None:
                url = str(item.url)
                same = before.get(item.url.key)
                entry = LockEntry(item.url.title, url, item.version, item.record.sha256, item.record.size)
                entries[item.url.key] = replace(entry, url=same.url, name=same.name) if same else entry
        if entries == before:
            return None
        content = {"format": 1, "entries": [asdict(entries[key]) for key in sorted(entries)]}
        try:
            write_atomically(path, (json.dumps(content, indent=2, ensure_ascii=False) + "\n").encode())
        except InputError as error:  # for example beside a world of an installed package
            hint = "copy the world to a folder of your own, if others shall get the same versions"
            text = f"everything is in the cache, but simkit {error.message}"
            self.report.diagnostics.warning(NO_LOCK, text, hint=hint)
            return None
        return path

    def _limit_problem(self, depth: int, count: int, *, is_new: bool) -> str:
        """Return the limit that a reference exceeds, or an empty text; a server could name models without end."""
        if depth > MAX_INCLUDE_DEPTH:
            return f"models that name one another are nested deeper than {MAX_INCLUDE_DEPTH}"
        if is_new and self._asked >= _MOST_RESOURCES:
            return f"the world names more than {_MOST_RESOURCES} resources"
        if count > _MOST_REFERENCES:
            return f"the world and its models name resources in more than {_MOST_REFERENCES} places"
        return ""

    def _resource(self, reference: Reference) -> FetchedResource | None:
        """Find or download one resource; return None, with an error recorded, if this is not possible."""
        url = reference.url.resource
        entry = None if self.options.update else self.lock.get(url.key)
        resource = (None if self.options.update else self._cached(url, entry)) or self._local(url)
        if resource is not None:
            return resource
        version = str(entry.version) if entry is not None else ""
        address = url.address(self.options.server, version)
        server = "://".join(urlsplit(address)[:2])
        if server in self._unreachable:
            self._unreachable[server][1].append(reference)
            return None
        try:
            self._check_environment()
            self.options.connection.check(address)
            if self.options.dry_run:
                remote, size = remote_size(address, self.options.connection)
                return FetchedResource(url, "to fetch", remote, size)
            return self._download(url, address, entry)
        except DownloadError as error:
            if error.is_unreachable:
                self._unreachable[server] = (error, [reference])
            else:
                self._error(reference, error)
            return None

    def _check_environment(self) -> None:
        """Refuse every request if the xacro file has read an environment variable, which can be a password.

        A search for its value in the URL is not enough: a condition can choose a URL for each letter of the value.
        """
        read = self.search.resolver.variables_read
        if read:
            names, where = ", ".join(read), next(iter(read.values()))
            message = f"nothing is sent, because the URL can contain the environment variable {names:.200} ({where})"
            hint = f"write the URL without xacro, or expand the file and read its URL: xacro {where.file} -o robot.urdf"
            raise DownloadError(PRIVATE, message, hint)

    def _cached(self, url: FuelUrl, entry: LockEntry | None) -> FetchedResource | None:
        """Return the resource in the cache; None if it is not there, or if it is not what the lock file lists."""
        folder = next((f for f in cached_versions(url, entry.version if entry else None) if f.is_dir()), None)
        if folder is None:
            return None
        record = read_record(folder)
        if entry is not None and record != Record(entry.sha256, entry.size):
            return None
        version = int(folder.name) if folder.name != TIP else None
        return FetchedResource(url, "in the cache", version, record.size if record else None, folder, record)

    def _local(self, url: FuelUrl) -> FetchedResource | None:
        """Return the resource in a folder of the search path."""
        path, _ = self.search.resolver.search(str(url), None)
        if path is None or not path.is_dir() or any(path.is_relative_to(cache) for cache in fuel_caches()):
            return None
        return FetchedResource(url, "on this machine", None, None, path)

    def _download(self, url: FuelUrl, address: str, entry: LockEntry | None) -> FetchedResource:
        name = hashlib.sha256(address.encode()).hexdigest()[:32]
        part, notes = self.cache / STAGE / f"{name}.part", self.cache / STAGE / f"{name}.json"
        limit = min(self.options.max_size, self._left)
        with exclusive_file(part, self.options.connection.end) as file:
            resource = None if self.options.update else self._cached(url, entry)  # from another process, meanwhile
            is_finished = True
            try:
                if resource is None:
                    with progress.task(f"downloading {url.title}", unit="MB") as task:
                        run = Download(address, file, notes, limit, self.options.connection, self._is_needed(url), task)
                        version, is_complete = run.run()
                        resource = self._stored(url, file, version, entry) if is_complete else self._known(url, version)
            except BaseException as error:  # also an interruption
                is_refused = isinstance(error, DownloadError) and error.code != NETWORK
                is_finished = is_refused or not file.seek(0, os.SEEK_END)
                raise
            finally:
                if is_finished:  # else the next run continues with this file
                    with suppress(OSError):
                        notes.unlink(missing_ok=True)
                    with suppress(OSError):
                        file_lock.remove_locked_file(file, part)
        assert resource is not None
        return resource

    def _is_needed(self, url: FuelUrl) -> Callable[[int | None], bool]:
        """Return a function that checks whether a version must be downloaded to update the cache."""
        return lambda version: not self.options.update or self._known(url, version) is None

    def _known(self, url: FuelUrl, version: int | None) -> FetchedResource | None:
        if version is None:
            return None
        cached = self._cached(replace(url, version=str(version)), None)
        return replace(cached, url=url) if cached is not None and cached.record is not None else None

    def _stored(
        self, url: FuelUrl, file: BufferedRandom, version: int | None, entry: LockEntry | None
    ) -> FetchedResource:
        """Check a downloaded archive, and put it into the cache."""
        record = archive_record(file)
        wanted = entry.version if entry is not None else None if url.version == TIP else int(url.version)
        if wanted is not None and version not in (None, wanted):
            message = f"the server sent version {version} instead of {wanted}"
            raise DownloadError(OTHER_CONTENT, message, "try again later, or take the newest: --update")
        if entry is not None and record != Record(entry.sha256, entry.size):
            message = (
                f"the archive is not the one in {LOCK_NAME}: SHA-256 {record.sha256[:16]}… and {record.size} bytes, "
                f"instead of {entry.sha256[:16]}… and {entry.size} bytes"
            )
            raise DownloadError(OTHER_CONTENT, message, "if this change is intended, accept it with --update")
        self._left -= record.size
        number = wanted or version or 1  # as Gazebo, if the server tells no version
        most = _UNPACKED_RATIO * self.options.max_size
        folder = store(file, record, replace(url, version=str(number)), self.cache, most)
        return FetchedResource(url, "fetched", number, record.size, folder, record)

    def _check_file(self, reference: Reference, fetched: FetchedResource | None) -> None:
        """Report a file that a URL names, but that the resource does not have."""
        inside = reference.url.inside
        if inside and fetched is not None and fetched.folder is not None and not (fetched.folder / inside).exists():
            version = f" version {fetched.version}" if fetched.version else ""
            message = f"{fetched.url.title}{version} has no file {inside}"
            self._error(
                reference,
                DownloadError(MISSING, message, "check the path in the URL, or take the newest version: --update"),
            )

    def _error(self, reference: Reference, error: DownloadError) -> None:
        self.report.diagnostics.error(error.code, f"{reference.url}: {error}", reference.where, error.hint)

    def _report_unreachable(self) -> None:
        """Report each server that gave no answer, with all resources that are missing."""
        for error, references in self._unreachable.values():
            urls = list(dict.fromkeys(str(r.url.resource) for r in references))
            more = f" and {len(urls) - _MOST_LISTED} more" if len(urls) > _MOST_LISTED else ""
            message = f"{error}; not fetched: {', '.join(urls[:_MOST_LISTED])}{more}"
            self.report.diagnostics.error(error.code, message, references[0].where, error.hint)
