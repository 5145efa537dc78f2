// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
//
// ask FILE | ask NAME DOMAIN: distances, forces and torques of a sphere, a capsule and a box at the
// model `ring`, from a file or a server, in C; and the library's refusals.
#define _POSIX_C_SOURCE 199309L /* nanosleep() */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tactus/tactus.h>
#include <time.h>

enum
{
    BYTES = 4 << 20,
    PATIENCE = 50000, /* Rounds of 2 ms; data from a server take time. */
    STEPS = 600
};

static tactus_error error;
static tactus_setup setup;
static void* memory;

static void need(int is_so, const char* what)
{
    if (!is_so)
    {
        fprintf(stderr, "ask: %s (%s)\n", what, error.text);
        exit(2);
    }
}
static void done(tactus_result result, const char* what)
{
    need(result == TACTUS_DONE, what);
}

/* Expects a refusal of this kind, in one line with these words. */
static void refused(tactus_result result, tactus_result expected, const char* words)
{
    const int is_one_line = strchr(error.text, '\n') == NULL;
    need(result == expected && is_one_line && strstr(error.text, words) != NULL, words);
}
static void bad(tactus_result result, const char* words)
{
    refused(result, TACTUS_BAD_ARGUMENT, words);
}

/* Tool in a separate frame at one place, with all answers of the frame. */
typedef struct probe
{
    tactus_tool tool;
    tactus_frame* frame;
    tactus_poses poses;
    double place_m[3];
    double lower_m;
    double upper_m;
    double nearest_m[3];
    double force_n[3];
    uint8_t kind;
    uint32_t flags;
} probe;

static void begin(probe* p, const tactus_tool* tool, double x_m, double z_m)
{
    memset(p, 0, sizeof(*p));
    p->tool = *tool;
    p->place_m[0] = x_m;
    p->place_m[2] = z_m;
    p->poses.size = sizeof(p->poses);
    p->poses.count = 1;
    p->poses.positions_m = p->place_m;
    p->poses.lower_m = &p->lower_m;
    p->poses.upper_m = &p->upper_m;
    p->poses.nearest_m = p->nearest_m;
    p->poses.force_n = p->force_n;
    p->poses.kind = &p->kind;
    p->poses.flags = &p->flags;
    tactus_setup with_tool = setup;
    with_tool.tools = &p->tool;
    done(tactus_frame_make(&with_tool, memory, BYTES, &p->frame, &error), "make");
}
static void run(probe* p)
{
    done(tactus_frame_run(p->frame, &p->poses, &error), "run");
}
/* Runs until the answer is exact, or with `is_whole` until the whole model is loaded. */
static void run_until(probe* p, int is_whole)
{
    const struct timespec while_s = {0, 2000000};
    tactus_frame_state state;
    state.size = sizeof(state);
    for (int i = 0; i < PATIENCE; ++i)
    {
        run(p);
        done(tactus_frame_load(p->frame, &error), "load");
        done(tactus_frame_state_of(p->frame, &state, &error), "state");
        const int is_exact = p->kind == TACTUS_EXACT && p->upper_m <= p->lower_m + 1e-9;
        if (is_whole ? state.is_whole : is_exact)
        {
            return;
        }
        nanosleep(&while_s, NULL);
    }
    need(0, is_whole ? "never whole" : "never exact");
}

/* Distance of a small tool half a metre above the top of the ring, requested or not. */
static void ask_from_afar(tactus_tool tool, int wants_distance)
{
    probe p;
    tool.radius_m = 0.001;
    tool.wants_distance = wants_distance;
    begin(&p, &tool, 0.028, 0.513);
    if (wants_distance)
    {
        run_until(&p, 0);
        need(fabs(p.lower_m - 0.5) < 5e-5 && fabs(p.nearest_m[2] - 0.013) < 5e-5,
             "another distance from afar");
    }
    else
    {
        p.poses.rounds = 1000;
        run(&p);
        need(p.kind == TACTUS_SEPARATED && p.upper_m - p.lower_m > 0.01,
             "exact though nobody asked");
    }
    printf("from afar: %.3f to %.3f mm\n", 1e3 * p.lower_m, 1e3 * p.upper_m);
    tactus_frame_end(p.frame);
}

