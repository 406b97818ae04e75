"""Execution of the requests of clients, with one answer for each request."""

from __future__ import annotations

from functools import partial
from typing import Final

from simkit import msgs
from simkit.bridges.live.bridge_requests import BRIDGE_REQUESTS
from simkit.bridges.live.connection import ClientConnection
from simkit.bridges.live.endpoint_requests import ENDPOINT_REQUESTS, LATER
from simkit.bridges.live.protocol import ANSWER, BadFrame, JsonObject, read_json_frame
from simkit.bridges.live.request_fields import CODE, client_text, find_handler
from simkit.bridges.live.requests import REQUESTS, Request, RequestHost, Response, define_types
from simkit.bridges.live.type_exchange import LARGEST_IN, detach
from simkit.errors import PluginError, SimkitError, SimulationDiverged, SubscriberError

_HANDLERS: Final = {**REQUESTS, **BRIDGE_REQUESTS, **ENDPOINT_REQUESTS}


def answer_request(server: RequestHost, peer: ClientConnection, body: bytes) -> None:
    """Execute a request of a client and send the answer.

    Raises:
        BadFrame: the frame is not a request.
        SimkitError: the request raised an error that ends the run.
    """
    args, data = read_json_frame(body)
    number, request_name = args.pop("id", None), args.pop("ask", None)
    interfaces = detach(args, LARGEST_IN)
    if type(number) is not int or not isinstance(request_name, str):
        raise BadFrame("a request needs an id and a name")
    raised: Exception | None = None
    answer: JsonObject = {"id": number}
    content = b""
    try:
        if interfaces:
            define_types(server, interfaces)
        handler = find_handler(_HANDLERS, request_name)
        result = handler(Request(server, peer, args, data, partial(peer.answer_later, number)))
        if result is LATER:
            return
        if isinstance(result, Response):
            answer["type"], content = msgs.type_name(result.message), msgs.serialize(result.message)
        else:
            answer["ok"] = result
    except SimkitError as error:
        answer |= {"error": str(error), "code": error.code}
        if isinstance(error, (PluginError, SimulationDiverged, SubscriberError)):
            raised = error  # the error ends the run, as it would for a caller in the process
    except Exception as error:  # noqa: BLE001 - a value that no check expected must not end the run
        answer |= {"error": client_text(error), "code": getattr(error, "code", CODE)}
    peer.send_json(ANSWER, answer, content)
    if raised is not None:
        peer.write()
        raise raised
