// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"

#include <optional>
#include <string>

namespace tactus::hrtc
{

/// Path of the histogram file for the times called `name`: FOLDER/NAME.hgrm.
[[nodiscard]] std::string histogram_path(const std::string& folder, const char* name);

/// Reason why histograms can't be written to the folder; none if they can. For a check before a
/// long run; leaves no file behind.
[[nodiscard]] std::optional<Refusal> probe_histograms(const std::string& folder);

} // namespace tactus::hrtc
