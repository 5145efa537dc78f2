// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

/* C interface of the library, for C and languages that can call C: distances and forces between
 * tools and models, with the accuracy of docs/accuracy.md. Units are SI: m, N, N m, s, rad. Frames
 * of reference are right-handed; positions are in the world frame unless another one is named. A
 * rotation is a 3 x 3 matrix, row by row, orthonormal to 1e-6; a position is x, y, z. Inputs must
 * be finite; the result for one out of its range is TACTUS_BAD_ARGUMENT unless stated otherwise.
 *
 * Calls return TACTUS_DONE or the kind of fault. A fault changes nothing and is described in one
 * line in `error`, unless that is null. No exception leaves a call. Records begin with `size`: set
 * it to sizeof of the record, so that a library of another version refuses unknown records. Inputs
 * are read during the call only, except the memory and models of a frame.
 *
 * Threads: a frame and its models belong to one thread at a time, with one exception:
 * tactus_frame_load() may run on one thread while tactus_frame_run() without `rounds` runs on
 * another one. Different frames, and models without a frame, may be used at the same time. */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
#define TACTUS_CALL extern "C"
#else
#define TACTUS_CALL extern
#endif

/* Version of records and calls; caller and library must have the same one. */
#define TACTUS_ABI 3U
/* Alignment of the start of a frame's memory, in bytes. */
#define TACTUS_ALIGNMENT 64U

typedef enum tactus_result
{
    TACTUS_DONE = 0,
    TACTUS_BAD_ARGUMENT = 1, /* Null pointer, number out of range, NaN. */
    TACTUS_BAD_VERSION = 2,  /* Another version of the library, or `size` not set. */
    TACTUS_REFUSED = 3,      /* Unsuitable file, model server or memory. */
    TACTUS_BUSY = 4          /* Memory or model in use by a frame; too many changes. */
} tactus_result;

/* One line without a line end, truncated if longer; empty after TACTUS_DONE. */
typedef struct tactus_error
{
    char text[512];
} tactus_error;

typedef struct tactus_model tactus_model;
typedef struct tactus_frame tactus_frame;
typedef struct tactus_static_model tactus_static_model;

/* TACTUS_ABI and version ("0.2.0", static) of the loaded library. */
TACTUS_CALL uint32_t tactus_abi(void);
TACTUS_CALL const char* tactus_version(void);

/* ---- Models ---- */

typedef struct tactus_model_info
{
    size_t size;
    double low_m[3]; /* Box of the source mesh, in its own frame. */
    double high_m[3];
    double diagonal_m; /* Diagonal of that box. */
    uint32_t faces;    /* Faces of the source mesh. */
    uint32_t vertices;
    int32_t is_closed; /* Not 0: the surface encloses an inside. */
    char hash[33];     /* 32 hexadecimal digits. */
} tactus_model_info;

/* Opens an .spm file. Checks everything except the chunks, which are checked when read. Waits for
 * the file. The caller owns the model until tactus_model_close(). */
TACTUS_CALL tactus_result tactus_model_open(uint32_t abi, const char* path, tactus_model** model,
                                            tactus_error* error);
/* Finds a model NAME or NAME@HASH on a DDS domain, 0 to 232. Waits at most `wait_s`, 0 to 3600 s;
 * TACTUS_REFUSED if no server offers the model by then. */
TACTUS_CALL tactus_result tactus_model_find(uint32_t abi, const char* name, uint32_t domain,
                                            double wait_s, tactus_model** model,
                                            tactus_error* error);
TACTUS_CALL tactus_result tactus_model_info_of(const tactus_model* model, tactus_model_info* info,
                                               tactus_error* error);
/* Closes a model; null has no effect. TACTUS_BUSY while a frame uses it. */
TACTUS_CALL tactus_result tactus_model_close(tactus_model* model, tactus_error* error);

/* ---- Distances without frames ---- */

typedef enum tactus_side
{
    TACTUS_UNSIGNED = 0, /* Open surface, or point on the surface. */
    TACTUS_OUTSIDE = 1,
    TACTUS_INSIDE = 2
} tactus_side;

/* Opens an .spm file and refines it to its source mesh: about 200 bytes and two microseconds a
 * face. The caller owns the model until tactus_static_model_close(). */
