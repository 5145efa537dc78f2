# SPDX-License-Identifier: Apache-2.0
# One interface target carries the warnings; only our own sources link it, privately.
add_library(tactus_warnings INTERFACE)
target_compile_options(tactus_warnings INTERFACE
    -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wold-style-cast
    -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wunused -Wformat=2 -Wdouble-promotion
    -Wimplicit-fallthrough)
# In a unity build every source is an include of what is compiled; the warning means headers.
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(tactus_warnings INTERFACE -Wno-subobject-linkage)
endif()
# Not for the sanitizers' presets: g++ warns of what their checks make of the standard library.
if(TACTUS_WERROR)
    target_compile_options(tactus_warnings INTERFACE -Werror)
endif()
