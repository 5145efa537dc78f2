// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

/* The library for C, and for every language that can call C. Distances and forces of tools at
 * models, as docs/accuracy.md promises them. Units are SI: m, N, N m, s, rad; frames of reference
 * are right-handed, and the world's where no other one is named. A rotation is a 3 x 3 matrix, row
 * by row, orthonormal to 1e-6; a position is x, y, z. Numbers that are given are finite; one out of
 * its range is TACTUS_BAD_ARGUMENT where nothing else is said.
 *
 * Calls return TACTUS_DONE or the kind of what was wrong, and write one line about it, unless
 * `error` is null; nothing has changed then. No exception leaves a call. Records begin with `size`:
 * set it to sizeof of the record, so that a library of another version refuses what it does not
 * know. What a call is given is read during the call, but for memory and models of a frame.
 *
 * Threads: a frame and its models are one thread's at a time, except that tactus_frame_load() may
 * run on one thread beside tactus_frame_run() without `rounds` on another one. Different frames,
 * and models of none, may be used at the same time. */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
#define TACTUS_CALL extern "C"
#else
#define TACTUS_CALL extern
#endif

/* Of records and calls; both sides must have the same one. */
#define TACTUS_ABI 3U
/* The lent memory of a frame starts on a multiple of it. */
#define TACTUS_ALIGNMENT 64U

typedef enum tactus_result
{
    TACTUS_DONE = 0,
    TACTUS_BAD_ARGUMENT = 1, /* A null pointer, a number out of range, NaN. */
    TACTUS_BAD_VERSION = 2,  /* Made for another version of the library, or `size` isn't set. */
    TACTUS_REFUSED = 3,      /* A file, a host or the memory is not good for it. */
    TACTUS_BUSY = 4          /* Memory or a model that a frame has; too many changed objects. */
} tactus_result;

/* One line, without a line end, cut where it is longer; empty after TACTUS_DONE. */
typedef struct tactus_error
{
    char text[512];
} tactus_error;

typedef struct tactus_model tactus_model;
typedef struct tactus_frame tactus_frame;
typedef struct tactus_static_model tactus_static_model;

/* The TACTUS_ABI and the version ("0.2.0", static) of the library that is loaded. */
TACTUS_CALL uint32_t tactus_abi(void);
TACTUS_CALL const char* tactus_version(void);

/* ---- Models ---- */

typedef struct tactus_model_info
{
    size_t size;
    double low_m[3]; /* Box of the source mesh, in its own frame. */
    double high_m[3];
    double diagonal_m; /* Of that box. */
    uint32_t faces;    /* Of the source mesh. */
    uint32_t vertices;
    int32_t is_closed; /* Not 0: the surface has an inside. */
    char hash[33];     /* 32 hexadecimal digits. */
} tactus_model_info;

/* Opens an .spm file; all but its chunks is checked now, each chunk when it is read. Waits for the
 * file. The model is the caller's until tactus_model_close(). */
TACTUS_CALL tactus_result tactus_model_open(uint32_t abi, const char* path, tactus_model** model,
                                            tactus_error* error);
/* Finds NAME or NAME@HASH on a DDS domain, 0 to 232; waits at most 0 to 3600 seconds, and is
 * TACTUS_REFUSED where nobody serves it by then. */
TACTUS_CALL tactus_result tactus_model_find(uint32_t abi, const char* name, uint32_t domain,
                                            double wait_s, tactus_model** model,
                                            tactus_error* error);
TACTUS_CALL tactus_result tactus_model_info_of(const tactus_model* model, tactus_model_info* info,
                                               tactus_error* error);
/* Null is nothing to close. TACTUS_BUSY while a frame has it. */
TACTUS_CALL tactus_result tactus_model_close(tactus_model* model, tactus_error* error);

/* ---- Distances without frames ---- */

typedef enum tactus_side
{
    TACTUS_UNSIGNED = 0, /* The surface is open, or the point is on it. */
    TACTUS_OUTSIDE = 1,
    TACTUS_INSIDE = 2
} tactus_side;

/* Opens an .spm file and refines all of it to its source mesh: about 200 bytes and two microseconds
 * a face. It is the caller's until tactus_static_model_close(). */
TACTUS_CALL tactus_result tactus_static_model_open(uint32_t abi, const char* path,
                                                   tactus_static_model** model,
                                                   tactus_error* error);
/* From N points, N x 3 in the source's frame, to the surface: between lower_m and upper_m, which
 * differ by rounding; nearest_m, N x 3, is of the surface. An output that is null is not written.
 * Any thread, several at once. Some microseconds a point. */
TACTUS_CALL tactus_result tactus_static_model_distances(const tactus_static_model* model,
                                                        size_t count, const double* points_m,
                                                        double* lower_m, double* upper_m,
                                                        uint8_t* side, double* nearest_m,
                                                        tactus_error* error);
/* Null is nothing to close. */
TACTUS_CALL void tactus_static_model_close(tactus_static_model* model);

