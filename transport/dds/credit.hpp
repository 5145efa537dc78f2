// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <cstdint>

namespace tactus::dds
{

/// The controller's side of the credit for one host's epoch.
///
/// The host counts the pieces it has `sent`, each sample says how many; it may go as far as
/// `granted`. We grant a window beyond what we have `seen` of that count. All are absolute, so a
/// lost sample leaks nothing: the next one that comes shows the whole count. Only when a whole
/// window is lost does nothing come any more; then it is written off.
class CreditWindow
{
public:
    explicit CreditWindow(std::uint64_t window) noexcept : window_(window) {}

    /// A new epoch counts from zero.
    void restart() noexcept { seen_ = received_ = 0; }

    /// A sample came with `pieces` pieces in it and this count.
    void on_sample(std::uint64_t sent, std::uint64_t pieces) noexcept
    {
        seen_ = std::max(seen_, sent);
        received_ += pieces;
    }

    /// Nothing came for long: what was granted is taken as lost.
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
