# SPDX-License-Identifier: Apache-2.0
# find_package() of one PART [core] in one VERSION [0.2], without a compiler.
cmake_minimum_required(VERSION 3.25)
if(NOT PART)
    set(PART core)
endif()
if(NOT VERSION)
    set(VERSION 0.2)
endif()
set(CMAKE_SIZEOF_VOID_P 8)
find_package(Tactus ${VERSION} REQUIRED COMPONENTS ${PART})
