// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace tactus::doctor
{

/// Limit of an unlimited resource.
inline constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

/// Measured behaviour of the system, as opposed to the contents of its files.
struct Measured
{
    /// Priority of the supervisor, one above the loop's of 80.
    static constexpr int kFifoPriority = 81;
    static constexpr std::uint64_t kClockReads = 64;

    std::string user{"root"};                  ///< User name for limits.conf.
    std::string machine;                       ///< Processor type, such as "x86_64" or "aarch64".
    std::string kernel_version;                ///< Version as uname reports it.
    std::string fifo_refused;                  ///< Name of the errno; empty: granted.
    std::optional<std::uint64_t> rtprio_limit; ///< None: unknown.
    bool memory_lock_granted{true};
    std::optional<std::uint64_t> memlock_limit; ///< Bytes; none: unknown.
    std::optional<std::uint64_t> clock_calls;   ///< System calls in kClockReads reads of the clock.
    std::optional<std::int64_t> clock_resolution_ns;
    bool float_control_is_default{true}; ///< State of a new thread: see reset_float_control().
    std::string preloaded;               ///< LD_PRELOAD.
    std::string dds_uri;                 ///< CYCLONEDDS_URI; empty is the same as unset.
};

/// Measures all fields on short-lived threads, in a few ms at most. The process is left unchanged,
/// except that locked memory becomes unlocked.
[[nodiscard]] Measured measure();

} // namespace tactus::doctor
