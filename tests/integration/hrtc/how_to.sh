#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# how_to.sh: runs the shell and Python blocks of docs/how-to.md verbatim, in order. tests/consumer
# covers its C++.
page=$(cd "$(dirname "$0")/../../.." && pwd)/docs/how-to.md
readonly page
source "$(dirname "$0")/common.sh"
source "$(dirname "$0")/run_page.sh"
run_page "$page" 5
grep -qE '^[0-9.]+ % of 2000 frames exact, within tolerance or separated$' page.log \
    || fail 'the report is not read'
check many.json frames == 2000 scene.objects == 3 \
    answers.exact+answers.separated+answers.within_tolerance '>' 1000
check moving.json frames == 3000 models.0.pose.followed == 1 models.0.pose.moves '>' 100
check again.json frames '>' 1000
finish
