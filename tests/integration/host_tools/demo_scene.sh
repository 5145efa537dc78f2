#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# demo_scene.sh SPM_BUILD DEMO_SCENE: the script of the demo's scene writes the same bytes each
# time, in a file that becomes 200 objects of 20 models. Skips (77) without python3.
set -euo pipefail
readonly build=$1 script=$2
command -v python3 >/dev/null || { echo 'no python3'; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
fail() { printf 'FAULT: %s\n' "$*"; exit 1; }

python3 "$script" a.glb --faces 200
python3 "$script" b.glb --faces 200
cmp a.glb b.glb || fail 'another run gives other bytes'
"$build" a.glb -o made >built.txt
grep -qx 'made/scene.gltf: 200 objects of 20 models' built.txt || fail "$(tail -n 1 built.txt)"
[[ -f made/lump-00.spm && -f made/lump-09-mirrored.spm && ! -f made/lump-09.spm ]] \
    || fail 'of the tenth model only the mirror image is shown'
code=0
python3 "$script" c.glb --models 5 --objects 4 2>/dev/null || code=$?
[[ $code == 2 && ! -e c.glb ]] || fail 'more models than objects are taken'
