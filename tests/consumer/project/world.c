// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
//
// world FILE: a world in C touches the model, with a mesh in memory beside it, and refuses what is
// wrong, in one line each.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tactus/tactus.h>

static tactus_error error;

static void need(int is_so, const char* what)
{
    if (!is_so)
    {
        fprintf(stderr, "world: %s (%s)\n", what, error.text);
        exit(2);
    }
}

static void refuses(tactus_result wanted, tactus_result result, const char* words)
{
    need(result == wanted && strstr(error.text, words) != NULL && strchr(error.text, '\n') == NULL,
         words);
}

int main(int argc, char** argv)
{
    static const double corners[12] = {0, 0, 0, 10, 0, 0, 0, 10, 0, 0, 0, 10};
    static const uint32_t faces[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    const double above_m[3] = {0.0, 0.0, 1.0};
    const double nowhere_m[3] = {0.0, 0.0, NAN};
    tactus_world_options options;
    tactus_world_object part;
    tactus_world_object solid;
    tactus_material material;
    tactus_world* world = NULL;
    tactus_world* other = NULL;
    tactus_handle object = 0;
    tactus_handle second = 0;
    tactus_handle hand = 0;
    tactus_hand_state felt = {.size = sizeof(felt)};
    tactus_world_counts counts = {.size = sizeof(counts)};
    need(argc == 2, "one model is needed");
    tactus_world_options_default(&options);
    options.objects_max = 3;
    tactus_world_object_default(&part);
    part.text = argv[1];
    tactus_world_object_default(&solid);
    solid.source = TACTUS_MESH;
    solid.text = "solid";
    solid.unit = "mm";
    solid.vertices = corners;
    solid.vertex_count = 4;
    solid.faces = faces;
    solid.face_count = 4;
    solid.pose.translation_m[0] = 1.0;
    tactus_material_default(&material);
    material.stiffness_n_per_m = 200.0;

    refuses(TACTUS_BAD_ARGUMENT, tactus_world_make(NULL, &world, &error), "options: null pointer");
    options.size = 1;
    refuses(TACTUS_BAD_VERSION, tactus_world_make(&options, &world, &error), "options: size is 1");
    options.size = sizeof(options);
    need(tactus_world_make(&options, &world, &error) == TACTUS_DONE, "make");
    need(tactus_world_make(&options, &other, &error) == TACTUS_DONE, "make another one");
    need(tactus_world_add(world, &part, &object, &error) == TACTUS_DONE, "add a file");
    need(tactus_world_add(world, &solid, &second, &error) == TACTUS_DONE, "add a mesh");
    need(tactus_world_add_hand(world, "sphere:0.002", NULL, &hand, &error) == TACTUS_DONE, "hand");
    refuses(TACTUS_BAD_ARGUMENT, tactus_world_remove(other, object, &error),
            "object: no handle of this world");
    refuses(TACTUS_BAD_ARGUMENT, tactus_world_state(world, object, &felt, &error),
            "hand: no handle of this world");
    need(tactus_world_state(world, hand, &felt, &error) == TACTUS_DONE && felt.withheld != 0 &&
             strstr(felt.why, "no frame has run yet") != NULL,
         "state before the first frame");
    need(tactus_world_step(world, hand, above_m, NULL, 0.0, &felt, &error) == TACTUS_DONE, "step");
    need(felt.frame == 1 && felt.withheld == 0, "state after a frame");
    refuses(TACTUS_BAD_ARGUMENT, tactus_world_step(world, hand, above_m, NULL, -1.0, &felt, &error),
            "dt_s: -1; 0 or more is allowed");
    refuses(TACTUS_BAD_ARGUMENT, tactus_world_hold(world, hand, nowhere_m, NULL, &error),
            "position_m: (0, 0, nan)");
    need(tactus_world_feel(world, object, &material, &error) == TACTUS_DONE, "feel");
    need(tactus_world_move(world, second, &part.pose, &error) == TACTUS_DONE, "move");
    need(tactus_world_remove(world, second, &error) == TACTUS_DONE, "remove");
    refuses(TACTUS_REFUSED, tactus_world_remove(world, second, &error), "was removed before");
    need(tactus_world_step(world, 0, NULL, NULL, 0.0, NULL, &error) == TACTUS_DONE, "a bare step");
    need(tactus_world_counts_of(world, &counts, &error) == TACTUS_DONE && counts.frames == 2 &&
             counts.is_running == 0,
         "counts");
    refuses(TACTUS_REFUSED, tactus_world_start(world, &error), "the program runs this World");
    need(tactus_world_stop(world, &error) == TACTUS_DONE, "stop");
    refuses(TACTUS_REFUSED, tactus_world_hold(world, hand, above_m, NULL, &error), "has ended");
    part.text = "nowhere.spm";
    refuses(TACTUS_REFUSED, tactus_world_add(other, &part, &object, &error), "nowhere.spm: ");
    refuses(TACTUS_REFUSED, tactus_world_start(other, &error), "nowhere.spm: ");
    tactus_world_end(world);
    tactus_world_end(other);
    tactus_world_end(NULL);
    puts("a world in C: every call answers");
    return 0;
}
