#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# spm_publish_bad_input.sh: files that cannot be served give the right exit code and one line; a
# chunk damaged while it is served does not end the server. ServerOptions covers wrong options, and
# decoder laws faults within a file.
source "$(dirname "$0")/common.sh"
model bumpy-sphere-5000 good.spm

refuse() { expect "$1" "$2" "$publish" --domain "$domain" --seconds 5 "${@:3}"; }

bytes=$(stat -c %s good.spm)
mkdir other
head -c $((bytes - 1)) good.spm >cut.spm
cp good.spm flip.spm
printf '\xff\xfe\xfd' | dd of=flip.spm bs=1 seek=$((bytes - 50)) conv=notrunc status=none
refuse 2 'missing.spm: cannot be opened: No such file or directory' missing.spm
refuse 2 'other: is not a file but a directory' other
refuse 2 'flip.spm: chunk 36 at offset' flip.spm
refuse 2 'other: cannot be read' good.spm --poses other
refuse 2 'cut.spm: *the file is cut short' good.spm cut.spm # A valid one does not help.

# Damage in every chunk: the server reports it and continues, the loop runs on the base mesh.
cp good.spm damaged.spm
start_publisher damaged.spm
dd if=/dev/zero of=damaged.spm bs=1 seek=$((bytes / 2)) count=$((bytes - bytes / 2)) \
    conv=notrunc status=none
waits() { # waits CODE ARGUMENT...: expects that exit code and reports of missing pieces.
    local code=0
    "$hrtc" --allow-no-rt --domain "$domain" --model damaged --duration 2 --report report.json \
        "${@:2}" >hrtc.log 2>&1 || code=$?
    ((code == $1)) || { cat hrtc.log; fault "pieces that did not come ended with $code"; }
    check report.json frames == 2000 wire.server_lost == 0 models.0.pieces_overdue '>' 0 \
        models.0.pieces_missing == '1*models.0.pieces_overdue'
    grep -q "^hrtc: model 'damaged': .* has not arrived; the surface there stays coarse" hrtc.log \
        || fault 'the controller does not tell of what it waits for'
    grep -q "^verdict .*pieces* of damaged did not arrive within 1 s" hrtc.log \
        || fault 'the verdict does not tell'
}
waits 0
waits 1 --strict
grep -q 'damaged.spm: .* at offset [0-9]* is damaged' publish.log \
    || fault "the server does not name the damage: $(cat publish.log)"
stop TERM "$publisher"
((stopped_with == 0)) || fault "spm_publish ended with $stopped_with"
finish
