// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/content_key.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus
{

/// Bytes of each part of a header or base mesh except the last, which has the remainder.
inline constexpr std::size_t kPartBytes = std::size_t{28} << 10U;

/// Number of parts of a header or base mesh of `bytes` bytes.
[[nodiscard]] constexpr std::uint32_t parts_of(std::size_t bytes) noexcept
{
    return static_cast<std::uint32_t>((bytes + kPartBytes - 1) / kPartBytes);
}

/// Part number `part` of the bytes `whole`; empty beyond the last part.
[[nodiscard]] constexpr std::span<const std::byte> part_of(std::span<const std::byte> whole,
                                                           std::uint32_t part) noexcept
{
    const std::size_t begin = std::min(part * kPartBytes, whole.size());
    return whole.subspan(begin, std::min(kPartBytes, whole.size() - begin));
}

/// Assembles a header or base mesh from its parts, in any order, each possibly repeated. The caller
/// verifies the hash of the whole.
class PartIntake
{
public:
    PartIntake() = default;
    PartIntake(ContentKind kind, std::size_t bytes)
        : kind_(kind)
        , bytes_(bytes)
        , is_resident_(parts_of(bytes), false)
        , missing_(is_resident_.size())
    {
    }

    /// Stores a part. False, with nothing changed, for a part received before or of another kind or
    /// size.
    bool receive(ContentKey key, std::span<const std::byte> bytes)
    {
        if (key.kind != kind_ || key.number >= is_resident_.size() || is_resident_[key.number] ||
            bytes.size() != part_of(bytes_, key.number).size())
        {
            return false;
        }
        std::ranges::copy(bytes,
                          bytes_.begin() + static_cast<std::ptrdiff_t>(key.number * kPartBytes));
        is_resident_[key.number] = true;
        --missing_;
        return true;
    }
    [[nodiscard]] std::size_t missing() const noexcept { return missing_; }
    /// Appends keys of missing parts to `keys`, until none is missing or `keys` holds `most`.
    void list_missing(std::vector<ContentKey>& keys, std::size_t most) const
    {
        for (std::uint32_t i = 0; i < is_resident_.size() && keys.size() < most; ++i)
        {
            if (!is_resident_[i])
            {
                keys.push_back({kind_, i});
            }
        }
    }
    [[nodiscard]] std::vector<std::byte>& bytes() noexcept { return bytes_; }

private:
    ContentKind kind_{ContentKind::base};
    std::vector<std::byte> bytes_;
    std::vector<bool> is_resident_; ///< True for each received part, by number.
    std::size_t missing_{0};
};

} // namespace tactus