/* ---- Frames ---- */

typedef enum tactus_shape
{
    TACTUS_SPHERE = 0,  /* A point with the radius. */
    TACTUS_CAPSULE = 1, /* The segment from -half_m to half_m with the radius. */
    TACTUS_BOX = 2      /* The box of the half extents half_m with the radius. */
} tactus_shape;

/* What touches. tactus_tool_default() sets all but the radius. */
typedef struct tactus_tool
{
    size_t size;
    int32_t shape;          /* tactus_shape */
    int32_t passes_through; /* 0: surfaces stop it and make forces. Else it measures where it is. */
    double radius_m;        /* 1e-6 to 1, of one that passes through to 1e3. Within it distances
                             * are exact. */
    double half_m[3];       /* Of a capsule or box, in the tool's frame; up to 1 or 1e3 likewise,
                             * either way, of a box from 0. */
    double stiffness_n_per_m; /* 1e-3 to 1e6: of the spring from proxy to hand. */
    double force_max_n;       /* 1e-3 to 1e6: the force's norm is clamped to it. */
    double torque_max_nm;     /* 0 to 1e6, likewise. A sphere has no torque. */
    double speed_max_m_per_s; /* 1e-6 to 1e6. In contact a hand that is faster is followed at this
                               * speed. */
    double smooth_m;          /* 0, or 1e-4 to 0.1: a sphere feels facets within this width as one
                               * smooth surface; it is within an eighth of it of the mesh. */
    int32_t wants_distance;   /* Not 0: distances become exact however far off, too, in frames
                               * that do so bit by bit behind what a force needs; a BRACKET or
                               * DECIDED until then, or where the memory is too little. */
} tactus_tool;

/* Where an object stands: place = translation + scale * rotation * place in the source mesh. */
typedef struct tactus_pose
{
    double rotation[9];
    double translation_m[3]; /* Up to 1e4 either way. */
    double scale;            /* 1e-3 to 1e3. */
} tactus_pose;

typedef struct tactus_object
{
    size_t size;
    uint32_t model; /* Index into the set-up's models. */
    tactus_pose pose;
    double static_friction;  /* 0 to 3, Coulomb's. */
    double dynamic_friction; /* 0 to the static one. */
} tactus_object;

/* How an object feels. tactus_material_default() makes it smooth and as stiff as the tool. */
typedef struct tactus_material
{
    size_t size;
    double stiffness_n_per_m;   /* 1e-3 to 1e6: the softer of this and the tool's counts; or 0. */
    double static_friction;     /* 0 to 3, Coulomb's. */
    double dynamic_friction;    /* 0 to the static one. */
    double damping_n_s_per_m;   /* 0 to 20, across the surface. */
    double viscosity_n_s_per_m; /* 0 to 20, along it. */
    double texture_height_m;    /* 0, or bumps, at most 1/32 of their length. */
    double texture_length_m;    /* With bumps 1e-4 to 1; else 0 to 1. */
} tactus_material;

typedef struct tactus_setup
{
    size_t size;
    uint32_t abi;                /* TACTUS_ABI */
    uint32_t model_count;        /* 1 to 256. */
    tactus_model* const* models; /* No model twice. */
    const tactus_tool* tools;
    const tactus_object* objects;
    uint32_t tool_count;   /* 1 to 16. */
    uint32_t object_count; /* 1 to 4096. */
    int64_t period_ns;     /* From frame to frame, 1e4 to 1e9. */
    int32_t loads_whole;   /* Not 0: a model that fits its share of the memory is loaded wholly. */
    double object_speed_max_m_per_s; /* 1e-6 to 1e6: see tactus_frame_place(). */
} tactus_setup;

/* Identity pose, no friction; a hand of 500 N/m, 8 N, 0.5 N m, 1 m/s; 1 ms, objects of 0.5 m/s.
 * Sizes and abi, too; all else 0. Null is nothing to fill. */
TACTUS_CALL void tactus_tool_default(tactus_tool* tool);
TACTUS_CALL void tactus_object_default(tactus_object* object);
TACTUS_CALL void tactus_material_default(tactus_material* material);
TACTUS_CALL void tactus_setup_default(tactus_setup* setup);

/* Makes a frame in memory that the caller lends until tactus_frame_end(); nothing grows. It starts
 * on a multiple of TACTUS_ALIGNMENT; with too few bytes the call is TACTUS_REFUSED and says how
 * many the models need. Each model serves one frame at a time, and stays open until that ends. */
TACTUS_CALL tactus_result tactus_frame_make(const tactus_setup* setup, void* memory, size_t bytes,
                                            tactus_frame** frame, tactus_error* error);
/* The memory and the models are the caller's again. Null is nothing to end. */
TACTUS_CALL void tactus_frame_end(tactus_frame* frame);

/* One round of loading: what the last frame asked for comes in with the next one, or from a host
 * with a later one. May wait for a file, allocates, not for a real-time thread. */
TACTUS_CALL tactus_result tactus_frame_load(tactus_frame* frame, tactus_error* error);

