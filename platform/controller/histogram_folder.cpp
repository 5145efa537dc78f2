// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/histogram_folder.hpp"

#include "transport/base/atomic_file.hpp"

#include <filesystem>

namespace tactus::hrtc
{

std::string histogram_path(const std::string& folder, const char* name)
{
    return (std::filesystem::path(folder) / (std::string(name) + ".hgrm")).string();
}

std::optional<Refusal> probe_histograms(const std::string& folder)
{
    return AtomicFile::probe(histogram_path(folder, "frame"));
}

} // namespace tactus::hrtc
