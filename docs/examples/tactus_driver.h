// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#ifndef TACTUS_DRIVER_H
#define TACTUS_DRIVER_H

/* A driver of a device for hrtc --device udp, in C99 or C++: the datagrams of docs/udp-device.md as
 * structs, and all that a driver does beside its hardware. Nothing of Tactus is linked: take this
 * file along. Fill in tactus_driver.describe, call tactus_driver_start(), and in each round give
 * tactus_driver_take() what the socket has, and send what tactus_driver_next() returns.
 *
 * No call waits or allocates. One thread. Little-endian processors with IEEE 754. */

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "the datagrams are little-endian"
#endif

enum
{
    /* Of tactus_describe.flags. */
    TACTUS_MEASURES_ROTATION = 1,
    /* Of tactus_sample.flags. */
    TACTUS_VALID = 1,
    TACTUS_HAS_VELOCITY = 2,
    TACTUS_HELD = 4,
    TACTUS_HAS_ROTATION = 8,
    TACTUS_HAS_ANGULAR_VELOCITY = 16,
    TACTUS_HAS_GRIPPER = 32,
    /* tactus_force.state. */
    TACTUS_IDLE = 0,
    TACTUS_FORCE = 1,
    TACTUS_BRAKE = 2 /* No force; damp the motion. */
};

#pragma pack(push, 1)

/* What all datagrams begin with; tactus_driver_next() fills it in. */
typedef struct tactus_head
{
    char magic[4];
    uint16_t version;
    uint16_t kind; /* 1 describe, 2 sample, 3 force. */
    uint64_t instance;
    uint64_t session;
    uint64_t sequence;
} tactus_head;

/* What the device is. SI. */
typedef struct tactus_describe
{
    tactus_head head;
    char name[32];
    double mass_kg;
    double damping_n_s_per_m;
    double friction_n; /* 0: not known. */
    double position_step_m;
    double delay_s; /* From a position to its force: sensors, time between samples, amplifiers. */
    double force_max_n;
    double force_growth_max_n_per_s;
    double stiffness_max_n_per_m;
    double added_damping_max_n_s_per_m;
    double workspace_centre_m[3];
    double workspace_radius_m;
    double speed_max_m_per_s;
    int64_t rate_min_hz;
    int64_t rate_max_hz;
    double torque_max_nm; /* 0: it makes none, and what else is of turning may be 0. */
    double inertia_kg_m2;
    double rotational_damping_nm_s_per_rad;
    double rotational_friction_nm;
    double rotation_step_rad;
    double torque_growth_max_nm_per_s;
    double rotational_stiffness_max_nm_per_rad;
    double added_rotational_damping_max_nm_s_per_rad;
    double gripper_force_max_n; /* 0: it makes none. */
    uint8_t tag[16];
    uint32_t flags;
    uint32_t checksum;
} tactus_describe;

/* One reading. */
typedef struct tactus_sample
{
    tactus_head head;
    double position_m[3];
    double velocity_m_per_s[3];
    int64_t time_ns;    /* When the position was taken; rising. */
    double rotation[4]; /* Unit quaternion x, y, z, w. */
    double angular_velocity_rad_per_s[3];
    double gripper_m;
    uint8_t tag[16];
    uint32_t buttons;
    uint32_t flags;
    uint32_t checksum;
} tactus_sample;

/* What the hardware is to do. */
typedef struct tactus_force
{
    tactus_head head;
    double force_n[3];
    double torque_nm[3];
    double gripper_n; /* Above 0 it opens. */
    uint64_t answers;
    uint8_t tag[16];
    uint32_t state;
    uint32_t checksum;
} tactus_force;

#pragma pack(pop)

typedef char tactus_describe_is_288[sizeof(tactus_describe) == 288 ? 1 : -1];
typedef char tactus_sample_is_180[sizeof(tactus_sample) == 180 ? 1 : -1];
typedef char tactus_force_is_120[sizeof(tactus_force) == 120 ? 1 : -1];

typedef struct tactus_driver
{
    tactus_describe describe; /* Yours up to gripper_force_max_n, and its flags. */
    tactus_force force;       /* For the hardware; zero while the controller is silent. */
    /* With a key: the BLAKE2b of 16 bytes of `size` bytes, keyed by it; null without. */
    void (*authenticate)(const void* bytes, size_t size, uint8_t tag[16]);
    uint64_t sequence;
    int64_t heard_ns;
    int64_t described_ns;
} tactus_driver;

