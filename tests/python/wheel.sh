#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# wheel.sh SOURCE SPM_BUILD PYTHON: pip makes a wheel for this Python, without a network; installed
# in a new environment, it feels a model. Skips (77) without pip, setuptools, venv or pybind11.
set -euo pipefail
readonly source=$1 build=$2 python=$3

fail() { printf 'FAULT: %s\n' "$*"; exit 1; }

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
"$python" -c 'import setuptools, ensurepip, numpy, pip, venv, wheel' 2>missing.log || {
    echo 'skipped: python3-pip, -setuptools, -venv, -wheel or -numpy is missing'
    exit 77
}
if command -v ccache >/dev/null; then
    export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
before=$(ls -A "$source/host_tools/python")
"$python" -m pip wheel --no-index --no-deps --no-build-isolation -w wheels \
    "$source/host_tools/python" >wheel.log 2>&1 || fail "$(tail -n 40 wheel.log)"
[[ $(ls -A "$source/host_tools/python") == "$before" ]] || fail 'files are left in the sources'
version=$(sed -n 's/^project(tactus VERSION \([0-9.]*\).*/\1/p' "$source/CMakeLists.txt")
made=$(echo wheels/*)
[[ -f "$made" && "$made" == "wheels/tactus-$version-cp"*-linux_*.whl ]] || fail "made $made"

"$python" -m venv --system-site-packages environment
environment/bin/python -m pip install --no-index --no-deps "$made" >install.log 2>&1 \
    || fail "$(<install.log)"
"$build" --shape torus --faces 2000 -o torus.spm >/dev/null 2>&1
environment/bin/python - "$scratch/environment" <<'PYTHON' || fail 'the module does not work'
import pathlib
import sys

import numpy as np
import tactus

module = pathlib.Path(tactus.__file__)
assert module.is_relative_to(sys.argv[1]), module
assert (module.parent / "tactus.pyi").is_file()
path = np.linspace([0.05, 0, 0.0315], [0.05, 0, 0.0215], 500)
force_n = np.asarray(tactus.touch("torus.spm", path).force_n)
assert force_n.shape == (500, 3) and force_n[-1][2] > 0.1 and not force_n[0].any(), force_n
PYTHON
environment/bin/python -m pip uninstall --yes tactus >uninstall.log 2>&1 || fail "$(<uninstall.log)"
[[ -z $(find environment -name 'tactus*') ]] || fail 'files are left after pip uninstall'

# Away from a checkout, one line says so.
cp -r "$source/host_tools/python" alone
! "$python" -m pip wheel --no-index --no-deps --no-build-isolation -w wheels ./alone \
    >alone.log 2>&1 || fail 'a wheel was made of nothing'
grep -q 'tactus: build the module in a checkout' alone.log || fail "$(<alone.log)"
