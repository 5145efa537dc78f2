# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""datagrams.py PORT SECONDS: floods the port of a udp device with at least 20,000 datagrams for at
least SECONDS: empty ones, garbage of the right size and magic, large ones. Prints their number."""
import random
import socket
import sys
import time

random.seed(1)
out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
out.setblocking(False)
kinds = [b"", random.randbytes(180), b"TCTD\2\0\2\0" + random.randbytes(172), random.randbytes(60000)]
start = time.monotonic()
end = start + float(sys.argv[2])
sent = 0
print("begun", flush=True)
while sent < 20_000 or time.monotonic() < end:
    try:
        out.sendto(kinds[sent % len(kinds)], ("127.0.0.1", int(sys.argv[1])))
    except OSError:  # The buffer is full.
        pass
    sent += 1
print(f"done {sent} times in {time.monotonic() - start:.2f} s")