TACTUS_CALL tactus_result tactus_static_model_open(uint32_t abi, const char* path,
                                                   tactus_static_model** model,
                                                   tactus_error* error);
/* Computes the distances from `count` points, N x 3 in the source's frame, to the surface. Each is
 * between lower_m and upper_m, which differ by rounding; nearest_m, N x 3, is the nearest point of
 * the surface. Null outputs are not written. Any thread, several at once. Some microseconds a
 * point. */
TACTUS_CALL tactus_result tactus_static_model_distances(const tactus_static_model* model,
                                                        size_t count, const double* points_m,
                                                        double* lower_m, double* upper_m,
                                                        uint8_t* side, double* nearest_m,
                                                        tactus_error* error);
/* Closes a model; null has no effect. */
TACTUS_CALL void tactus_static_model_close(tactus_static_model* model);

/* ---- Frames ---- */

typedef enum tactus_shape
{
    TACTUS_SPHERE = 0,  /* Sphere of the radius. */
    TACTUS_CAPSULE = 1, /* Segment from -half_m to half_m with the radius. */
    TACTUS_BOX = 2      /* Box of the half extents half_m with the radius. */
} tactus_shape;

/* A tool. tactus_tool_default() sets all members except the radius. */
typedef struct tactus_tool
{
    size_t size;
    int32_t shape;            /* tactus_shape */
    int32_t query_only;       /* Not 0: query-only, it measures at its position without forces. 0:
                               * surfaces stop it and cause forces. */
    double radius_m;          /* Radius, 1e-6 to 1, up to 1e3 if query-only. Distances within it are
                               * exact. */
    double half_m[3];         /* Half extents of a capsule or box, in the tool's frame; within 1, or
                               * 1e3 if query-only, in both directions; not negative for a box. */
    double stiffness_n_per_m; /* Stiffness of the spring from proxy to device, 1e-3 to 1e6. */
    double force_max_n;       /* Limit of the force's norm, 1e-3 to 1e6. */
    double torque_max_nm;     /* Limit of the torque's norm, 0 to 1e6. A sphere has no torque. */
    double speed_max_m_per_s; /* Proxy speed limit in contact, 1e-6 to 1e6: a faster device pose is
                               * followed at this speed. */
    double shading_m;         /* Width of force shading, 0 or 1e-4 to 0.1, for spheres only: facets
                               * within it are felt as one smooth surface, which is within an
                               * eighth of it of the mesh. */
    int32_t wants_distance;   /* Not 0: distances become exact at any range too, over several frames
                               * and after the needs of forces; BOUNDED or SEPARATED until then, or
                               * if the memory does not suffice. */
} tactus_tool;

/* Pose of an object: position = translation + scale * rotation * position in the source mesh. */
typedef struct tactus_pose
{
    double rotation[9];
    double translation_m[3]; /* Within 1e4 in both directions. */
    double scale;            /* 1e-3 to 1e3. */
} tactus_pose;

typedef struct tactus_object
{
    size_t size;
    uint32_t model; /* Index into the set-up's models. */
    tactus_pose pose;
    double static_friction;  /* Coulomb coefficient, 0 to 3. */
    double dynamic_friction; /* 0 to the static one. */
} tactus_object;

/* Material of an object. tactus_material_default() makes it smooth and as stiff as the tool. */
typedef struct tactus_material
{
    size_t size;
    double stiffness_n_per_m;   /* 1e-3 to 1e6, limited to the tool's; or 0: the tool's. */
    double static_friction;     /* Coulomb coefficient, 0 to 3. */
    double dynamic_friction;    /* 0 to the static one. */
    double damping_n_s_per_m;   /* 0 to 20, normal to the surface. */
    double viscosity_n_s_per_m; /* 0 to 20, tangential. */
    double texture_height_m;    /* 0: smooth; at most 1/32 of the length. */
    double texture_length_m;    /* 1e-4 to 1; without texture 0 to 1. */
} tactus_material;

