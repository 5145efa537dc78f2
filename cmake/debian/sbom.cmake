# SPDX-License-Identifier: Apache-2.0
# Run by cpack when the packages are made: writes their bill of materials beside them.
cmake_policy(VERSION 3.25)
execute_process(
    COMMAND ${CPACK_TACTUS_PYTHON} -B ${CPACK_TACTUS_SOURCE}/cmake/debian/sbom.py
        ${CPACK_TACTUS_SOURCE} ${CPACK_PACKAGE_DIRECTORY}/tactus_${CPACK_PACKAGE_VERSION}.spdx.json
        ${CPACK_PACKAGE_FILES}
    COMMAND_ERROR_IS_FATAL ANY)
