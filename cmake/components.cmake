# SPDX-License-Identifier: Apache-2.0
# What is installed for programs of others: components, each a shared and a static library of whole
# modules, with its headers, CMake targets and a pkg-config file (docs/library.md).
#
# A header of a module is included by its path: "rt_core/frame/frame.hpp". Installed, a public one
# is <tactus/rt_core/frame/frame.hpp>; the headers that it needs, and nobody should include, are
# under <tactus/detail/...>. cmake/install_headers.cmake finds those and writes the new names.
include(CMakePackageConfigHelpers)

set(TACTUS_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/Tactus)
set(TACTUS_HEADER_DIR ${CMAKE_INSTALL_INCLUDEDIR})
# Before 1.0 nothing is promised from one minor version to the next; the file name says 0.
set(TACTUS_SOVERSION ${PROJECT_VERSION_MAJOR})

# What a program that includes the headers must be compiled with, so that its types and its numbers
# are the library's (rt_flags.cmake).
get_target_property(numerics_options tactus_numerics INTERFACE_COMPILE_OPTIONS)
get_target_property(numerics_definitions tactus_numerics INTERFACE_COMPILE_DEFINITIONS)
list(TRANSFORM numerics_definitions PREPEND -D OUTPUT_VARIABLE numerics_flags)
list(JOIN numerics_options " " numerics_options_text)
list(JOIN numerics_flags " " numerics_flags_text)
set(TACTUS_PKGCONFIG_CFLAGS "${numerics_options_text} ${numerics_flags_text}")

configure_file(${PROJECT_SOURCE_DIR}/cmake/version.hpp.in
    ${CMAKE_BINARY_DIR}/installed/version.hpp @ONLY)
set(TACTUS_WORLD_HEADER <tactus/platform/world/world.hpp>)
configure_file(${PROJECT_SOURCE_DIR}/cmake/world.hpp.in
    ${CMAKE_BINARY_DIR}/installed/world.hpp @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/installed/version.hpp
    DESTINATION ${TACTUS_HEADER_DIR}/tactus COMPONENT libtactus-dev)
configure_file(${PROJECT_SOURCE_DIR}/cmake/TactusConfig.cmake.in
    ${CMAKE_BINARY_DIR}/installed/TactusConfig.cmake @ONLY)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/installed/TactusConfigVersion.cmake
    VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/installed/TactusConfig.cmake
        ${CMAKE_BINARY_DIR}/installed/TactusConfigVersion.cmake
    DESTINATION ${TACTUS_PACKAGE_DIR} COMPONENT libtactus-dev)

# tactus_component_library(<name> SHARED|STATIC): one of the two libraries, from the objects that
# the modules have compiled. Only one of the two is imported by a program, as Tactus::<name>.
function(tactus_component_library name kind)
    string(TOLOWER ${kind} suffix)
    set(library tactus_${name}_${suffix})
    set(file_name tactus_${name})
    if(name STREQUAL tactus) # The one that brings all others.
        set(file_name tactus)
    endif()
    list(TRANSFORM ARG_MODULES REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE objects)
    add_library(${library} ${kind} ${objects})
    set_target_properties(${library} PROPERTIES
        LINKER_LANGUAGE CXX OUTPUT_NAME ${file_name} EXPORT_NAME ${name}
        VERSION ${PROJECT_VERSION} SOVERSION ${TACTUS_SOVERSION})
    target_compile_features(${library} INTERFACE cxx_std_20)
    target_compile_options(${library} INTERFACE ${numerics_options})
    target_compile_definitions(${library} INTERFACE ${numerics_definitions})
    target_include_directories(${library} INTERFACE $<INSTALL_INTERFACE:${TACTUS_HEADER_DIR}>)
    list(TRANSFORM ARG_NEEDS REPLACE "(.+)" "tactus_\\1_${suffix}" OUTPUT_VARIABLE needs)
    target_link_libraries(${library} PUBLIC ${needs} ${ARG_LINK})
    if(kind STREQUAL STATIC)
        target_link_libraries(${library} PRIVATE ${ARG_LINK_PRIVATE})
    else()
        # Linked here, so that a program needs none of their development files.
        target_link_libraries(${library} PRIVATE $<BUILD_INTERFACE:${ARG_LINK_PRIVATE}>)
        # Calls within the library are its own: no detour, and nobody's function in their place.
        target_link_options(${library} PRIVATE LINKER:-Bsymbolic-functions LINKER:-z,now
            LINKER:--version-script=${PROJECT_SOURCE_DIR}/cmake/exported_symbols.map)
        # They find one another wherever they are moved to, together.
        set_target_properties(${library} PROPERTIES INSTALL_RPATH "$ORIGIN"
            LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/exported_symbols.map)
    endif()
    install(TARGETS ${library} EXPORT ${library}
        LIBRARY COMPONENT libtactus0 NAMELINK_COMPONENT libtactus-dev
        ARCHIVE COMPONENT libtactus-dev)
    install(EXPORT ${library} NAMESPACE Tactus:: FILE Tactus-${name}-${suffix}.cmake
        DESTINATION ${TACTUS_PACKAGE_DIR} COMPONENT libtactus-dev)
