// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/atomic_file.hpp"
#include "transport/base/refusal.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace tactus::hrtc
{

/// Path of the histogram file for the times called `name`: FOLDER/NAME.hgrm.
[[nodiscard]] inline std::string histogram_path(const std::string& folder, const char* name)
{
    return (std::filesystem::path(folder) / (std::string(name) + ".hgrm")).string();
}

/// Reason why histograms can't be written to the folder; none if they can. For a check before a
/// long run; leaves no file behind.
[[nodiscard]] inline std::optional<Refusal> probe_histograms(const std::string& folder)
{
    return AtomicFile::probe(histogram_path(folder, "frame"));
}

} // namespace tactus::hrtc
