# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""udp_driver.py PORT [HEIGHT_M [KEY]]: a device of 0.1 kg, 1e-4 kg m^2 on springs of 200 N/m,
0.5 N m/rad. The hand that holds it goes up and down its z, from +HEIGHT_M to -HEIGHT_M and back in
4 s; without HEIGHT_M it rests. KEY: the file of hrtc --device-key. Needs tactus_driver.py beside."""
import math
import socket
import sys
import time

from tactus_driver import (BRAKE, HAS_ANGULAR_VELOCITY, HAS_ROTATION, HAS_VELOCITY, HELD,
                           MEASURES_ROTATION, VALID, Describe, Driver, Sample)

height_m = float(sys.argv[2]) if len(sys.argv) > 2 else 0.0
key = bytes.fromhex(open(sys.argv[3]).read()) if len(sys.argv) > 3 else None
driver = Driver(Describe(
    name=b"python", mass_kg=0.1, damping_n_s_per_m=1, delay_s=0.002, force_max_n=8,
    force_growth_max_n_per_s=20000, stiffness_max_n_per_m=3000, added_damping_max_n_s_per_m=5,
    workspace_radius_m=0.2, speed_max_m_per_s=10, rate_min_hz=100, rate_max_hz=4000,
    torque_max_nm=0.2, inertia_kg_m2=1e-4, rotational_damping_nm_s_per_rad=1e-3,
    torque_growth_max_nm_per_s=1000, rotational_stiffness_max_nm_per_rad=1,
    added_rotational_damping_max_nm_s_per_rad=5e-3, flags=MEASURES_ROTATION), key)
controller = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
controller.connect(("127.0.0.1", int(sys.argv[1])))
controller.setblocking(False)

def take_all():
    try:
        while True:
            driver.take(controller.recv(512), time.monotonic_ns())
    except OSError:
        pass  # Nothing more, or nobody there yet.

x, v = [0.0, 0.0, height_m] + [0.0] * 3, [0.0] * 6
began = time.monotonic()
while True:
    now = time.monotonic()
    take_all()
    force, brakes = driver.force, driver.force.state == BRAKE
    hand = [0.0, 0.0, height_m * math.cos(2 * math.pi * (now - began) / 4)]
    for i in range(3):  # Here your device is written and read.
        v[i] += 0.001 * (force.force_n[i] - 200 * (x[i] - hand[i]) - (60 if brakes else 6) * v[i]) / 0.1
        x[i] += 0.001 * v[i]
    for i in range(3, 6):
        v[i] += 0.001 * (force.torque_nm[i - 3] - 0.5 * x[i] - (0.1 if brakes else 0.01) * v[i]) / 1e-4
        x[i] += 0.001 * v[i]
    w = math.sqrt(max(0.0, 1 - sum((a / 2) ** 2 for a in x[3:])))
    sample = Sample(position_m=tuple(x[:3]), velocity_m_per_s=tuple(v[:3]),
                    time_ns=time.monotonic_ns(), rotation=tuple([a / 2 for a in x[3:]] + [w]),
                    angular_velocity_rad_per_s=tuple(v[3:]),
                    flags=VALID | HAS_VELOCITY | HELD | HAS_ROTATION | HAS_ANGULAR_VELOCITY)
    if datagram := driver.next(sample, time.monotonic_ns()):
        try:
            controller.send(datagram)
        except OSError:
            pass  # Nobody there yet.
    time.sleep(max(0.0, now + 0.001 - time.monotonic()))