typedef struct tactus_setup
{
    size_t size;
    uint32_t abi;                /* TACTUS_ABI */
    uint32_t model_count;        /* 1 to 256. */
    tactus_model* const* models; /* Different models. */
    const tactus_tool* tools;
    const tactus_object* objects;
    uint32_t tool_count;   /* 1 to 16. */
    uint32_t object_count; /* 1 to 4096. */
    int64_t period_ns;     /* Period of frames, 1e4 to 1e9. */
    int32_t loads_whole;   /* Not 0: models that fit their share of the memory are loaded fully. */
    double object_speed_max_m_per_s; /* 1e-6 to 1e6, see tactus_frame_place(). */
} tactus_setup;

/* Fill a record with defaults and set `size`; members not named here are 0. Tool: 500 N/m, 8 N,
 * 0.5 N m, 1 m/s. Object: identity pose, no friction. Set-up: `abi`, a period of 1 ms, objects of
 * 0.5 m/s at most. A null pointer has no effect. */
TACTUS_CALL void tactus_tool_default(tactus_tool* tool);
TACTUS_CALL void tactus_object_default(tactus_object* object);
TACTUS_CALL void tactus_material_default(tactus_material* material);
TACTUS_CALL void tactus_setup_default(tactus_setup* setup);

/* Creates a frame in memory that the caller provides until tactus_frame_end(); it never grows. The
 * memory must start on a multiple of TACTUS_ALIGNMENT. TACTUS_REFUSED if it is too small; the line
 * in `error` has the number of bytes that the models need. Each model serves one frame at a time,
 * and must stay open until that ends. */
TACTUS_CALL tactus_result tactus_frame_make(const tactus_setup* setup, void* memory, size_t bytes,
                                            tactus_frame** frame, tactus_error* error);
/* Ends a frame and releases its memory and models to the caller. Null has no effect. */
TACTUS_CALL void tactus_frame_end(tactus_frame* frame);

/* Runs one round of loading. Data that the last frame requested are available to the next frame,
 * or, from a model server, to a later frame. May wait for a file, and allocates: not for a
 * real-time thread. */
TACTUS_CALL tactus_result tactus_frame_load(tactus_frame* frame, tactus_error* error);

/* Flags of a tool, for tactus_poses. */
#define TACTUS_IN_CONTACT 1U
#define TACTUS_HALTED 2U            /* Proxy halted: nearby surface not loaded; force must fade. */
#define TACTUS_OVER_CONSTRAINED 4U  /* Over-constrained by objects; force must fade. */
#define TACTUS_CAPACITY_EXCEEDED 8U /* Contact capacity exceeded. */
#define TACTUS_DATA_LIMITED 16U     /* Data-limited: proxy moved as far as the loaded surface. */
#define TACTUS_RATE_LIMITED 32U     /* An object within reach lags its pose; force must fade. */

typedef enum tactus_kind
{
    TACTUS_EXACT = 0,     /* lower_m and upper_m differ by rounding only. */
    TACTUS_SEPARATED = 1, /* Separated: proven to be out of contact. */
    TACTUS_BOUNDED = 2,   /* Bounded below and above; contact undecided. */
    TACTUS_STALE = 3,     /* Answer for an outdated pose. */
    /* Exact for coarser faces, whose error is subtracted from lower_m. */
    TACTUS_WITHIN_TOLERANCE = 4
} tactus_kind;

/* Arrays of the caller for N poses, T tools and J objects of the set-up, last index fastest. Null
 * outputs are not written. */
typedef struct tactus_poses
{
    size_t size;
    size_t count;              /* N */
    const double* positions_m; /* N x T x 3: centres of the tools, within 1e6 on each axis. */
    const double* rotations;   /* N x T x 9, or null: all are the identity. */
    double* force_n;           /* N x T x 3, on the device. */
    double* torque_nm;         /* N x T x 3, on the device, about the tool's position. */
    double* proxy_m;           /* N x T x 3: positions of the proxies. */
    uint32_t* flags;           /* N x T */
    /* Distances from the tool's core, radius not subtracted, at the proxy's position at the start
     * of the frame. */
    double* lower_m;   /* N x T x J: lower bounds. */
    double* upper_m;   /* N x T x J: upper bounds; infinite if unknown. */
    uint8_t* kind;     /* N x T x J: tactus_kind. */
    double* nearest_m; /* N x T x J x 3: nearest points of the surface; NaN unless kind is
                        * TACTUS_EXACT or TACTUS_WITHIN_TOLERANCE. */
    uint32_t rounds;   /* Maximum number of frames for each pose, 1 to 10000, with loading between
                        * them. They end early when the answers are exact (or SEPARATED for a tool
                        * without wants_distance), no tool waits for data, and all motion has
                        * ended. 0: one frame, no loading. */
} tactus_poses;

