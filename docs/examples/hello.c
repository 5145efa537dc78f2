// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include <stdio.h>
#include <tactus/tactus.h>

int main(int argc, char** argv)
{
    tactus_error error = {.text = ""};
    tactus_world_options options;
    tactus_world_object part;
    tactus_world* world = NULL;
    tactus_handle object, hand;
    tactus_hand_state felt = {.size = sizeof(felt)};
    tactus_world_options_default(&options);
    tactus_world_object_default(&part);
    part.text = argc > 1 ? argv[1] : "torus.spm";
    if (tactus_world_make(&options, &world, &error) == TACTUS_DONE &&
        tactus_world_add(world, &part, &object, &error) == TACTUS_DONE &&
        tactus_world_add_hand(world, "sphere:0.002", NULL, NULL, &hand, &error) == TACTUS_DONE)
    {
        for (int i = 0; i <= 1000 && error.text[0] == '\0'; ++i)
        {
            const double at_m[3] = {0.05, 0.0, i < 500 ? 0.0315 - 2e-5 * i : 0.0215};
            tactus_world_step(world, hand, at_m, NULL, 0.0, &felt, &error);
        }
    }
    fprintf(stderr, "%s%s", error.text, error.text[0] != '\0' ? "\n" : "");
    printf("force %.3f N, proxy at %.5f m\n", felt.force_n[2], felt.proxy_m[2]);
    tactus_world_end(world);
    return error.text[0] != '\0' ? 2 : 0;
}
