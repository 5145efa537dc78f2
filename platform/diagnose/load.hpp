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

/// Kind of work that keeps a machine busy beside the loop.
enum class LoadKind : std::uint8_t
{
    cpu,    ///< Arithmetic on every processor.
    memory, ///< Writes across 64 MiB and maps new memory, on every processor.
    disk,   ///< Writes, syncs and reads back a file of 16 MiB in the folder for temporary files.
};
/// Names in the order of LoadKind.
inline constexpr std::array<const char*, 3> kLoadNames{"cpu", "memory", "disk"};

[[nodiscard]] std::optional<LoadKind> parse_load(std::string_view name) noexcept;

/// Does work of this kind on the calling thread until `goes_on`, called every few milliseconds,
/// returns false. Returns the reason if the work had to stop earlier.
[[nodiscard]] std::optional<std::string> work(LoadKind kind, bool (*goes_on)());

/// Processes of ordinary priority that do work of the given kinds during this object's life.
/// Threads would share the loop's memory, and their mappings would disturb it. The processes end by
/// themselves when this process does.
class Load
{
public:
    /// Starts `program` with the arguments `load` and the kind's name. Returns the error of the
    /// first process that can't be started.
    [[nodiscard]] static Result<Load, std::string> start(std::span<const LoadKind> kinds,
                                                         const std::string& program);

    Load(Load&& other) noexcept;
    Load& operator=(Load&&) = delete;
    Load(const Load&) = delete;
    Load& operator=(const Load&) = delete;
    ~Load();

    /// Removes the first worker that has ended by itself, and returns its kind; none if all still
    /// run.
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
    /// Writing end of the workers' standard input; the workers run until it is closed.
    int lifeline_{-1};
    int their_end_{-1};
};

/// Runs `hrtc load KIND`, which works on this machine until its standard input ends.
int run_load(int argc, char** argv);

} // namespace tactus::hrtc
