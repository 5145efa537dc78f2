// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"

#include <optional>
#include <string>

namespace tactus::hrtc
{

/// Path of the file for the times `name` of a run in its folder of histograms.
[[nodiscard]] std::string histogram_path(const std::string& folder, const char* name);

/// Reason why the folder can't take the files, for a check before a long run. Leaves no file
/// behind.
[[nodiscard]] std::optional<Refusal> probe_histograms(const std::string& folder);

} // namespace tactus::hrtc
