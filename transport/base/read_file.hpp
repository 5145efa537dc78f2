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

/// Bytes of a regular file that has 1 to `most` of them. The refusal gives the fault without the
/// file's name. The size is checked first, so a file that is too large is not read.
[[nodiscard]] Result<std::string, Refusal>
read_file(const std::filesystem::path& path,
          std::uintmax_t most = std::numeric_limits<std::uintmax_t>::max());

} // namespace tactus
