# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash disable=SC2154 # What common.sh sets is used here.
# Runs the commands of a documentation page; sourced after common.sh.

# run_page PAGE COUNT: runs the page's COUNT blocks of shell and Python verbatim and in order, in
# one shell that ends at the first failure. Programs are called as the page calls them, on a domain
# of this test, and on any machine. Their output is in page.log.
run_page() {
    local program
    command -v python3 >/dev/null || exit 77
    mkdir programs
    cat >programs/hrtc <<SCRIPT
#!/bin/bash
[[ "\$1" == --replay ]] || set -- --allow-no-rt --domain $domain --wait $patience_s "\$@"
exec "$hrtc" "\$@"
SCRIPT
    cat >programs/spm_publish <<SCRIPT
#!/bin/bash
exec "$publish" --domain $domain "\$@"
SCRIPT
    chmod +x programs/*
    for program in "$build" "$inspect" "$tactus"; do
        ln -s "$program" programs/
    done
    # A Python block is a document for python3.
    awk '/^```/ { kind = kind == "" ? substr($0, 4) : ""
                  blocks += kind == "sh" || kind == "python"
                  if (kind == "python") print "python3 - <<\"PYTHON\""
                  if (kind == "" && was == "python") print "PYTHON"
                  was = kind; next }
         kind == "sh" || kind == "python"
         END { print "echo ran " blocks " blocks" }' "$1" >page.sh
    PATH=$scratch/programs:$PATH bash -eu page.sh >page.log 2>&1 || fail "$1: $(cat page.log)"
    cat page.log
    grep -qx "ran $2 blocks" page.log || fail "not $2 blocks were run"
}
