#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# metrics.sh: the metrics of spm_publish --metrics and spm_view satisfy promtool, and follow a
# controller that is started and ended.
source "$(dirname "$0")/common.sh"
readonly view=$1/spm_view
command -v promtool >/dev/null || {
    echo 'skipped: no promtool here'
    exit 77
}

# get URL [HEADER: VALUE]: prints the text; fails for every status except 200.
get() {
    python3 - "$@" <<'PYTHON'
import sys
import urllib.request

request = urllib.request.Request(sys.argv[1])
for header in sys.argv[2:]:
    request.add_header(*header.split(": "))
print(urllib.request.build_opener(urllib.request.ProxyHandler({})).open(request).read().decode(),
      end="")
PYTHON
}
# tells URL NAME OP VALUE: true if a sample of that name satisfies the comparison.
tells() {
    get "$1" >metrics.txt && awk -v name="$2" -v op="$3" -v value="$4" '
        $1 == name || index($1, name "{") == 1 {
            found = (op == "==" && $2 == value) || (op == ">" && $2 > value) }
        END { exit !found }' metrics.txt
}
# check_metrics URL: promtool accepts all of it.
check_metrics() {
    get "$1" >metrics.txt
    promtool check metrics <metrics.txt >promtool.txt 2>&1 || fault "$1: $(<promtool.txt)"
    [[ ! -s promtool.txt ]] || fault "$1: promtool says: $(<promtool.txt)"
}

model torus-20000 torus.spm
start_publisher torus.spm --metrics 0
served=$(sed -n 's/^metrics on //p' publish.log)
readonly served
[[ "$served" == http://127.0.0.1:*/metrics ]] || fail "metrics on '$served'"
tells "$served" tactus_controllers == 0 || fault 'a controller before there is one'
grep -q '^tactus_model_faces{model="torus",hash="[0-9a-f]*"} 20000$' metrics.txt \
    || fault "no faces of the model: $(<metrics.txt)"
check_metrics "$served"

"$view" --domain "$domain" --port 0 >/dev/null 2>view.log &
started+=("$!")
wait_for_line view.log 'shows DDS domain'
shown=$(sed -n 's|^\(http://[^ ]*/\) .*|\1metrics|p' view.log)
readonly shown

start_hrtc --model torus --duration 600 --name hand-1
for url in "$served" "$shown"; do
    wait_until "controller at $url" tells "$url" tactus_frames_total '>' 100
    grep -q '^tactus_frames_total{controller="hand-1",id="[0-9a-f]*"} ' metrics.txt \
        || fault "no name at $url: $(<metrics.txt)"
    check_metrics "$url"
done
wait_until 'piece' tells "$served" tactus_subscriber_pieces_sent_total '>' 0
wait_until 'piece' tells "$served" tactus_bytes_sent_total '>' 0
stop INT "$controller"
for url in "$served" "$shown"; do
    wait_until "end of the controller at $url" tells "$url" tactus_controllers == 0
    check_metrics "$url"
done

# The server is for this machine only, one program a port.
! get "$served" 'Host: elsewhere:80' >/dev/null 2>&1 || fault 'another name is answered'
! get "$served" 'Origin: http://elsewhere' >/dev/null 2>&1 || fault 'another page is answered'
port=${served##*:}
expect 2 "port ${port%/*} of 127.0.0.1 is not available: *; set another with --metrics" \
    "$publish" --domain "$domain" torus.spm --metrics "${port%/*}"
expect 3 "--metrics: '65536' is not a whole number in 0 .. 65535" "$publish" torus.spm \
    --metrics 65536
finish
