#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_bad_input.sh: whatever is wrong with options, models, files or the report's path gives the
# right exit code and one line that names it; nothing is left half-written.
source "$(dirname "$0")/common.sh"
model bumpy-sphere-5000 good.spm
mkdir out

refuse() { expect "$1" "$2" "$hrtc" --allow-no-rt "${@:3}"; }
refuse_option() { # refuse_option OPTION VALUE ALLOWED: the line names the option and what it takes.
    refuse 3 "$1: *$3" --model bumpy "$1" "$2"
}
run_file() { timeout 30 "$hrtc" --allow-no-rt --transport file --model good.spm "$@"; }

# A file of options: its keys are checked as the command line is, and go behind it.
refuse_config() { # refuse_config PATTERN LINE: of a file with this line.
    printf '%s\n' "$2" >bad.toml
    refuse 3 "$1" --model bumpy --config bad.toml
}
refuse_config "bad.toml:1: no option is called 'buoyancy'; a line is KEY = VALUE" 'buoyancy = 3'
refuse_config "bad.toml:3: no option is called 'stifness'; 'stiffness'[?]" \
    $'# Mine.\nrate = 1000\n  stifness = 300'
refuse_config "bad.toml:2: there are no sections; '[[]loop]' is one" $'\n[loop]\nrate = 1000'
refuse_config "bad.toml:1: *KEY = VALUE" 'splits: quickly'
refuse_config '--rate: *fast*100 .. 10000' 'rate = "fast"'
refuse_config '--rate: *99*100 .. 10000' 'rate = 99'
refuse_config '--rate: ' 'rate ='
refuse_config '--rate: ' 'rate = [1000, 2000]'
refuse_config '--cpu: *1.5*0 .. 1023' 'cpu = 1.5'
refuse_config '--pool-mib: *0.25 .. 4096' 'pool-mib = 0'
refuse_config 'maybe' 'no-static = "maybe"'
refuse_config '--device: *udp:ADDRESS:PORT' 'device = "phantom"'
refuse_config 'not allowed in a configuration file' 'config = "other.toml"'
refuse 2 "missing.toml: can't be read" --config missing.toml
refuse 2 "out: can't be read" --config out
printf 'model = ["bumpy", "torus"]\nplace = ["0,0,0", "1,0,0"]\nrate = 2000\n' >good.toml
"$hrtc" --config good.toml --rate 4000 --print-config >all.toml || fault '--print-config'
grep -qx 'rate=4000' all.toml || fault 'the command line does not go first'
grep -q '^place=.*1,0,0' all.toml || fault 'a list is lost'
"$hrtc" --config all.toml --print-config | cmp - all.toml || fault 'what is printed reads otherwise'

# The command line.
[[ $("$hrtc" --version) == 'hrtc '* ]] || fault 'hrtc --version'
"$hrtc" --help >help.txt
grep -q -- --pool-mib help.txt || fault 'hrtc --help'
! LC_ALL=C grep -q '[^[:print:]]' help.txt || fault 'hrtc --help prints more than text'
refuse 3 --model
refuse 3 --fast --model bumpy --fast
readonly rates='100 .. 10000'
for value in 0 -1 99 10001 1e300 nan fast 1000.5 ''; do
    refuse_option --rate "$value" "$rates"
done
for value in 0 -1 86401 inf nan long; do
    refuse_option --duration "$value" '0.1 .. 86400'
done
for value in 0 0.2 4097 nan big; do
    refuse_option --pool-mib "$value" '0.25 .. 4096'
done
refuse_option --cache-mib 0 '0.05 .. 4096'
refuse_option --cache-mib 2 'less than --pool-mib'
for value in 0 -1 1000000 1.5 many; do
    refuse_option --splits "$value" '1 .. 256'
done
for value in 0 0.9 10001 nan soon ''; do
    refuse_option --frame-budget-us "$value" '1 .. 10000'
done
refuse 3 '--frame-budget-us: must be less than the period of 1000 us' --model bumpy \
    --frame-budget-us 1000
refuse 3 'the period of 250 us' --model bumpy --rate 4000 --frame-budget-us 300
refuse_option --stiffness 0 '1 .. 3000'
refuse_option --stiffness 3001 '1 .. 3000'
for value in 0 -1 0.009 101 nan fast ''; do
    refuse_option --speed-limit "$value" '0.01 .. 100'
done
for value in -1 32 1.5 left; do
    refuse_option --clutch "$value" '0 .. 31'
done
refuse_option --domain -1 '0 .. 232'
refuse_option --domain 233 '0 .. 232'
refuse_option --domain 1.5 '0 .. 232'
refuse_option --wait 0 '0.1 .. 3600'
refuse_option --priority 0 '1 .. 98'
refuse_option --priority 99 '1 .. 98'
refuse_option --supervisor-periods 1 '2 .. 1000'
refuse_option --supervisor-periods 1001 '2 .. 1000'
refuse_option --cpu -1 '0 .. 1023'
refuse_option --cpu 1024 '0 .. 1023'
(($(nproc --all) > 1023)) || refuse_option --cpu 1023 'it may use'
for value in phantom udp: udp:80 udp:65536 udp:5x udp::48500 ''; do
    refuse_option --device "$value" 'udp:ADDRESS:PORT'
