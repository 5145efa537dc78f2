# SPDX-License-Identifier: Apache-2.0
# Same inputs, same bits: no contraction into FMA on any target, Eigen's own vectorisation off
# (it issues explicit FMA, and the ABI of its aligned types would change with the flags).
add_library(tactus_numerics INTERFACE)
target_compile_options(tactus_numerics INTERFACE -ffp-contract=off)
# Its index checks would bring assert() into rt_core; fixed-size types do not need them.
target_compile_definitions(tactus_numerics INTERFACE
    EIGEN_DONT_VECTORIZE EIGEN_MAX_ALIGN_BYTES=0 EIGEN_NO_DEBUG)

# One set of objects for shared and static libraries and programs. No function may be replaced by
# another one of its name, so that calls within a library are as direct as without -fPIC; inline
# functions of a library are its own, whatever a program's were compiled with.
add_compile_options(-fPIC -fno-semantic-interposition
    $<$<COMPILE_LANGUAGE:CXX>:-fvisibility-inlines-hidden>)

# Stack protector, marks for shadow stack and branch targets, checked calls of libc; not beside
# sanitizers, which check the same. A library on the frame's path takes tactus_without_guards().
if(NOT TACTUS_SANITIZE)
    if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
        set(branches -fcf-protection=full)
        set(branches_of_frame -fcf-protection=return)
    elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
        set(branches -mbranch-protection=standard)
        set(branches_of_frame -mbranch-protection=none)
    endif()
    add_compile_options(-fstack-protector-strong ${branches}
        "$<$<CONFIG:Release>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=2>")
endif()
# tactus_without_guards(<target>): a stack protector costs a frame 2 to 3 % of its instructions,
# marks of branch targets 0.7 to 1 %. The target has no precompiled headers of others.
function(tactus_without_guards target)
    if(NOT TACTUS_SANITIZE)
        target_compile_options(${target} PRIVATE -fno-stack-protector ${branches_of_frame})
    endif()
endfunction()

if(TACTUS_SANITIZE)
    add_compile_options(
        -fsanitize=${TACTUS_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
    add_link_options(-fsanitize=${TACTUS_SANITIZE})
endif()
if(TACTUS_FUNCTION_EFFECTS)
    add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-Werror=function-effects>)
endif()

# tactus_library(<name> SOURCES ... HEADERS ... LINK ...)
# One target per module: explicit files, headers included from the repository root. A header is the
# first include of its source, where it has one, and is compiled alone with it; the others are where
# CMAKE_VERIFY_INTERFACE_HEADER_SETS is on. PRECOMPILED headers of its own take the
# place of the common ones (precompiled.cmake). The global property TACTUS_MODULES lists all of
# them.
function(tactus_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;LINK;LINK_PRIVATE;PRECOMPILED" ${ARGN})
    add_library(${name} STATIC ${ARG_SOURCES})
    set_property(GLOBAL APPEND PROPERTY TACTUS_MODULES ${name})
    target_sources(${name} PUBLIC
        FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${ARG_HEADERS})
    set(alone ${ARG_HEADERS})
    foreach(source ${ARG_SOURCES})
        string(REGEX REPLACE "\\.cpp$" ".hpp" own ${source})
        list(REMOVE_ITEM alone ${own})
    endforeach()
    target_sources(${name} PUBLIC
        FILE_SET alone TYPE HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${alone})
    set_target_properties(${name} PROPERTIES INTERFACE_HEADER_SETS_TO_VERIFY alone)
    target_link_libraries(${name} PUBLIC tactus_numerics ${ARG_LINK}
        PRIVATE $<BUILD_INTERFACE:tactus_warnings> ${ARG_LINK_PRIVATE})
    if(ARG_PRECOMPILED)
        target_precompile_headers(${name} PRIVATE ${ARG_PRECOMPILED})
    else()
        target_precompile_headers(${name} REUSE_FROM tactus_common_headers)
    endif()
endfunction()

# tactus_program(<name> [PRECOMPILED <target>] SOURCES ... LINK ...)
# Calls into shared libraries are bound at start: bound lazily, the first memcpy of a frame would
# run the dynamic linker, locks included.
function(tactus_program name)
    cmake_parse_arguments(ARG "" "PRECOMPILED" "SOURCES;LINK" ${ARGN})
    if(NOT ARG_PRECOMPILED)
        set(ARG_PRECOMPILED tactus_common_headers)
    endif()
    add_executable(${name} ${ARG_SOURCES})
    target_precompile_headers(${name} REUSE_FROM ${ARG_PRECOMPILED})
    target_link_libraries(${name} PRIVATE $<BUILD_INTERFACE:tactus_warnings> ${ARG_LINK})
    target_link_options(${name} PRIVATE LINKER:-z,now)
    target_compile_definitions(${name} PRIVATE TACTUS_VERSION="${PROJECT_VERSION}")
endfunction()
