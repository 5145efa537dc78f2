# SPDX-License-Identifier: Apache-2.0
# Run by `cmake --install` for one component: writes its public headers to `destination`, and those
# that they include to `destination`/detail, with the names that they have there.
#
# source          the checkout
# own_headers     public headers of the component, relative to it
# public_headers  those, and the ones of the components that it needs
# destination     the folder that programs include as <tactus/...>
cmake_policy(VERSION 3.25)
set(waiting ${own_headers})
set(written)
while(waiting)
    list(POP_FRONT waiting header)
    list(APPEND written ${header})
    # Semicolons and brackets of C++ are nothing special in one string.
    file(READ ${source}/${header} text)
    string(REGEX MATCHALL "\n#include \"[^\"\n]+\"" includes "${text}")
    foreach(include ${includes})
        string(REGEX REPLACE "^\n#include \"(.+)\"$" "\\1" name "${include}")
        if(NOT EXISTS ${source}/${name})
            message(FATAL_ERROR "${header} includes \"${name}\", which is no header of the project")
        endif()
        set(new_name tactus/detail/${name})
        if(name IN_LIST public_headers)
            set(new_name tactus/${name})
        elseif(NOT name IN_LIST written AND NOT name IN_LIST waiting)
            list(APPEND waiting ${name})
        endif()
        string(REPLACE "${include}" "\n#include <${new_name}>" text "${text}")
    endforeach()
    set(file ${destination}/detail/${header})
    if(header IN_LIST public_headers)
        set(file ${destination}/${header})
    endif()
    set(old)
    if(EXISTS ${file})
        file(READ ${file} old)
    endif()
    if(NOT "${old}" STREQUAL "${text}")
        file(WRITE ${file} "${text}")
        # As install(FILES) does, whatever the umask is.
        file(CHMOD ${file} PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
        message(STATUS "Installing: ${file}")
    endif()
    list(APPEND CMAKE_INSTALL_MANIFEST_FILES ${file})
endwhile()
