// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
//
// ask FILE | ask NAME DOMAIN: distances of a ball, a capsule and a box to the model `ring`, of a
// file or of a host, forces and torques, from C; and what the library refuses.
#define _POSIX_C_SOURCE 199309L /* nanosleep() */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tactus/tactus.h>
#include <time.h>

static void need(int is_so, const char* what, const tactus_error* error)
{
    if (!is_so)
    {
        fprintf(stderr, "ask: %s (%s)\n", what, error->text);
        exit(2);
    }
}

/* The call was refused in this way, with one line that has these words. */
static void refused(tactus_result result, tactus_result expected, const char* words,
                    const tactus_error* error)
{
    const int is_one_line = strchr(error->text, '\n') == NULL;
    need(result == expected && is_one_line && strstr(error->text, words) != NULL, words, error);
}

/* All poses are exact; what a host sends takes its time. */
static void run_until_exact(tactus_frame* frame, const tactus_poses* poses, tactus_error* error)
{
    const struct timespec while_s = {0, 2000000};
    int is_open = 1;
    for (int i = 0; i < 5000 && is_open; ++i)
    {
        need(tactus_frame_run(frame, poses, error) == TACTUS_DONE, "run", error);
        is_open = 0;
        for (size_t k = 0; k < poses->count; ++k)
        {
            is_open |=
                poses->kind[k] != TACTUS_EXACT || poses->upper_m[k] > poses->lower_m[k] + 1e-9;
        }
        need(nanosleep(&while_s, NULL) == 0 || is_open == 0, "sleep", error);
    }
    need(!is_open, "never exact", error);
}

/* Half a metre above the top of the ring, by a small tool that asks, or that doesn't. */
static void ask_from_afar(const tactus_setup* of_ball, int wants_distance, void* memory,
                          size_t bytes, tactus_error* error)
{
    tactus_tool tool = *of_ball->tools;
    tool.radius_m = 0.001;
    tool.wants_distance = wants_distance;
    tactus_setup setup = *of_ball;
    setup.tools = &tool;
    tactus_frame* frame = NULL;
    need(tactus_frame_make(&setup, memory, bytes, &frame, error) == TACTUS_DONE, "make", error);

    const double place_m[3] = {0.028, 0.0, 0.513};
    double lower_m[1];
    double upper_m[1];
    double nearest_m[3];
    uint8_t kind[1];
    tactus_poses poses;
    memset(&poses, 0, sizeof(poses));
    poses.size = sizeof(poses);
    poses.count = 1;
    poses.positions_m = place_m;
    poses.lower_m = lower_m;
    poses.upper_m = upper_m;
    poses.nearest_m = nearest_m;
    poses.kind = kind;
    poses.rounds = 1000;
    if (wants_distance)
    {
        run_until_exact(frame, &poses, error);
        need(fabs(lower_m[0] - 0.5) < 5e-5 && fabs(nearest_m[2] - 0.013) < 5e-5,
             "another distance from afar", error);
    }
    else
    {
        need(tactus_frame_run(frame, &poses, error) == TACTUS_DONE, "run", error);
        need(kind[0] == TACTUS_DECIDED && upper_m[0] - lower_m[0] > 0.01,
             "exact though nobody asked", error);
    }
    printf("from afar: %.3f to %.3f mm\n", 1e3 * lower_m[0], 1e3 * upper_m[0]);
    tactus_frame_end(frame);
}

/* Distances of a tool of this shape that stands upright, 9.8 mm above the top of the ring. */
static void ask_upright(const tactus_setup* of_ball, tactus_shape shape, const double half_m[3],
                        void* memory, size_t bytes, tactus_error* error)
{
    tactus_tool tool = *of_ball->tools;
    tool.shape = (int32_t)shape;
    memcpy(tool.half_m, half_m, sizeof(tool.half_m));
    tactus_setup setup = *of_ball;
    setup.tools = &tool;
    tactus_frame* frame = NULL;
    need(tactus_frame_make(&setup, memory, bytes, &frame, error) == TACTUS_DONE, "make", error);

    const double place_m[3] = {0.028, 0.0, 0.0228};
    double lower_m[1];
    double upper_m[1];
    uint8_t kind[1];
    tactus_poses poses;
    memset(&poses, 0, sizeof(poses));
    poses.size = sizeof(poses);
    poses.count = 1;
    poses.positions_m = place_m;
    poses.lower_m = lower_m;
    poses.upper_m = upper_m;
    poses.kind = kind;
    poses.rounds = 1000;
    run_until_exact(frame, &poses, error);
    printf("shape %d: %.3f mm\n", tool.shape, 1e3 * lower_m[0]);
    need(fabs(lower_m[0] - (0.0098 - half_m[2])) < 5e-5, "another distance of that shape", error);
    tactus_frame_end(frame);
}

