"""Live view of a simulation in a browser: a page, the server of the page, and the packets between both.

The server runs in a thread of its own and never uses the simulation. The run calls `LiveView.update` between two
slices: it executes the requests that have arrived, and copies at most 30 states a second. The thread sends the newest
packet of each stream to each client; an older packet that a slow client has not yet taken is dropped.

Addresses: `/` (page, needs `?token=`), `/app.js`, `/app.css`, `/scene?token=` (packet `scene`) and the WebSocket
`/ws?token=`.

Packets (server to page, binary): the length of the JSON head (uint32, little endian), the head, and arrays. The head
has `kind`, and `arrays`: name -> [type, offset in bytes after the head, shape]. Types are those of NumPy: `<f4`, `<i4`,
`<u2` and `|u1`. The kind of a packet is the name of its stream. `scene_changed`, `state` and `appearance` always come;
a page asks for other streams with `{"do": "want", "streams": {name: options}}`, which replaces the former.

Requests (page to server, text): one JSON object with `do` and its arguments. A request with an `id` is answered by
`{"id": …, "ok": value}` or `{"id": …, "error": text}`; without an `id`, errors come as `{"error": text}`.
`page_requests.REQUESTS` has all requests, `streams.STREAMS` all streams; a new one is one function or class there.
"""
