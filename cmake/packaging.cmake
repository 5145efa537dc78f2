# SPDX-License-Identifier: Apache-2.0
# Debian packages by cpack, one for each component of what is installed (docs/install.md):
#
#     cmake --workflow --preset deb
#
# Texts, scripts and files that only Debian has are in cmake/debian, each beginning with the name of
# its package; cmake/debian/stage.cmake lays them out.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME ${PROJECT_NAME})
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_VENDOR "Tactus")
# Whoever hands packages on gives a name of their own.
set(TACTUS_MAINTAINER "Tactus authors <tactus@example.org>" CACHE STRING
    "Maintainer that the Debian packages name")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${TACTUS_MAINTAINER}")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # Each package has its own.
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL)
# Known to the scripts that cpack runs because their names begin with CPACK_.
set(CPACK_TACTUS_SOURCE ${PROJECT_SOURCE_DIR})
set(CPACK_TACTUS_PREFIX ${CMAKE_INSTALL_PREFIX})
set(CPACK_TACTUS_STRIP ${CMAKE_STRIP})
set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_SOURCE_DIR}/cmake/debian/check.cmake)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian/stage.cmake)

# tactus_package(<name> SECTION <section> [ARCHITECTURE all] [DEPENDS <package>...]
#     [RECOMMENDS <package>...] [SUGGESTS <package>...] [SERVICES <unit>...]
#     DESCRIPTION <first line and paragraphs>)
# dpkg-shlibdeps adds the packages of linked libraries to the dependencies. With SERVICES the
# maintainer scripts' @on_configure@, @on_remove@ and @after_removal@ are those of the units.
macro(tactus_package name)
    cmake_parse_arguments(ARG "" "SECTION;ARCHITECTURE;DESCRIPTION"
        "DEPENDS;RECOMMENDS;SUGGESTS;SERVICES" ${ARGN})
    string(TOUPPER ${name} upper)
    list(APPEND CPACK_COMPONENTS_ALL ${name})
    set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
    set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${ARG_SECTION})
    set(CPACK_DEBIAN_${upper}_DESCRIPTION "${ARG_DESCRIPTION}")
    list(JOIN ARG_DEPENDS ", " CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS)
    list(JOIN ARG_RECOMMENDS ", " CPACK_DEBIAN_${upper}_PACKAGE_RECOMMENDS)
    list(JOIN ARG_SUGGESTS ", " CPACK_DEBIAN_${upper}_PACKAGE_SUGGESTS)
    if(ARG_ARCHITECTURE)
        set(CPACK_DEBIAN_${upper}_PACKAGE_ARCHITECTURE ${ARG_ARCHITECTURE})
        set(CPACK_DEBIAN_${upper}_PACKAGE_SHLIBDEPS OFF)
    endif()
    foreach(moment on_configure on_remove after_removal)
        set(${moment})
        foreach(service ${ARG_SERVICES})
            file(READ ${PROJECT_SOURCE_DIR}/cmake/debian/service.${moment} script)
            string(CONFIGURE "${script}" script @ONLY)
            string(APPEND ${moment} "${script}")
        endforeach()
        string(STRIP "${${moment}}" ${moment})
    endforeach()
    set(CPACK_DEBIAN_${upper}_PACKAGE_CONTROL_EXTRA)
    foreach(file conffiles postinst postrm prerm shlibs triggers)
        if(EXISTS ${PROJECT_SOURCE_DIR}/cmake/debian/${name}.${file})
            configure_file(${PROJECT_SOURCE_DIR}/cmake/debian/${name}.${file}
                ${CMAKE_BINARY_DIR}/debian/${name}/${file} @ONLY)
            list(APPEND CPACK_DEBIAN_${upper}_PACKAGE_CONTROL_EXTRA
                ${CMAKE_BINARY_DIR}/debian/${name}/${file})
        endif()
    endforeach()
endmacro()

