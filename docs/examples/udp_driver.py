# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""udp_driver.py PORT [HEIGHT_M [KEY]]: a device of 0.1 kg, 1e-4 kg m^2 on springs of 200 N/m,
0.5 N m/rad. The hand that holds it goes up and down its z, from +HEIGHT_M to -HEIGHT_M and back in
4 s; without HEIGHT_M it rests. KEY: the file of hrtc --device-key."""
import hashlib, math, secrets, socket, struct, sys, time

TABLE = list(range(256))
for _ in range(8):
    TABLE = [value >> 1 ^ (0x82F63B78 if value & 1 else 0) for value in TABLE]

def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc = TABLE[(crc ^ byte) & 255] ^ crc >> 8
    return struct.pack("<I", crc ^ 0xFFFFFFFF)

key = bytes.fromhex(open(sys.argv[3]).read()) if len(sys.argv) > 3 else None

def sealed(data, at):
    """A datagram up to its checksum, with the tag that begins at `at`."""
    plain = data[:at] + bytes(16) + data[at + 16:]
    tag = hashlib.blake2b(plain, digest_size=16, key=key).digest() if key else bytes(16)
    return data[:at] + tag + data[at + 16:]

controller = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
controller.connect(("127.0.0.1", int(sys.argv[1])))
controller.setblocking(False)
instance, session, sequence = secrets.randbits(63) + 1, 0, 0
INFO = struct.pack("<32s14d2q9d16sI", b"python", 0.1, 1, 0, 0, 0.002, 8, 20000, 3000, 5,
                   0, 0, 0, 0.2, 10, 100, 4000,
                   0.2, 1e-4, 1e-3, 0, 0, 1000, 1, 5e-3, 0, bytes(16), 1)

def send(kind, session, body):
    global sequence
    sequence += 1
    data = struct.pack("<4s2H3Q", b"TCTD", 2, kind, instance, session, sequence) + body
    data = sealed(data, 264 if kind == 1 else 152)
    try:
        controller.send(data + crc32c(data))
    except OSError:
        pass  # Nobody there yet.

def newest_force(last):
    """Sequence, session, force and torque, state of the newest datagram above `last`, or None."""
    newest = None
    try:
        while True:
            data = controller.recv(512)
            is_whole = len(data) == 120 and crc32c(data[:116]) == data[116:]
            is_true = not key or sealed(data[:116], 96) == data[:116]
            if is_whole and is_true and data[:8] == b"TCTD\2\0\3\0":
                whose, given, number, *force, _, _, _, state = struct.unpack_from(
                    "<3Q6ddQ16sI", data, 8)
                if whose == instance and number > last:
                    last, newest = number, (number, given, force, state)
    except OSError:
        return newest

height_m = float(sys.argv[2]) if len(sys.argv) > 2 else 0.0
x, v, force, state, last = [0.0, 0.0, height_m] + [0.0] * 3, [0.0] * 6, [0.0] * 6, 0, 0
heard = described = 0.0
began = time.monotonic()
while True:
    now = time.monotonic()
    if news := newest_force(last):
        last, session, force, state = news
        heard = now
    if now - heard > 0.02:  # The watchdog.
        force, state = [0.0] * 6, 0
    if now - heard > 0.1:
        session, last = 0, 0
    if session == 0 and now - described > 0.1:
        described = now
        send(1, 0, INFO)
    hand = [0.0, 0.0, height_m * math.cos(2 * math.pi * (now - began) / 4)]
    for i in range(3):  # Here your device is read and written.
        v[i] += 0.001 * (force[i] - 200 * (x[i] - hand[i]) - (60 if state == 2 else 6) * v[i]) / 0.1
        x[i] += 0.001 * v[i]
    for i in range(3, 6):
        v[i] += 0.001 * (force[i] - 0.5 * x[i] - (0.1 if state == 2 else 0.01) * v[i]) / 1e-4
        x[i] += 0.001 * v[i]
    w = math.sqrt(max(0.0, 1 - sum((a / 2) ** 2 for a in x[3:])))
    turn = [a / 2 for a in x[3:]] + [w]
    if session:
        send(2, session, struct.pack("<6dq4d4d16sII", *x[:3], *v[:3], time.monotonic_ns(), *turn,
                                     *v[3:], 0.0, bytes(16), 0, 1 | 2 | 4 | 8 | 16))
    time.sleep(max(0.0, now + 0.001 - time.monotonic()))
