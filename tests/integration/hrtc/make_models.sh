#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# make_models.sh SPM_BUILD FOLDER: makes the models of the other scripts once: encoding takes both
# processors, and a loop beside it is late.
set -euo pipefail
readonly build=$1 folder=$2
mkdir -p "$folder"
for model in bumpy-sphere-{5,20,60,100,200}000 torus-{10,20}000; do
    "$build" --shape "${model%-*}" --faces "${model##*-}" -o "$folder/$model.spm"
done
