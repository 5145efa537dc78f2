# SPDX-License-Identifier: Apache-2.0
# Run by cpack when each component lies in a folder of its own, before the packages are made: what
# Debian's policy asks for besides.
cmake_policy(VERSION 3.25)
set(debian ${CPACK_TACTUS_SOURCE}/cmake/debian)
set(folder_mode OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(file_mode OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)

function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# put(<file> <name in the package>): does nothing where the package has no such file.
function(put file name)
    if(EXISTS ${file})
        get_filename_component(folder ${root}/${name} DIRECTORY)
        file(MAKE_DIRECTORY ${folder})
        configure_file(${file} ${root}/${name} COPYONLY)
    endif()
endfunction()

file(STRINGS ${debian}/changelog newest LIMIT_COUNT 1)
if(NOT newest MATCHES "^tactus \\(([^)]+)\\)" OR NOT CMAKE_MATCH_1 STREQUAL CPACK_PACKAGE_VERSION)
    message(FATAL_ERROR "cmake/debian/changelog begins with '${newest}', the project's version is \
${CPACK_PACKAGE_VERSION}")
endif()

foreach(package ${CPACK_COMPONENTS_ALL})
    set(root ${CPACK_TEMPORARY_DIRECTORY}/${package})
    put(${debian}/changelog usr/share/doc/${package}/changelog)
    put(${debian}/copyright usr/share/doc/${package}/copyright)
    put(${debian}/${package}.lintian-overrides usr/share/lintian/overrides/${package})
    put(${debian}/${package}.limits etc/security/limits.d/tactus.conf)
    put(${debian}/${package}.sysctl usr/lib/sysctl.d/61-tactus.conf)
    if(package STREQUAL tactus-controller)
        put(${CPACK_TACTUS_SOURCE}/platform/hrtc/deploy/hrtc.toml etc/tactus/hrtc.toml)
    elseif(package STREQUAL tactus-host)
        foreach(service spm_publish spm_view)
            put(${debian}/${service}.default etc/default/${service})
        endforeach()
        file(MAKE_DIRECTORY ${root}/var/lib/tactus) # Where models are looked for.
    endif()

    file(GLOB_RECURSE texts ${root}/usr/share/man/* ${root}/usr/share/doc/${package}/changelog)
    foreach(text ${texts})
        run(gzip -9nf ${text})
    endforeach()
    # What cpack strips are programs and shared libraries.
    file(GLOB_RECURSE archives ${root}/usr/lib/*.a)
    foreach(archive ${archives})
        run(${CPACK_TACTUS_STRIP} --strip-debug --enable-deterministic-archives
            --remove-section=.comment --remove-section=.note ${archive})
    endforeach()
    # Whatever the umask of whoever calls cpack is.
    file(GLOB_RECURSE entries LIST_DIRECTORIES true ${root}/*)
    foreach(entry ${entries})
        file(RELATIVE_PATH name ${root} ${entry})
        if(IS_DIRECTORY ${entry})
            file(CHMOD ${entry} PERMISSIONS ${folder_mode})
        elseif(name MATCHES "^(etc|usr/share|usr/lib/sysctl.d|usr/lib/systemd)/")
            file(CHMOD ${entry} PERMISSIONS ${file_mode})
        endif()
    endforeach()
endforeach()
