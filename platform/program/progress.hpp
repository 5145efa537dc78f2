// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace tactus
{

/// Tells on stderr how far a long piece of work has come: percent, items a second, time left. Says
/// nothing in the first two seconds; then on a terminal one line that is written over, elsewhere,
/// and in JSON, a line every ten seconds. Its level is info.
class Progress
{
public:
    /// `what` is done to `items`, e.g. "simplify" and "faces", by the program of that name.
    Progress(std::string program, std::string what, std::string items);
    /// Clears the line on a terminal.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// `total` may be zero; nothing is said then.
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