/* CRC-32C, Castagnoli. */
static inline uint32_t tactus_crc32c(const void* bytes, size_t size)
{
    const uint8_t* at = (const uint8_t*)bytes;
    uint32_t crc = 0xFFFFFFFFU;
    while (size-- > 0)
    {
        int bit;
        crc ^= *at++;
        for (bit = 0; bit < 8; ++bit)
        {
            crc = (crc >> 1) ^ (0x82F63B78U & (0U - (crc & 1U)));
        }
    }
    return crc ^ 0xFFFFFFFFU;
}

/* All zeros but what is filled in of `describe`. `instance`: at random, not 0, another one each
 * time that the program starts. `now_ns`, here and below: of a monotonic clock. */
static inline void tactus_driver_start(tactus_driver* driver, uint64_t instance, int64_t now_ns)
{
    driver->describe.head.instance = instance;
    driver->heard_ns = driver->described_ns = now_ns - 1000000000;
}

/* A datagram that came. 1: it is the newest force, and in `force`; 0: it counts for nothing. */
static inline int tactus_driver_take(tactus_driver* driver, const void* bytes, size_t size,
                                     int64_t now_ns)
{
    tactus_force force;
    if (size != sizeof(force))
    {
        return 0;
    }
    memcpy(&force, bytes, sizeof(force));
    if (memcmp(force.head.magic, "TCTD", 4) != 0 || force.head.version != 2 ||
        force.head.kind != 3 || force.head.instance != driver->describe.head.instance ||
        force.head.sequence <= driver->force.head.sequence ||
        force.checksum != tactus_crc32c(&force, offsetof(tactus_force, checksum)))
    {
        return 0;
    }
    if (driver->authenticate != NULL)
    {
        uint8_t tag[16];
        const tactus_force sent = force;
        memset(force.tag, 0, sizeof(force.tag));
        driver->authenticate(&force, offsetof(tactus_force, checksum), tag);
        if (memcmp(tag, sent.tag, sizeof(tag)) != 0)
        {
            return 0;
        }
    }
    driver->force = force;
    driver->heard_ns = now_ns;
    return 1;
}

/* What is to be sent now, of *size bytes: the description or, of the device as it is now, `sample`;
 * null: nothing, as long as no controller is there. Once a round, at least every 10 ms: it is the
 * watchdog, too, which takes the force away when the controller is silent. */
static inline const void* tactus_driver_next(tactus_driver* driver, tactus_sample* sample,
                                             int64_t now_ns, size_t* size)
{
    const int is_attached = now_ns - driver->heard_ns <= 100000000;
    tactus_head* head = is_attached ? &sample->head : &driver->describe.head;
    uint8_t* tag = is_attached ? sample->tag : driver->describe.tag;
    uint32_t* checksum = is_attached ? &sample->checksum : &driver->describe.checksum;
    const uint64_t instance = driver->describe.head.instance;
    if (now_ns - driver->heard_ns > 20000000)
    {
        const tactus_head newest = driver->force.head;
        memset(&driver->force, 0, sizeof(driver->force));
        driver->force.head = newest;
    }
    if (!is_attached)
    {
        memset(&driver->force.head, 0, sizeof(driver->force.head)); /* From its beginning. */
        if (now_ns - driver->described_ns < 100000000)
        {
            return NULL;
        }
        driver->described_ns = now_ns;
    }
    memcpy(head->magic, "TCTD", 4);
    head->version = 2;
    head->kind = is_attached ? 2 : 1;
    head->instance = instance;
    head->session = is_attached ? driver->force.head.session : 0;
    head->sequence = ++driver->sequence;
    memset(tag, 0, 16);
    *size = is_attached ? sizeof(*sample) : sizeof(driver->describe);
    if (driver->authenticate != NULL)
    {
        uint8_t expected[16];
        driver->authenticate(head, *size - 4, expected);
        memcpy(tag, expected, 16);
    }
    *checksum = tactus_crc32c(head, *size - 4);
    return head;
}

#endif