endfunction()

# tactus_component(<name> MODULES <library>... PUBLIC <header>... [NEEDS <component>...]
#     [LINK <library>...] [LINK_PRIVATE <library>...]
#     [PC_REQUIRES <module>...] [PC_REQUIRES_PRIVATE <module>...] [PC_LIBS_PRIVATE <flag>...])
# LINK are libraries whose headers ours include. The PC_ ones say the same for pkg-config.
function(tactus_component name)
    cmake_parse_arguments(ARG "" "" "MODULES;PUBLIC;NEEDS;LINK;LINK_PRIVATE;PC_REQUIRES;\
PC_REQUIRES_PRIVATE;PC_LIBS_PRIVATE" ${ARGN})
    foreach(header ${ARG_PUBLIC})
        if(NOT EXISTS ${PROJECT_SOURCE_DIR}/${header})
            message(FATAL_ERROR "component ${name}: there is no header ${header}")
        endif()
    endforeach()
    set(TACTUS_PUBLIC_HEADERS_${name} ${ARG_PUBLIC} PARENT_SCOPE)
    tactus_component_library(${name} SHARED)
    tactus_component_library(${name} STATIC)

    # Of all components so far, since a header may include those of another one.
    set(public ${ARG_PUBLIC})
    foreach(needed ${ARG_NEEDS})
        list(APPEND public ${TACTUS_PUBLIC_HEADERS_${needed}})
    endforeach()
    install(CODE "
        set(source \"${PROJECT_SOURCE_DIR}\")
        set(own_headers \"${ARG_PUBLIC}\")
        set(public_headers \"${public}\")
        set(destination
            \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${TACTUS_HEADER_DIR}/tactus\")
        include(\"${PROJECT_SOURCE_DIR}/cmake/install_headers.cmake\")"
        COMPONENT libtactus-dev)

    list(TRANSFORM ARG_NEEDS PREPEND tactus- OUTPUT_VARIABLE requires)
    list(JOIN ARG_PC_REQUIRES " " TACTUS_PC_REQUIRES)
    list(JOIN requires " " requires)
    string(STRIP "${requires} ${TACTUS_PC_REQUIRES}" TACTUS_PC_REQUIRES)
    list(JOIN ARG_PC_REQUIRES_PRIVATE " " TACTUS_PC_REQUIRES_PRIVATE)
    list(JOIN ARG_PC_LIBS_PRIVATE " " TACTUS_PC_LIBS_PRIVATE)
    set(TACTUS_PC_MODULE tactus-${name})
    set(TACTUS_PC_LIBRARY tactus_${name})
    if(name STREQUAL tactus)
        set(TACTUS_PC_MODULE tactus)
        set(TACTUS_PC_LIBRARY tactus)
    endif()
    file(RELATIVE_PATH TACTUS_PC_PREFIX
        ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
    configure_file(${PROJECT_SOURCE_DIR}/cmake/tactus.pc.in
        ${CMAKE_BINARY_DIR}/installed/${TACTUS_PC_MODULE}.pc @ONLY)
    install(FILES ${CMAKE_BINARY_DIR}/installed/${TACTUS_PC_MODULE}.pc
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT libtactus-dev)
endfunction()

# The frame, what goes in and comes out, and what every other component uses.
tactus_component(core
    MODULES tactus_rt_core tactus_base
    LINK Eigen3::Eigen
    LINK_PRIVATE ccd
    PC_REQUIRES eigen3
    PC_REQUIRES_PRIVATE ccd
    PUBLIC
        rt_core/base/arena.hpp
        rt_core/base/assert.hpp
        rt_core/base/model_id.hpp
        rt_core/base/realtime.hpp
        rt_core/base/result.hpp
        rt_core/force/force_pipeline.hpp
        rt_core/force/external_force.hpp
        rt_core/frame/frame.hpp
        rt_core/frame/frame_setup.hpp
        rt_core/frame/model.hpp
        rt_core/frame/model_capacities.hpp
        rt_core/geometry/object_speed_limit.hpp
        rt_core/geometry/convex.hpp
        rt_core/geometry/shapes.hpp
        rt_core/geometry/tool_core.hpp
        rt_core/kernels/kernels.hpp
        rt_core/limits.hpp
        rt_core/math/aabb.hpp
        rt_core/math/rotation.hpp
        rt_core/math/similarity.hpp
        rt_core/math/vec3.hpp
        rt_core/records/contact.hpp
        rt_core/records/device_limits.hpp
        rt_core/records/device_record.hpp
        rt_core/records/frame_input.hpp
        rt_core/records/frame_output.hpp
        rt_core/records/local_surface.hpp
        rt_core/records/material.hpp
        rt_core/records/mesh_report.hpp
        rt_core/records/object_pose.hpp
        rt_core/records/prediction.hpp
        rt_core/records/safety.hpp
        rt_core/records/scene_change.hpp
        rt_core/records/tool_force.hpp
        rt_core/records/tool_load.hpp
        rt_core/records/tool_period.hpp
        rt_core/records/work_counters.hpp
        rt_core/spm/base_mesh.hpp
        rt_core/spm/error_code.hpp
        rt_core/spm/header.hpp
        rt_core/spm/ids.hpp
        transport/base/print_assertions.hpp
        transport/base/refusal.hpp)
if(TACTUS_ONLY_CORE)
    return()
endif()

tactus_component(transport
    NEEDS core
    MODULES tactus_content_hash tactus_transport tactus_store tactus_topic_types tactus_dds
    LINK_PRIVATE sodium fmt::fmt CycloneDDS::ddsc crypto
    PC_REQUIRES_PRIVATE libsodium fmt CycloneDDS libcrypto
    PUBLIC
        transport/chunk_link.hpp
        transport/content_hash.hpp
        transport/chunk_loader.hpp
        transport/dds/dds_client.hpp
        transport/dds/dds_server.hpp
        transport/dds/object_publisher.hpp
        transport/dds/scene_reader.hpp
        transport/dds/telemetry.hpp
        transport/inside_test.hpp
        transport/log.hpp
        transport/model_identity.hpp
        transport/model_name.hpp
        transport/pose.hpp
        transport/served_model.hpp
        transport/shown_object.hpp
        transport/slot_bank.hpp
        transport/store/model_store.hpp
        transport/store/static_model.hpp
        transport/store/store_link.hpp
        transport/telemetry.hpp)

tactus_component(platform
    NEEDS core
    MODULES tactus_platform tactus_recording
    LINK_PRIVATE Threads::Threads ${CMAKE_DL_LIBS}
    PC_LIBS_PRIVATE -pthread
    PUBLIC
        platform/devices/device_frame.hpp
        platform/devices/device_guard.hpp
        platform/devices/dhd/dhd_device.hpp
        platform/devices/haptic_device.hpp
        platform/devices/plugin/device_plugin.hpp
        platform/devices/simulated/operator_motion.hpp
        platform/devices/simulated/scripted_operator.hpp
        platform/devices/simulated/simulated_device.hpp
        platform/devices/udp/udp_device.hpp
        platform/devices/wrapped_device.hpp
        platform/machine/clock.hpp
        platform/machine/float_control.hpp
        platform/machine/heartbeat.hpp
        platform/machine/latency_histogram.hpp
        platform/machine/periodic_timer.hpp
        platform/machine/pool_memory.hpp
        platform/machine/posix/memory_lock.hpp
        platform/machine/posix/posix_clock.hpp
        platform/machine/posix/posix_periodic_timer.hpp
        platform/machine/posix/service_notify.hpp
        platform/machine/rt_thread.hpp
        platform/machine/time.hpp
        platform/recording/frame_tap.hpp
        platform/recording/recording.hpp
        platform/recording/recording_writer.hpp
        platform/recording/replay.hpp)

tactus_component(host
    NEEDS core transport
    MODULES tactus_mesh tactus_shapes tactus_simplify tactus_encode
    LINK_PRIVATE fmt::fmt Threads::Threads
    PC_REQUIRES_PRIVATE fmt
    PC_LIBS_PRIVATE -pthread
    PUBLIC
        host_tools/encode/decoded_model.hpp
        host_tools/encode/extract.hpp
        host_tools/encode/write_spm.hpp
        host_tools/encode/zone.hpp
        host_tools/mesh/prepare.hpp
        host_tools/mesh/quantised_mesh.hpp
        host_tools/mesh/read_mesh.hpp
        host_tools/mesh/triangle_mesh.hpp
        host_tools/mesh/write_mesh.hpp
        host_tools/shapes/shapes.hpp
        host_tools/simplify/simplify.hpp)

tactus_component(c NEEDS core transport MODULES tactus_c LINK_PRIVATE fmt::fmt
    PC_REQUIRES_PRIVATE fmt PC_LIBS_PRIVATE -lstdc++)
# It includes nothing of ours, and has one name in every language.
install(FILES ${PROJECT_SOURCE_DIR}/host_tools/c/tactus.h
    DESTINATION ${TACTUS_HEADER_DIR}/tactus COMPONENT libtactus-dev)

# The public class World, and with it the loop of hrtc. It brings all other components.
tactus_component(tactus
    NEEDS core transport platform host c
    MODULES tactus_loop tactus_choices tactus_scene_keeper tactus_controller tactus_readers
        tactus_scene tactus_build tactus_edit tactus_world tactus_c_world
        tactus_no_allocation_counter
    LINK_PRIVATE fmt::fmt CycloneDDS::ddsc Threads::Threads
    PC_REQUIRES_PRIVATE fmt CycloneDDS
    PC_LIBS_PRIVATE -pthread
    PUBLIC
        platform/loop/hand_state.hpp
        platform/world/world.hpp
        platform/world/world_options.hpp
        platform/world/world_parts.hpp)
install(FILES ${CMAKE_BINARY_DIR}/installed/world.hpp
    DESTINATION ${TACTUS_HEADER_DIR}/tactus COMPONENT libtactus-dev)
