// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/build/build_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>

namespace tactus
{

namespace
{

constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t kMib = std::uint64_t{1} << 20U;

/// Upper estimate of the memory for a face. Measured on shapes and scans of 13 k to 400 k faces
/// with 2 and 16 threads: 310 to 440 bytes, besides kBaseMib.
constexpr std::uint64_t kBytesPerFace = 480;
constexpr std::uint64_t kBaseMib = 16;

/// The number at the start of a file; kUnknown without one, such as "max" for a group without a
/// limit.
std::uint64_t number_in(const std::filesystem::path& path)
{
    std::ifstream file(path);
    std::uint64_t bytes = 0;
    return file >> bytes ? bytes : kUnknown;
}

std::uint64_t available_of_machine(const std::filesystem::path& root)
{
    std::ifstream file(root / "proc/meminfo");
    for (std::string key; file >> key;)
    {
        std::uint64_t kib = 0;
        if (key == "MemAvailable:" && file >> kib)
        {
            return kib * 1'024;
        }
        file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    }
    return kUnknown;
}

/// Remaining memory of the control group (version 2), seen from within.
std::uint64_t left_of_group(const std::filesystem::path& root)
{
    const std::filesystem::path group = root / "sys/fs/cgroup";
    const std::uint64_t most = number_in(group / "memory.max");
    const std::uint64_t used = number_in(group / "memory.current");
    return most == kUnknown || used == kUnknown ? kUnknown : most - std::min(used, most);
}

} // namespace

std::uint64_t needed_mib(std::size_t faces)
{
    return kBaseMib + (std::uint64_t{faces} * kBytesPerFace + kMib - 1) / kMib;
}

std::optional<std::uint64_t> available_mib(const std::filesystem::path& root)
{
    const std::uint64_t bytes = std::min(available_of_machine(root), left_of_group(root));
    return bytes == kUnknown ? std::nullopt : std::optional(bytes / kMib);
}

std::optional<Refusal> check_memory(const std::string& what, std::uint64_t needed,
                                    std::optional<std::uint32_t> allowed_mib)
{
    if (allowed_mib)
    {
        return needed <= *allowed_mib
                   ? std::nullopt
                   : std::optional(Refusal{fmt::format("{} needs {} MiB; --memory-mib allows {}",
                                                       what, needed, *allowed_mib)});
    }
    const auto available = available_mib();
    return !available || needed <= *available
               ? std::nullopt
               : std::optional(Refusal{fmt::format("{} needs {} MiB, but {} are available; set "
                                                   "--memory-mib {} to build with swapping",
                                                   what, needed, *available, needed)});
}

} // namespace tactus
