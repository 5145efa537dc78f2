// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace tactus
{

/// Peak memory, rounded up, from a mesh with this number of faces until its model is written.
[[nodiscard]] std::uint64_t needed_mib(std::size_t faces);

/// Memory that this program can use without swapping, limited by the machine and its control group;
/// none if unknown. `root` replaces / in tests.
[[nodiscard]] std::optional<std::uint64_t> available_mib(const std::filesystem::path& root = "/");

/// Refuses a need above `allowed_mib`, or above the machine's available memory if that is not set,
/// and states the least sufficient value. `what` names the mesh or file in the refusal.
[[nodiscard]] std::optional<Refusal> check_memory(const std::string& what, std::uint64_t needed,
                                                  std::optional<std::uint32_t> allowed_mib);

} // namespace tactus
