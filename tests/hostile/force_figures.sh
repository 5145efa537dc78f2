# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash disable=SC2154 # It is sourced after common.sh.
# Force of a recording, period by period; sourced after common.sh.

# export_force NAME: exports NAME.rec to NAME.csv.
export_force() {
    "$hrtc" --replay "$1.rec" --export "$1.csv" >replay.log 2>&1 \
        || fail "the recording of $1 doesn't replay: $(cat replay.log)"
}

# force_figures FILE [WALL SLEW]: prints the greatest growth of the force in a period, its greatest
# decrease in a period in touch, both in N, the share of the frames in contact, and the greatest
# excess of a growth over the law on change (docs/safety.md): WALL in N/m times the motion of the
# hand and 0.5 mm a period of the object, and SLEW in N.
force_figures() {
    awk -F, -v wall="${2:-0}" -v slew="${3:-0}" '
        NR == 1 {
            for (i = 1; i <= NF; ++i) at[$i] = i
            force = "tool0.sent_force_world_n"
            hand = "tool0.device_world_m"
            beyond = -1
            next
        }
        {
            n = sqrt($at[force ".x"] ^ 2 + $at[force ".y"] ^ 2 + $at[force ".z"] ^ 2)
            way = sqrt(($at[hand ".x"] - x) ^ 2 + ($at[hand ".y"] - y) ^ 2 \
                       + ($at[hand ".z"] - z) ^ 2)
            periods = $at["tool0.elapsed_periods"] > 1 ? $at["tool0.elapsed_periods"] : 1
            touches = $at["tool0.in_contact"] == "true" || $at["tool0.in_contact"] == 1
            grown = (n - before) / periods
            most = grown > most ? grown : most
            least = touches && -grown > least ? -grown : least
            over = n - before - wall * (way + 5e-4 * periods) - slew
            beyond = NR > 2 && over > beyond ? over : beyond
            in_touch += touches
            before = n
            x = $at[hand ".x"]
            y = $at[hand ".y"]
            z = $at[hand ".z"]
        }
        END { printf "%.4f %.4f %.4f %.4f\n", most, least, in_touch / (NR - 1), beyond }' "$1"
}

# at_most NAME VALUE LIMIT
at_most() {
    awk -v value="$2" -v limit="$3" 'BEGIN { exit !(value <= limit) }' \
        || fault "$1 is $2, above $3"
}
