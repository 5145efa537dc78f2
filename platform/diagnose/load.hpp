// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::hrtc
{

/// Work that keeps a machine busy beside the loop.
enum class LoadKind : std::uint8_t
{
    cpu,    ///< Arithmetic, on every processor.
    memory, ///< Writes all over 64 MiB and maps memory anew, on every processor.
    disk,   ///< Writes, syncs and reads back a file of 16 MiB in the folder for temporary files.
};
/// In the order of LoadKind.
inline constexpr std::array<const char*, 3> kLoadNames{"cpu", "memory", "disk"};

[[nodiscard]] std::optional<LoadKind> parse_load(std::string_view name) noexcept;

/// Does this work on the calling thread until `goes_on`, asked every few milliseconds, says no.
/// Returns why it had to stop before, if it had to.
[[nodiscard]] std::optional<std::string> work(LoadKind kind, bool (*goes_on)());

/// Other processes of ordinary priority that do such work as long as this lives. Processes and not
/// threads, so that what they do to their memory does nothing to the loop's; they end by themselves
/// when this process does.
class Load
{
public:
    /// Starts them: `program` with the arguments `load` and the kind's name. Returns which one
    /// could not be started.
    [[nodiscard]] static Result<Load, std::string> start(std::span<const LoadKind> kinds,
                                                         const std::string& program);

    Load(Load&& other) noexcept;
    Load& operator=(Load&&) = delete;
    Load(const Load&) = delete;
    Load& operator=(const Load&) = delete;
    ~Load();

    /// The first kind of work that has ended by itself, if one has.
    [[nodiscard]] std::optional<LoadKind> ended();

private:
    struct Worker
    {
        LoadKind kind;
        int process;
    };

    Load() = default;
    [[nodiscard]] std::optional<std::string> start_one(LoadKind kind, const std::string& program);

    std::vector<Worker> workers_;
    int lifeline_{-1}; ///< They live as long as its other end is open.
    int their_end_{-1};
};

/// `hrtc load KIND...`: does the work on this machine until its standard input ends.
int run_load(int argc, char** argv);

} // namespace tactus::hrtc
