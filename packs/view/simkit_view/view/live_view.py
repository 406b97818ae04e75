"""Live view of a simulation: copies states for the pages, and executes the requests of the pages."""

from __future__ import annotations

import gzip
import hashlib
import queue
import secrets
import time
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.bridges.live.request_fields import CODE, client_text
from simkit.errors import InputError, PluginError, SimulationDiverged, SubscriberError
from simkit.recording.travel import Travel
from simkit_view.view import scene_packet
from simkit_view.view.driving import Driving
from simkit_view.view.marker_feedback import MarkerFeedback
from simkit_view.view.packet import Stream, make_packet
from simkit_view.view.page_calls import PageCalls
from simkit_view.view.page_requests import execute_request
from simkit_view.view.page_server import PageRequest, PageServer
from simkit_view.view.streams import CLEARED, LASTING, StreamMaker, make_stream
from simkit_view.web.access import is_loopback

if TYPE_CHECKING:
    from simkit import Simulation

PERIOD: Final = 1 / 30
"""Least wall time between two states [s]."""
_APPEARANCE_PERIOD: Final = 0.25  # [s] of wall time between two looks at colours and lights
_PACE_WINDOW: Final = 0.5  # [s] of wall time over which the real-time factor is measured
_REQUESTS_PER_TURN: Final = 64
_PACKING: Final = 5  # level of gzip


def compress_packet(packet: bytes) -> bytes:
    """Return a packet compressed with gzip; equal packets give equal bytes."""
    return gzip.compress(packet, _PACKING, mtime=0)


