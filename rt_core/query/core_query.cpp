// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/core_query.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/geometry/separations.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/query/block_search.hpp"
#include "rt_core/query/nearest_triangles.hpp"
#include "rt_core/query/probe.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace tactus
{

namespace
{

static_assert(kBlockVertices == CornersAtCore::kCorners);

/// Share of the tolerance by which an answer may change if not every face is measured.
constexpr double kUnmeasuredShare = 0x1p-4;
/// Difference in quanta up to which distances may be equal.
constexpr double kTied = 0x1p-20;
/// Bound on the rounding of heights of placed corners, relative to their coordinates.
constexpr double kPlaceRounding = 1e-14;

/// Distance in quanta that is larger than any model and far from overflow.
constexpr double kMostQuanta = 0x1p100;

/// Returns the oriented box of a core, in the kernels' form.
KernelBox make_kernel_box(const PlacedCore& core, float quantum_m) noexcept
{
    KernelBox box{};
    box.center = make_probe(core.center(), quantum_m);
    float sum = 0.0F;
    for (std::size_t i = 0; i < 3; ++i)
    {
        const auto along = static_cast<Eigen::Index>(i);
        box.half_along[i] = round_up_to_float(
            std::min(core.half()[along] / static_cast<double>(quantum_m), kMostQuanta));
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            box.axes[i][axis] =
                static_cast<float>(core.axes()(static_cast<Eigen::Index>(axis), along));
            box.half[axis] += std::abs(box.axes[i][axis]) * box.half_along[i];
        }
    }
    for (std::size_t i = 0; i < 3; ++i)
    {
        sum += box.half[i] + box.half_along[i];
    }
    box.center.slack += sum * kPairMargin;
    return box;
}

/// Search of one query. Kernels bound the distances of boxes from the oriented box of the core.
class CoreSearch
{
public:
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): each block fills corners_.
    CoreSearch(const AbTree& tree, const PlacedCore& core, double reach_m, ProofShare share,
               std::uint32_t enough, ErrorCode tolerance, WalkBudget& budget,
               LocalSurface& surface) noexcept
        : tree_(tree)
        , core_(core)
        , quantum_(static_cast<double>(tree.quantum_m()))
        , reach_(reach_m)
        , share_(static_cast<double>(share_of(share)))
        , enough_(enough)
        , tolerance_(tolerance)
        , little_m_(kUnmeasuredShare * static_cast<double>(error_in_quanta(tolerance)) * quantum_)
        , looked_(reach_m + static_cast<double>(error_in_quanta(tolerance)) * quantum_)
        , budget_(budget)
        , box_(make_kernel_box(core, tree.quantum_m()))
        , triangles_(surface)
    {
        if (core.is_convex_body())
        {
            separations_.emplace(core);
        }
    }

    void run(QueryMemory& memory) noexcept
    {
        search_blocks(tree_, box_, budget_, memory, *this);
        memory.block = nearest_block_ == kNoNode ? memory.block : nearest_block_;
    }

    [[nodiscard]] float bound() const noexcept
    {
        const double quanta = worth_m() / quantum_;
        return quanta < kFarQuanta ? round_up_to_float(quanta)
                                   : std::numeric_limits<float>::infinity();
    }

    void leave(float gap) noexcept { open_ = std::min(open_, static_cast<double>(gap) * quantum_); }

    /// Tests the faces of a block; false if the budget is spent or enough is known.
    [[nodiscard]] bool test_block(std::uint32_t index) noexcept
    {
        const BlockGeometry& block = tree_.block(index);
        if (!budget_.take_triangles(face_count(block)))
        {
            // Nothing is proven, as the bound of the block's box may be lost.
            open_ = std::min(open_, 0.0);
            return false;
        }
        const BlockSide& side = tree_.side(index);
        TACTUS_ASSERT(side.in_use);
        core_.measure_corners(block.coordinates, corners_);
        if (separations_ && is_apart(block, side))
        {
            return true;
        }
        const std::uint32_t open = side.coarse != 0 ? lanes_above(side, tolerance_) : 0U;
        for (std::uint32_t lanes = block.faces; lanes != 0; lanes &= lanes - 1)
        {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
            const bool is_exact = (side.coarse >> lane & 1U) == 0;
            const ErrorCode code = is_exact ? ErrorCode{0} : side.errors[lane];
            test_face({index, lane, code, static_cast<double>(error_in_quanta(code)) * quantum_,
                       (open >> lane & 1U) != 0, (side.outdated >> lane & 1U) != 0});
            if (met_ >= enough_)
            {
                open_ = std::min(open_, 0.0);
                return false;
            }
        }
        return true;
    }

    [[nodiscard]] DistanceAnswer answer() const noexcept
    {
        Findings found;
        found.exact_lower_m = exact_lower_;
        found.tolerated_lower_m = tolerated_lower_;
        found.upper_m = upper_;
        // No face is nearer than one that meets the core, so `open_m` need not be below zero.
        found.open_m = tree_.is_complete() ? std::max(open_, 0.0) : 0.0;
        found.pruned_m = limit_ > looked_ ? worth_m() : kInfinity;
        found.dropped_m = triangles_.dropped_m();
        DistanceAnswer answer = answer_from(found, reach_);
        answer.tool_point_m = core_.center();
        answer.tolerated_m = static_cast<double>(error_in_quanta(largest_tolerated_)) * quantum_ +
                             (is_unmeasured_ ? little_m_ : 0.0);
        if (is_nearest_proven(found))
        {
            answer.tool_point_m = nearest_.on_shape;
            answer.nearest_face = nearest_face_;
            answer.nearest_point_m = nearest_.on_triangle;
            answer.nearest_feature = nearest_.feature;
        }
        return answer;
    }

private:
    struct Face
    {
        std::uint32_t block;
        std::uint32_t lane;
        ErrorCode error;
        double error_m;   ///< Error of the face, in metres.
        bool is_open;     ///< True if the face does not count as the surface.
        bool is_outdated; ///< True if its corners may not be on the surface.
    };

    /// Cheap bounds on a face's distance, with the closest points of a convex body in reach.
    struct Measure
    {
        CoreBounds bounds;
        std::optional<ClosestPoints> closest;
    };

    /// Distance beyond which faces change no result. Never grows, so that faces left out stay
    /// beyond it.
    [[nodiscard]] double worth_m() const noexcept
    {
        return limit_ > looked_ ? std::max(looked_, share_ * limit_)
                                : std::max(std::min(looked_, triangles_.dropped_m()), limit_);
    }

    /// True if one direction proves that the whole block is too far from a convex body to matter.
    [[nodiscard]] bool is_apart(const BlockGeometry& block, const BlockSide& side) noexcept
    {
        budget_.spend(WorkCost::block_row);
        const double error = static_cast<double>(largest_error_quanta(side)) * quantum_;
        const double worth = worth_m() + error;
        const double apart =
            separations_->bound_all(block.coordinates, block.vertices, corners_, worth);
        if (apart > worth && lanes_above(side, tolerance_) != 0)
        {
            open_ = std::min(open_, apart - error);
        }
        return apart > worth;
    }

    void test_face(const Face& face) noexcept
    {
        const double worth = worth_m();
        const bool is_left = face.is_open;
        const Measure known = measure_within(face, worth + face.error_m, !is_left);
        double lower = known.bounds.lower - face.error_m;
        if (is_left && lower <= worth && lower < open_)
        {
            // Measures as refinement does, so that a gap that suffices there is not open here.
            const ClosestPoints closest = measure(face, known);
            lower = closest.distance - closest.distance_error - face.error_m;
        }
        open_ = is_left ? std::min(open_, lower) : open_;
        if (lower > worth)
        {
            return;
        }
        if (face.error != 0 && !face.is_outdated)
        {
            bound_by_corners(face, known.bounds);
        }
        if (!is_left)
        {
            add_surface(face, known);
        }
    }

    [[nodiscard]] Measure measure_within(const Face& face, double limit_m, bool is_surface) noexcept
    {
        const BlockGeometry& block = tree_.block(face.block);
        const std::array<std::uint8_t, 3> corners{
            block.corners[0][face.lane], block.corners[1][face.lane], block.corners[2][face.lane]};
        Measure found{core_.bounds(corners_, corners, limit_m), std::nullopt};
        // The core is no convex body.
        if (tolerance_ != 0 && !separations_ && found.bounds.lower <= limit_m)
        {
            found.bounds.lower = std::max(found.bounds.lower, bound_along_way(corners));
        }
        if (separations_ && found.bounds.lower <= limit_m)
        {
            found.bounds.lower = std::max(found.bounds.lower, separations_->bound(corners));
            if (found.bounds.lower <= limit_m &&
                !(is_surface && tells_nothing(face, found.bounds.lower)))
            {
                measure_body(face, limit_m, found);
            }
        }
        return found;
    }

    void measure_body(const Face& face, double limit_m, Measure& found) noexcept
    {
        // Ratio of bounds above which a further direction is worth its cost.
        constexpr double kHardlyMore = 1.05;
        budget_.spend(WorkCost::gjk);
        Vec3 direction(0.0, 0.0, 0.0); // The start of PlacedCore::closest(), for the same bits.
        const GjkAnswer answer = gjk_distance(core_.body(), triangle_of(face), direction, limit_m);
        const ClosestPoints closest = to_closest_points(answer);
        if (answer.lower > kHardlyMore * found.bounds.lower)
        {
            separations_->add(direction);
        }
        found.bounds.lower =
            std::max(found.bounds.lower, closest.distance - closest.distance_error);
        found.bounds.upper = closest.distance + closest.distance_error;
        found.bounds.meet = closest.meet;
        if (!(answer.lower > limit_m)) // If false, the search ended at the limit.
        {
            found.closest = closest;
        }
    }

    [[nodiscard]] Triangle triangle_of(const Face& face) const noexcept
    {
        return to_triangle(block_triangle(tree_.block(face.block), face.lane));
    }

    [[nodiscard]] ClosestPoints measure(const Face& face, const Measure& known) const noexcept
    {
        return known.closest ? *known.closest : measure(triangle_of(face));
    }
    [[nodiscard]] ClosestPoints measure(const Triangle& triangle) const noexcept
    {
        const ClosestPoints closest = core_.closest(triangle);
        budget_.spend(separations_             ? WorkCost::gjk
                      : is_found_soon(closest) ? WorkCost::at_corner
                                               : WorkCost::measured);
        return closest;
    }

    /// True if a corner of the triangle is nearest to a box, as for most faces under a flat box;
    /// costs less.
    [[nodiscard]] bool is_found_soon(const ClosestPoints& closest) const noexcept
    {
        return core_.is_box() && closest.feature <= TriangleFeature::corner_2;
    }

    /// Adds a face that counts as the surface: it is exact or within the tolerance.
    void add_surface(const Face& face, const Measure& known) noexcept
    {
        const PrimId prim = tree_.side(face.block).prims[face.lane];
        const FaceId id = tree_.face_of(prim);
        const CoreBounds& bounds = known.bounds;
        double lower = std::max(0.0, bounds.lower);
        bool meets = bounds.meet;
        take_upper(face, bounds.upper);
        const double stands_for = lower - face.error_m;
        const bool is_left_out = tells_nothing(face, bounds.lower);
        if (!is_left_out &&
            (may_be_nearest(id, stands_for) || (stands_for <= reach_ && bounds.upper > reach_)))
        {
            const ClosestPoints closest = measure(face, known);
            lower = std::max(0.0, closest.distance - closest.distance_error);
            meets = closest.meet;
            take_upper(face, closest.distance + closest.distance_error);
            keep_if_nearest(closest, id, face.block);
            measured_lower_ = std::min(measured_lower_, lower - face.error_m);
        }
        lower -= face.error_m; // Lower bound on the source mesh's surface that the face stands for.
        largest_tolerated_ = std::max(largest_tolerated_, face.error);
        if (lower <= reach_)
        {
            if (LocalTriangle* const place = triangles_.add(std::max(0.0, lower)))
            {
                *place = {prim, block_triangle(tree_.block(face.block), face.lane)};
            }
        }
        // The face does not make the answer exact if a nearer exact face may have been left out.
        const bool is_exact = !is_left_out || lower >= nearest_.distance - kTied * quantum_;
        is_unmeasured_ = is_unmeasured_ || !is_exact;
        double& least = face.error == 0 && is_exact ? exact_lower_ : tolerated_lower_;
        least = std::min(least, lower);
        met_ += meets ? 1U : 0U;
    }

    /// Takes an upper bound on the distance to the source mesh's surface.
    void take_upper(double upper_m) noexcept
    {
        upper_ = std::min(upper_, upper_m);
        limit_ = std::min(limit_, upper_m);
    }
    /// Takes an upper bound on the distance to a face that counts as the surface.
    void take_upper(const Face& face, double upper_m) noexcept
    {
        limit_ = std::min(limit_, upper_m);
        upper_ = face.error == 0 ? std::min(upper_, upper_m) : upper_;
    }

    /// True if a measurement of the face would change the answer by less than a small part of the
    /// tolerance: a flat tool is about as far from all faces below it. Without a tolerance all
    /// faces are measured, so that their order does not matter.
    [[nodiscard]] bool tells_nothing(const Face& face, double lower_m) const noexcept
    {
        return tolerance_ != 0 && lower_m >= nearest_.distance - little_m_ &&
               lower_m - face.error_m >= measured_lower_ - little_m_ &&
               (face.error != 0 || lower_m >= upper_ - little_m_);
    }

    /// Lower bound on the gap between core and face, along the direction to the nearest measured
    /// face.
    [[nodiscard]] double bound_along_way(const std::array<std::uint8_t, 3>& corners) const noexcept
    {
        double least = kInfinity;
        for (const std::uint8_t i : corners)
        {
            const Vec3 place(corners_.place[0][i], corners_.place[1][i], corners_.place[2][i]);
            least = std::min(least, way_.dot(place) - kPlaceRounding * place.cwiseAbs().sum());
        }
        const Vec3& half = core_.half();
        return least - way_.cwiseAbs().dot(half) - kPlaceRounding * half.sum();
    }

    /// True if the face may be the nearest. The lowest id decides between equally near faces.
    [[nodiscard]] bool may_be_nearest(FaceId face, double lower_m) const noexcept
    {
        return lower_m <= limit_ && (nearest_.distance > 0.0 || face < nearest_face_);
    }

    void keep_if_nearest(const ClosestPoints& closest, FaceId face, std::uint32_t block) noexcept
    {
        if (closest.distance < nearest_.distance ||
            (closest.distance == nearest_.distance && face < nearest_face_))
        {
            nearest_ = closest;
            nearest_face_ = face;
            nearest_block_ = block;
            way_ = closest.distance > 0.0
                       ? Vec3(core_.axes().transpose() * closest.gap / closest.distance)
                       : Vec3(0.0, 0.0, 0.0);
        }
    }

    /// Bounds the distance by a coarse face's corners, which are original vertices.
    void bound_by_corners(const Face& face, const CoreBounds& bounds) noexcept
    {
        if (!core_.is_convex_body())
        {
            take_upper(bounds.upper);
            return;
        }
        for (const Vec3& corner : triangle_of(face))
        {
            const Triangle point{corner, corner, corner};
            if (std::max(bounds.lower, core_.bounds(point).lower) < upper_ - little_m_)
            {
                const ClosestPoints closest = measure(point);
                take_upper(closest.distance + closest.distance_error);
            }
        }
    }

    const AbTree& tree_;
    const PlacedCore& core_;
    double quantum_;
    double reach_;
    double share_; ///< Share of the best known distance beyond which faces are not tested.
    std::uint32_t enough_;
    ErrorCode tolerance_; ///< Largest error of faces that count as the surface.
    double little_m_;     ///< Small part of the tolerance, in metres.
    /// Range of the search: the reach plus the tolerance, as a farther face may stand for surface
    /// within the reach.
    double looked_;
    WalkBudget& budget_;
    KernelBox box_;
    NearestTriangles triangles_;
    std::optional<Separations> separations_; ///< Separating directions; only for a convex body.
    CornersAtCore corners_;                  ///< Corners of the tested block.
    double open_{kInfinity};                 ///< Lower bound on the distance of inexact faces.
    double exact_lower_{kInfinity};          ///< Lower bound on the distance of exact faces.
    /// Lower bound on the distance of surface that coarse faces within the tolerance stand for.
    double tolerated_lower_{kInfinity};
    double upper_{kInfinity}; ///< Upper bound on the distance to the source mesh's surface.
    /// Upper bound on the distance to the source mesh's surface or to a face that counts as it.
    double limit_{kInfinity};
    /// Lower bound on the distance from the measured faces of the surface.
    double measured_lower_{kInfinity};
    ErrorCode largest_tolerated_{0};
    bool is_unmeasured_{false}; ///< A face that may be nearer than nearest_ was left out.
    std::uint32_t met_{0};      ///< Number of faces of the surface that meet the core.
    ClosestPoints nearest_{.distance = kInfinity};
    /// Direction from the core to nearest_, in the axes of the core's box; of length 1, or 0 if
    /// unknown.
    Vec3 way_{0.0, 0.0, 0.0};
    FaceId nearest_face_{};
    std::uint32_t nearest_block_{kNoNode};
};

} // namespace

void gather_surface(const AbTree& tree, const PlacedCore& core, double reach_m, QueryMemory& memory,
                    WalkBudget& budget, LocalSurface& surface, ProofShare share,
                    std::uint32_t enough, ErrorCode tolerance) noexcept
{
    TACTUS_ASSERT(enough > 0);
    if (core.is_point())
    {
        gather_surface(tree, core.center(), reach_m, memory, budget, surface, share, tolerance);
        return;
    }
    if (is_beyond_kernels(core.center(), tree.quantum_m()))
    {
        gather_surface(tree, core.center(), reach_m, memory, budget, surface, share, tolerance);
        DistanceAnswer& answer = surface.answer;
        answer.lower_m = std::max(0.0, answer.lower_m - core.radius());
        answer.kind = answer.lower_m > reach_m ? AnswerKind::separated : AnswerKind::bounded;
        return;
    }
    TACTUS_ASSERT(!core.is_mesh());
    surface.center_m = core.center();
    CoreSearch search(tree, core, reach_m, share, enough, tolerance, budget, surface);
    search.run(memory);
    surface.answer = search.answer();
    surface.is_cut = surface.truncated || budget.is_spent;
}

} // namespace tactus
