// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
//
// ask FILE: distances of a ball to the model `ring`, from C; and what the library refuses.
#include <tactus/tactus.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

int main(int argc, char** argv)
{
    tactus_error error = {""};
    tactus_model* model = NULL;
    need(argc == 2, "usage: ask FILE", &error);
    need(tactus_model_open(TACTUS_ABI, argv[1], &model, &error) == TACTUS_DONE, "open", &error);

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

    /* 10 mm above the top of the ring, and in the middle of its hole. */
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
    need(tactus_frame_run(frame, &poses, &error) == TACTUS_DONE, "run", &error);
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
            "made for ABI version 2; this library has 1", &error);
    setup.abi = TACTUS_ABI + 1;
    refused(tactus_frame_make(&setup, memory, bytes, &second, &error), TACTUS_BAD_VERSION,
            "made for ABI version 2", &error);
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

    /* An object that moves away by 5 mm is 5 mm farther away. */
    poses.positions_m = places_m;
    poses.count = 1;
    ring.pose.translation_m[2] = -0.005;
    need(tactus_frame_place(frame, 0, &ring.pose, &error) == TACTUS_DONE, "place", &error);
    const double before_m = lower_m[0];
    need(tactus_frame_run(frame, &poses, &error) == TACTUS_DONE, "run again", &error);
    need(fabs(lower_m[0] - before_m - 0.005) < 1e-3, "not farther away", &error);

    tactus_frame_end(frame);
    need(tactus_frame_make(&setup, memory, bytes, &frame, &error) == TACTUS_DONE, "make again",
         &error);
    tactus_frame_end(frame);
    need(tactus_model_close(model, &error) == TACTUS_DONE, "close", &error);
    free(memory);
    free(more);
    return 0;
}