/* Moves the tools through the poses, one frame for each or up to `rounds`; the answers of a pose
 * are those of its last frame. All inputs are checked before the first frame; that cost grows with
 * the arrays. Without `rounds` the call does not allocate and makes no system call; with `rounds`
 * it may do both, and wait for a file. */
TACTUS_CALL tactus_result tactus_frame_run(tactus_frame* frame, const tactus_poses* poses,
                                           tactus_error* error);
/* Sets the pose of an object from the next frame on; the last call counts. If a tool touches the
 * object, or may within 20 ms, the motion is rate-limited over several frames: no point of the
 * object in the tool's reach moves faster than object_speed_max_m_per_s, so a step of the pose
 * changes the force at most at the rate stiffness x speed. If the object is more than 20 ms of that
 * speed behind, a tool that may touch it in this frame has TACTUS_RATE_LIMITED. Calls of this
 * function and of tactus_frame_feel(), and objects in motion, occupy up to 64 places for a frame;
 * TACTUS_BUSY beyond. Thread of tactus_frame_run(), also for tactus_frame_state_of(). */
TACTUS_CALL tactus_result tactus_frame_place(tactus_frame* frame, uint32_t object,
                                             const tactus_pose* pose, tactus_error* error);

/* Sets the material of an object from the next frame on; tools in contact blend to it linearly
 * within 50 ms. Thread of tactus_frame_run(). */
TACTUS_CALL tactus_result tactus_frame_feel(tactus_frame* frame, uint32_t object,
                                            const tactus_material* material, tactus_error* error);

/* Tests before the first frame whether tools begin inside a closed object at its present pose: the
 * surface would hold such a tool inside, and pull back a hand that leaves. positions_m, T x 3, has
 * the tools' centres; inside, T, is set to 1 or 0, and to 0 for query-only tools. Allocates: not
 * for a real-time thread. */
TACTUS_CALL tactus_result tactus_frame_begins_inside(const tactus_frame* frame,
                                                     const double* positions_m, uint8_t* inside,
                                                     tactus_error* error);

typedef struct tactus_frame_state
{
    size_t size;
    uint64_t frames;     /* Number of frames run. */
    uint32_t pages_used; /* Pages of all models, 8 KiB each. */
    uint32_t pages_total;
    uint32_t faces_used; /* Active faces. */
    int32_t is_whole;    /* Not 0: all models are fully resident and refined (loads_whole). */
} tactus_frame_state;

TACTUS_CALL tactus_result tactus_frame_state_of(const tactus_frame* frame,
                                                tactus_frame_state* state, tactus_error* error);

/* ---- Worlds ---- */

/* Objects, hands and the guarded loop of hrtc in one handle, as the class tactus::World of C++
 * (docs/library.md). These calls are in the library of CMake's target Tactus::tactus and of
 * pkg-config's module tactus. Strings are UTF-8 in the words of hrtc's options.
 *
 * Threads: tactus_world_state(), _hold(), _move(), _feel(), _remove(), _carve(), _fill(),
 * _displace(), _save(), _counts_of() and _stop() are for any thread and never block the loop; one
 * thread makes the other calls. */

typedef struct tactus_world tactus_world;
/* An object or a hand of one world. 0: none. */
typedef uint64_t tactus_handle;

