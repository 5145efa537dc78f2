// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <cstdint>

namespace tactus::dds
{

/// Controller's side of the flow control of pieces from one server (one epoch).
///
/// The server sends in each sample the number of pieces `sent` so far, and stops at `granted`. The
/// controller grants a window beyond `seen`, the largest number it received. All numbers are
/// totals, so the next sample repairs the loss of one. Only the loss of a whole window stops the
/// flow; then write_off() treats it as seen.
class CreditWindow
{
public:
    explicit CreditWindow(std::uint64_t window) noexcept : window_(window) {}

    /// Records a sample that states the total `sent` and holds `pieces` pieces.
    void on_sample(std::uint64_t sent, std::uint64_t pieces) noexcept
    {
        seen_ = std::max(seen_, sent);
        received_ += pieces;
    }

    /// Treats all granted pieces as lost; for use after a long silence.
    void write_off() noexcept { seen_ = granted(); }

    [[nodiscard]] std::uint64_t seen() const noexcept { return seen_; }
    [[nodiscard]] std::uint64_t granted() const noexcept { return seen_ + window_; }
    [[nodiscard]] std::uint64_t received() const noexcept { return received_; }

private:
    std::uint64_t window_;
    std::uint64_t seen_{0};
    std::uint64_t received_{0};
};

} // namespace tactus::dds
