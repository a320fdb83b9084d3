"""The other end of the page's websocket without a browser: moves sliders, and sees what comes back."""

from __future__ import annotations

import time
from types import TracebackType
from typing import Any

import msgspec
import viser
import zstandard
from websockets.sync.client import connect

LARGEST = 64 * 2**20
CAMERA = {
    "type": "ViewerCameraMessage",
    "wxyz": (1.0, 0.0, 0.0, 0.0),
    "position": (3.0, 3.0, 3.0),
    "fov": 0.6,
    "near": 0.01,
    "far": 1000.0,
    "image_height": 600,
    "image_width": 800,
    "look_at": (0.0, 0.0, 0.0),
    "up_direction": (0.0, 0.0, 1.0),
}


class RawClient:
    """A client of a page; sliders: limits of every slider by its label."""

    def __init__(self, port: int) -> None:
        protocol: Any = f"viser-v{viser.__version__}"
        self._socket = connect(
            f"ws://127.0.0.1:{port}", subprotocols=[protocol], max_size=LARGEST, compression=None
        )
        self._uuids: dict[str, str] = {}
        self.sliders: dict[str, tuple[float, float]] = {}
        self._send(CAMERA)
        self.receive(until=lambda messages: any(m["type"] == "ReplayDoneMessage" for m in messages))

    def move(self, label: str, value: float) -> float:
        """Move a slider as a page does; returns when it was sent (s, perf_counter)."""
        sent = time.perf_counter()
        self._send({"type": "GuiUpdateMessage", "uuid": self._uuids[label], "updates": {"value": value}})
        return sent

    def receive(self, until: Any, timeout: float = 10.0) -> float:
        """Read until a window of messages is as wanted; returns when it came (s, perf_counter)."""
        end = time.monotonic() + timeout
        while True:
            data = self._socket.recv(timeout=max(end - time.monotonic(), 0.001))
            came = time.perf_counter()
            messages = self._decode(bytes(data))  # type: ignore[arg-type]
            self._note(messages)
            if until(messages):
                return came

    def drain(self) -> int:
        """Read what is there; returns the number of windows."""
        count = 0
        while True:
            try:
                self._socket.recv(timeout=0.0)
            except TimeoutError:
                return count
            count += 1

    def _note(self, messages: list[dict[str, Any]]) -> None:
        for message in messages:
            if message["type"] == "GuiSliderMessage":
                props = message["props"]
                self._uuids[props["label"]] = message["uuid"]
                self.sliders[props["label"]] = props["min"], props["max"]

    def _send(self, message: dict[str, Any]) -> None:
        self._socket.send(msgspec.msgpack.encode(message))

    @staticmethod
    def _decode(data: bytes) -> list[dict[str, Any]]:
        size = int.from_bytes(data[8:16], "little")
        inner = zstandard.ZstdDecompressor().decompress(
            data[16 : 16 + size], max_output_size=int.from_bytes(data[:8], "little")
        )
        return list(msgspec.msgpack.decode(inner)["messages"])

    def __enter__(self) -> RawClient:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._socket.close()


def moves_tubes(messages: list[dict[str, Any]]) -> bool:
    """Whether new vertices of a tube are among the messages."""
    return any(
        message["type"] == "SceneNodeUpdateMessage"
        and "/tubes/" in message["name"]
        and "vertices" in message["updates"]
        for message in messages
    )
