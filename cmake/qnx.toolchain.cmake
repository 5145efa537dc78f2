# SPDX-License-Identifier: Apache-2.0
# For QNX's Software Development Platform 8.0 (7.1: docs/internals/porting.md), which must be in the
# environment: source its qnxsdp-env.sh, then
#
#   cmake -S . -B build/qnx -G Ninja --toolchain cmake/qnx.toolchain.cmake -DTACTUS_ONLY_PORTABLE=ON
#
# Never run with the real compilers by us: docs/internals/porting.md says what was tried instead.
foreach(variable QNX_HOST QNX_TARGET)
    if(NOT IS_DIRECTORY "$ENV{${variable}}")
        message(FATAL_ERROR "${variable} names no folder; source qnxsdp-env.sh of QNX's SDP first")
    endif()
endforeach()

# Processor of the target, as QNX calls it.
set(TACTUS_QNX_PROCESSOR aarch64le CACHE STRING "aarch64le or x86_64")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES TACTUS_QNX_PROCESSOR)
if(NOT TACTUS_QNX_PROCESSOR MATCHES "^(aarch64le|x86_64)$")
    message(FATAL_ERROR "TACTUS_QNX_PROCESSOR '${TACTUS_QNX_PROCESSOR}': aarch64le or x86_64")
endif()
string(REGEX REPLACE "le$" "" CMAKE_SYSTEM_PROCESSOR ${TACTUS_QNX_PROCESSOR})
set(CMAKE_SYSTEM_NAME QNX)

set(CMAKE_C_COMPILER "$ENV{QNX_HOST}/usr/bin/qcc")
set(CMAKE_CXX_COMPILER "$ENV{QNX_HOST}/usr/bin/q++")
set(CMAKE_C_COMPILER_TARGET gcc_nto${TACTUS_QNX_PROCESSOR})
set(CMAKE_CXX_COMPILER_TARGET gcc_nto${TACTUS_QNX_PROCESSOR})
foreach(tool AR RANLIB NM STRIP)
    string(TOLOWER ${tool} name)
    set(CMAKE_${tool} "$ENV{QNX_HOST}/usr/bin/nto${CMAKE_SYSTEM_PROCESSOR}-${name}"
        CACHE FILEPATH "Of the SDP")
endforeach()
# With -std=c++20 the C library shows only ISO C; this brings POSIX and MAP_ANONYMOUS back.
set(CMAKE_C_FLAGS_INIT -D_QNX_SOURCE)
set(CMAKE_CXX_FLAGS_INIT -D_QNX_SOURCE)

# Libraries are the target's; Eigen's package has nothing but headers and may be the host's.
set(CMAKE_FIND_ROOT_PATH "$ENV{QNX_TARGET}" "$ENV{QNX_TARGET}/${TACTUS_QNX_PROCESSOR}")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE BOTH)
