// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/content_key.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::dds
{

/// A piece of one of a host's models.
struct HostPiece
{
    std::uint32_t model{0}; ///< Its number on the host.
    ContentKey key;

    constexpr bool operator==(const HostPiece&) const noexcept = default;
};

/// What one controller waits for at its host: newest generation first, within it in the order of
/// asking; each piece once. When it is full the last ones are forgotten: the oldest generation.
class WishQueue
{
public:
    explicit WishQueue(std::size_t capacity) : capacity_(capacity)
    {
        wishes_.reserve(capacity + 1);
    }

    /// Generations count up and may wrap.
    void add(const HostPiece& piece, std::uint32_t generation)
    {
        std::erase_if(wishes_, [&](const Wish& wish) { return wish.piece == piece; });
        const auto at =
            std::find_if(wishes_.begin(), wishes_.end(),
                         [&](const Wish& wish)
                         { return static_cast<std::int32_t>(wish.generation - generation) < 0; });
        wishes_.insert(at, {piece, generation});
        if (wishes_.size() > capacity_)
        {
            wishes_.pop_back();
            ++forgotten_;
        }
    }

    [[nodiscard]] bool empty() const noexcept { return wishes_.empty(); }
    [[nodiscard]] std::size_t size() const noexcept { return wishes_.size(); }
    [[nodiscard]] std::uint64_t forgotten() const noexcept { return forgotten_; }
    /// The most urgent one; there must be one.
    [[nodiscard]] const HostPiece& front() const noexcept { return wishes_.front().piece; }
    void pop_front() noexcept { wishes_.erase(wishes_.begin()); }

private:
    struct Wish
    {
        HostPiece piece;
        std::uint32_t generation{0};
    };

    std::size_t capacity_;
    std::vector<Wish> wishes_;
    std::uint64_t forgotten_{0};
};

} // namespace tactus::dds
