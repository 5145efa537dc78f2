// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <string>

namespace tactus::posix
{

/// The symbol of an errno value ("EPERM"), or "errno 123" for those that set-up does not meet.
[[nodiscard]] std::string name_of_error(int error);

/// The login name of the effective user, or "uid 1000" when it has none.
[[nodiscard]] std::string user_name();

} // namespace tactus::posix