# A program fits the minor version that it was compiled with (docs/library.md).
math(EXPR next_minor "${PROJECT_VERSION_MINOR} + 1")
set(next_version ${PROJECT_VERSION_MAJOR}.${next_minor})
set(shlibs_text)
foreach(component core transport platform host c)
    string(APPEND shlibs_text "libtactus_${component} ${TACTUS_SOVERSION} libtactus0 \
(>= ${PROJECT_VERSION}), libtactus0 (<< ${next_version}~)\n")
endforeach()
string(APPEND shlibs_text "libtactus ${TACTUS_SOVERSION} libtactus0 \
(>= ${PROJECT_VERSION}), libtactus0 (<< ${next_version}~)\n")
string(STRIP "${shlibs_text}" shlibs_text)
tactus_package(libtactus0
    SECTION libs
    SUGGESTS tactus-doc
    DESCRIPTION "haptic touch of huge triangle meshes - shared libraries
Tactus lets a hand feel triangle meshes that are larger than the memory of
the machine that computes the force. A controller with a few MiB refines the
mesh where the tool is, 1000 times a second. Every answer is exact, or it is
a bracket that is proven to hold the distance.
.
These are the shared libraries: frame, transport over files and DDS, real-time
platform, encoder and the interface for C.")
tactus_package(libtactus-dev
    SECTION libdevel
    DEPENDS "libtactus0 (= ${PROJECT_VERSION})" "libeigen3-dev (>= 3.4)" libccd-dev
        libfmt-dev libsodium-dev libssl-dev cyclonedds-dev
    SUGGESTS tactus-doc
    DESCRIPTION "haptic touch of huge triangle meshes - development files
Tactus lets a hand feel triangle meshes that are larger than the memory of
the machine that computes the force.
.
These are the headers, static libraries, the package for CMake's find_package
and the files of pkg-config.")
tactus_package(tactus-host
    SECTION science
    SERVICES spm_publish.service spm_view.service
    DEPENDS libjs-three libjs-dygraphs
    SUGGESTS tactus-doc tactus-controller
    DESCRIPTION "haptic touch of huge triangle meshes - programs of the host
Tactus lets a hand feel triangle meshes that are larger than the memory of
the machine that computes the force.
.
spm_build turns meshes into models, spm_inspect checks and shows them,
spm_publish serves them to controllers over DDS, spm_view shows in a browser
what controllers touch, both as services if wanted; tactus-keys makes the keys
of DDS Security. tactus is one name for these programs and the controller.
The services are not enabled:
/etc/default/spm_publish first says what to serve.")
tactus_package(tactus-controller
    SECTION science
    SERVICES hrtc.service
    DEPENDS adduser
    RECOMMENDS libjs-dygraphs
    SUGGESTS tactus-doc tactus-host
    DESCRIPTION "haptic touch of huge triangle meshes - real-time controller
Tactus lets a hand feel triangle meshes that are larger than the memory of
the machine that computes the force.
.
hrtc reads a device, refines the models where its tool is and answers with a
force, 1000 times a second. Its service is not enabled: /etc/tactus/hrtc.toml
first says what to touch. The group haptics may take real-time priority
and lock memory.")
tactus_package(tactus-doc
    SECTION doc
    ARCHITECTURE all
    DESCRIPTION "haptic touch of huge triangle meshes - documentation
Tactus lets a hand feel triangle meshes that are larger than the memory of
the machine that computes the force.
.
These are its pages: installing, library, Python, protocol, formats, safety,
and an example of the controller's options.")
if(TARGET tactus_python)
    find_package(Python3 COMPONENTS Interpreter QUIET)
    math(EXPR next_python "${Python3_VERSION_MINOR} + 1")
    tactus_package(python3-tactus
        SECTION python
        DEPENDS "python3 (>= 3.${Python3_VERSION_MINOR}~)" "python3 (<< 3.${next_python})"
            python3-numpy
        SUGGESTS tactus-doc tactus-host
        DESCRIPTION "haptic touch of huge triangle meshes - Python module
Tactus lets a hand feel triangle meshes that are larger than the memory of
the machine that computes the force.
.
The module tactus answers with distances and forces of many poses in one
call, with arrays of NumPy in and out, for research and tests.")
endif()
include(CPack)
