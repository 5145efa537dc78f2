#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# feed.py BIN_DIR EXAMPLES_DIR: the feed of spm_view while hrtc touches a model, by server-sent
# events and by datagrams, against each other and against the recording of the run; wrong options
# and requests; and the files of the example's page.
#
# Every wait is for an event and names a missing one; all started programs are ended in any case.
import csv
import json
import math
import os
import pathlib
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.parse
import urllib.request

PATIENCE_S = 300  # Only a broken program waits this long.
TOOL = "21d"  # Numbers of a tool after its four integers.
started = []


def expect(is_so, what):
    if not is_so:
        print(f"feed: {what}", flush=True)
        sys.exit(1)


def eventually(found, what):
    end_s = time.monotonic() + PATIENCE_S
    while time.monotonic() < end_s:
        if value := found():
            return value
        time.sleep(0.05)
    expect(False, f"missing: {what}")


def start(*command, log):
    with open(log, "wb") as file:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=file,
                                   stderr=subprocess.STDOUT)
    started.append(process)
    return process


def line_in(log, pattern):
    def find():
        match = re.search(pattern, pathlib.Path(log).read_text(errors="replace"))
        return match and match.group(1)
    return eventually(find, f"'{pattern}' in {log}")


def refused(command, code, what):
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S)
    text = done.stdout + done.stderr
    expect(done.returncode == code and what in text,
           f"{command[1:]}: exit code {done.returncode} instead of {code}, or no '{what}': {text}")


def status(url, headers=None):
    try:
        request = urllib.request.Request(url, headers=headers or {})
        return urllib.request.urlopen(request, timeout=PATIENCE_S).status
    except urllib.error.HTTPError as error:
        return error.code


def events(url, count):
    """The next `count` events of the feed."""
    found = []
    with urllib.request.urlopen(url + "feed", timeout=PATIENCE_S) as answer:
        expect(answer.headers["Content-Type"] == "text/event-stream", "content type of /feed")
        for line in answer:
            if line.startswith(b"data: "):
                found.append(json.loads(line[6:]))
            if len(found) == count:
                return found
    expect(False, f"/feed ended after {len(found)} events")


def unpacked(datagram):
    """A datagram as the same dictionaries as in JSON, read by offsets of the documentation."""
    head = struct.unpack_from("<4s8HIQQq16s64s", datagram)
    expect(head[0] == b"TFED" and head[1:5] == (128, 256, 160, 1), f"head of a datagram: {head}")
    tools, objects = head[5:7]
    expect(len(datagram) == 128 + 256 * tools + 160 * objects, "length of a datagram")
    state = {"serial": head[10], "frame": head[11], "time_ns": head[12], "tools": [],
             "objects": [], "name": head[14].rstrip(b"\0").decode()}
    for i in range(tools):
        values = struct.unpack_from("<4I" + TOOL + "d64s", datagram, 128 + 256 * i)
        state["tools"].append({
            "number": values[0], "in_contact": values[1] & 1 != 0, "buttons": values[2],
            "position_m": list(values[4:7]), "rotation": list(values[7:11]),
            "proxy_m": list(values[11:14]), "proxy_rotation": list(values[14:18]),
            "force_n": list(values[18:21]), "torque_nm": list(values[21:24])})
    for i in range(objects):
        values = struct.unpack_from("<IIQ8d16s64s", datagram, 128 + 256 * tools + 160 * i)
        state["objects"].append({
            "number": values[0], "object": values[1], "server": f"{values[2]:016x}",
            "translation_m": list(values[3:6]), "rotation": list(values[6:10]),
            "scale": values[10], "model": values[11].hex(),
            "name": values[12].rstrip(b"\0").decode()})
    return state


def agrees(one, other, what):
    """All values of `one` are equal in `other`, to the bit."""
    if isinstance(one, dict):
        for name in one:
            agrees(one[name], other[name], f"{what}.{name}")
    elif isinstance(one, list):
        expect(len(one) == len(other), f"{what}: {one} and {other}")
        for i, each in enumerate(one):
            agrees(each, other[i], f"{what}[{i}]")
    else:
        expect(one == other, f"{what}: {one} and {other}")


