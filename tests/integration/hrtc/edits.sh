# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# Functions of the scripts that carve bumpy.spm into carved.spm; sourced after common.sh.

# volume_mm3 FILE: prints the volume of a closed mesh in an OBJ file.
volume_mm3() {
    python3 - "$1" <<'PYTHON'
import sys

corners, volume = [], 0.0
for line in open(sys.argv[1]):
    words = line.split()
    if words[:1] == ["v"]:
        corners.append([float(word) for word in words[1:4]])
    elif words[:1] == ["f"]:
        a, b, c = (corners[int(word.split("/")[0]) - 1] for word in words[1:4])
        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                   + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6.0
print(volume * 1e9)
PYTHON
}
# of_edits PATTERN: prints the number that PATTERN captures in the server's last line of edits.
of_edits() { sed -n "s/^.*edits of 'bumpy': .*$1.*\$/\\1/p" publish.log; }
# of_report FILE KEY: prints a number of the first model in a report.
of_report() {
    python3 -c 'if True:
        import json, sys
        print(json.load(open(sys.argv[1]))["models"][0][sys.argv[2]])' "$@"
}
# check_saved INSPECT: the saved file is a sound model with the server's revision, and has lost the
# volume that the server's last line has.
check_saved() {
    local program=$1 removed lost
    removed=$(of_edits ' \([0-9.]*\) mm^3 removed')
    "$program" carved.spm --json >carved.json || fault 'carved.spm is not sound'
    check carved.json revision == "$(of_edits ' \([0-9]*\) edits\{0,1\},')" is_closed == 1
    "$program" bumpy.spm --extract --error 0 -o before.obj >/dev/null
    "$program" carved.spm --extract --error 0 -o after.obj >/dev/null
    lost="$(volume_mm3 before.obj) - $(volume_mm3 after.obj)"
    awk "BEGIN { lost = $lost
                 exit !(lost > 0.98 * $removed && lost < 1.02 * $removed && lost > 0) }" \
        || fault "lost $lost, not $removed mm^3"
}
