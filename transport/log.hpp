// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

namespace tactus
{

/// Receives one line of text without a newline, on the transport thread. If the function is empty,
/// nothing is logged.
using Log = std::function<void(const std::string&)>;

/// Limits the lines per second and reports the number left out, so that a fault that repeats
/// quickly neither floods the terminal nor stalls its thread. One thread; reads the clock, and
/// allocates when a line is written.
class RateLimitedLog
{
public:
    static constexpr std::uint32_t kLinesPerSecond = 5;

    explicit RateLimitedLog(Log log, std::uint32_t lines_per_second = kLinesPerSecond)
        : log_(std::move(log)), lines_per_second_(lines_per_second)
    {
    }

    /// Counts a line and returns true if it may be written now, by write_now(). Build the line only
    /// then.
    [[nodiscard]] bool try_begin()
    {
        const auto now = std::chrono::steady_clock::now();
        if (now - second_start_ >= std::chrono::seconds(1))
        {
            second_start_ = now;
            lines_ = 0;
            if (suppressed_ > 0 && log_)
            {
                log_(std::to_string(suppressed_) +
                     (suppressed_ == 1 ? " more line" : " more lines") + " left out");
            }
            suppressed_ = 0;
        }
        if (lines_ >= lines_per_second_)
        {
            ++suppressed_;
            return false;
        }
        ++lines_;
        return true;
    }

    /// Writes a line after try_begin() allowed it.
    void write_now(const std::string& line)
    {
        if (log_)
        {
            log_(line);
        }
    }

    void write(const std::string& line)
    {
        if (try_begin())
        {
            write_now(line);
        }
    }

private:
    Log log_;
    std::uint32_t lines_per_second_;
    std::chrono::steady_clock::time_point second_start_{};
    std::uint32_t lines_{0};
    std::uint64_t suppressed_{0};
};

} // namespace tactus
