#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_tools_on_the_bunny.sh: a tool of each form, and a mesh probe, touch the Stanford bunny, in
# virtual time. Skipped (77) without the meshes of TACTUS_MESHES.
source "$(dirname "$0")/common.sh"

readonly bunny=${TACTUS_MESHES:-}/stanford-bunny.obj
[[ -f "$bunny" ]] || {
    echo 'skipped: TACTUS_MESHES has no stanford-bunny.obj'
    exit 77
}
"$build" "$bunny" --fit-diag 0.2 -o bunny.spm >build.log 2>&1
"$build" --shape torus --faces 3000 --fit-diag 0.02 -o probe.spm >build.log 2>&1
printf 'OFF\n4 4 0\n-0.005 -0.005 0\n0.005 -0.005 0\n0 0.005 0\n0 0 0.01\n%s' \
    $'3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n' >wedge.off

# touch TORQUE TOOL [ARGUMENT]...
touch() {
    run_hrtc --virtual-time --model bunny.spm --tool "$2" \
        --duration "${seconds:-2}" "${@:3}"
    check_clean report.json
    check report.json tools.0.force_max_n '>' 0.3 tools.0.force_max_n '<=' 8
    check report.json tools.0.contact_share '>' 0.3
    if (($1)); then
        check report.json tools.0.torque_max_nm '>' 0 tools.0.twist_max_rad '>' 0
    else
        check report.json tools.0.torque_max_nm == 0
    fi
}
touch 0 point
touch 0 sphere:0.002
touch 1 capsule:0.002,0.02
touch 1 box:0.01,0.008,0.004,0.0005
touch 1 hull:wedge.off,0.0005
seconds=6 touch 1 mesh:probe.spm,0.0005 --pool-mib 8
touch 1 box:0.01,0.008,0.004,0.0005 --motion turn
touch 1 box:0.01,0.008,0.004,0.0005 --motion edge
finish
