#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# lying_models.sh BIN CHECK_REPORT SANITIZER LIAR: models with false content and valid hashes.
# spm_inspect names the claim, or no program opens it; a touch of it is data-limited, and no force
# has a step.
source "$(dirname "$0")/../integration/hrtc/common.sh"
readonly liar=$4
model bumpy-sphere-20000 true.spm
"$inspect" true.spm >true.txt || fault "spm_inspect: the true one ended with $?"

lie() { "$liar" true.spm "$1.spm" "$1" || fail "liar $1 ended with $?"; }
false_claim() { # false_claim LIE PATTERN: expects code 1 and one line, after those of progress.
    local code=0
    lie "$1"
    "$inspect" "$1.spm" >said.txt 2>&1 || code=$?
    sed -i '/^check: /d' said.txt
    { ((code == 1)) && [[ $(wc -l <said.txt) == 1 ]] \
        && grep -q "^spm_inspect: $1.spm: false claim: $2" said.txt; } \
        || fault "$1: spm_inspect ended with $code: $(cat said.txt)"
}
false_claim faces 'header: the number of faces is stated as'
false_claim vertices 'header: the number of vertices is stated as'
false_claim depth 'header: the depth is stated as'
false_claim open 'header: the mesh is stated as open; it is closed'
false_claim extent 'header: the extent in y is stated as'
false_claim no_error 'header: the largest error bound in quanta is stated as 0; it is'
false_claim most_error 'header: the largest error bound in quanta is stated as 4294967295; it is'
false_claim regions 'region 0: is stated as occupied; it is empty'
false_claim boxes 'chunk 0: its influence box is'
false_claim page_boxes 'chunk 0: its influence box'
false_claim chunk_boxes_all 'chunk 0: its influence box is'
false_claim box_all 'index page 0: its box in the header is'
false_claim buckets '.*bucket '
lie base_errors
code=0
"$inspect" base_errors.spm >said.txt 2>&1 || code=$?
{ ((code == 1)) && grep -q 'false claim: error bounds: the surface point (.*) is ' said.txt; } \
    || fault "base_errors ended with $code: $(cat said.txt)"

for unfit in origin far quantum; do
    lie "$unfit"
    expect 2 "$unfit.spm*lies farther than 10,000 km" "$inspect" "$unfit.spm"
done
lie quantisation
expect 2 'quantisation.spm*holds a value outside its range' "$inspect" quantisation.spm
expect 2 'origin.spm*lies farther' "$publish" --domain "$domain" origin.spm
expect 2 'origin.spm*lies farther' "$hrtc" --allow-no-rt --transport file --model origin.spm

for lie in boxes box_all base_errors no_error regions; do
    "$hrtc" --virtual-time --model "$lie.spm" --no-static --device sim:touch --duration 2 \
        --report report.json >hrtc.log 2>&1 || fault "hrtc with $lie ended with $?: $(cat hrtc.log)"
    check report.json frames == 2000 force.max_n '<=' 3.3 force.max_step_n '<' 0.45
done
finish
