// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/surface_query.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

class SurfaceGatherer
{
public:
    SurfaceGatherer(const AbTree& tree, const Vec3& center_m, double reach_m,
                    LocalSurface& surface) noexcept
        : tree_(tree), center_(center_m), reach_(reach_m), surface_(surface)
    {
        surface.center_m = center_m;
        surface.answer = DistanceAnswer{};
        surface.count = 0;
        surface.truncated = false;
    }

    /// Beyond this nothing changes the answer.
    [[nodiscard]] double bound_sq() const noexcept
    {
        const double bound = std::max(reach_, upper_);
        return bound * bound;
    }

    void test_block(std::uint32_t block_index) noexcept
    {
        const BlockGeometry& block = tree_.block(block_index);
        const BlockSide& side = tree_.side(block_index);
        for (std::uint32_t lanes = block.faces; lanes != 0; lanes &= lanes - 1)
        {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
            const std::array<Vec3f, 3> corners = block_triangle(block, lane);
            const Triangle triangle = to_triangle(corners);
            const ClosestPoint closest = closest_point_on_triangle(center_, triangle);
            if (side.errors[lane] == 0)
            {
                add_exact(tree_.face_of(side.prims[lane]), corners, closest);
            }
            else
            {
                add_coarse(
                    triangle, closest,
                    static_cast<double>(error_in_quanta(side.errors[lane]) * tree_.quantum_m()));
            }
        }
    }

    void add_unvisited(std::span<const WalkItem> items) noexcept
    {
        for (const WalkItem& item : items)
        {
            unproven_ = std::min(unproven_, std::sqrt(item.distance_sq) * kBoxDistanceSlack);
        }
    }

    void finish() noexcept
    {
        if (!tree_.is_complete())
        {
            unproven_ = 0.0;
        }
        DistanceAnswer& answer = surface_.answer;
        answer.upper_m = upper_;
        answer.lower_m = std::max(0.0, std::min(exact_lower_, unproven_));
        answer.certified_radius_m = std::max(0.0, std::min({reach_, unproven_, dropped_}));
        const bool is_exact = exact_lower_ <= unproven_ && !answer.nearest_face.is_none();
        answer.kind = answer.lower_m > reach_ ? AnswerKind::decided
                      : is_exact              ? AnswerKind::exact
                                              : AnswerKind::bracket;
    }

private:
    void add_exact(FaceId face, const std::array<Vec3f, 3>& corners,
                   const ClosestPoint& closest) noexcept
    {
        const double distance = std::sqrt(closest.distance_sq);
        exact_lower_ = std::min(exact_lower_, distance - closest.distance_error);
        upper_ = std::min(upper_, distance + closest.distance_error);
        DistanceAnswer& answer = surface_.answer;
        // Ties go to the lowest face id, whatever the order of traversal.
        if (closest.distance_sq < nearest_sq_ ||
            (closest.distance_sq == nearest_sq_ && face < answer.nearest_face))
        {
            nearest_sq_ = closest.distance_sq;
            answer.nearest_face = face;
            answer.nearest_point_m = closest.point;
            answer.nearest_feature = closest.feature;
        }
        if (distance - closest.distance_error <= reach_)
        {
            collect(face, corners, distance - closest.distance_error);
        }
    }

    void add_coarse(const Triangle& triangle, const ClosestPoint& closest, double error_m) noexcept
    {
        const double distance = std::sqrt(closest.distance_sq);
        unproven_ = std::min(unproven_, distance - closest.distance_error - error_m);
        for (const Vec3& corner : triangle)
        {
            upper_ = std::min(upper_, (corner - center_).norm() * (1.0 + 4e-16));
        }
    }

    /// Keeps the nearest kMaxLocalTriangles; the nearest dropped one ends the certified radius.
    void collect(FaceId face, const std::array<Vec3f, 3>& corners, double distance) noexcept
    {
        if (surface_.count < kMaxLocalTriangles)
        {
            surface_.distances_m[surface_.count] = distance;
            surface_.triangles[surface_.count++] = {face, corners};
            return;
        }
        surface_.truncated = true;
        auto& distances = surface_.distances_m;
        const auto farthest = static_cast<std::size_t>(
            std::max_element(distances.begin(), distances.end()) - distances.begin());
        dropped_ = std::min(dropped_, std::max(distance, distances[farthest]));
        if (distance < distances[farthest])
        {
            distances[farthest] = distance;
            surface_.triangles[farthest] = {face, corners};
        }
    }

    static constexpr double kInfinity = std::numeric_limits<double>::infinity();

    const AbTree& tree_;
    Vec3 center_;
    double reach_;
    LocalSurface& surface_;
    double exact_lower_{kInfinity};
    double upper_{kInfinity};
    double unproven_{kInfinity}; ///< Least distance at which something is not known exactly.
    double dropped_{kInfinity};
    double nearest_sq_{kInfinity};
};

} // namespace

[[gnu::noinline]] void gather_surface(const AbTree& tree, const Vec3& center_m, double reach_m,
                                      WalkBudget& budget, LocalSurface& surface) noexcept
{
    SurfaceGatherer gatherer(tree, center_m, reach_m, surface);
    TreeWalk walk(tree, center_m, budget);
    for (std::uint32_t block = walk.next_block(gatherer.bound_sq(), false); block != kNoNode;
         block = walk.next_block(gatherer.bound_sq(), false))
    {
        if (!budget.take_triangles(face_count(tree.block(block))))
        {
            // The block itself was taken off the stack: its parent's bound covers it.
            const WalkItem unread{TreeRef::to_block(block), 0.0};
            gatherer.add_unvisited({&unread, 1});
            break;
        }
        gatherer.test_block(block);
    }
    gatherer.add_unvisited(walk.left());
    gatherer.finish();
}

} // namespace tactus
