"""HTTP byte by byte, for what clients that behave cannot send."""

from __future__ import annotations

import socket
from urllib.parse import urlsplit

from tests.service import PATIENCE_SECONDS, Service


def connect(service: Service) -> socket.socket:
    """A connection to the service."""
    address = urlsplit(service.url)
    return socket.create_connection((address.hostname, address.port), PATIENCE_SECONDS)


def host_of(service: Service) -> str:
    """What belongs into the header ``Host``."""
    return urlsplit(service.url).netloc


def exchange(service: Service, request: bytes) -> bytes:
    """What comes back until the service closes, or has nothing more to say for a second."""
    with connect(service) as connection:
        connection.sendall(request)
        return received(connection)


def received(connection: socket.socket, seconds: float = 1.0) -> bytes:
    """What comes until the other side closes, or says nothing for so many ``seconds``."""
    answer = b""
    while True:
        try:
            part = connection.recv(65536)
        except TimeoutError:
            return answer
        except ConnectionResetError:
            return answer
        if not part:
            return answer
        answer += part
        connection.settimeout(seconds)


def status_of(answer: bytes) -> int:
    """The status of an answer."""
    return int(answer.split(b" ", 2)[1])
