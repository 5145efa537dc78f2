// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"

#include <optional>
#include <string>

namespace tactus::hrtc
{

/// The file of one of a run's times in its folder of histograms.
[[nodiscard]] std::string histogram_path(const std::string& folder, const char* name);

/// Why the folder can't take the files; before a long run. Leaves nothing behind.
[[nodiscard]] std::optional<Refusal> probe_histograms(const std::string& folder);

} // namespace tactus::hrtc
