#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# network_streamed_models.sh BIN CHECK_REPORT SANITIZER NETWORK_RELAY LIST_SAFETY JUDGE_RECORDING
# SCENE_RIDER DEMO_SCENE: a hand flies over DDS, 10 ms each way, at 2 m/s through 200 objects and
# touches them in turn. In pools of 8 MiB 20 models are all resident, and of 200 some, whose base
# meshes are loaded and removed with the hand. No frame is blocked by a missing model, except one
# whose base mesh the machine delayed (scene_rider.cpp).
source "$(dirname "$0")/two_networks.sh"
readonly scene_rider=$7 demo_scene=$8
command -v python3 >/dev/null || { echo 'skipped: no python3'; exit 77; }

# ride MODELS VISITS FIGURE...: checks figures of the ride through a scene of this number of models.
ride() {
    local models=$1 visits=$2
    python3 "$demo_scene" demo.glb --faces 1000 --models "$models" || fail 'no scene'
    "$build" demo.glb -o "made-$models" >built.txt || fail "$(cat built.txt)"
    start_publisher "made-$models/scene.gltf" --scene demo
    in_controller_network "$scene_rider" --domain "$domain" --scene demo --pool-mib 8 --speed 2 \
        --visits "$visits" >ride.json 2>rider.log || fail "the rider ended badly: $(cat rider.log)"
    cat ride.json
    check ride.json models == "$models" objects == 200 visits == "$visits" \
        touched == "$visits" invisible_wall_frames == 0 "${@:3}"
    stop_publisher
}

start_relay --delay-ms 10
ride 20 6 streamed_models == 0 bases_at_start == 20
ride 200 15 streamed_models '>' 0 bases_at_start == 1 came '>' 60 went '>' 60 here_max '<' 40
finish
