# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""sniff.py MODEL WORD...: what goes over the loopback of this network: prints as one JSON
object how many frames hold UDP, how many of them a WORD of at least 6 bytes, and how many 16 bytes
of the file MODEL that are there once. It says "ready" first and ends with SIGTERM. Needs root."""
import json
import pathlib
import signal
import socket
import sys

WINDOW = 16
model = pathlib.Path(sys.argv[1]).read_bytes()
words = [word.encode() for word in sys.argv[2:]]
windows = {}
for at in range(len(model) - WINDOW):
    piece = model[at:at + WINDOW]
    windows[piece] = windows.get(piece, 0) + 1
telling = {piece for piece, count in windows.items() if count == 1 and len(set(piece)) > 8}

sniffer = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(3))
sniffer.setsockopt(socket.SOL_SOCKET, 33, 32 << 20)  # SO_RCVBUFFORCE.
sniffer.bind(("lo", 0))
sniffer.settimeout(0.2)
ends = []
signal.signal(signal.SIGTERM, lambda *_: ends.append(True))
print("ready", flush=True)
frames = []
while True:
    try:
        frames.append(sniffer.recv(70000))
    except TimeoutError:
        if ends:  # All packets until then are taken.
            break
udp = [frame[42:] for frame in frames if len(frame) > 42 and frame[23] == 17]
print(json.dumps({
    "udp": len(udp),
    "words": sum(any(word in frame for word in words) for frame in udp),
    "payload": sum(any(frame[at:at + WINDOW] in telling for at in range(len(frame) - WINDOW + 1))
                   for frame in udp)}))
