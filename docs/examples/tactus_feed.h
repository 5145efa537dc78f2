// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#ifndef TACTUS_FEED_H
#define TACTUS_FEED_H

/* The datagrams of spm_view --feed-udp (docs/feed.md) as structs, in C11 or C++. Nothing of Tactus
 * is linked: take this file along. SI units in the controller's world, right-handed; quaternions
 * are x, y, z, w. Little-endian processors with IEEE 754. */

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "the datagrams are little-endian"
#endif

enum
{
    TACTUS_FEED_VERSION = 1,
    TACTUS_FEED_TOOLS_MAX = 16,
    TACTUS_FEED_OBJECTS_MAX = 64, /* Of one datagram. */
    TACTUS_FEED_BYTES_MAX = 14464,
    /* Bits of tactus_feed_tool.flags. */
    TACTUS_FEED_IN_CONTACT = 1,
    TACTUS_FEED_HALTED = 2,
    TACTUS_FEED_OVER_CONSTRAINED = 4,
    TACTUS_FEED_DATA_LIMITED = 8,
    TACTUS_FEED_HAS_GRIPPER = 16
};

/* Head of a datagram; tools and then objects follow. */
typedef struct tactus_feed_head
{
    char magic[4]; /* "TFED" */
    uint16_t head_bytes;
    uint16_t tool_bytes;
    uint16_t object_bytes;
    uint16_t version;
    uint16_t tool_count;
    uint16_t object_count;
    uint16_t part; /* Number of the datagram, from 0, of the part_count of one state. */
    uint16_t part_count;
    uint32_t period_ns; /* Period of the controller's loop. */
    uint64_t serial;    /* Grows with each state of the controller. */
    uint64_t frame;     /* Number of frames run. */
    int64_t time_ns;    /* Start of the frame on the controller's clock. */
    uint8_t controller[16];
    char name[64]; /* Name of the controller. */
} tactus_feed_head;

typedef struct tactus_feed_tool
{
    uint32_t number;
    uint32_t flags;
    uint32_t buttons;     /* Bit n: button n is pressed. */
    uint32_t state;       /* 0 reset, 1 idle, 2 force, 3 brake. */
    double position_m[3]; /* Pose of the device. */
    double rotation[4];
    double proxy_m[3]; /* Pose of the proxy: draw the tool here. */
    double proxy_rotation[4];
    double force_n[3]; /* Sent to the device. */
    double torque_nm[3];
    double gripper_m; /* 0 without a gripper. */
    double radius_m;  /* 0: not known yet. */
    char shape[64];   /* As in hrtc --tool; empty: not known yet. */
} tactus_feed_tool;

typedef struct tactus_feed_object
{
    uint32_t number;         /* On the controller. */
    uint32_t object;         /* On the server, or on the controller without one. */
    uint64_t server;         /* 0: no server. */
    double translation_m[3]; /* World = translation + scale * rotation * point of the mesh. */
    double rotation[4];
    double scale;
    uint8_t model[16]; /* Hash of the model. */
    char name[64];     /* Name of the object, or else of its model. */
} tactus_feed_object;

typedef struct tactus_feed
{
    tactus_feed_head head;
    tactus_feed_tool tools[TACTUS_FEED_TOOLS_MAX];
    tactus_feed_object objects[TACTUS_FEED_OBJECTS_MAX];
} tactus_feed;

#ifdef __cplusplus
static_assert(sizeof(tactus_feed_head) == 128 && offsetof(tactus_feed_head, name) == 64, "");
static_assert(sizeof(tactus_feed_tool) == 256 && offsetof(tactus_feed_tool, shape) == 192, "");
static_assert(sizeof(tactus_feed_object) == 160 && offsetof(tactus_feed_object, name) == 96, "");
static_assert(sizeof(tactus_feed) == TACTUS_FEED_BYTES_MAX, "");
#else
_Static_assert(sizeof(tactus_feed_head) == 128 && offsetof(tactus_feed_head, name) == 64, "");
_Static_assert(sizeof(tactus_feed_tool) == 256 && offsetof(tactus_feed_tool, shape) == 192, "");
_Static_assert(sizeof(tactus_feed_object) == 160 && offsetof(tactus_feed_object, name) == 96, "");
_Static_assert(sizeof(tactus_feed) == TACTUS_FEED_BYTES_MAX, "");
#endif

/* True if all numbers are finite: x - x is 0. */
static inline int tactus_feed_are_finite(const double* numbers, size_t count)
{
    for (size_t i = 0; i < count; ++i)
    {
        if (!(numbers[i] - numbers[i] == 0.0))
        {
            return 0;
        }
    }
    return 1;
}

static inline int tactus_feed_is_sound_tool(const tactus_feed_tool* tool)
{
    return tactus_feed_are_finite(tool->position_m, 3) &&
           tactus_feed_are_finite(tool->rotation, 4) && tactus_feed_are_finite(tool->proxy_m, 3) &&
           tactus_feed_are_finite(tool->proxy_rotation, 4) &&
           tactus_feed_are_finite(tool->force_n, 3) && tactus_feed_are_finite(tool->torque_nm, 3) &&
           tactus_feed_are_finite(&tool->gripper_m, 1) &&
           tactus_feed_are_finite(&tool->radius_m, 1);
}

static inline int tactus_feed_is_sound_object(const tactus_feed_object* object)
{
    return tactus_feed_are_finite(object->translation_m, 3) &&
           tactus_feed_are_finite(object->rotation, 4) &&
           tactus_feed_are_finite(&object->scale, 1) && object->scale > 0.0;
}

/* Reads a datagram into `feed`. Returns NULL, or, with `feed` in no defined state, the reason why
 * the datagram is refused. */
static inline const char* tactus_feed_read(tactus_feed* feed, const char* bytes, size_t size)
{
    tactus_feed_head* head = &feed->head;
    if (size < sizeof(*head))
    {
        return "the datagram is too short";
    }
    memcpy(head, bytes, sizeof(*head));
    if (memcmp(head->magic, "TFED", 4) != 0 || head->version != TACTUS_FEED_VERSION)
    {
        return "the datagram is not of version 1 of the feed";
    }
    if (head->head_bytes != sizeof(*head) || head->tool_bytes != sizeof(tactus_feed_tool) ||
        head->object_bytes != sizeof(tactus_feed_object) ||
        head->tool_count > TACTUS_FEED_TOOLS_MAX || head->object_count > TACTUS_FEED_OBJECTS_MAX ||
        head->part >= head->part_count)
    {
        return "a size or count is out of range";
    }
    const size_t tools = head->tool_count * sizeof(tactus_feed_tool);
    const size_t objects = head->object_count * sizeof(tactus_feed_object);
    if (size != sizeof(*head) + tools + objects)
    {
        return "the datagram's length contradicts its counts";
    }
    memcpy(feed->tools, bytes + sizeof(*head), tools);
    memcpy(feed->objects, bytes + sizeof(*head) + tools, objects);
    head->name[sizeof(head->name) - 1] = 0;
    for (size_t i = 0; i < head->tool_count; ++i)
    {
        feed->tools[i].shape[sizeof(feed->tools[i].shape) - 1] = 0;
        if (!tactus_feed_is_sound_tool(&feed->tools[i]))
        {
            return "a value of a tool is out of range";
        }
    }
    for (size_t i = 0; i < head->object_count; ++i)
    {
        feed->objects[i].name[sizeof(feed->objects[i].name) - 1] = 0;
        if (!tactus_feed_is_sound_object(&feed->objects[i]))
        {
            return "a value of an object is out of range";
        }
    }
    return NULL;
}

#endif