class LiveView:
    """Live view of a simulation; a context manager. The run calls `update` between two slices.

    Args:
        sim: simulation to show.
        host: address to bind to.
        port: port; 0 for a free one.
        token: token of the address; a random one by default.
        recording: packet with a recording, which pages play instead of the simulation's states.
        streams: makers of streams that replace those of the simulation, by the first part of their names.

    Attributes:
        travel: paths that the models have driven.
        driving: robots that the pages drive; the run sends its commands when they are due.
        calls: calls of services and goals of actions that pages have sent.
        is_held: True after a page has requested a pause, until a page resumes.

    Raises:
        InputError: SK-WEB-006 the address cannot be used.
    """

    def __init__(
        self,
        sim: Simulation,
        host: str = "127.0.0.1",
        port: int = 0,
        token: str = "",
        recording: bytes = b"",
        streams: Mapping[str, StreamMaker] | None = None,
    ) -> None:
        self.sim, self._host, self._token = sim, host, token or secrets.token_urlsafe(16)
        self.revision, self.is_held = 0, False
        self.travel, self.driving, self.calls = Travel(sim), Driving(sim), PageCalls(sim)
        self.marker_feedback = MarkerFeedback(sim)
        try:
            self.server = PageServer(host, port, self._token)
        except OSError as error:
            text = f"{host}:{port} cannot be used for the page: {error.strerror or error}"
            raise InputError("SK-WEB-006", text, help="choose another port, or 0 for a free one") from None
        self._is_recording = bool(recording)
        if recording:
            self.server.set_recording(compress_packet(recording))
        self._streams: dict[str, Stream | None] = {}
        self._own_streams: dict[str, StreamMaker] = {
            "calls": lambda _: self.calls,
            "driving": lambda _: self.driving,
            **(streams or {}),
        }
        self._last = self._looked = 0.0
        self._tick = sim.tick
        self._sent: tuple[object, ...] = ()
        self._pace = (time.perf_counter(), sim.time)
        self._rtf = 0.0
        self._packets: dict[str, bytes] = {}
        self._set_scene()
        self._send_packets()

    @property
    def address(self) -> str:
        """Address of the page, with its token."""
        host = {"": "127.0.0.1", "0.0.0.0": "127.0.0.1", "::": "::1"}.get(self._host, self._host)
        return f"http://{f'[{host}]' if ':' in host else host}:{self.server.port}/?token={self._token}"

    @property
    def is_local(self) -> bool:
        """True if only this machine reaches the page."""
        return is_loopback(self._host)

    def slices(self, *lengths: float) -> tuple[float, ...]:
        """Return the lengths of the run's slices [s, wall time]: shorter ones while a page is open."""
        return tuple(min(length, 0.6 * PERIOD) for length in lengths) if self.server.client_count else lengths

    # ------------------------------------------------------------------ between two slices

    def update(self) -> None:
        """Execute waiting requests, and send the pages what has changed.

        Raises:
            PluginError, SubscriberError, SimulationDiverged: error of a plugin, callback or step that a request caused.
        """
        if not self.server.requests.empty():
            self._execute_requests()
        now = time.perf_counter()
        if now - self._last < PERIOD:
            return
        self._last = now
        self.travel.sample()
        if not self.server.client_count:
            self._close_streams()
            return
        if self.sim.tick < self._tick:
            self._clear_streams()
        self._tick = self.sim.tick
        if self.sim.mj_model is not self._model:
            self._set_scene()
        elif now - self._looked > _APPEARANCE_PERIOD:
            self._looked = now
            self._send_appearance()
        self._send_state(now)
        self._send_streams()
        self._send_packets()

    def _send_state(self, now: float) -> None:
        sim, pausing = self.sim, self.sim.control.pausing
        wall, simulated = self._pace
        if now - wall > _PACE_WINDOW:
            self._rtf, self._pace = max(0.0, (sim.time - simulated) / (now - wall)), (now, sim.time)
        poses = scene_packet.poses(sim, self._moving)
        content = (self.revision, sim.tick, sim.paused, pausing.pace, poses.tobytes())
        if content == self._sent:
            return
        self._sent = content
        head = {
            "kind": "state",
            "revision": self.revision,
            "time": sim.time,
            "tick": sim.tick,
            "paused": sim.paused,
            "pace": pausing.pace,
            "rtf": round(self._rtf, 3),
            "contacts": int(sim.mj_data.ncon),
        }
        self._packets["state"] = make_packet(head, {"poses": poses})

    def _send_packets(self) -> None:
        """Send the packets of an update together, because each wake-up of the server's thread costs time."""
        if self._packets:
            self.server.send(self._packets)
            self._packets = {}

    def stream(self, name: str) -> Stream | None:
        """Return an open stream; None if no page shows it."""
        return self._streams.get(name)

    def _make_stream(self, name: str) -> Stream | None:
        kind, _, argument = name.partition(":")
        maker = self._own_streams.get(kind)
        return make_stream(self.sim, name) if maker is None else maker(argument)

    def _send_streams(self) -> None:
        wants = self.server.wants
        for name in [name for name in self._streams if name not in wants]:
            stream = self._streams.pop(name)
            if stream is not None:
                stream.close()
        for name, options in wants.items():
            try:
                if name not in self._streams:
                    self._streams[name] = self._make_stream(name)
                stream = self._streams[name]
                packet = None if stream is None else stream.packet(options)
            except (PluginError, SimulationDiverged, SubscriberError):
                raise
            except Exception as error:  # noqa: BLE001 - no renderer, or an odd message: the run goes on without it
                broken, self._streams[name] = self._streams.get(name), None
                if broken is not None:
                    broken.close()
                packet = make_packet({"kind": name, "error": client_text(error)}, {})
            if packet is not None:
                self._packets[name] = packet

    def _close_streams(self, is_closed: Callable[[str], bool] = lambda _: True) -> None:
        """Close the streams of the chosen kinds; default: all."""
        for name in [name for name in self._streams if is_closed(name.partition(":")[0])]:
            stream = self._streams.pop(name)
            if stream is not None:
                stream.close()

    def _clear_streams(self) -> None:
        """Clear what pages show of messages and samples of before a reset."""
        for name in self._streams:
            if cleared := CLEARED.get(name.partition(":")[0]):
                self._packets[name] = make_packet({"kind": name, **cleared[0]}, cleared[1])
        self._close_streams(lambda kind: kind in CLEARED)

    # ------------------------------------------------------------------ scene

    def _set_scene(self) -> None:
        self.revision += 1
        self._model = self.sim.mj_model
        self._moving = scene_packet.moving_bodies(self._model)
        self._close_streams(lambda kind: kind not in LASTING)
        extra = {"seed": self.sim.seed, "recording": self._is_recording}
        packet = scene_packet.make_scene_packet(self.sim, self.revision, extra)
        self._looks = self._appearance_digest()
        self.server.set_scene(compress_packet(packet))
        self._packets["scene_changed"] = make_packet({"kind": "scene_changed", "revision": self.revision}, {})
        self._sent = ()

    def _appearance_digest(self) -> bytes:
        digest = hashlib.blake2b(digest_size=16)
        for values in scene_packet.appearance(self.sim).values():
            digest.update(np.ascontiguousarray(values).data)
        return digest.digest()

    def _send_appearance(self) -> None:
        digest = self._appearance_digest()
        if digest != self._looks:
            self._looks = digest
            head = {"kind": "appearance", "revision": self.revision}
            self._packets["appearance"] = make_packet(head, scene_packet.appearance(self.sim))

    # ------------------------------------------------------------------ requests

    def _execute_requests(self) -> None:
        for _ in range(_REQUESTS_PER_TURN):
            try:
                request = self.server.requests.get_nowait()
            except queue.Empty:
                return
            self._execute(request)

    def _execute(self, request: PageRequest) -> None:
        number = request.content.pop("id", None)
        try:
            value = execute_request(self, request)
        except (PluginError, SimulationDiverged, SubscriberError) as error:
            self.server.answer(request.client, {"id": number, "error": str(error), "code": error.code})
            raise  # the error ends the run, as it would for a caller in the process
        except Exception as error:  # noqa: BLE001 - no request of a page ends the run
            answer = {"id": number, "error": client_text(error), "code": getattr(error, "code", CODE)}
            self.server.answer(request.client, answer)
        else:
            if number is not None:
                self.server.answer(request.client, {"id": number, "ok": value})

    # ------------------------------------------------------------------ the end

    def close(self) -> None:
        """Disconnect the pages."""
        self._close_streams()
        self.server.close()

    def __enter__(self) -> LiveView:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
