// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
//
// world FILE: a world in C touches the model, edits a mesh in memory beside it, and refuses what is
// wrong, in one line each. Writes carved.spm.
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
    const double origin_m[3] = {0.0, 0.0, 0.0};
    const double within_m[3] = {0.0008, 0.0008, 0.0008};
    const double peak_m[3] = {0.0, 0.0, 0.01};
    const double down_m[3] = {0.0, 0.0, -0.001};
    double volume_m3 = 0.0;
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
    solid.edit_faces = 262145;
    tactus_material_default(&material);
    material.stiffness_n_per_m = 200.0;

    refuses(TACTUS_BAD_ARGUMENT, tactus_world_make(NULL, &world, &error), "options: null pointer");
    options.size = 1;
    refuses(TACTUS_BAD_VERSION, tactus_world_make(&options, &world, &error), "options: size is 1");
    options.size = sizeof(options);
    need(tactus_world_make(&options, &world, &error) == TACTUS_DONE, "make");
    need(tactus_world_make(&options, &other, &error) == TACTUS_DONE, "make another one");
    part.text = "nowhere.spm";
    refuses(TACTUS_REFUSED, tactus_world_add(world, &part, &object, &error), "nowhere.spm: ");
    part.text = argv[1];
    need(tactus_world_add(world, &part, &object, &error) == TACTUS_DONE, "add a file");
    refuses(TACTUS_BAD_ARGUMENT, tactus_world_add(world, &solid, &second, &error),
            "object.edit_faces: 262145; 0 to 262144 is allowed");
    solid.edit_faces = 256;
    need(tactus_world_add(world, &solid, &second, &error) == TACTUS_DONE, "add a mesh");
    need(tactus_world_add_hand(world, "sphere:0.002", NULL, "carve:50", &hand, &error) ==
             TACTUS_DONE,
         "hand");
    refuses(
        TACTUS_REFUSED,
        tactus_world_carve(world, second, "sphere:0.001", origin_m, NULL, origin_m, NULL, &error),
        "carve(): edits begin with the first frame");
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

    // The box has an eighth of its volume within the solid, at its corner.
    const tactus_result carved = tactus_world_carve(world, second, "box:0.002,0.002,0.002",
                                                    origin_m, NULL, origin_m, &volume_m3, &error);
    need(carved == TACTUS_DONE && fabs(volume_m3 - 1e-9) < 5e-12, "carve");
    need(tactus_world_fill(world, second, "box:0.001,0.001,0.001", within_m, NULL, within_m,
                           &volume_m3, &error) == TACTUS_DONE &&
             fabs(volume_m3 - 0.343e-9) < 5e-12,
         "fill");
    // A tenth of the solid's volume of 1e-6 / 6.
    need(tactus_world_displace(world, second, peak_m, 0.002, down_m, &volume_m3, &error) ==
                 TACTUS_DONE &&
             fabs(volume_m3 + 1e-7 / 6.0) < 5e-12,
         "displace");
    need(tactus_world_carve(world, second, "sphere:0.002", peak_m, NULL, origin_m, NULL, &error) ==
             TACTUS_DONE,
         "carve without an answer");
    refuses(
        TACTUS_REFUSED,
        tactus_world_fill(world, object, "sphere:0.001", origin_m, NULL, origin_m, NULL, &error),
        "fill(): 'ring' has no room for edits; set edit_faces");
    refuses(TACTUS_REFUSED,
            tactus_world_carve(world, second, "point", origin_m, NULL, origin_m, NULL, &error),
            "carve(): tool: only a sphere");
    refuses(TACTUS_BAD_ARGUMENT,
            tactus_world_carve(world, second, NULL, origin_m, NULL, origin_m, NULL, &error),
            "tool: null pointer");
    refuses(
        TACTUS_BAD_ARGUMENT,
        tactus_world_carve(world, second, "sphere:0.001", nowhere_m, NULL, origin_m, NULL, &error),
        "carve(): position_m: (0, 0, nan)");
    refuses(
        TACTUS_BAD_ARGUMENT,
        tactus_world_carve(world, second, "sphere:0.001", origin_m, NULL, nowhere_m, NULL, &error),
        "to_m: element 2 is nan");
    refuses(TACTUS_BAD_ARGUMENT,
            tactus_world_displace(world, second, peak_m, NAN, down_m, NULL, &error),
            "radius_m: element 0 is nan");
    refuses(TACTUS_REFUSED,
            tactus_world_displace(world, second, peak_m, -1.0, down_m, NULL, &error),
            "displace(): displacement: ");
    refuses(TACTUS_REFUSED, tactus_world_save(world, second, "/nowhere/carved.spm", &error),
            "/nowhere/");
    need(tactus_world_save(world, second, "carved.spm", &error) == TACTUS_DONE, "save");
    need(tactus_world_step(world, hand, above_m, NULL, 0.0, &felt, &error) == TACTUS_DONE,
         "step after edits");
    need(tactus_world_remove(world, second, &error) == TACTUS_DONE, "remove");
    refuses(TACTUS_REFUSED, tactus_world_remove(world, second, &error), "was removed before");
    need(tactus_world_step(world, 0, NULL, NULL, 0.0, NULL, &error) == TACTUS_DONE, "a bare step");
    need(tactus_world_counts_of(world, &counts, &error) == TACTUS_DONE && counts.frames == 3 &&
             counts.is_running == 0,
         "counts");
    refuses(TACTUS_REFUSED, tactus_world_start(world, &error), "the program runs this World");
    need(tactus_world_stop(world, &error) == TACTUS_DONE, "stop");
    refuses(TACTUS_REFUSED, tactus_world_hold(world, hand, above_m, NULL, &error), "has ended");
    part.text = "carved.spm";
    need(tactus_world_add(other, &part, &object, &error) == TACTUS_DONE, "add the saved model");
    refuses(TACTUS_REFUSED, tactus_world_add_hand(other, "ball:1", NULL, NULL, &hand, &error),
            "tool: 'ball:1'");
    refuses(TACTUS_REFUSED, tactus_world_start(other, &error),
            "start(): the World has no hand; refused: tool: 'ball:1'");
    tactus_world_end(world);
    tactus_world_end(other);
    tactus_world_end(NULL);
    puts("a world in C: every call answers");
    return 0;
}