def watch(programs, domain):
    receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
    receiver.bind(("127.0.0.1", 0))
    receiver.settimeout(PATIENCE_S)
    port = receiver.getsockname()[1]
    start(programs / "spm_view", "--domain", domain, "--port", "0", "--feed-udp", str(port),
          "--pages", sys.argv[2], log="view.log")
    url = line_in("view.log", r"(http://\S+) shows")
    for path in ("feed", "pages/feed_three.html"):
        found = status(url + path, {"Origin": "http://evil.example"})
        expect(found == 403, f"{path} for another page: {found}")
    expect(status(url + "pages/../../README.md") == 404, "a file beside the folder of --pages")
    page = urllib.request.urlopen(url + "pages/feed_three.html", timeout=PATIENCE_S).read().decode()
    for source in re.findall(r'src="([^"]+)"', page):
        found = status(urllib.parse.urljoin(url + "pages/", source))
        expect(found == 200, f"{source} of the example's page: {found}")

    run = start(programs / "hrtc", "ball.spm", "--domain", domain, "--device", "sim",
                "--allow-no-rt", "--duration", "600", "--record", "run.rec", log="hrtc.log")
    told = events(url, 1)
    slow = socket.create_connection(("127.0.0.1", int(url.rsplit(":", 1)[1].strip("/"))))
    slow.sendall(f"GET /feed HTTP/1.1\r\nHost: {url[7:-1]}\r\n\r\n".encode())  # Never read.
    told += events(url, 300)
    by_serial = {}
    while told[-1]["serial"] not in by_serial:  # All datagrams up to the last event.
        state = unpacked(receiver.recv(70_000))
        by_serial[state["serial"]] = state
    slow.close()
    both = [each for each in told if each["serial"] in by_serial]
    expect(len(both) >= len(told) - 1, f"{len(both)} of {len(told)} events have a datagram")
    for each in both:
        agrees(by_serial[each["serial"]], each, f"state {each['serial']}")
    rate = (len(told) - 2) * 1e9 / (told[-1]["time_ns"] - told[1]["time_ns"])
    print(f"feed: {rate:.0f} events a second")
    expect(any(math.hypot(*each["tools"][0]["force_n"]) > 0.0 for each in told), "a force")
    ball = told[-1]["objects"]
    expect(len(ball) == 1 and ball[0]["name"] == "ball" and ball[0]["scale"] == 1.0,
           f"objects of the feed: {ball}")
    run.send_signal(signal.SIGINT)
    run.wait(PATIENCE_S)
    expect(run.returncode == 0, f"hrtc ended with {run.returncode}")
    return told


def compare_with_recording(programs, told):
    subprocess.run([programs / "hrtc", "--replay", "run.rec", "--export", "run.csv"], check=True,
                   timeout=PATIENCE_S, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open("run.csv", encoding="utf-8", newline="") as file:
        rows = {int(row["frame"]) + 1: row for row in csv.DictReader(file)}
    compared = 0
    for state in told:
        row = rows.get(state["frame"])
        if row is None:  # The recorder may lose frames on a busy machine.
            continue
        compared += 1
        for field, column in (("position_m", "device_world_m"), ("proxy_m", "proxy_world_m"),
                              ("force_n", "sent_force_world_n")):
            for i, axis in enumerate("xyz"):
                wanted = float(row[f"tool0.{column}.{axis}"])
                got = state["tools"][0][field][i]
                expect(math.isclose(got, wanted, rel_tol=1e-9, abs_tol=1e-12),
                       f"frame {state['frame']}: {field} {got} in the feed, {wanted} recorded")
    expect(compared > 0, "no frame of the feed is in the recording")


def main():
    programs = pathlib.Path(sys.argv[1]).resolve()
    sys.argv[2] = str(pathlib.Path(sys.argv[2]).resolve())
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # No process is left running.
    domain = os.environ.get("TACTUS_TEST_DOMAIN", str(os.getpid() % 231))
    os.environ.pop("CYCLONEDDS_URI", None)
    view = str(programs / "spm_view")
    for wrong in ("0", "70000", "seven", "localhost:7301", "127.0.0.1:", ":7301", "1.2.3:7301"):
        refused([view, "--feed-udp", wrong], 3, "--feed-udp: '")
    refused([view, "--feed-udp", "192.0.2.1:7301"], 3, "--plain")
    refused([view, "--feed-udp", "7301", "--replay", "run.rec"], 3, "--replay")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        os.chdir(folder)
        try:
            refused([view, "--domain", domain, "--port", "0", "--pages", "no-folder"], 2,
                    "--pages: 'no-folder' is no folder")
            subprocess.run([programs / "spm_build", "--shape", "bumpy-sphere", "--faces", "20000",
                            "-o", "ball.spm"], check=True, timeout=PATIENCE_S,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            told = watch(programs, domain)
            compare_with_recording(programs, told)
        finally:
            for process in started:
                process.kill()
                process.wait()
            os.chdir("/")


main()
