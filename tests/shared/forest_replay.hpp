// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/simplify.hpp"
#include "tests/shared/manifold.hpp"

#include <cstdint>
#include <random>
#include <vector>

namespace tactus::test
{

/// Replay of a simplification from the base upward, from the collapses alone: the faces with their
/// corners and bounds, and the splits that the state permits.
class ForestReplay
{
public:
    /// Starts at the base.
    explicit ForestReplay(const Simplification& forest, std::size_t face_count);

    struct Face
    {
        bool active{false};
        Corners corners{};
        float error{0.0F};
    };

    [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }
    [[nodiscard]] std::vector<Corners> active_corners() const;
    [[nodiscard]] bool is_split(std::uint32_t collapse) const { return split_[collapse] != 0; }
    [[nodiscard]] std::size_t split_count() const { return split_count_; }

    /// Undoes the collapse after all that it depends on.
    void split_with_closure(std::uint32_t collapse);
    /// Undoes random collapses, with their closures, until at least `count` are undone.
    void split_randomly(std::size_t count, std::mt19937& random);

    /// Collapse whose undoing changed the active face last; kNoFace in its base state.
    [[nodiscard]] std::uint32_t last_change(std::uint32_t face) const;

private:
    void split(std::uint32_t collapse);

    const Simplification& forest_;
    std::vector<Face> faces_;
    std::vector<std::vector<std::uint32_t>> changes_; ///< Collapses of each face, in order.
    std::vector<std::size_t> done_; ///< Number of collapses of each face that are in effect.
    std::vector<char> split_;
    std::size_t split_count_{0};
};

} // namespace tactus::test