done
for value in sim: sim:sigma replay replay: dhd: dhd:64 dhd:-1; do
    refuse_option --device "$value" "${value%%:*}:[A-Z]"
done
for value in nan nan@1 nan@1+0 nan@-1+1 nan@1+2000000000 late@1+1 ''; do
    refuse_option --device-fault "$value" 'KIND@FRAME+LENGTH'
done
refuse 3 '--device-fault: there is no simulated device' --model a --device udp \
    --device-fault nan@1+1
many=()
for ((i = 0; i < 65; ++i)); do many+=(--device-fault "nan@$i+1"); done
refuse 3 '--device-fault: at most 64' --model a "${many[@]}"
refuse_option --motion fly 'script, free, approach'
refuse_option --motion '' 'script, free, approach'
refuse 3 '--motion: there is no simulated device' --model a --device udp --motion free
refuse 3 'extra' --model a extra
refuse 3 '--device: 2 given for 1 tools' --model a --device sim --device sim
refuse 3 '--device: 3 given for 2 tools' --model a --tools 2 --device sim --device sim --device sim
refuse 3 '--device-frame: 1 given for 0' --model a --device-frame 0,0,0
refuse 3 'in the world already' --model a --device sim --device-frame 0,0,0
refuse 3 'in the world already' --model a --device replay:a.rec --device-frame 0,0,0
refuse 3 '1e4 m' --model a --device udp --device-frame 1,2
refuse_option --transport smtp 'is not dds or file'
for value in cube sphere: sphere:0 sphere:0.1,1 capsule:0.1 capsule:0,0.1 box:1,1 box:1,1,0 \
    box:1,1,1,2 hull: hull:a.obj,2 mesh: mesh:,0.1 sphere:1.1 \
    sphere:nan sphere:1mm $'sphere:\e[2J'; do
    refuse_option --tool "$value" '1e-5 to 1 m'
done
for value in -1 5.1 1,2 1,0,0,2 nan 1kg ''; do
    refuse_option --tool-mass "$value" '0 to 5 kg'
done
refuse 3 '--tool-mass: 2 given for 1 tools' --model a --tool-mass 1 --tool-mass 1
for value in point:1,2 line:0,0,0 plane:0,0,0,0,0,0 cone:1,2,3 point:0,0,0,5000 ''; do
    refuse_option --guide "$value" 'a direction that is not zero'
done
refuse 3 '--guide: 2 given for 1 tools' --model a --guide none --guide none
for value in 1 1,2 1,2,3,4 1,2,x 1,2,3,400,0,0 1,2,3,0,0,0,0 nan,0,0 2e4,0,0 ''; do
    refuse_option --place "$value" X,Y,Z
done
refuse 3 '--objects: 1; 2 are there from the start' --model bumpy --place 0,0,0 --place 1,0,0 \
    --objects 1
for value in 0 4097 -1 many; do
    refuse 3 --objects --model bumpy --objects "$value"
done
for value in 0 17 -1; do
    refuse 3 --tools --model bumpy --tools "$value"
done
refuse 3 '--tools: 2, but --tool is given 1 times' --model bumpy --tools 2 --tool sphere:0.01
for value in 0.5 3001 soft 500,-0.1 500,3.1 500,0.5,0.6 500,1,1,21 500,1,1,1,1 nan '500,' '' \
    stiffness=0 static=0.1,static=0.1 dynamic=0.1 texture=1; do
    refuse_option --material "$value" '1 to 3000 N/m'
done
refuse 3 --material --model bumpy --material 100 --material 100
for value in 0 101 -1 stiff nan; do
    refuse 3 --angular-stiffness --model bumpy --angular-stiffness "$value"
done
for value in 0 0.2 -1 soft nan; do
    refuse 3 --smooth --model bumpy --smooth "$value"
done
refuse 3 '--smooth: no --tool is a point or a sphere' --model bumpy --smooth 0.005 \
    --tool box:0.01,0.01,0.01

# A model's name, which is checked before anything is asked for.
readonly letters='A-Z a-z 0-9 . _ -'
for name in '' 'a b' ä $'a\nb' $'\e[31mred' "$(printf 'n%.0s' {1..64})"; do
    refuse 3 "--model: *$letters" --model "$name"
    refuse 3 "--name: *$letters" --model bumpy --name "$name"
done
refuse 3 'hexadecimal' --model bumpy@12
refuse 3 'hexadecimal' --model "bumpy@$(printf 'g%.0s' {1..32})"
refuse 2 "'bumpy' is not published on domain $domain" --model bumpy --domain "$domain" --wait 1

