# SPDX-License-Identifier: Apache-2.0
# Headers of others that most sources include, parsed once: a third of the compile time. g++ only.
# clang's builds go without, so that a source that lacks an include of its own fails in .ci/run;
# but there the tests, many of which are compiled as one, have them.
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()
# Without these leaves ccache takes no source that has them.
if(CMAKE_CXX_COMPILER_LAUNCHER MATCHES "ccache$")
    set(CMAKE_CXX_COMPILER_LAUNCHER
        env CCACHE_SLOPPINESS=pch_defines,time_macros ${CMAKE_CXX_COMPILER_LAUNCHER})
endif()

# All that rt_core may include, and its sources do.
set(TACTUS_RT_CORE_PRECOMPILED
    <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <atomic> <bit> <cmath> <cstddef> <cstdint>
    <cstring> <limits> <optional> <span> <tuple> <type_traits> <utility> <variant>)

# tactus_precompiled(<name> LINK <library>... HEADERS <header>...)
# Others take it by REUSE_FROM; their flags and the macros that these headers ask for must be the
# same. A source with options of its own has SKIP_PRECOMPILE_HEADERS.
function(tactus_precompiled name)
    cmake_parse_arguments(ARG "" "" "LINK;HEADERS" ${ARGN})
    set(nothing "${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp")
    file(TOUCH ${nothing})
    add_library(${name} OBJECT ${nothing})
    target_link_libraries(${name} PRIVATE
        tactus_numerics $<BUILD_INTERFACE:tactus_warnings> ${ARG_LINK})
    target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
    if(CMAKE_VERIFY_INTERFACE_HEADER_SETS)
        set_target_properties(${name} PROPERTIES DISABLE_PRECOMPILE_HEADERS OFF)
    endif()
endfunction()

set(TACTUS_COMMON_PRECOMPILED
    ${TACTUS_RT_CORE_PRECOMPILED} <chrono> <filesystem> <functional> <memory> <string> <vector>)
tactus_precompiled(tactus_common_headers LINK Eigen3::Eigen
    HEADERS ${TACTUS_COMMON_PRECOMPILED})