/* A capsule that lies across the ring is pressed down with one end. */
static void press_one_end(const tactus_setup* of_ball, void* memory, size_t bytes,
                          tactus_error* error)
{
    tactus_tool stick;
    tactus_tool_default(&stick);
    stick.shape = TACTUS_CAPSULE;
    stick.radius_m = 0.002;
    stick.half_m[1] = 0.01; /* Turned by a quarter below, so that it lies along -x. */
    tactus_setup setup = *of_ball;
    setup.tools = &stick;
    tactus_frame* frame = NULL;
    need(tactus_frame_make(&setup, memory, bytes, &frame, error) == TACTUS_DONE, "make", error);

    /* The end at x = 0.028 m is over the top, 0.013 m high; it is lowered from 5 to -1 mm. */
    enum
    {
        STEPS = 600
    };
    static double places_m[STEPS][3];
    static double rotations[STEPS][9];
    static double force_n[STEPS][3];
    static double torque_nm[STEPS][3];
    static const double quarter[9] = {0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0};
    for (int i = 0; i < STEPS; ++i)
    {
        places_m[i][0] = 0.018;
        places_m[i][2] = 0.015 + 0.005 - 0.00001 * i;
        memcpy(rotations[i], quarter, sizeof(quarter));
    }
    tactus_poses poses;
    memset(&poses, 0, sizeof(poses));
    poses.size = sizeof(poses);
    poses.count = STEPS;
    poses.positions_m = &places_m[0][0];
    poses.rotations = &rotations[0][0];
    poses.force_n = &force_n[0][0];
    poses.torque_nm = &torque_nm[0][0];
    poses.rounds = 100;
    need(tactus_frame_run(frame, &poses, error) == TACTUS_DONE, "press", error);
    const double force = force_n[STEPS - 1][2];
    const double torque = torque_nm[STEPS - 1][1];
    printf("pressed at one end: %.3f N, %.5f N m\n", force, torque);
    /* (x, 0, 0) x (0, 0, F) = (0, -x F, 0), with a lever x of 10 mm. */
    need(force > 0.1 && torque < -0.005 * force && torque > -0.012 * force, "torque", error);
    need(force_n[0][2] == 0.0 && torque_nm[0][1] == 0.0, "felt before it touches", error);
    tactus_frame_end(frame);
}

/* The largest step of the force of a hand 3 mm deep, under which the ring goes up and down by 2 mm
 * every four frames; of a ring that is believed to move at that speed at most. */
static double shake(const tactus_setup* of_ball, double speed_m_per_s, void* memory, size_t bytes,
                    tactus_error* error)
{
    tactus_tool hand;
    tactus_tool_default(&hand);
    hand.radius_m = 0.002;
    tactus_setup setup = *of_ball;
    setup.tools = &hand;
    setup.object_speed_max_m_per_s = speed_m_per_s;
    tactus_frame* frame = NULL;
    need(tactus_frame_make(&setup, memory, bytes, &frame, error) == TACTUS_DONE, "make", error);
    double place_m[3] = {0.028, 0.0, 0.025};
    double force_n[3] = {0.0, 0.0, 0.0};
    uint32_t flags[1] = {0};
    tactus_poses poses;
    memset(&poses, 0, sizeof(poses));
    poses.size = sizeof(poses);
    poses.count = 1;
    poses.positions_m = place_m;
    poses.force_n = force_n;
    poses.flags = flags;
    poses.rounds = 100;
    for (; place_m[2] > 0.012; place_m[2] -= 0.0001)
    {
        need(tactus_frame_run(frame, &poses, error) == TACTUS_DONE, "come down", error);
    }
    need(force_n[2] > 1.2 && (flags[0] & TACTUS_IN_CONTACT) != 0, "no touch", error);
    poses.rounds = 0;
    double step_max_n = 0.0;
    tactus_object ring;
    tactus_object_default(&ring);
    for (int i = 0; i < 200; ++i)
    {
        ring.pose.translation_m[2] = i / 4 % 2 == 0 ? 0.002 : -0.002;
        need(tactus_frame_place(frame, 0, &ring.pose, error) == TACTUS_DONE, "place", error);
        const double before_n = force_n[2];
        need(tactus_frame_load(frame, error) == TACTUS_DONE, "load", error);
        need(tactus_frame_run(frame, &poses, error) == TACTUS_DONE, "run", error);
        step_max_n = fmax(step_max_n, fabs(force_n[2] - before_n));
        need((flags[0] & TACTUS_OUTRUN) == 0, "4 mm are more than 20 ms", error);
    }
    tactus_frame_end(frame);
    printf("shaken at %g m/s: %.3f N at once\n", speed_m_per_s, step_max_n);
    return step_max_n;
}

