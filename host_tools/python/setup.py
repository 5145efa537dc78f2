# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""The module tactus for the Python that runs this: CMake compiles it in build/ of the checkout."""
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
BUILD = ROOT / "build" / f"wheel-{sys.implementation.cache_tag}"


def cmake(*arguments):
    try:
        subprocess.run(["cmake", *arguments], cwd=ROOT, check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"tactus: the module can't be compiled: {error}; it needs the packages of "
                 "cmake/packages.txt, pybind11-dev and the headers of this Python")


class CMakeModule(build_ext):
    def build_extension(self, ext):
        cmake("--preset", "release", "-B", str(BUILD), "-DTACTUS_TESTS=OFF",
              f"-DPython3_EXECUTABLE={sys.executable}")
        cmake("--build", str(BUILD), "--target", "tactus_python")
        made = pathlib.Path(self.get_ext_fullpath(ext.name))
        made.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(BUILD / "python" / self.get_ext_filename(ext.name), made)
        if not self.inplace:
            shutil.copy(HERE / "tactus.pyi", made.parent)


if not (ROOT / "CMakeLists.txt").is_file():
    sys.exit("tactus: build the module in a checkout: pip install host_tools/python")
BUILD.mkdir(parents=True, exist_ok=True)
setup(
    version=re.search(r"project\(tactus VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1],
    ext_modules=[Extension("tactus", [])],
    packages=[],
    py_modules=[],
    cmdclass={"build_ext": CMakeModule},
    options={"egg_info": {"egg_base": str(BUILD)}, "build": {"build_base": str(BUILD / "setup")}},
)
