// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/volume.hpp"
#include "rt_core/base/assert.hpp"

#include <array>
#include <bit>
#include <cstdint>

namespace tactus
{

inline constexpr std::uint32_t kNoNode = 0xFFFF'FFFFU;

/// A child of a node or the root of a tree: a node, a block, or nothing.
struct TreeRef
{
    std::uint32_t value{kNoNode};

    [[nodiscard]] static constexpr TreeRef to_node(std::uint32_t node) noexcept
    {
        return {node << 1U};
    }
    [[nodiscard]] static constexpr TreeRef to_block(std::uint32_t block) noexcept
    {
        return {(block << 1U) | 1U};
    }
    [[nodiscard]] constexpr bool is_none() const noexcept { return value == kNoNode; }
    [[nodiscard]] constexpr bool is_block() const noexcept { return (value & 1U) != 0; }
    [[nodiscard]] constexpr std::uint32_t index() const noexcept { return value >> 1U; }
    constexpr bool operator==(const TreeRef&) const noexcept = default;
};

/// An aligned range of 1, 2, 4 or 8 values of a node's digit: a binary cell.
struct DigitRange
{
    std::uint32_t first{0};
    std::uint32_t width{0};
};

/// Kinds of faces below a node's child.
struct FacesBelow
{
    bool some_coarse{false};
    bool some_exact{false};

    bool operator==(const FacesBelow&) const noexcept = default;
};

/// An 8-wide node of the AB-Tree. It represents one octal digit of the
/// faces' paths, at bit `shift`; all paths below it agree above that digit. A child is a node (one
/// digit value) or a block (an aligned range of 1, 2 or 4 digit values: the binary levels are
/// collapsed). 256 B with boxes.
struct alignas(64) AbNode
{
    static constexpr std::uint32_t kNoChild = 8;
    static_assert(kNoChild >= kNodeChildren, "no child's index is the index of no child");
    static constexpr std::uint32_t kSeveral = 9; ///< Result of only_child_in(); never stored.

    AabbVolume::Rows volumes{}; ///< Boxes of the children.
    std::array<TreeRef, kNodeChildren> children{};
    /// Path of a face inserted below; only bits above the node's digit count.
    std::uint64_t prefix{0};
    std::uint32_t digit_map{0x8888'8888U}; ///< Child of each digit value, 4 bits each; 8 is none.
    std::uint32_t parent{kNoNode};
    /// Next node in the list of marked ones, or of refit's level. Free nodes are linked by
    /// `parent`.
    std::uint32_t link{kNoNode};
    std::uint8_t shift{0};
    std::uint8_t mask{0};   ///< Children in use.
    std::uint8_t coarse{0}; ///< Children with an inexact face below.
    std::uint8_t child{0};  ///< Index as child of the parent.
    bool in_use{false};
    bool is_marked{false}; ///< True while in the list of marked nodes, even once freed.
    bool is_queued{false}; ///< True while in refit's list of its level.
    std::uint8_t owner{0}; ///< Model of the node's tree.
    std::uint8_t exact{0}; ///< Children with an exact face below.

    [[nodiscard]] std::uint32_t digit_of(std::uint64_t path) const noexcept
    {
        return static_cast<std::uint32_t>(path >> shift) & 7U;
    }
    /// True if the path agrees with `prefix` above the node's digit, so that its face belongs
    /// below.
    [[nodiscard]] bool holds(std::uint64_t path) const noexcept
    {
        return (((path ^ prefix) >> shift) >> 3U) == 0;
    }
    [[nodiscard]] std::uint32_t child_of(std::uint32_t digit) const noexcept
    {
        return (digit_map >> (4 * digit)) & 15U;
    }
    void assign(DigitRange digits, std::uint32_t child_index) noexcept
    {
        TACTUS_ASSERT(digits.first + digits.width <= kNodeChildren);
        TACTUS_ASSERT(child_index <= kNoChild);
        for (std::uint32_t digit = digits.first; digit < digits.first + digits.width; ++digit)
        {
            digit_map = (digit_map & ~(15U << (4 * digit))) | (child_index << (4 * digit));
        }
    }
    /// The digit values of a child; it has at least one.
    [[nodiscard]] DigitRange range_of(std::uint32_t child_index) const noexcept
    {
        DigitRange range;
        for (std::uint32_t digit = kNodeChildren; digit-- > 0;)
        {
            if (child_of(digit) == child_index)
            {
                range = {digit, range.width + 1};
            }
        }
        return range;
    }
    /// The one child that the digits lead to: kNoChild if there is none, kSeveral if more.
    [[nodiscard]] std::uint32_t only_child_in(DigitRange digits) const noexcept
    {
        std::uint32_t only = kNoChild;
        for (std::uint32_t digit = digits.first; digit < digits.first + digits.width; ++digit)
        {
            const std::uint32_t found = child_of(digit);
            if (found != kNoChild && only != kNoChild && found != only)
            {
                return kSeveral;
            }
            only = found == kNoChild ? only : found;
        }
        return only;
    }
    [[nodiscard]] std::uint32_t child_count() const noexcept
    {
        return static_cast<std::uint32_t>(std::popcount(mask));
    }
    [[nodiscard]] Aabb box_of(std::uint32_t index) const noexcept
    {
        TACTUS_ASSERT(index < kNodeChildren);
        return volumes.get(index);
    }
    /// Faces below all children.
    [[nodiscard]] FacesBelow below() const noexcept { return {coarse != 0, exact != 0}; }
    [[nodiscard]] FacesBelow below(std::uint32_t index) const noexcept
    {
        TACTUS_ASSERT(index < kNodeChildren);
        return {((std::uint32_t{coarse} >> index) & 1U) != 0,
                ((std::uint32_t{exact} >> index) & 1U) != 0};
    }
    void set_below(std::uint32_t index, FacesBelow faces) noexcept
    {
        TACTUS_ASSERT(index < kNodeChildren);
        const std::uint32_t bit = 1U << index;
        coarse = static_cast<std::uint8_t>(faces.some_coarse ? coarse | bit : coarse & ~bit);
        exact = static_cast<std::uint8_t>(faces.some_exact ? exact | bit : exact & ~bit);
    }
};

static_assert(sizeof(AbNode) == 256);

} // namespace tactus
