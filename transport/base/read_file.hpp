// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

namespace tactus
{

/// Content of a regular file of 1 to `most` bytes. The refusal gives the fault without the path.
/// The size is checked first, so a file that is too large is not read.
[[nodiscard]] Result<std::string, Refusal>
read_file(const std::filesystem::path& path,
          std::uintmax_t most = std::numeric_limits<std::uintmax_t>::max());

} // namespace tactus
