#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# spm_publish_bad_input.sh: files that can't be served and names that can't be published give the
# right exit code and one line; a chunk that is damaged while it is served does not end the host.
source "$(dirname "$0")/common.sh"
model bumpy-sphere-5000 good.spm

refuse() { expect "$1" "$2" "$publish" --domain "$domain" --seconds 5 "${@:3}"; }

[[ $("$publish" --version) == 'spm_publish '* ]] || fault 'spm_publish --version'
[[ $("$publish" --help) == *--domain* ]] || fault 'spm_publish --help'
refuse 3 FILE
refuse 3 --fast good.spm --fast
expect 3 '0 .. 232' "$publish" good.spm --domain 233
expect 3 '0 .. 232' "$publish" good.spm --domain -1
expect 3 '0 .. 232' "$publish" good.spm --domain 1.5
expect 3 '0.1 .. ' "$publish" good.spm --seconds 0
expect 3 '0.1 .. ' "$publish" good.spm --seconds nan

readonly letters='A-Z a-z 0-9 . _ -'
for name in '' 'a b' 'a/b' 'a@b' $'a\nb' $'\e[31mred' "$(printf 'n%.0s' {1..64})"; do
    refuse 3 "$letters" good.spm --name "$name"
done
refuse 3 '2 times for 1' good.spm --name a --name b
cp good.spm 'two words.spm'
refuse 3 'give one with --name' 'two words.spm'
mkdir other
cp good.spm other/good.spm
refuse 3 "published as 'good'" good.spm other/good.spm
refuse 3 "published as 'twice'" good.spm other/good.spm --name twice --name twice

bytes=$(stat -c %s good.spm)
: >empty.spm
printf 'solid of some other program\n' >foreign.spm
head -c 100 good.spm >header.spm
head -c $((bytes - 1)) good.spm >cut.spm
{ cat good.spm; printf x; } >long.spm
cp good.spm bent.spm
printf '\xff\xfe' | dd of=bent.spm bs=1 seek=64 conv=notrunc status=none
cp good.spm version.spm
printf '\xff' | dd of=version.spm bs=1 seek=8 conv=notrunc status=none
refuse 2 'missing.spm: cannot be opened' missing.spm
refuse 2 'other: ' other
refuse 2 'empty.spm: is empty' empty.spm
refuse 2 'foreign.spm: is not an SPM model' foreign.spm
refuse 2 'header.spm: is cut short' header.spm
refuse 2 'cut.spm: ' cut.spm
refuse 2 'long.spm: ' long.spm
refuse 2 'bent.spm: ' bent.spm
refuse 2 'version' version.spm
refuse 2 'cut.spm: ' good.spm cut.spm # One that is good does not help.

# Damage in every chunk: the host says so and goes on, the loop runs on the base mesh.
cp good.spm damaged.spm
start_publisher damaged.spm
dd if=/dev/zero of=damaged.spm bs=1 seek=$((bytes / 2)) count=$((bytes - bytes / 2)) \
    conv=notrunc status=none
run_hrtc --model damaged --duration 4
check report.json frames == 4000 wire.host_lost == 0 models.0.pieces_overdue '>' 0 \
    models.0.pieces_missing == '1*models.0.pieces_overdue'
grep -q "^hrtc: model 'damaged': .* doesn't come; the surface there stays coarse" hrtc.log \
    || fault 'the controller does not tell of what it waits for'
grep -q "^verdict .*pieces of damaged that didn't come within 1 s" hrtc.log \
    || fault 'the verdict does not tell'
code=0
"$hrtc" --allow-no-rt --domain "$domain" --model damaged --duration 4 --strict >strict.log 2>&1 \
    || code=$?
((code == 1)) || fault "--strict: pieces that did not come ended with $code"
grep -q 'damaged.spm: .* at offset [0-9]* is damaged' publish.log \
    || fault "the host does not name the damage: $(cat publish.log)"
stop TERM "$publisher"
((stopped_with == 0)) || fault "spm_publish ended with $stopped_with"
finish
