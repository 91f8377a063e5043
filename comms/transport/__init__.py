"""How MAVLink bytes leave the process: UDP, TCP, serial lines and pseudo-terminals, all by one small protocol.

>>> from comms.transport import transport_of
>>> with transport_of("udpin:127.0.0.1:0") as server, transport_of(server.url.replace("in", "out")) as client:
...     client.write(b"hello")
...     server.read(0.0)
[b'hello']

`url` says which is meant, `contract` what all of them promise; `udp`, `tcp` and `serial_line` are the kinds, `stream`
is one peer's end of a byte stream. Nothing here blocks and nothing raises once it is open: peers come and go.
"""

from comms.transport.contract import Counts, Transport, TransportError
from comms.transport.url import FORMS, transport_of

__all__ = ["FORMS", "Counts", "Transport", "TransportError", "transport_of"]
