// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/* udp_driver PORT HEIGHT_M: a device of 0.1 kg on a spring of 200 N/m, whose hand goes up and down
 * its z, from +HEIGHT_M to -HEIGHT_M and back in 4 s. */
#include <arpa/inet.h>
#include <math.h>
#include <stdlib.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <time.h>

#include "tactus_driver.h"

static int64_t now_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * INT64_C(1000000000) + now.tv_nsec;
}

int main(int argc, char** argv)
{
    const double height_m = argc > 2 ? atof(argv[2]) : 0.0;
    const int controller = socket(AF_INET, SOCK_DGRAM, 0);
    struct sockaddr_in address = {0};
    address.sin_family = AF_INET;
    address.sin_port = htons((uint16_t)(argc > 1 ? atoi(argv[1]) : 48500));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (controller < 0 || connect(controller, (struct sockaddr*)&address, sizeof(address)) != 0)
    {
        return 1;
    }

    tactus_driver driver = {.describe = {.name = "c",
                                         .mass_kg = 0.1,
                                         .damping_n_s_per_m = 1.0,
                                         .delay_s = 0.002,
                                         .force_max_n = 8.0,
                                         .force_growth_max_n_per_s = 20000.0,
                                         .stiffness_max_n_per_m = 3000.0,
                                         .added_damping_max_n_s_per_m = 5.0,
                                         .workspace_radius_m = 0.2,
                                         .speed_max_m_per_s = 10.0,
                                         .rate_min_hz = 100,
                                         .rate_max_hz = 4000}};
    uint64_t instance = 0;
    if (getrandom(&instance, sizeof(instance), 0) != sizeof(instance))
    {
        return 1;
    }
    const int64_t began_ns = now_ns();
    tactus_driver_start(&driver, instance | 1, began_ns);

    double z_m = height_m;
    double v_m_per_s = 0.0;
    for (;;)
    {
        const int64_t now = now_ns();
        char bytes[512];
        ssize_t size = 0;
        while ((size = recv(controller, bytes, sizeof(bytes), MSG_DONTWAIT)) > 0)
        {
            tactus_driver_take(&driver, bytes, (size_t)size, now);
        }
        /* Here your device is written and read. */
        const double hand_m = height_m * cos(2.0 * M_PI * (double)(now - began_ns) * 1e-9 / 4.0);
        const double damping = driver.force.state == TACTUS_BRAKE ? 60.0 : 6.0;
        v_m_per_s +=
            0.001 / 0.1 * (driver.force.force_n[2] - 200.0 * (z_m - hand_m) - damping * v_m_per_s);
        z_m += 0.001 * v_m_per_s;
        tactus_sample sample = {.position_m = {0.0, 0.0, z_m},
                                .velocity_m_per_s = {0.0, 0.0, v_m_per_s},
                                .time_ns = now_ns(),
                                .flags = TACTUS_VALID | TACTUS_HAS_VELOCITY | TACTUS_HELD};

        size_t length = 0;
        const void* datagram = tactus_driver_next(&driver, &sample, now, &length);
        if (datagram != NULL)
        {
            send(controller, datagram, length, 0); /* Fails while no controller listens. */
        }
        const struct timespec pause = {0, 1000000};
        nanosleep(&pause, NULL);
    }
}
