// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/content_key.hpp"
#include "transport/piece_parts.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus
{

/// Puts something together that comes in parts, in any order and more than once. Which bytes they
/// are is for who has the whole to check.
class PartIntake
{
public:
    PartIntake() = default;
    PartIntake(ContentKind kind, std::size_t bytes)
        : kind_(kind), bytes_(bytes), is_here_(parts_of(bytes), false), missing_(is_here_.size())
    {
    }

    /// False for what is here already, of another kind or of another size.
    bool receive(ContentKey key, std::span<const std::byte> bytes)
    {
        if (key.kind != kind_ || key.number >= is_here_.size() || is_here_[key.number] ||
            bytes.size() != part_of(bytes_, key.number).size())
        {
            return false;
        }
        std::ranges::copy(bytes,
                          bytes_.begin() + static_cast<std::ptrdiff_t>(key.number * kPartBytes));
        is_here_[key.number] = true;
        --missing_;
        return true;
    }
    [[nodiscard]] std::size_t missing() const noexcept { return missing_; }
    /// Adds the missing parts to `keys` while those are fewer than `most`.
    void list_missing(std::vector<ContentKey>& keys, std::size_t most) const
    {
        for (std::uint32_t i = 0; i < is_here_.size() && keys.size() < most; ++i)
        {
            if (!is_here_[i])
            {
                keys.push_back({kind_, i});
            }
        }
    }
    [[nodiscard]] std::vector<std::byte>& bytes() noexcept { return bytes_; }

private:
    ContentKind kind_{ContentKind::base};
    std::vector<std::byte> bytes_;
    std::vector<bool> is_here_; ///< By part.
    std::size_t missing_{0};
};

} // namespace tactus
