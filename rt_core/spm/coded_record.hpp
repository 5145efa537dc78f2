// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"
#include "rt_core/spm/error_code.hpp"
#include "rt_core/spm/ids.hpp"
#include "rt_core/spm/page.hpp"

#include <array>
#include <bit>
#include <cstdint>

namespace tactus
{

/// A record as a chunk codes it: a fan round a corner of the anchor face, with `left` faces on one
/// side of it and `right` on the other. It can be parsed alone, but its meaning depends on the
/// records that it names, so it becomes a VsplitRecord only when those are linked
/// (rt_core/spm/star_resolver.hpp).
struct CodedRecord
{
    /// Source of a fan face's state: the record that changed the face last, or its base state.
    struct Owner
    {
        enum class Kind : std::uint8_t
        {
            /// Not coded: derived from the edge to the previous face. Never for the anchor.
            derived,
            record, ///< `value` is a record.
            base    ///< `value` is a base face in its base state.
        };
        std::uint32_t value{0};
        Kind kind{Kind::derived};
        std::array<std::uint8_t, 3> reserved{};

        constexpr bool operator==(const Owner&) const noexcept = default;
    };

    Owner anchor;
    /// Owners of the further fan faces, rightward from the anchor, then leftward.
    std::array<Owner, kMaxFanFaces - 1> others{};
    /// v minus its prediction (RingPrediction).
    std::array<std::int32_t, 3> residual{};
    /// [0]: bucket of A minus the anchor's. [1]: bucket of B minus A's, or the anchor's without A.
    std::array<std::int32_t, 2> bucket_step{};
    std::array<ErrorCode, kMaxStarFaces> error{}; ///< Same as in VsplitRecord.
    std::uint8_t place{0};                        ///< Place of the anchor in its owner's star.
    std::uint8_t corner{0};                       ///< The anchor's corner that is u.
    std::uint8_t left{0};                         ///< Fan faces before the anchor.
    std::uint8_t right{0};                        ///< Fan faces behind the anchor.
    std::uint8_t sides{0};                        ///< Bit 0: A exists; bit 1: B exists.
    std::array<std::uint8_t, 3> reserved{};
    std::array<std::uint32_t, 11> unused{};

    [[nodiscard]] constexpr std::uint32_t fan_size() const noexcept { return left + right + 1U; }
    [[nodiscard]] constexpr bool has_face(std::uint32_t side) const noexcept
    {
        return ((sides >> side) & 1U) != 0;
    }
    constexpr bool operator==(const CodedRecord&) const noexcept = default;
};

// A parsed record waits in the memory of the record that it becomes.
static_assert(sizeof(CodedRecord) == sizeof(VsplitRecord));

[[nodiscard]] inline VsplitRecord waiting_form(const CodedRecord& coded) noexcept
{
    return std::bit_cast<VsplitRecord>(coded);
}
[[nodiscard]] inline CodedRecord coded_form(const VsplitRecord& waiting) noexcept
{
    return std::bit_cast<CodedRecord>(waiting);
}

} // namespace tactus
