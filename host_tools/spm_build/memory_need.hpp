// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace tactus::spm_build
{

/// At the peak, rounded up: what a mesh of so many faces takes in memory until its model is
/// written.
[[nodiscard]] std::uint64_t needed_mib(std::size_t faces);

/// What this program can take without swapping, of the machine and of the group that it runs in;
/// none where that can't be told. `root` stands for / in tests.
[[nodiscard]] std::optional<std::uint64_t> available_mib(const std::filesystem::path& root = "/");

/// Refuses what needs more than `allowed_mib`, or than the machine has where that is not said, with
/// the least that works. `what` names it.
[[nodiscard]] std::optional<Refusal> check_memory(const std::string& what, std::uint64_t needed,
                                                  std::optional<std::uint32_t> allowed_mib);

} // namespace tactus::spm_build
