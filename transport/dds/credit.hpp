// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <cstdint>

namespace tactus::dds
{

/// The controller's side of the credit for one server's epoch.
///
/// The server counts the pieces it has `sent` and includes the count in each sample; it may send
/// until the count reaches `granted`. The controller grants a window beyond the count that it has
/// `seen`. All numbers are absolute, so a lost sample leaks no credit: the next one that arrives
/// shows the whole count. Only the loss of a whole window stops the flow; then the window is
/// written off.
class CreditWindow
{
public:
    explicit CreditWindow(std::uint64_t window) noexcept : window_(window) {}

    /// Records a sample with this count and `pieces` pieces.
    void on_sample(std::uint64_t sent, std::uint64_t pieces) noexcept
    {
        seen_ = std::max(seen_, sent);
        received_ += pieces;
    }

    /// Treats everything granted as lost, after a long silence.
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