/* Distances of an upright tool of this shape, 9.8 mm above the top of the ring. */
static void ask_upright(tactus_tool tool, tactus_shape shape, double x_m, double y_m, double z_m)
{
    probe p;
    tool.shape = (int32_t)shape;
    tool.half_m[0] = x_m;
    tool.half_m[1] = y_m;
    tool.half_m[2] = z_m;
    begin(&p, &tool, 0.028, 0.0228);
    run_until(&p, 0);
    printf("shape %d: %.3f mm\n", tool.shape, 1e3 * p.lower_m);
    need(fabs(p.lower_m - (0.0098 - z_m)) < 5e-5, "another distance of that shape");
    tactus_frame_end(p.frame);
}

/* Capsule across the ring, pressed down with one end: that at x = 0.028 m is over the top, 0.013 m
 * high, and moves from 5 to -1 mm. */
static void press_one_end(void)
{
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
    tactus_tool stick;
    tactus_tool_default(&stick);
    stick.shape = TACTUS_CAPSULE;
    stick.radius_m = 0.002;
    stick.half_m[1] = 0.01; /* A quarter turn puts it along -x. */
    probe p;
    begin(&p, &stick, 0.018, 0.1);
    run_until(&p, 1);
    tactus_poses poses;
    memset(&poses, 0, sizeof(poses));
    poses.size = sizeof(poses);
    poses.count = STEPS;
    poses.positions_m = &places_m[0][0];
    poses.rotations = &rotations[0][0];
    poses.force_n = &force_n[0][0];
    poses.torque_nm = &torque_nm[0][0];
    poses.rounds = 100;
    done(tactus_frame_run(p.frame, &poses, &error), "press");
    const double force = force_n[STEPS - 1][2];
    const double torque = torque_nm[STEPS - 1][1];
    printf("pressed at one end: %.3f N, %.5f N m\n", force, torque);
    /* (x, 0, 0) x (0, 0, F) = (0, -x F, 0), with a lever x of 10 mm. */
    need(force > 0.1 && torque < -0.005 * force && torque > -0.012 * force, "torque");
    need(force_n[0][2] == 0.0 && torque_nm[0][1] == 0.0, "felt before it touches");
    tactus_frame_end(p.frame);
}

/* Tests for the inside: true for a hand in the tube of the ring, false for one in its hole and for
 * a query-only tool. */
static void ask_inside(void)
{
    tactus_tool hand;
    tactus_tool_default(&hand);
    hand.radius_m = 0.001;
    for (int i = 0; i < 3; ++i)
    {
        uint8_t inside = 9;
        hand.query_only = i == 2;
        probe p;
        begin(&p, &hand, i == 1 ? 0.0 : 0.028, 0.0);
        done(tactus_frame_begins_inside(p.frame, p.place_m, &inside, &error), "inside");
        need(inside == (i == 0), "another side of the ring");
        p.place_m[0] = NAN;
        need(tactus_frame_begins_inside(p.frame, p.place_m, &inside, &error) == TACTUS_BAD_ARGUMENT,
             "a place that is no number");
        tactus_frame_end(p.frame);
    }
}

/* Greatest step of the force on a hand 3 mm deep, while the ring moves up and down by 2 mm every
 * four frames, with this object speed limit. */
