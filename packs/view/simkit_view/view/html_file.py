"""One HTML file with the page, a scene and a recording, which plays without simkit."""

from __future__ import annotations

import base64
import gzip
import html
import re
from typing import Final

from simkit_view.view.page_server import page_file

_POLICY: Final = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src blob: data:"
_START: Final = """
const unpack = id => {
  const text = document.getElementById(id).textContent;
  const bytes = Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip')));
};
window.simkitFile = {
  scene: await (await unpack('simkit-scene')).arrayBuffer(),
  recording: await (await unpack('simkit-recording')).arrayBuffer(),
  series: await (await unpack('simkit-series')).arrayBuffer(),
};
const script = document.createElement('script');
script.type = 'module';
script.textContent = await (await unpack('simkit-app')).text();
document.body.append(script);
"""


def html_file(title: str, scene: bytes, recording: bytes, series: bytes = b"") -> str:
    """Return the text of the file.

    Args:
        title: title of the page.
        scene: packet `scene`.
        recording: packet `recording`.
        series: packet with the numbers of topics; empty for none.
    """
    page = page_file("index.html").decode()
    body = re.search(r"<body>(.*?)<script", page, re.DOTALL)
    assert body is not None
    data = {"scene": scene, "recording": recording, "series": series, "app": page_file("app.js")}
    packed = {name: base64.b64encode(gzip.compress(content, 9, mtime=0)).decode() for name, content in data.items()}
    scripts = "\n".join(
        f'<script type="text/plain" id="simkit-{name}">{text}</script>' for name, text in packed.items()
    )
    licences = html.escape(page_file("LICENSES.txt").decode()).replace("--", "- -")
    return f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="{_POLICY}">
<title>{html.escape(title)}</title>
<style>{page_file("app.css").decode()}</style>
<!-- {licences} -->
</head>
<body>{body[1]}
{scripts}
<script type="module">{_START}</script>
</body>
</html>
"""
