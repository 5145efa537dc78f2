// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/boundary_distance.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/geometry/closest_features.hpp"
#include "rt_core/geometry/face_filter.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/kernel_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tactus
{

namespace
{

/// Distance of edges, in local lengths, beyond which an error of kFilterMargin in a place changes
/// the distance only by its square.
constexpr double kFarApart = 1e-6;

enum class Kind : std::uint8_t
{
    corner_face, ///< Corner i of the first, face of the second.
    face_corner, ///< Face of the first, corner j of the second.
    edges,       ///< Edge i of the first, edge j of the second.
};

/// A pair of features and its distance in double.
struct Candidate
{
    Kind kind;
    std::uint32_t i;
    std::uint32_t j;
    /// Bit of this pair of features, so that edges that meet at one nearest corner are decided only
    /// once. 0 if double is not accurate enough to name the pair.
    std::uint64_t pair;
    double distance;
};

/// Search for the nearest boundary points: filters all pairs of features, then decides between
/// those that may be nearest.
class BoundaryDistance
{
public:
    BoundaryDistance(std::span<const Vec3> corners, const Triangle& triangle) noexcept
        : corners_(corners), triangle_(triangle), length_(local_length(corners, triangle))
    {
        TACTUS_ASSERT(corners.size() == 2 || corners.size() == 3);
    }

    ClosestPoints find() noexcept
    {
        filter_corners();
        filter_edges();
        for (const Candidate& candidate : candidates_)
        {
            if (may_be_nearest(candidate))
            {
                decide(candidate);
            }
        }
        TACTUS_ASSERT(best_.distance < kInfinity);
        best_.distance_error = kernel_error(0.0, length_);
        return best_;
    }

private:
    [[nodiscard]] Segment edge_of_first(std::size_t i) const noexcept
    {
        return {corners_[i], corners_[(i + 1) % corners_.size()]};
    }
    [[nodiscard]] Segment edge_of_second(std::size_t j) const noexcept
    {
        return {triangle_[j], triangle_[(j + 1) % 3]};
    }
    [[nodiscard]] Triangle first_triangle() const noexcept
    {
        return {corners_[0], corners_[1], corners_[2]};
    }

    void filter_corners() noexcept
    {
        const FaceFilter second(triangle_, length_);
        for (std::uint32_t i = 0; i < corners_.size(); ++i)
        {
            add_corner({Kind::corner_face, i, 0, 0, second.height_of(corners_[i])});
        }
        if (corners_.size() == 3)
        {
            const FaceFilter first(first_triangle(), length_);
            for (std::uint32_t j = 0; j < 3; ++j)
            {
                add_corner({Kind::face_corner, 0, j, 0, first.height_of(triangle_[j])});
            }
        }
    }

    /// Adds a corner over a face. It gives no upper bound, as it may still be beside the face.
    void add_corner(const Candidate& candidate) noexcept
    {
        if (candidate.distance < kInfinity)
        {
            candidates_.push_back(candidate);
        }
    }

    void filter_edges() noexcept
    {
        const std::uint32_t edges_of_first = corners_.size() == 2 ? 1 : 3;
        for (std::uint32_t i = 0; i < edges_of_first; ++i)
        {
            for (std::uint32_t j = 0; j < 3; ++j)
            {
                const auto at = approach_segments<double>(edge_of_first(i), edge_of_second(j));
                const double distance = std::sqrt(dot(at.gap, at.gap));
                const bool is_known = !at.is_parallel && distance > kFarApart * length_;
                upper_ = std::min(upper_, distance + kFilterMargin * length_);
                candidates_.push_back({Kind::edges, i, j,
                                       is_known ? pair_of(feature_of_edge(i, at.first_parameter),
                                                          feature_of_edge(j, at.second_parameter))
                                                : 0,
                                       distance});
            }
        }
    }

    static std::uint64_t pair_of(TriangleFeature first, TriangleFeature second) noexcept
    {
        return std::uint64_t{1} << (7 * static_cast<unsigned>(first) +
                                    static_cast<unsigned>(second));
    }

    [[nodiscard]] bool may_be_nearest(const Candidate& candidate) const noexcept
    {
        return candidate.distance - kFilterMargin * length_ <= std::min(upper_, best_.distance) &&
               (candidate.pair & separated_) == 0;
    }

    void decide(const Candidate& candidate) noexcept
    {
        separated_ |= candidate.pair;
        switch (candidate.kind)
        {
        case Kind::corner_face:
            if (const auto gap = approach_face<DoubleDouble>(corners_[candidate.i], triangle_))
            {
                keep_if_nearer(to_triple<DoubleDouble>(corners_[candidate.i]), *gap,
                               static_cast<TriangleFeature>(candidate.i),
                               TriangleFeature::interior);
            }
            return;
        case Kind::face_corner:
            if (const auto gap =
                    approach_face<DoubleDouble>(triangle_[candidate.j], first_triangle()))
            {
                keep_if_nearer(to_triple<DoubleDouble>(triangle_[candidate.j]) + *gap, -*gap,
                               TriangleFeature::interior,
                               static_cast<TriangleFeature>(candidate.j));
            }
            return;
        case Kind::edges:
            decide_edges(candidate.i, candidate.j);
            return;
        }
    }

    void decide_edges(std::size_t i, std::size_t j) noexcept
    {
        const Segment edge = edge_of_first(i);
        const auto at = approach_segments<DoubleDouble>(edge, edge_of_second(j));
        keep_if_nearer(to_triple<DoubleDouble>(edge.from) +
                           at.first_parameter * difference<DoubleDouble>(edge.to, edge.from),
                       at.gap, feature_of_edge(i, to_double(at.first_parameter)),
                       feature_of_edge(j, to_double(at.second_parameter)));
    }

    /// Keeps these points if they are nearer than the best so far; ties keep the earlier ones.
    void keep_if_nearer(const Triple<DoubleDouble>& from, const Triple<DoubleDouble>& gap,
                        TriangleFeature feature_of_first, TriangleFeature feature) noexcept
    {
        const DoubleDouble distance_sq = dot(gap, gap);
        if (distance_sq < best_sq_)
        {
            best_sq_ = distance_sq;
            best_.on_shape = to_vec3(from);
            best_.on_triangle = to_vec3(from + gap);
            best_.gap = to_vec3(gap);
            best_.distance = std::sqrt(distance_sq.high);
            best_.shape_feature = feature_of_first;
            best_.feature = feature;
        }
    }

    std::span<const Vec3> corners_;
    const Triangle& triangle_;
    double length_;
    double upper_{kInfinity};
    StaticVector<Candidate, 15> candidates_;
    std::uint64_t separated_{0}; ///< Bits of the pairs that were already decided.
    DoubleDouble best_sq_{kInfinity};
    ClosestPoints best_{.distance = kInfinity};
};

} // namespace

double local_length(std::span<const Vec3> corners, const Triangle& triangle) noexcept
{
    double longest_sq = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
        const Vec3& next = corners[(i + 1) % corners.size()];
        longest_sq = std::max(longest_sq, (next - corners[i]).squaredNorm());
        for (const Vec3& corner : triangle)
        {
            longest_sq = std::max(longest_sq, (corners[i] - corner).squaredNorm());
        }
    }
    for (std::size_t j = 0; j < 3; ++j)
    {
        longest_sq = std::max(longest_sq, (triangle[(j + 1) % 3] - triangle[j]).squaredNorm());
    }
    return std::sqrt(longest_sq);
}

ClosestPoints nearest_boundary_points(std::span<const Vec3> corners,
                                      const Triangle& triangle) noexcept
{
    return BoundaryDistance(corners, triangle).find();
}

} // namespace tactus
