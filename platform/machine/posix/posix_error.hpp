// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <string>

namespace tactus::posix
{

/// Symbol of an errno value ("EPERM"), or "errno 123" for values outside the implementation's list.
[[nodiscard]] std::string name_of_error(int error);

/// Login name of the effective user, or "uid 1000" if it has none.
[[nodiscard]] std::string user_name();

} // namespace tactus::posix