# Files.
bytes=$(stat -c %s good.spm)
: >empty.spm
printf 'solid of some other program\n' >foreign.spm
head -c 5 good.spm >five.spm
head -c 100 good.spm >header.spm
head -c $((bytes - 1)) good.spm >cut.spm
{ cat good.spm; printf x; } >long.spm
cp good.spm bent.spm
printf '\xff\xfe' | dd of=bent.spm bs=1 seek=64 conv=notrunc status=none
refuse_file() { refuse 2 "$1: $2" --transport file --model "$1"; }
refuse_file missing.spm 'cannot be opened'
refuse_file out 'is not a file but a directory'
refuse_file empty.spm 'is empty'
refuse_file foreign.spm 'is not an SPM model'
refuse_file five.spm 'is not an SPM model'
refuse_file header.spm 'is cut short: the file ends at byte 100'
refuse_file cut.spm "has $((bytes - 1)) bytes where its header states $bytes: it is cut short"
refuse_file long.spm "has $((bytes + 1)) bytes where its header states $bytes: it is followed"
refuse_file bent.spm 'the header (bytes 0 to '
refuse 2 'no?where.spm: cannot be opened' --transport file --model $'no\nwhere.spm'
refuse 2 --pool-mib --transport file --model good.spm --pool-mib 0.25

# What nothing needs of the most memory isn't taken, nor locked.
if [[ -z "$sanitizer" ]]; then
    (ulimit -v 2000000 \
        && run_file --pool-mib 4096 --duration 0.5 --report most.json >hrtc.log 2>&1) \
        || { cat hrtc.log; fault 'it takes all of --pool-mib'; }
    check most.json frames == 500 pools.total_bytes '<' 20000000
fi

# A report that can't be written is known before the run.
start=$SECONDS
mkfifo pipe.json
mkdir folder.json
for name in run run.htm run.JSON json; do
    refuse_option --report "$name" 'neither in .json nor, for a page, in .html'
done
for path in nowhere/report.json folder.json good.spm/report.json pipe.json; do
    refuse 2 "$path" --transport file --model good.spm --duration 60 --report "$path"
done
((SECONDS - start < 30)) || fault 'it ran before it found out that it could not report'
[[ -z $(ls -A out)$(ls -A folder.json) && -p pipe.json && -z $(compgen -G '*partial*') ]] \
    || fault "left behind: $(ls -A . out)"

# A chunk that is damaged is refused when it comes; the run goes on with what is sound, says so, and
# with --strict it has failed.
"$inspect" good.spm --json >/dev/null
cp good.spm chunk.spm
printf '\xff\xfe\xfd' | dd of=chunk.spm bs=1 seek=$((bytes - 50)) conv=notrunc status=none
damaged() { # damaged CODE ARGUMENT...: ends with that code and names the damage once.
    local code=0
    timeout 30 "$hrtc" --allow-no-rt --transport file --model chunk.spm --duration 3 \
        --report out/report.json "${@:2}" >hrtc.log 2>&1 || code=$?
    ((code == $1)) || { cat hrtc.log; fault "a damaged chunk ended the run with $code"; }
    check out/report.json frames == 3000 models.0.pieces_refused == 1
    grep -q '^verdict .*1 damaged pieces of chunk' hrtc.log || fault 'the verdict does not tell'
    [[ $(grep -c '^hrtc: chunk.spm: .*damaged' hrtc.log) == 1 ]] || fault 'it is not told once'
}
damaged 0
damaged 1 --strict
rm -f out/report.json

# A hand that is too fast gets no force, and the report says why.
run_file --duration 2 --speed-limit 0.01 --report out/report.json >hrtc.log 2>&1 \
    || { cat hrtc.log; fault 'a run with a speed limit ended badly'; }
check out/report.json safety.begun.velocity '>' 0 safety.events '>' 2 \
    safety.events_left_out '>=' 0 safety.begun.garbage == 0 safety.begun.disconnect == 0 \
    safety.begun.software '<=' 1
grep -q '^safety .*velocity' hrtc.log || fault 'no word about the speed'
rm -f out/report.json

# A report in .html is a page, whole and with the run's figures.
run_file --duration 0.5 --report out/run.html --report out/report.json >hrtc.log 2>&1 \
    || fault 'no page'
[[ $(head -n 1 out/run.html) == '<!DOCTYPE html>' && $(tail -n 1 out/run.html) == '</html>' ]] \
    || fault 'the page is no page'
grep -qF "$(sed -n 's/^frames *//p' hrtc.log)" out/run.html || fault 'the page is of another run'
if command -v python3 >/dev/null; then
    python3 -c 'import sys, xml.etree.ElementTree as tree; tree.parse(sys.argv[1])' out/run.html \
        || fault 'the page is not well-formed'
fi
check out/report.json frames == 500
rm -f out/run.html out/report.json

# An interrupted run ends early and reports.
"$hrtc" --allow-no-rt --transport file --model good.spm --duration 60 --report out/report.json \
    >hrtc.log 2>&1 &
controller=$!
started+=("$controller")
wait_for_sleeps 1000 "$controller"
stop INT "$controller"
((stopped_with == 0)) || fault "the interrupted run ended with $stopped_with"
check out/report.json frames '>' 0 frames '<' 10000
[[ $(ls -A out) == report.json ]] || fault "left behind: $(ls -A out)"
finish
