// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace tactus::doctor
{

/// A limit of resources that is none.
inline constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

/// What the system grants and does when it is really asked, as against what its files tell.
struct Measured
{
    /// The supervisor's, one above the loop's of 80.
    static constexpr int kFifoPriority = 81;
    static constexpr std::uint64_t kClockReads = 64;

    std::string user{"root"};                  ///< In the words of limits.conf.
    std::string machine;                       ///< Of the processor: "x86_64", "aarch64".
    std::string kernel_version;                ///< As uname states it.
    std::string fifo_refused;                  ///< Name of the errno; empty: granted.
    std::optional<std::uint64_t> rtprio_limit; ///< None: not known.
    bool memory_lock_granted{true};
    std::optional<std::uint64_t> memlock_limit; ///< Bytes; none: not known.
    std::optional<std::uint64_t> clock_calls;   ///< System calls in kClockReads reads of the clock.
    std::optional<std::int64_t> clock_resolution_ns;
    bool float_control_is_default{true}; ///< Of a new thread: see reset_float_control().
    std::string preloaded;               ///< LD_PRELOAD.
    std::string dds_uri;                 ///< CYCLONEDDS_URI; empty is the same as not set.
};

/// Tries it all, on short-lived threads, and leaves the process as it was; but memory that was
/// locked becomes unlocked. At most a few ms.
[[nodiscard]] Measured measure();

} // namespace tactus::doctor