/* Options of a world: those of hrtc, with its ranges. tactus_world_options_default() sets all. */
typedef struct tactus_world_options
{
    size_t size;
    uint32_t abi;                /* TACTUS_ABI */
    uint32_t objects_max;        /* Largest number of objects; 0: the number at the start. */
    int64_t rate_hz;             /* 100 to 10000 [default: 1000] */
    double memory_mib;           /* 0.25 to 4096 [default: 2] */
    double stiffness_n_per_m;    /* 1 to 3000 [default: 500] */
    double object_speed_m_per_s; /* Objects near a tool, 0.001 to 100 [default: 0.5] */
    double wait_s;               /* Wait for a device or a server, 0.1 to 3600 [default: 10] */
    double duration_s;           /* Loop of start, 0.1 to 86400 s; 0: until stopped. */
    uint32_t domain;             /* DDS domain of servers and viewers, 0 to 232. */
    int32_t is_watched;          /* Not 0: viewers can see the world. */
    int32_t follows_poses;       /* Not 0: servers move their objects [default: 1] */
    int32_t loads_whole;         /* Not 0: a model that fits is loaded as a whole [default: 1] */
    int32_t allow_no_rt;         /* Not 0: start without real-time rights. */
    int32_t has_no_guardian;     /* Not 0: no process guards dhd and plugin devices. */
    const char* record;          /* File of a recording; null: none. */
} tactus_world_options;
TACTUS_CALL void tactus_world_options_default(tactus_world_options* options);

/* A model: a file, a mesh, or the name of a published model. */
typedef enum tactus_source
{
    TACTUS_MODEL_FILE = 0, /* `text` is the path of an .spm file. */
    TACTUS_MESH_FILE = 1,  /* `text` is the path of a mesh in `unit`; it is encoded at once. */
    TACTUS_PUBLISHED = 2,  /* `text` is NAME, NAME@HASH or NAME@SERVER. */
    TACTUS_MESH = 3        /* A mesh in memory in `unit`, named `text`; it is encoded at once. */
} tactus_source;

/* An object of a world. tactus_world_object_default() sets an identity pose and the unit m. */
typedef struct tactus_world_object
{
    size_t size;
    int32_t source; /* tactus_source */
    uint32_t vertex_count;
    const char* text;
    const char* unit;       /* m, cm, mm, in or inch. */
    const double* vertices; /* vertex_count x 3 */
    const uint32_t* faces;  /* face_count x 3 */
    size_t face_count;
    tactus_pose pose;
    const tactus_material* material; /* Null: smooth, as stiff as the tool. */
    uint32_t edit_faces; /* Room of the model for faces that edits add, 0 to 262144; the largest of
                          * its objects is used. 0 for a published model. */
} tactus_world_object;
TACTUS_CALL void tactus_world_object_default(tactus_world_object* object);

/* Makes a world; the caller owns it until tactus_world_end(), which stops it. Null has no effect.
 */
TACTUS_CALL tactus_result tactus_world_make(const tactus_world_options* options,
                                            tactus_world** world, tactus_error* error);
TACTUS_CALL void tactus_world_end(tactus_world* world);

/* Adds an object. */
TACTUS_CALL tactus_result tactus_world_add(tactus_world* world, const tactus_world_object* object,
                                           tactus_handle* handle, tactus_error* error);
/* Adds a hand before the first frame: a tool as for --tool, such as "sphere:0.002", and a device as
 * for --device; null: the program moves the hand. `edit` is carve:RATE as for --edit: the tool
 * carves models with room for edits, and published ones; null: it does not. */
TACTUS_CALL tactus_result tactus_world_add_hand(tactus_world* world, const char* tool,
                                                const char* device, const char* edit,
                                                tactus_handle* hand, tactus_error* error);

/* Starts the guarded loop; ends it, or a loop of one's own. A world that has ended keeps its last
 * states, has closed its devices and never runs again. */
TACTUS_CALL tactus_result tactus_world_start(tactus_world* world, tactus_error* error);
TACTUS_CALL tactus_result tactus_world_stop(tactus_world* world, tactus_error* error);

/* Largest number of contacts of a hand. */
#define TACTUS_HAND_CONTACTS 4U

/* Bounds and nearest points of a tool and one object near it, world frame. */
typedef struct tactus_hand_contact
{
    uint32_t object;     /* Number of the object; the n-th of the start has n - 1. */
    int32_t kind;        /* tactus_kind */
    int32_t is_touched;  /* Not 0: the tool may touch the object. */
    double lower_m;      /* Bounds of the distance from the tool's core. */
    double upper_m;      /* Infinite if unknown. */
    double on_tool_m[3]; /* Nearest points, of an exact answer. */
    double on_object_m[3];
} tactus_hand_contact;