static double shake(double speed_m_per_s)
{
    tactus_tool hand;
    tactus_tool_default(&hand);
    hand.radius_m = 0.002;
    setup.object_speed_max_m_per_s = speed_m_per_s;
    probe p;
    begin(&p, &hand, 0.028, 0.025);
    run_until(&p, 1);
    p.poses.rounds = 100;
    for (; p.place_m[2] > 0.012; p.place_m[2] -= 0.0001)
    {
        run(&p);
    }
    need(p.force_n[2] > 1.2 && (p.flags & TACTUS_IN_CONTACT) != 0, "no touch");
    p.poses.rounds = 0;
    double step_max_n = 0.0;
    tactus_object ring;
    tactus_object_default(&ring);
    for (int i = 0; i < 200; ++i)
    {
        ring.pose.translation_m[2] = i / 4 % 2 == 0 ? 0.002 : -0.002;
        done(tactus_frame_place(p.frame, 0, &ring.pose, &error), "place");
        const double before_n = p.force_n[2];
        done(tactus_frame_load(p.frame, &error), "load");
        run(&p);
        step_max_n = fmax(step_max_n, fabs(p.force_n[2] - before_n));
        need((p.flags & TACTUS_RATE_LIMITED) == 0, "4 mm are more than 20 ms");
    }
    tactus_frame_end(p.frame);
    printf("shaken at %g m/s: %.3f N at once\n", speed_m_per_s, step_max_n);
    return step_max_n;
}

/* Refusals while `p` has the memory and the model. */
static void ask_for_what_is_refused(probe* p, const char* file, tactus_model* model)
{
    /* Another version of library, records or frame. */
    tactus_model* other = NULL;
    tactus_frame* second = NULL;
    refused(tactus_model_open(TACTUS_ABI + 1, file, &other, &error), TACTUS_BAD_VERSION,
            "the program was compiled for ABI version 4; this library has 3");
    tactus_tool tool = p->tool;
    tactus_setup bad_setup = setup;
    bad_setup.tools = &tool;
    bad_setup.abi = TACTUS_ABI + 1;
    refused(tactus_frame_make(&bad_setup, memory, BYTES, &second, &error), TACTUS_BAD_VERSION,
            "compiled for ABI version 4");
    bad_setup.abi = TACTUS_ABI;
    tool.size -= 8;
    refused(tactus_frame_make(&bad_setup, memory, BYTES, &second, &error), TACTUS_BAD_VERSION,
            "tools[0].: size is");
    tool.size += 8;

    /* Memory and model of another frame; memory that is too small or not aligned. */
    refused(tactus_frame_make(&bad_setup, memory, BYTES, &second, &error), TACTUS_BUSY,
            "memory: another frame uses this memory");
    refused(tactus_model_close(model, &error), TACTUS_BUSY, "is in use by a frame");
    void* more = aligned_alloc(TACTUS_ALIGNMENT, BYTES);
    refused(tactus_frame_make(&bad_setup, more, BYTES, &second, &error), TACTUS_BUSY,
            "is in another frame");
    refused(tactus_frame_make(&bad_setup, more, 4096, &second, &error), TACTUS_REFUSED,
            "memory: 4096 bytes");
    bad(tactus_frame_make(&bad_setup, (char*)more + 1, BYTES - 1, &second, &error),
        "multiple of 64");
    bad(tactus_frame_make(&bad_setup, NULL, BYTES, &second, &error), "memory: null");
    bad_setup.object_speed_max_m_per_s = 0.0;
    bad(tactus_frame_make(&bad_setup, more, BYTES, &second, &error),
        "setup.object_speed_max_m_per_s: 0; 1e-06 to 1000000 is allowed");
    free(more);

    /* Numbers out of range. */
    double bad_m[3] = {0.0, NAN, 0.0};
    p->poses.positions_m = bad_m;
    bad(tactus_frame_run(p->frame, &p->poses, &error), "poses.positions_m: element 1 is nan");
    p->poses.positions_m = NULL;
    bad(tactus_frame_run(p->frame, &p->poses, &error), "positions_m: null");
    p->poses.positions_m = p->place_m;
    tactus_object ring;
    tactus_object_default(&ring);
    bad(tactus_frame_place(p->frame, 1, &ring.pose, &error), "object: 1; 0 to 0 is allowed");
    ring.pose.scale = 0.0;
    bad(tactus_frame_place(p->frame, 0, &ring.pose, &error), "pose.scale: 0");
    tactus_material rough;
    tactus_material_default(&rough);
    rough.static_friction = 11.0;
    bad(tactus_frame_feel(p->frame, 0, &rough, &error),
        "material.static_friction: 11; 0 to 3 is allowed");
    rough.static_friction = 0.5;
    bad(tactus_frame_feel(p->frame, 1, &rough, &error), "object: 1; 0 to 0 is allowed");
    rough.size -= 8;
    refused(tactus_frame_feel(p->frame, 0, &rough, &error), TACTUS_BAD_VERSION,
            "material: size is");
    rough.size += 8;
    done(tactus_frame_feel(p->frame, 0, &rough, &error), "feel");
}