int main(int argc, char** argv)
{
    tactus_error error = {""};
    tactus_model* model = NULL;
    need(argc == 2 || argc == 3, "usage: ask FILE | ask NAME DOMAIN", &error);
    if (argc == 2)
    {
        need(tactus_model_open(TACTUS_ABI, argv[1], &model, &error) == TACTUS_DONE, "open", &error);
    }
    else
    {
        const uint32_t domain = (uint32_t)strtoul(argv[2], NULL, 10);
        need(tactus_model_find(TACTUS_ABI, argv[1], domain, 20.0, &model, &error) == TACTUS_DONE,
             "find", &error);
    }
    tactus_model_info info;
    info.size = sizeof(info);
    need(tactus_model_info_of(model, &info, &error) == TACTUS_DONE, "info", &error);
    need(info.faces > 1000 && info.is_closed && strlen(info.hash) == 32, "another model", &error);

    tactus_tool ball;
    tactus_tool_default(&ball);
    ball.radius_m = 0.02;
    ball.passes_through = 1;
    tactus_object ring;
    tactus_object_default(&ring);
    tactus_setup setup;
    tactus_setup_default(&setup);
    setup.models = &model;
    setup.model_count = 1;
    setup.tools = &ball;
    setup.tool_count = 1;
    setup.objects = &ring;
    setup.object_count = 1;

    const size_t bytes = (size_t)4 << 20;
    void* memory = aligned_alloc(TACTUS_ALIGNMENT, bytes);
    tactus_frame* frame = NULL;
    need(tactus_frame_make(&setup, memory, bytes, &frame, &error) == TACTUS_DONE, "make", &error);

    /* 9.8 mm above the top of the ring, and in the middle of its hole. */
    const double places_m[6] = {0.028, 0.0, 0.0228, 0.0, 0.0, 0.0};
    double lower_m[2];
    double upper_m[2];
    uint8_t kind[2];
    tactus_poses poses;
    memset(&poses, 0, sizeof(poses));
    poses.size = sizeof(poses);
    poses.count = 2;
    poses.positions_m = places_m;
    poses.lower_m = lower_m;
    poses.upper_m = upper_m;
    poses.kind = kind;
    poses.rounds = 1000;
    run_until_exact(frame, &poses, &error);
    for (int i = 0; i < 2; ++i)
    {
        printf("%.3f to %.3f mm, %s\n", 1e3 * lower_m[i], 1e3 * upper_m[i],
               kind[i] == TACTUS_EXACT ? "exact" : "not exact");
        need(kind[i] == TACTUS_EXACT && upper_m[i] - lower_m[i] < 1e-9, "not exact", &error);
        need(lower_m[i] > 0.009 && upper_m[i] < 0.018, "another distance", &error);
    }

    /* Another version of library, records or frame. */
    tactus_model* other = NULL;
    tactus_frame* second = NULL;
    refused(tactus_model_open(TACTUS_ABI + 1, argv[1], &other, &error), TACTUS_BAD_VERSION,
            "made for ABI version 3; this library has 2", &error);
    setup.abi = TACTUS_ABI + 1;
    refused(tactus_frame_make(&setup, memory, bytes, &second, &error), TACTUS_BAD_VERSION,
            "made for ABI version 3", &error);
    setup.abi = TACTUS_ABI;
    ball.size -= 8;
    refused(tactus_frame_make(&setup, memory, bytes, &second, &error), TACTUS_BAD_VERSION,
            "tools[0].: its size is", &error);
    ball.size += 8;

    /* What another frame has; memory that is too small, or starts anywhere. */
    refused(tactus_frame_make(&setup, memory, bytes, &second, &error), TACTUS_BUSY,
            "memory: a frame that has not ended uses it", &error);
    refused(tactus_model_close(model, &error), TACTUS_BUSY, "serves a frame", &error);
    void* more = aligned_alloc(TACTUS_ALIGNMENT, bytes);
    refused(tactus_frame_make(&setup, more, bytes, &second, &error), TACTUS_BUSY,
            "serves another frame", &error);
    refused(tactus_frame_make(&setup, more, 4096, &second, &error), TACTUS_REFUSED,
            "memory: 4096 bytes", &error);
    refused(tactus_frame_make(&setup, (char*)more + 1, bytes - 1, &second, &error),
            TACTUS_BAD_ARGUMENT, "multiple of 64", &error);
    refused(tactus_frame_make(&setup, NULL, bytes, &second, &error), TACTUS_BAD_ARGUMENT,
            "memory: null", &error);

    /* Numbers. */
    double bad_m[6] = {0.0, 0.0, 0.0, 0.0, NAN, 0.0};
    poses.positions_m = bad_m;
    refused(tactus_frame_run(frame, &poses, &error), TACTUS_BAD_ARGUMENT,
            "poses.positions_m: element 4 is nan", &error);
    poses.positions_m = NULL;
    refused(tactus_frame_run(frame, &poses, &error), TACTUS_BAD_ARGUMENT, "positions_m: null",
            &error);
    refused(tactus_frame_place(frame, 1, &ring.pose, &error), TACTUS_BAD_ARGUMENT,
            "object: 1; 0 to 0 is allowed", &error);
    ring.pose.scale = 0.0;
    refused(tactus_frame_place(frame, 0, &ring.pose, &error), TACTUS_BAD_ARGUMENT, "pose.scale: 0",
            &error);
    ring.pose.scale = 1.0;

    tactus_material rough;
    tactus_material_default(&rough);
    rough.static_friction = 11.0;
    refused(tactus_frame_feel(frame, 0, &rough, &error), TACTUS_BAD_ARGUMENT,
            "material.static_friction: 11; 0 to 10 is allowed", &error);
    rough.static_friction = 0.5;
    refused(tactus_frame_feel(frame, 1, &rough, &error), TACTUS_BAD_ARGUMENT,
            "object: 1; 0 to 0 is allowed", &error);
    rough.size -= 8;
    refused(tactus_frame_feel(frame, 0, &rough, &error), TACTUS_BAD_VERSION,
            "material: its size is", &error);
    rough.size += 8;
    setup.object_speed_max_m_per_s = 0.0;
    refused(tactus_frame_make(&setup, more, bytes, &second, &error), TACTUS_BAD_ARGUMENT,
            "setup.object_speed_max_m_per_s: 0; 1e-06 to 1000000 is allowed", &error);
    setup.object_speed_max_m_per_s = 0.5;
    need(tactus_frame_feel(frame, 0, &rough, &error) == TACTUS_DONE, "feel", &error);

    /* An object that moves away by 5 mm is 5 mm farther away. */
    poses.positions_m = places_m;
    poses.count = 1;
    ring.pose.translation_m[2] = -0.005;
    need(tactus_frame_place(frame, 0, &ring.pose, &error) == TACTUS_DONE, "place", &error);
    const double before_m = lower_m[0];
    need(tactus_frame_run(frame, &poses, &error) == TACTUS_DONE, "run again", &error);
    need(fabs(lower_m[0] - before_m - 0.005) < 1e-3, "not farther away", &error);

    tactus_frame_end(frame);

    ring.pose.translation_m[2] = 0.0;
    const double capsule_half_m[3] = {0.0, 0.0, 0.004};
    const double box_half_m[3] = {0.001, 0.002, 0.006};
    ask_upright(&setup, TACTUS_CAPSULE, capsule_half_m, memory, bytes, &error);
    ask_upright(&setup, TACTUS_BOX, box_half_m, memory, bytes, &error);
    ask_from_afar(&setup, 1, memory, bytes, &error);
    ask_from_afar(&setup, 0, memory, bytes, &error);
    press_one_end(&setup, memory, bytes, &error);
    /* 500 N/m: half a metre a second changes the force by 0.25 N a frame. */
    need(shake(&setup, 0.5, memory, bytes, &error) < 0.33, "a step of the force", &error);
    need(shake(&setup, 1e6, memory, bytes, &error) > 1.5, "no step though all is believed", &error);
    need(tactus_model_close(model, &error) == TACTUS_DONE, "close", &error);
    free(memory);
    free(more);
    return 0;
}
