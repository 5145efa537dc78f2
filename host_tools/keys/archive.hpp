// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <ctime>
#include <string>
#include <vector>

namespace tactus::keys
{

/// One file of an archive.
struct ArchivedFile
{
    std::string name; ///< Name within the folder, with it at most 99 bytes.
    std::string bytes;
    bool is_secret{false}; ///< Mode 0600, else 0644.
};

/// A tar archive (ustar) of one folder with these files, all of the user root.
[[nodiscard]] std::string archive(const std::string& folder, const std::vector<ArchivedFile>& files,
                                  std::time_t time);

} // namespace tactus::keys
