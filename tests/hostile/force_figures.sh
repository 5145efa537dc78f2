# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash disable=SC2154 # It is sourced after common.sh.
# A recording's force, period by period; sourced after common.sh.

# export_force NAME: of NAME.rec; into NAME.csv.
export_force() {
    "$hrtc" --replay "$1.rec" --export "$1.csv" >replay.log 2>&1 \
        || fail "the recording of $1 doesn't replay: $(cat replay.log)"
}

# force_figures FILE: the largest growth of the force a period, its largest fall a period in touch,
# both in N, and the share of the frames in contact.
force_figures() {
    awk -F, '
        NR == 1 {
            for (i = 1; i <= NF; ++i) at[$i] = i
            force = "tool0.sent_force_world_n"
            next
        }
        {
            n = sqrt($at[force ".x"] ^ 2 + $at[force ".y"] ^ 2 + $at[force ".z"] ^ 2)
            periods = $at["tool0.elapsed_periods"] > 1 ? $at["tool0.elapsed_periods"] : 1
            touches = $at["tool0.in_contact"] == "true" || $at["tool0.in_contact"] == 1
            grown = (n - before) / periods
            most = grown > most ? grown : most
            least = touches && -grown > least ? -grown : least
            in_touch += touches
            before = n
        }
        END { printf "%.4f %.4f %.4f\n", most, least, in_touch / (NR - 1) }' "$1"
}

# at_most NAME VALUE LIMIT
at_most() {
    awk -v value="$2" -v limit="$3" 'BEGIN { exit !(value <= limit) }' \
        || fault "$1 is $2, above $3"
}