/* What is true of a tool, flags of tactus_poses. */
#define TACTUS_IN_CONTACT 1U
#define TACTUS_FROZEN 2U     /* The surface near it has not come yet; its force must fade. */
#define TACTUS_SQUEEZED 4U   /* Objects leave it no room; its force must fade. */
#define TACTUS_CROWDED 8U    /* More touches it than the limits allow. */
#define TACTUS_HELD_BACK 16U /* It went as far as the surface is known. */
#define TACTUS_OUTRUN 32U    /* What it may touch lags its pose; its force must fade. */

typedef enum tactus_kind
{
    TACTUS_EXACT = 0,   /* lower_m and upper_m differ by rounding only. */
    TACTUS_DECIDED = 1, /* Proven to be out of touch. */
    TACTUS_BRACKET = 2, /* Lower bound and upper bound, and the question is open. */
    TACTUS_STALE = 3,   /* Of a pose that is too old. */
    /* As exact, where coarser faces whose error is taken off lower_m count as the surface. */
    TACTUS_WITHIN_TOLERANCE = 4
} tactus_kind;

/* All arrays are the caller's. N poses, T tools, J objects of the set-up, the last index fastest.
 * An output that is null is not written. */
typedef struct tactus_poses
{
    size_t size;
    size_t count;              /* N */
    const double* positions_m; /* N x T x 3: the tools' centres, below 1e6 on each axis. */
    const double* rotations;   /* N x T x 9, or null: none is turned. */
    double* force_n;           /* N x T x 3, on the hand. */
    double* torque_nm;         /* N x T x 3, on the hand, about the tool's position. */
    double* proxy_m;           /* N x T x 3: where the surface lets the tool be. */
    uint32_t* flags;           /* N x T */
    /* From the tool's core, its radius not taken off, at its place: the proxy at the start of the
     * frame. */
    double* lower_m;   /* N x T x J: no surface is nearer. */
    double* upper_m;   /* N x T x J: some surface is within it; infinite where none is known. */
    uint8_t* kind;     /* N x T x J: tactus_kind. */
    double* nearest_m; /* N x T x J x 3: of the surface; NaN where kind isn't TACTUS_EXACT. */
    uint32_t rounds;   /* Frames for each pose, with loading between: until the answers are exact
                        * (or decided, of a tool without wants_distance) and no tool waits for the
                        * surface and nothing is on its way, at most so many, 1 to 10000. 0: one
                        * frame, no loading. */
} tactus_poses;

/* Moves the tools through the poses, a frame for each or as many as `rounds` allows; a pose's
 * answers are those of its last frame. All is checked before the first frame runs, in time by the
 * arrays. Without `rounds` it allocates nothing and makes no system call; with them it may do both,
 * and wait for a file. */
TACTUS_CALL tactus_result tactus_frame_run(tactus_frame* frame, const tactus_poses* poses,
                                           tactus_error* error);
/* With the next frame the object stands there. While a tool touches it, or may within 20 ms, it is
 * carried there with that frame and those after it: no point of it in the tool's reach goes faster
 * than object_speed_max_m_per_s, so no step of a pose makes a force change faster than by stiffness
 * x speed. Behind by more than 20 ms of that, TACTUS_OUTRUN is true of a tool that it may touch in
 * this frame. The last place that was said counts. At most 64 of these, of objects that are being
 * carried, and of tactus_frame_feel() wait for one frame, of more TACTUS_BUSY. On the thread of
 * tactus_frame_run(), as is tactus_frame_state_of(). */
TACTUS_CALL tactus_result tactus_frame_place(tactus_frame* frame, uint32_t object,
                                             const tactus_pose* pose, tactus_error* error);

/* From the next frame on the object feels so; tools that touch it go there from what they felt, in
 * even steps within 50 ms. On the same thread. */
TACTUS_CALL tactus_result tactus_frame_feel(tactus_frame* frame, uint32_t object,
                                            const tactus_material* material, tactus_error* error);

/* Whether each tool, with its centre there, begins inside a closed object where that stands now:
 * the surface then holds it from within, and pulls back a hand that leaves. For before the first
 * frame; allocates, not for a real-time thread. positions_m, T x 3; inside, T: 0 of one that
 * doesn't, and of one that passes through. */
TACTUS_CALL tactus_result tactus_frame_begins_inside(const tactus_frame* frame,
                                                     const double* positions_m, uint8_t* inside,
                                                     tactus_error* error);

typedef struct tactus_frame_state
{
    size_t size;
    uint64_t frames;     /* That were run. */
    uint32_t pages_used; /* Of all models, of 8 KiB each. */
    uint32_t pages_total;
    uint32_t faces_used; /* Active ones. */
    int32_t is_whole;    /* Not 0: all models are here and refined wholly (loads_whole). */
} tactus_frame_state;

TACTUS_CALL tactus_result tactus_frame_state_of(const tactus_frame* frame,
                                                tactus_frame_state* state, tactus_error* error);
