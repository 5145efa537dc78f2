# SPDX-License-Identifier: Apache-2.0
# Run by cpack before anything else: what a package could not be made of is refused in one line.
if(NOT CPACK_GENERATOR STREQUAL "DEB")
    message(FATAL_ERROR "cpack -G ${CPACK_GENERATOR}: there are only Debian packages, -G DEB")
endif()
if(NOT CPACK_TACTUS_PREFIX STREQUAL "/usr")
    message(FATAL_ERROR "this build is for ${CPACK_TACTUS_PREFIX}, Debian packages are for /usr: \
run cmake --workflow --preset deb, or configure with -DCMAKE_INSTALL_PREFIX=/usr")
endif()
# Without it cpack goes on and makes packages that depend on nothing.
find_program(TACTUS_SHLIBDEPS dpkg-shlibdeps)
if(NOT TACTUS_SHLIBDEPS)
    message(FATAL_ERROR "dpkg-shlibdeps is missing, which finds what packages depend on: install \
the package dpkg-dev")
endif()
