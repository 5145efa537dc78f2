// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/program.hpp"
#include "tests/bench/relayed_networks.hpp"
#include "tests/bench/scenes.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tactus::bench
{

inline constexpr std::chrono::seconds kStartTimeout{60};

/// DDS domain of this process and its programs, very likely unused by others on this machine.
[[nodiscard]] std::uint32_t dds_domain();

/// Starts one of our programs at an end, in our DDS domain. Its output goes to a file with its name
/// in the folder.
[[nodiscard]] Program start_at(const NetworkEnd& end, const std::string& name,
                               const std::filesystem::path& folder,
                               const std::vector<std::string>& arguments);

/// Starts spm_publish with this scene as "model" and waits until it is ready.
[[nodiscard]] Program publish(const Scene& scene, const NetworkEnd& end,
                              const std::filesystem::path& folder);

} // namespace tactus::bench