/* State of a hand after the newest frame. */
typedef struct tactus_hand_state
{
    size_t size;
    uint64_t frame; /* Number of frames; 0: none has run. */
    double force_n[3];
    double torque_nm[3];
    double position_m[3];
    double proxy_m[3];
    double proxy_rotation[9];
    int32_t in_contact;
    int32_t began_inside;
    int32_t withheld; /* Not 0: less than the surface's force is sent; `why` says why. */
    uint32_t causes;  /* Bits of the causes (docs/safety.md), in their order there. */
    uint32_t buttons;
    uint32_t contact_count;
    tactus_hand_contact contacts[TACTUS_HAND_CONTACTS];
    char why[256]; /* One line; empty if nothing is withheld. */
} tactus_hand_state;

TACTUS_CALL tactus_result tactus_world_state(const tactus_world* world, tactus_handle hand,
                                             tactus_hand_state* state, tactus_error* error);
/* Moves a hand of the program for the next frames. `rotation` has 9 numbers; null: identity. */
TACTUS_CALL tactus_result tactus_world_hold(tactus_world* world, tactus_handle hand,
                                            const double* position_m, const double* rotation,
                                            tactus_error* error);
/* Runs the next frame in a loop of one's own, `dt_s` after the last one, rounded to periods, at
 * most a second; 0: one period. `hand` moves to the pose; 0: all hands stay, and the state is not
 * written. The first call opens models and devices; udp, dhd and plugin devices need start.
 * `state` may be null. */
TACTUS_CALL tactus_result tactus_world_step(tactus_world* world, tactus_handle hand,
                                            const double* position_m, const double* rotation,
                                            double dt_s, tactus_hand_state* state,
                                            tactus_error* error);

/* Moves an object, changes its material, removes it. TACTUS_REFUSED if it was removed before. */
TACTUS_CALL tactus_result tactus_world_move(tactus_world* world, tactus_handle object,
                                            const tactus_pose* pose, tactus_error* error);
TACTUS_CALL tactus_result tactus_world_feel(tactus_world* world, tactus_handle object,
                                            const tactus_material* material, tactus_error* error);
TACTUS_CALL tactus_result tactus_world_remove(tactus_world* world, tactus_handle object,
                                              tactus_error* error);

/* Removes from an object's model, or adds to it, what a tool as for --tool sweeps from a pose to
 * the position to_m without rotation: a sphere, a capsule, or a box without a radius. Positions are
 * in the model's frame, as it is in its file; all objects of the model change. `rotation` has 9
 * numbers; null: identity. volume_m3 is the removed or added volume there; may be null. A few ms;
 * the next frames have the new surface. TACTUS_REFUSED before the first frame, without edit_faces,
 * and beyond the limits of docs/edits.md. */
TACTUS_CALL tactus_result tactus_world_carve(tactus_world* world, tactus_handle object,
                                             const char* tool, const double* position_m,
                                             const double* rotation, const double* to_m,
                                             double* volume_m3, tactus_error* error);
TACTUS_CALL tactus_result tactus_world_fill(tactus_world* world, tactus_handle object,
                                            const char* tool, const double* position_m,
                                            const double* rotation, const double* to_m,
                                            double* volume_m3, tactus_error* error);
/* Moves the vertices of an object's model within radius_m of center_m by
 * vector_m x (1 - d^2 / radius_m^2)^2 at the distance d; otherwise as tactus_world_fill(). */
TACTUS_CALL tactus_result tactus_world_displace(tactus_world* world, tactus_handle object,
                                                const double* center_m, double radius_m,
                                                const double* vector_m, double* volume_m3,
                                                tactus_error* error);
/* Writes an object's model with its edits as one .spm file: the whole file or none. Also after
 * tactus_world_stop(). */
TACTUS_CALL tactus_result tactus_world_save(const tactus_world* world, tactus_handle object,
                                            const char* path, tactus_error* error);

typedef struct tactus_world_counts
{
    size_t size;
    uint64_t frames;
    uint64_t missed;         /* Deadlines missed. */
    uint64_t overruns;       /* Frames that took too long. */
    uint64_t latency_misses; /* Frames that the machine woke too late. */
    uint64_t brakes;         /* Brakes by the supervisor. */
    int32_t is_running;      /* Not 0: the loop of start runs. */
} tactus_world_counts;
TACTUS_CALL tactus_result tactus_world_counts_of(const tactus_world* world,
                                                 tactus_world_counts* counts, tactus_error* error);
