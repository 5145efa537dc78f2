// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace tactus
{

/// Shows the progress of long work on stderr: percent, items per second, time left. Prints nothing
/// in the first two seconds. Then a terminal gets one line that is overwritten; otherwise, and in
/// JSON, a line appears every ten seconds. The level is info.
class Progress
{
public:
    /// `what` is the work and `items` its unit, e.g. "simplify" and "faces"; `program` is the
    /// program's name.
    Progress(std::string program, std::string what, std::string items);
    /// Clears the line on a terminal.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Updates the counts. If `done` or `total` is zero, nothing is printed.
    void update(std::size_t done, std::size_t total);

private:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] bool is_due(Clock::time_point now) const;

    std::string program_;
    std::string what_;
    std::string items_;
    bool is_terminal_;
    bool has_line_{false};
    Clock::time_point start_;
    Clock::time_point last_;
};

} // namespace tactus
