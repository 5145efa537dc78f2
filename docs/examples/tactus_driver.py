# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""A driver of a device for hrtc --device udp: the datagrams of docs/udp-device.md as structs, and
all that a driver does beside its hardware. Nothing of Tactus is needed: take this file along.

>>> driver = Driver(Describe(name=b"mine", mass_kg=0.1, force_max_n=8))
>>> driver.next(Sample(flags=VALID | HELD), now_ns=0)[:4]  # Describes itself until it is heard.
b'TCTD'
"""
import ctypes
import hashlib
import secrets

MEASURES_ROTATION = 1  # Of Describe.flags.
VALID, HAS_VELOCITY, HELD, HAS_ROTATION, HAS_ANGULAR_VELOCITY, HAS_GRIPPER = 1, 2, 4, 8, 16, 32
IDLE, FORCE, BRAKE = 0, 1, 2  # Force.state; BRAKE: no force, damp the motion.

_DESCRIBE, _SAMPLE, _FORCE = 1, 2, 3
_f64, _u64, _u32, _i64 = ctypes.c_double, ctypes.c_uint64, ctypes.c_uint32, ctypes.c_int64
_tag = ("tag", ctypes.c_ubyte * 16)


class Head(ctypes.LittleEndianStructure):
    """What all datagrams begin with; Driver fills it in."""
    _pack_ = 1
    _fields_ = [("magic", ctypes.c_char * 4), ("version", ctypes.c_uint16),
                ("kind", ctypes.c_uint16), ("instance", _u64), ("session", _u64),
                ("sequence", _u64)]


class Describe(ctypes.LittleEndianStructure):
    """What the device is; docs/udp-device.md has the ranges. SI."""
    _pack_ = 1
    _fields_ = [("head", Head), ("name", ctypes.c_char * 32)] + [(name, _f64) for name in (
        "mass_kg", "damping_n_s_per_m", "friction_n", "position_step_m", "delay_s", "force_max_n",
        "force_growth_max_n_per_s", "stiffness_max_n_per_m", "added_damping_max_n_s_per_m")] + [
        ("workspace_centre_m", _f64 * 3), ("workspace_radius_m", _f64), ("speed_max_m_per_s", _f64),
        ("rate_min_hz", _i64), ("rate_max_hz", _i64)] + [(name, _f64) for name in (
            "torque_max_nm", "inertia_kg_m2", "rotational_damping_nm_s_per_rad", "rotational_friction_nm",
            "rotation_step_rad", "torque_growth_max_nm_per_s", "rotational_stiffness_max_nm_per_rad",
            "added_rotational_damping_max_nm_s_per_rad", "gripper_force_max_n")] + [
        _tag, ("flags", _u32), ("checksum", _u32)]


class Sample(ctypes.LittleEndianStructure):
    """One reading."""
    _pack_ = 1
    _fields_ = [("head", Head), ("position_m", _f64 * 3), ("velocity_m_per_s", _f64 * 3),
                ("time_ns", _i64), ("rotation", _f64 * 4), ("angular_velocity_rad_per_s", _f64 * 3),
                ("gripper_m", _f64), _tag, ("buttons", _u32), ("flags", _u32), ("checksum", _u32)]


class Force(ctypes.LittleEndianStructure):
    """What the hardware is to do."""
    _pack_ = 1
    _fields_ = [("head", Head), ("force_n", _f64 * 3), ("torque_nm", _f64 * 3),
                ("gripper_n", _f64), ("answers", _u64), _tag, ("state", _u32), ("checksum", _u32)]


def _crc32c_table():
    table = list(range(256))
    for _ in range(8):
        table = [value >> 1 ^ (0x82F63B78 if value & 1 else 0) for value in table]
    return table


_TABLE = _crc32c_table()


def crc32c(data):
    """Castagnoli's."""
    crc = 0xFFFFFFFF
    for byte in data:
        crc = _TABLE[(crc ^ byte) & 255] ^ crc >> 8
    return crc ^ 0xFFFFFFFF


class Driver:
    """Give take() what the socket has, and send what next() returns, once a round. `force` is for
    the hardware; it is zero while the controller is silent. `key`: the 32 bytes of
    hrtc --device-key. Times are of a monotonic clock."""

    def __init__(self, describe, key=None):
        self.describe = describe
        self.force = Force()
        self._key = key
        self._instance = secrets.randbits(63) + 1
        self._sequence = 0
        self._heard_ns = self._described_ns = None

    def take(self, data, now_ns):
        """A datagram that came: True when it is the newest force."""
        if len(data) != ctypes.sizeof(Force):
            return False
        force = Force.from_buffer_copy(data)
        head = force.head
        is_ours = (head.magic, head.version, head.kind, head.instance) == (
            b"TCTD", 2, _FORCE, self._instance)
        if not is_ours or head.sequence <= self.force.head.sequence or self._closed(force) != data:
            return False
        self.force, self._heard_ns = force, now_ns
        return True

    def next(self, sample, now_ns):
        """What is to be sent now: the description or, of the device as it is now, `sample`; None
        for nothing. At least every 10 ms: it is the watchdog, too."""
        silent_ns = float("inf") if self._heard_ns is None else now_ns - self._heard_ns
        if silent_ns > 20e6:
            self.force = Force(head=self.force.head)
        if silent_ns <= 100e6:
            return self._tagged(sample, _SAMPLE, self.force.head.session)
        self.force = Force()
        if self._described_ns is not None and now_ns - self._described_ns < 100e6:
            return None
        self._described_ns = now_ns
        return self._tagged(self.describe, _DESCRIBE, 0)

    def _tagged(self, datagram, kind, session):
        self._sequence += 1
        datagram.head = Head(b"TCTD", 2, kind, self._instance, session, self._sequence)
        return self._closed(datagram)

    def _closed(self, datagram):
        """Its bytes, with the right tag and checksum."""
        closed = type(datagram).from_buffer_copy(datagram)
        if self._key:
            closed.tag[:] = bytes(16)
            plain = bytes(closed)[:-4]
            closed.tag[:] = hashlib.blake2b(plain, digest_size=16, key=self._key).digest()
        closed.checksum = crc32c(bytes(closed)[:-4])
        return bytes(closed)