int main(int argc, char** argv)
{
    tactus_model* model = NULL;
    need(argc == 2 || argc == 3, "usage: ask FILE | ask NAME DOMAIN");
    if (argc == 2)
    {
        done(tactus_model_open(TACTUS_ABI, argv[1], &model, &error), "open");
    }
    else
    {
        const uint32_t domain = (uint32_t)strtoul(argv[2], NULL, 10);
        done(tactus_model_find(TACTUS_ABI, argv[1], domain, 60.0, &model, &error), "find");
    }
    tactus_model_info info;
    info.size = sizeof(info);
    done(tactus_model_info_of(model, &info, &error), "info");
    need(info.faces > 1000 && info.is_closed && strlen(info.hash) == 32, "another model");

    tactus_tool sphere;
    tactus_tool_default(&sphere);
    sphere.radius_m = 0.02;
    sphere.query_only = 1;
    tactus_object ring;
    tactus_object_default(&ring);
    tactus_setup_default(&setup);
    setup.models = &model;
    setup.model_count = 1;
    setup.tool_count = 1;
    setup.objects = &ring;
    setup.object_count = 1;
    memory = aligned_alloc(TACTUS_ALIGNMENT, BYTES);

    /* Points in the middle of its hole, and 9.8 mm above the top of the ring. */
    probe p;
    begin(&p, &sphere, 0.0, 0.0);
    for (int i = 0; i < 2; ++i)
    {
        p.place_m[0] = i == 0 ? 0.0 : 0.028;
        p.place_m[2] = i == 0 ? 0.0 : 0.0228;
        run_until(&p, 0);
        printf("%.3f to %.3f mm\n", 1e3 * p.lower_m, 1e3 * p.upper_m);
        need(p.lower_m > 0.009 && p.upper_m < 0.018, "another distance");
    }
    ask_for_what_is_refused(&p, argv[1], model);

    /* An object that moves away by 5 mm is 5 mm farther away. */
    const double before_m = p.lower_m;
    ring.pose.translation_m[2] = -0.005;
    done(tactus_frame_place(p.frame, 0, &ring.pose, &error), "place");
    p.poses.rounds = 1000; /* It moves there by 0.5 mm a frame. */
    run(&p);
    need(fabs(p.lower_m - before_m - 0.005) < 1e-3, "not farther away");
    tactus_frame_end(p.frame);

    ring.pose.translation_m[2] = 0.0;
    ask_upright(sphere, TACTUS_CAPSULE, 0.0, 0.0, 0.004);
    ask_upright(sphere, TACTUS_BOX, 0.001, 0.002, 0.006);
    ask_from_afar(sphere, 1);
    ask_from_afar(sphere, 0);
    setup.loads_whole = 1;
    press_one_end();
    ask_inside();
    /* 500 N/m: half a metre a second changes the force by 0.25 N a frame. */
    need(shake(0.5) < 0.33, "a step of the force");
    need(shake(1e6) > 1.5, "no step though no speed is too high");
    done(tactus_model_close(model, &error), "close");
    free(memory);
    return 0;
}
