// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <string>

namespace tactus
{

/// Decides a program's exit code: a wrong option is usage, the other two are failures at run time.
enum class PlatformErrorKind
{
    bad_option,    ///< The caller asked for something outside the stated range.
    not_permitted, ///< The machine could, but this process may not.
    system         ///< The operating system failed for another reason.
};

/// Why set-up was refused: complete lines, ready for a person to read, separated by newlines.
struct PlatformError
{
    PlatformErrorKind kind{PlatformErrorKind::system};
    std::string message;
};

} // namespace tactus
