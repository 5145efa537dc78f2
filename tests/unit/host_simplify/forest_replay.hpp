// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/simplify.hpp"
#include "tests/unit/host_simplify/distance_oracle.hpp"

#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace tactus::test
{

using Corners = std::array<std::uint32_t, 3>;

/// Replays a simplification from the base upward, from the collapses alone: which faces there are,
/// their corners and bounds, and which splits the present state allows.
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
    [[nodiscard]] bool is_split(std::uint32_t collapse) const { return split_[collapse] != 0; }
    [[nodiscard]] std::size_t split_count() const { return split_count_; }

    /// Undoes the collapse, and before it all that it depends on.
    void split_with_closure(std::uint32_t collapse);
    /// Undoes random collapses, with their closures, until at least `count` are undone.
    void split_randomly(std::size_t count, std::mt19937& random);

    /// The collapse whose undoing changed the active face last; kNoFace in its base state.
    [[nodiscard]] std::uint32_t last_change(std::uint32_t face) const;

private:
    void split(std::uint32_t collapse);

    const Simplification& forest_;
    std::vector<Face> faces_;
    std::vector<std::vector<std::uint32_t>> changes_; ///< Of each face: collapses, in their order.
    std::vector<std::size_t> done_;                   ///< Of each face: how many of them stand.
    std::vector<char> split_;
    std::size_t split_count_{0};
};

/// Empty when the active faces are a 2-manifold with borders; otherwise what is wrong.
[[nodiscard]] std::string manifold_fault(const std::vector<ForestReplay::Face>& faces);

/// The corners turned so that the least comes first: equal for the same oriented face.
[[nodiscard]] Corners turned(const Corners& corners);

/// Points of the original surface: every vertex and `per_face` random points a face.
[[nodiscard]] std::vector<LongPoint> sample_surface(const QuantisedMesh& mesh, unsigned per_face,
                                                    std::mt19937& random);

/// What the oracle's own rounding may add, in quanta.
inline constexpr long double kOracleTolerance = 1e-9L;

/// Largest over the points of least over the active faces of distance - factor x bound; a sound
/// certificate keeps it within the tolerance for factor 1. Stops at the first point beyond it.
[[nodiscard]] long double worst_violation(const QuantisedMesh& mesh,
                                          const std::vector<ForestReplay::Face>& faces,
                                          const std::vector<LongPoint>& points, double factor);

} // namespace tactus::test
