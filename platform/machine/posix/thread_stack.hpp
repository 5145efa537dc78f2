// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <span>

namespace tactus::posix
{

/// Memory for one thread's stack, every page touched. A page without access below it lets an
/// overflow stop the process instead of writing elsewhere.
class ThreadStack
{
public:
    /// Rounds up to whole pages. If the system has no memory left, memory() is empty: check it.
    explicit ThreadStack(std::size_t bytes) noexcept;
    ThreadStack(const ThreadStack&) = delete;
    ThreadStack& operator=(const ThreadStack&) = delete;
    ~ThreadStack();

    [[nodiscard]] std::span<std::byte> memory() const noexcept { return memory_; }

private:
    std::span<std::byte> mapped_;
    std::span<std::byte> memory_;
};

} // namespace tactus::posix
