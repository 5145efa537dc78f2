#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# demo_shortened.sh SETUP BUILD_DIR [--scene | --view | --carve]: the README's demo with the
# programs of this build, for a second: it ends well, prints the summary, names the report, and
# leaves no process.
set -euo pipefail
readonly setup=$1
export TACTUS_BUILD_DIR=$2
readonly more=${3:-}
unset CYCLONEDDS_URI

fail() {
    printf 'FAULT: %s\n' "$*"
    exit 1
}

output=$(mktemp)
trap 'rm -f "$output"' EXIT
# A separate session distinguishes the demo's processes from all others.
code=0
# shellcheck disable=SC2016 # The inner shell expands them.
setsid --wait bash -c 'echo $$ >"$1"; shift; exec bash "$@"' demo "$output.session" \
    "$setup" demo ${more:+"$more"} --seconds 1 --domain "${TACTUS_TEST_DOMAIN:-$(($$ % 231))}" \
    >"$output" 2>&1 || code=$?
session=$(cat "$output.session")
rm -f "$output.session"
cat "$output"
((code == 0)) || fail "the demo ended with $code"
texts=('frames      1000 at 1000 Hz' 'answers     exact' 'times us' 'memory      ' 'deadlines   ')
if [[ "$more" == --view ]]; then
    texts+=('View: http://127.0.0.1:')
elif [[ "$more" == --scene ]]; then
    texts+=('scene.gltf: 200 objects of 20 models' 'touches     200 objects of 20 models'
        'scene       200 objects, at most 200')
    [[ $(grep -c '^tool  ' "$output") == 2 ]] || fail 'not two hands'
elif [[ "$more" == --carve ]]; then
    texts+=('carving     ' 'mm^3 removed')
fi
for text in "${texts[@]}"; do
    grep -qF -- "$text" "$output" || fail "no '$text' in what the demo printed"
done
report=$(sed -n 's/^Report: //p' "$output")
[[ -s "$report" ]] || fail "no report at '$report'"
for stat in /proc/[0-9]*/stat; do
    # Fields after the name, which is in parentheses: state, parent, group, session.
    read -r _ _ _ of_session _ 2>/dev/null < <(sed 's/.*) //' "$stat" 2>/dev/null) || continue
    [[ "$of_session" != "$session" ]] || fail "left running: $(cat "$stat")"
done

# Only the demo takes a scene and a view.
code=0
refusal=$(unset TACTUS_BUILD_DIR && bash "$setup" bench --scene 2>&1) || code=$?
[[ $code == 3 && "$refusal" == *"--scene, --view and --carve are for 'demo' only"* ]] \
    || fail "bench --scene: $code, $refusal"
