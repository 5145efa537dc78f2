#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# server_strikes.sh BIN CHECK_REPORT SANITIZER LYING_HOST ATTACK: the server of a scene behaves
# correctly until a tool is near its object. The force is checked period by period, in recordings,
# on a device of the omega class and one of the touch class, compared with that of a correct server.
source "$(dirname "$0")/../integration/hrtc/common.sh"
source "$(dirname "$0")/force_figures.sh"
readonly lying_server=$4 attack=${5#server_}
readonly tool_m=0.002
declare -A growth fall share excess
# Greatest growth of a force in a period, in N. A dragged hand moves by 0.33 mm itself, and the law
# on change counts that.
declare -A growth_max_n=([omega]=0.5 [touch]=0.25)
[[ "$attack" != drag ]] || growth_max_n=([omega]=0.55 [touch]=0.37)
readonly growth_max_n
# Arguments of force_figures: the wall is the device's or 500 N/m, the slew a hundredth of the
# device's force.
readonly -A wall_n_per_m=([omega]=500 [touch]=400) slew_n=([omega]=0.12 [touch]=0.033)

# run_against NAME DEVICE ATTACK [NUMBER]: a run of some seconds with that server. Its force is in
# NAME.csv, its figures in growth[NAME], fall[NAME], share[NAME] and excess[NAME].
run_against() {
    local name=$1 device=$2
    "$lying_server" "$domain" bumpy.spm "$tool_m" "${@:3}" >"$name-server.log" 2>&1 &
    local server=$!
    started+=("$server")
    wait_for_line "$name-server.log" 'ready on DDS domain'
    start_hrtc --scene toy --device "sim:$device" --tool "sphere:$tool_m" --duration 6 \
        --wait "$patience_s" --report "$name.json" --record "$name.rec"
    end_hrtc
    cp hrtc.log "$name.log"
    stop TERM "$server"
    ((stopped_with == 0)) || fail "the server ended with $stopped_with: $(cat "$name-server.log")"
    grep -Eq '^done [1-9]' "$name-server.log" || fail "it did nothing: $(cat "$name-server.log")"
    check_clean "$name.json"
    export_force "$name"
    read -r "growth[$name]" "fall[$name]" "share[$name]" "excess[$name]" \
        < <(force_figures "$name.csv" "${wall_n_per_m[$device]}" "${slew_n[$device]}")
    echo "$name: $(tail -n 1 "$name-server.log"), growth ${growth[$name]} N," \
        "fall ${fall[$name]} N, in contact ${share[$name]}, beyond the law ${excess[$name]} N"
}

case $attack in
    strike) variants=('strike 0.012' 'strike 0.015' 'strike 0.025') ;;
    drag) variants=('drag 0.45') ;;
    *) variants=("$attack") ;;
esac
model bumpy-sphere-20000 bumpy.spm
for device in omega touch; do
    run_against "honest-$device" "$device" honest
    for variant in "${variants[@]}"; do
        name=${variant// /-}-$device
        # shellcheck disable=SC2086 # An attack and its number.
        run_against "$name" "$device" $variant
        at_most "what is beyond the law on change, $name," "${excess[$name]}" 0.0001
        [[ "$attack" != materials ]] || was_held_up "$name.json" \
            || at_most "the largest fall a period, $name," "${fall[$name]}" 0.5
        # Motion above the limit is reported.
        [[ "$variant" != 'strike 0.025' ]] || was_held_up "$name.json" \
            || check "$name.json" safety.begun.jump '>=' 1
        # A stalled loop sees more of an object's motion in a frame than in a period.
        was_held_up "$name.json" \
            || at_most "the largest growth a period, $name," "${growth[$name]}" \
                "${growth_max_n[$device]}"
        check "$name.json" force.max_n '<=' "$([[ $device == omega ]] && echo 8 || echo 3.3)"
    done
done
finish
