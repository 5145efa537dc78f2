// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/coded_record.hpp"
#include "rt_core/spm/tiers.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace tactus
{

/// Probability of a 0 bit in units of 2^-12. Each coded bit moves it by 1/32 of its distance from
/// the certain value.
using Probability = std::uint16_t;

inline constexpr std::uint32_t kProbabilityBits = 12;
inline constexpr std::uint32_t kAdaptShift = 5;
/// The coder's range never stays below this.
inline constexpr std::uint32_t kRangeLeast = 1U << 24U;

/// Moves the probability of a 0 bit towards `bit`; it never leaves 31 .. 4065.
constexpr void adapt(Probability& zero, std::uint32_t bit) noexcept
{
    constexpr std::uint32_t kOne = 1U << kProbabilityBits;
    const std::uint32_t if_one = 0U - bit;
    const std::uint32_t less = (zero >> kAdaptShift) & if_one;
    const std::uint32_t more = ((kOne - zero) >> kAdaptShift) & ~if_one;
    zero = static_cast<Probability>(zero + more - less);
}

/// Adaptive model of a whole number: its number of bits, then the two bits below the first one; the
/// other bits are raw.
struct NumberModel
{
    std::array<Probability, 32> width{};
    std::array<std::array<Probability, 4>, 32> next_bits{};
};

/// Adaptive model of a signed number.
struct SignedModel
{
    Probability negative{};
    NumberModel magnitude;
};

/// All probabilities of a chunk. They start from values that are compiled in
/// (rt_core/spm/chunk_model.cpp), the same for every chunk.
struct ChunkModel
{
    static constexpr std::size_t kWidthGroups = 12;

    /// First index: 0 for anchors, 1 for other owners.
    std::array<std::array<std::array<Probability, 16>, 3>, 2> tier_step;
    /// First index as above; second: 0 within the record's own tier, 1 in a coarser one.
    std::array<std::array<SignedModel, 2>, 2> owner_step;
    std::array<std::array<Probability, 8>, 2> place;
    std::array<std::array<Probability, 4>, 8> corner;
    std::array<Probability, 8> left;
    std::array<std::array<Probability, 8>, 8> right;
    Probability has_both_sides;
    Probability has_only_second;
    std::array<std::array<Probability, 4>, 2> is_named;
    /// First index: 0 in the plane of the ring, 1 along its normal; second: width of the last
    /// residual.
    std::array<std::array<std::array<Probability, 32>, kWidthGroups>, 2> residual_width;
    std::array<std::array<std::array<Probability, 4>, 32>, 2> residual_next_bits;
    std::array<Probability, 2> residual_negative;
    std::array<Probability, 4> is_exact;
    SignedModel largest_error;
    /// First index: 0 for A and B, 1 for fan faces; second: the previous face's error, 0 if there
    /// is none, 1 exact, 2 other.
    std::array<std::array<std::array<Probability, 16>, 3>, 2> error_below;
    std::array<SignedModel, 2> bucket_step;
    Probability has_none; ///< Used for records without both sides.
};

inline constexpr std::size_t kChunkProbabilities = sizeof(ChunkModel) / sizeof(Probability);
static_assert(kChunkProbabilities * sizeof(Probability) == sizeof(ChunkModel));

/// Initial probabilities of every chunk.
[[nodiscard]] const ChunkModel& initial_chunk_model() noexcept;

/// Errors are coded relative to the record's largest one, in steps of two codes below it.
inline constexpr std::uint32_t kExactBelow = 15; ///< Value for an error of 0.

[[nodiscard]] constexpr std::uint32_t steps_below(ErrorCode error, ErrorCode largest) noexcept
{
    const std::uint32_t steps = error < largest ? (largest - error) / 2U : 0U;
    return error == 0 ? kExactBelow : steps < kExactBelow ? steps : kExactBelow - 1;
}
[[nodiscard]] constexpr ErrorCode error_below(ErrorCode largest, std::uint32_t steps) noexcept
{
    TACTUS_ASSERT(steps <= kExactBelow);
    const std::uint32_t error = largest > 2 * steps ? largest - 2 * steps : 1U;
    return static_cast<ErrorCode>(steps == kExactBelow ? 0U : error);
}
/// The error as a chunk stores it: at least `error`, and 0 only for 0.
[[nodiscard]] constexpr ErrorCode rounded_error(ErrorCode error, ErrorCode largest) noexcept
{
    return error_below(largest, steps_below(error, largest));
}

/// The syntax of a chunk, written once: with a RangeEncoder it writes records, with a RangeDecoder
/// it reads them. Decoded values are any that bits can produce, so a reader checks ranges. Cost: 64
/// to 90 bits a record.
template <typename Coder>
class ChunkGrammar
{
public:
    ChunkGrammar(Coder& coder, const ModelCounts& counts, ChunkId chunk) noexcept
        : coder_(coder), model_(initial_chunk_model()), counts_(counts)
    {
        TACTUS_ASSERT(chunk.value < counts.chunks());
        const RecordId first{chunk.value << kRecordsPerChunkLog2};
        const Tier own = tier_of(first);
        for (std::uint32_t tier = 0; tier < kTiers; ++tier)
        {
            // All tiers cover the surface in the same order, so the proportional record is near.
            const Tier& other = kAllTiers[tier];
            const std::uint64_t ahead = first.value - own.first;
            last_[tier] = static_cast<std::uint32_t>(
                other.first + ahead * (other.end - other.first) / (own.end - own.first));
        }
    }

    void code(RecordId id, CodedRecord& record) noexcept
    {
        TACTUS_ASSERT(id.value < counts_.records);
        own_ = tier_of(id).number;
        code_fan(id, record);
        code_residual(record);
        code_errors(record);
        code_buckets(record);
    }

    /// False once a decoded number named a tier before the first, or an error without a code.
    [[nodiscard]] bool is_sound() const noexcept { return is_sound_; }

    /// The present probabilities; used to learn the initial ones.
    [[nodiscard]] const ChunkModel& model() const noexcept { return model_; }

private:
    static constexpr std::uint32_t kTiers = 12; ///< Enough for 2^29 records.
    static constexpr std::uint32_t kBaseStep = 15;

    struct Tier
    {
        std::uint32_t number{0};
        std::uint64_t first{0};
        std::uint64_t end{0};
    };
    enum Role : std::uint8_t // NOLINT(cppcoreguidelines-use-enum-class): an index.
    {
        kAnchor,
        kOther
    };

    static constexpr std::array<Tier, kTiers> make_tiers() noexcept
    {
        std::array<Tier, kTiers> tiers{};
        std::uint64_t end = 0;
        for (std::uint32_t number = 0; number < kTiers; ++number)
        {
            tiers[number] = {number, end, tier_end(end)};
            end = tiers[number].end;
        }
        return tiers;
    }
    static constexpr std::array<Tier, kTiers> kAllTiers = make_tiers();

    [[nodiscard]] Tier tier_of(RecordId id) const noexcept
    {
        std::uint32_t number = 0;
        while (number + 1 < kTiers && id.value >= kAllTiers[number].end)
        {
            ++number;
        }
        Tier tier = kAllTiers[number];
        tier.end = tier.end < counts_.records ? tier.end : counts_.records;
        tier.end = tier.end > tier.first ? tier.end : tier.first + 1;
        return tier;
    }

    // --- Numbers ---------------------------------------------------------------------------------

    template <std::size_t Size>
    std::uint32_t code_tree(std::array<Probability, Size>& tree, std::uint32_t value) noexcept
    {
        constexpr auto kSize = static_cast<std::uint32_t>(Size);
        constexpr auto kBits = static_cast<std::uint32_t>(std::countr_zero(kSize));
        static_assert(std::has_single_bit(kSize));
        std::uint32_t node = 1;
        for (std::uint32_t i = kBits; i-- > 0;)
        {
            node = node << 1U | coder_.code_bit(tree[node], (value >> i) & 1U);
        }
        return node & (kSize - 1);
    }

    /// Codes the bits below the highest one of a number that is `width` bits wide; returns the
    /// number.
    std::uint32_t code_rest(std::array<Probability, 4>& next_bits, std::uint32_t width,
                            std::uint32_t value) noexcept
    {
        TACTUS_ASSERT(width <= 32);
        if (width < 2)
        {
            return width;
        }
        std::uint32_t number = 1;
        const std::uint32_t modelled = width - 1 < 2 ? width - 1 : 2;
        for (std::uint32_t i = 0; i < modelled; ++i)
        {
            // The first bit uses node 1, the second node 2 or 3.
            const std::uint32_t bit =
                coder_.code_bit(next_bits[number], (value >> (width - 2 - i)) & 1U);
            number = number << 1U | bit;
        }
        const std::uint32_t raw = width - 1 - modelled;
        const std::uint32_t rest = coder_.code_raw(raw, value & ((std::uint32_t{1} << raw) - 1));
        return number << raw | rest;
    }

    std::uint32_t code_number(NumberModel& model, std::uint32_t value) noexcept
    {
        const std::uint32_t width =
            code_tree(model.width, static_cast<std::uint32_t>(std::bit_width(value)));
        return code_rest(model.next_bits[width], width, value);
    }

    std::int32_t code_signed(SignedModel& model, std::int32_t value) noexcept
    {
        const std::uint32_t magnitude = code_number(model.magnitude, magnitude_of(value));
        if (magnitude == 0)
        {
            return 0;
        }
        return with_sign(magnitude, coder_.code_bit(model.negative, value < 0 ? 1U : 0U));
    }

    [[nodiscard]] static std::uint32_t magnitude_of(std::int32_t value) noexcept
    {
        const auto bits = static_cast<std::uint32_t>(value);
        return value < 0 ? 0U - bits : bits;
    }
    [[nodiscard]] static std::int32_t with_sign(std::uint32_t magnitude,
                                                std::uint32_t negative) noexcept
    {
        return static_cast<std::int32_t>(negative != 0 ? 0U - magnitude : magnitude);
    }

    // --- The fan ---------------------------------------------------------------------------------

    void code_fan(RecordId id, CodedRecord& record) noexcept
    {
        code_owner(kAnchor, id, record.anchor);
        const bool is_base = record.anchor.kind == CodedRecord::Owner::Kind::base;
        if (!is_base)
        {
            record.place = code_small(model_.place[last_step_ == 0 ? 0 : 1], record.place);
        }
        record.corner = code_small(model_.corner[is_base ? 0 : record.place], record.corner);
        record.left = code_small(model_.left, record.left);
        record.right = code_small(model_.right[record.left], record.right);
        const std::uint32_t both =
            coder_.code_bit(model_.has_both_sides, record.sides != 3 ? 1 : 0);
        record.sides = both == 0 ? std::uint8_t{3} : code_side(record.sides);
        for (std::uint32_t i = 0; i + 1 < record.fan_size() && i < record.others.size(); ++i)
        {
            const bool is_left = i >= record.right;
            code_other(id, is_left ? 1 : 0, is_left ? i - record.right : i, record.others[i]);
        }
    }

    /// Codes CodedRecord::sides if A and B don't both exist.
    std::uint8_t code_side(std::uint32_t sides) noexcept
    {
        if (coder_.code_bit(model_.has_none, sides == 0 ? 1 : 0) != 0)
        {
            return 0;
        }
        return static_cast<std::uint8_t>(
            1U + coder_.code_bit(model_.has_only_second, sides == 2 ? 1 : 0));
    }

    template <std::size_t Size>
    std::uint8_t code_small(std::array<Probability, Size>& tree, std::uint32_t value) noexcept
    {
        return static_cast<std::uint8_t>(code_tree(tree, value));
    }

    void code_other(RecordId id, std::size_t side, std::size_t step,
                    CodedRecord::Owner& owner) noexcept
    {
        const std::uint32_t named = owner.kind == CodedRecord::Owner::Kind::derived ? 0 : 1;
        if (coder_.code_bit(model_.is_named[side][step < 3 ? step : 3], named) != 0)
        {
            code_owner(kOther, id, owner);
        }
        else
        {
            owner = {};
        }
    }

    void code_owner(Role role, RecordId id, CodedRecord::Owner& owner) noexcept
    {
        using Kind = CodedRecord::Owner::Kind;
        const bool is_base = owner.kind == Kind::base;
        const std::uint32_t tier = is_base ? 0 : tier_of({owner.value}).number;
        TACTUS_ASSERT(tier <= own_);
        auto& tree = model_.tier_step[role][context_of(last_step_)];
        const std::uint32_t step = code_tree(tree, is_base ? kBaseStep : own_ - tier);
        if (role == kAnchor)
        {
            last_step_ = step;
        }
        if (step == kBaseStep)
        {
            const auto bits = static_cast<std::uint32_t>(std::bit_width(counts_.base_faces - 1));
            owner = {coder_.code_raw(bits, owner.value), Kind::base, {}};
            return;
        }
        is_sound_ = is_sound_ && step <= own_;
        const std::uint32_t target = is_sound_ ? own_ - step : 0;
        const std::uint32_t from = step == 0 ? id.value : last_[target];
        const std::int32_t way = code_signed(model_.owner_step[role][step == 0 ? 0 : 1],
                                             static_cast<std::int32_t>(owner.value - from));
        owner = {from + static_cast<std::uint32_t>(way), Kind::record, {}};
        last_[target] = owner.value;
    }

    [[nodiscard]] static std::size_t context_of(std::uint32_t step) noexcept
    {
        return step < 2 ? step : 2;
    }

    // --- The rest --------------------------------------------------------------------------------

    void code_residual(CodedRecord& record) noexcept
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            const std::size_t kind = i < 2 ? 0 : 1; // The last one is along the normal.
            const std::uint32_t magnitude = magnitude_of(record.residual[i]);
            const std::size_t group =
                std::min<std::size_t>(widths_[kind], ChunkModel::kWidthGroups - 1);
            const std::uint32_t width =
                code_tree(model_.residual_width[kind][group],
                          static_cast<std::uint32_t>(std::bit_width(magnitude)));
            const std::uint32_t value =
                code_rest(model_.residual_next_bits[kind][width], width, magnitude);
            widths_[kind] = i == 1 && widths_[0] > width ? widths_[0] : width;
            const std::uint32_t is_negative = record.residual[i] < 0 ? 1U : 0U;
            record.residual[i] =
                value == 0 ? 0
                           : with_sign(value, coder_.code_bit(model_.residual_negative[kind],
                                                              is_negative));
        }
    }

    /// Codes the largest error, then how far the others are below it, in steps of two codes.
    void code_errors(CodedRecord& record) noexcept
    {
        ErrorCode largest = 0;
        for (const ErrorCode error : record.error)
        {
            largest = error > largest ? error : largest;
        }
        const std::uint32_t exact =
            coder_.code_bit(model_.is_exact[exact_before_], largest == 0 ? 1U : 0U);
        exact_before_ = ((exact_before_ << 1U) | exact) & 3U;
        if (exact != 0)
        {
            record.error = {};
            return;
        }
        const std::int32_t step = code_signed(model_.largest_error, largest - largest_before_);
        const std::int64_t sum = std::int64_t{largest_before_} + step;
        is_sound_ = is_sound_ && sum >= 1 && sum <= 255;
        largest_before_ = static_cast<ErrorCode>(is_sound_ ? sum : 1);
        std::size_t context = 0;
        for (std::uint32_t place = 0; place < kMaxStarFaces; ++place)
        {
            if (place < 2 ? !record.has_face(place) : place >= 2 + record.fan_size())
            {
                record.error[place] = 0;
                continue;
            }
            const std::uint32_t steps =
                code_tree(model_.error_below[place < 2 ? 0 : 1][context],
                          steps_below(record.error[place], largest_before_));
            record.error[place] = error_below(largest_before_, steps);
            context = steps == kExactBelow ? 1 : 2;
        }
    }

    void code_buckets(CodedRecord& record) noexcept
    {
        for (std::size_t i = 0; i < 2; ++i)
        {
            if (record.has_face(static_cast<std::uint32_t>(i)))
            {
                const bool is_first = i == 0 || !record.has_face(0);
                record.bucket_step[i] =
                    code_signed(model_.bucket_step[is_first ? 0 : 1], record.bucket_step[i]);
            }
            else
            {
                record.bucket_step[i] = 0;
            }
        }
    }

    Coder& coder_;
    ChunkModel model_;
    ModelCounts counts_;
    std::array<std::uint32_t, kTiers> last_{}; ///< Last named owner by tier, or a guess.
    std::uint32_t own_{0};                     ///< Tier of the record.
    std::uint32_t last_step_{0};
    std::array<std::uint32_t, 2> widths_{};
    std::uint32_t exact_before_{0};
    ErrorCode largest_before_{0};
    bool is_sound_{true};
};

} // namespace tactus
