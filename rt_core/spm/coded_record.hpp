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

/// A record as a chunk says it: "a fan round a corner of this face, so many faces to its left and
/// right". What that means depends on the records that are named, so it can be parsed by itself
/// but becomes a VsplitRecord only when those are linked (rt_core/spm/star_resolver.hpp).
struct CodedRecord
{
    /// Which record changed a fan face last.
    struct Owner
    {
        enum class Kind : std::uint8_t
        {
            derived, ///< Found from the edge to the face before it; never for the anchor.
            record,  ///< `value` is a record.
            base     ///< `value` is a base face in its base state.
        };
        std::uint32_t value{0};
        Kind kind{Kind::derived};
        std::array<std::uint8_t, 3> reserved{};

        constexpr bool operator==(const Owner&) const noexcept = default;
    };

    Owner anchor;
    /// Of the further fan faces, rightward from the anchor, then leftward.
    std::array<Owner, kMaxFanFaces - 1> others{};
    /// v against its prediction (RingPrediction).
    std::array<std::int32_t, 3> residual{};
    /// Of A against the anchor's bucket, or B's where there is no A; of B against A's.
    std::array<std::int32_t, 2> bucket_step{};
    std::array<ErrorCode, kMaxStarFaces> error{}; ///< As in VsplitRecord.
    std::uint8_t place{0};                        ///< The anchor's in its owner's star.
    std::uint8_t corner{0};                       ///< Which of the anchor's corners is u.
    std::uint8_t left{0};                         ///< Fan faces before the anchor.
    std::uint8_t right{0};                        ///< And behind it.
    std::uint8_t sides{0};                        ///< 1 when A is there, 2 for B.
    std::array<std::uint8_t, 3> reserved{};
    std::array<std::uint32_t, 11> unused{};

    [[nodiscard]] constexpr std::uint32_t fan_size() const noexcept { return left + right + 1U; }
    [[nodiscard]] constexpr bool has_face(std::uint32_t side) const noexcept
    {
        return ((sides >> side) & 1U) != 0;
    }
    constexpr bool operator==(const CodedRecord&) const noexcept = default;
};

// A parsed record waits in the place of the record that it becomes.
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
