// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/candidates.hpp"

#include "host_tools/mesh/mesh_places.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/math/vec3.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace tactus
{

namespace
{

/// The memoryless quadric of a vertex: area-weighted squared distance to the planes of its
/// *present* faces. Ignoring removed faces beats accumulating them by a fifth in RMS error, and
/// needs no memory between rounds.
class PlaneQuadric
{
public:
    PlaneQuadric(const QuantisedMesh& mesh, const VertexRing& ring) noexcept;

    /// Cost of moving the vertex to `point`, in quanta^4. Faces without area have no plane and do
    /// not count.
    [[nodiscard]] double at(const Vec3& point) const noexcept;

private:
    Vec3 vertex_;
    /// Unit normals times the root of the area.
    StaticVector<Vec3, kMaxStarFaces> planes_;
};

PlaneQuadric::PlaneQuadric(const QuantisedMesh& mesh, const VertexRing& ring) noexcept
    : vertex_(grid_point(mesh, ring.vertex))
{
    Vec3 spoke = grid_point(mesh, ring.neighbours[0]) - vertex_;
    for (std::uint32_t i = 0; i < ring.face_count; ++i)
    {
        const Vec3 next_spoke = grid_point(mesh, ring.neighbours[i + 1]) - vertex_;
        const Vec3 normal = spoke.cross(next_spoke);
        const double double_area = normal.norm();
        if (double_area > 0)
        {
            planes_.push_back(normal * std::sqrt(0.5 / double_area));
        }
        spoke = next_spoke;
    }
}

double PlaneQuadric::at(const Vec3& point) const noexcept
{
    const Vec3 offset = point - vertex_;
    double sum = 0;
    for (const Vec3& plane : planes_)
    {
        const double distance = plane.dot(offset);
        sum += distance * distance;
    }
    return sum;
}

/// Factor of the fourth power of the collapsed edge's length. This cost decides between equal
/// costs, mainly on flat regions.
constexpr double kLengthWeight = 1e-6;
/// Share of the quadric in the measured cost. The quadric prevents bridges between sheets that the
/// samples miss.
constexpr double kQuadricShare = 0.1;
/// Maximum number of neighbours whose error is measured; more give no gain.
constexpr std::size_t kMeasuredMax = 6;

struct Choice
{
    double quadric{0};
    double upkeep{0}; ///< Boundary and length terms.
    std::uint32_t place{0};
    Spoils spoils{Spoils::nothing};

    [[nodiscard]] double cost() const noexcept { return quadric + upkeep; }
};

using Choices = StaticVector<Choice, kMaxStarFaces>;

/// All collapses of the vertex, cheapest first by quadric, boundary and length; equal costs stay in
/// ring order.
Choices rank_neighbours(const CandidateInput& input, const VertexRing& ring)
{
    const PlaneQuadric quadric(input.mesh, ring);
    const Vec3 vertex = grid_point(input.mesh, ring.vertex);
    Choices choices;
    for (std::uint32_t place = 0; place < ring.place_count(); ++place)
    {
        const Vec3 parent = grid_point(input.mesh, ring.parent_at(place));
        const double squared_length = (parent - vertex).squaredNorm();
        const double upkeep = input.boundary.at(ring.vertex, parent) +
                              kLengthWeight * squared_length * squared_length;
        choices.push_back({quadric.at(parent), upkeep, place, Spoils::nothing});
        for (std::size_t i = choices.size() - 1; i > 0 && choices[i].cost() < choices[i - 1].cost();
             --i)
        {
            std::swap(choices[i], choices[i - 1]);
        }
    }
    return choices;
}

/// The legal choices of the least spoiling level, at most `count_max`, cheapest first.
Choices keep_least_spoiling(const CandidateInput& input, const VertexRing& ring,
                            const Choices& ranked, std::size_t count_max)
{
    Choices kept;
    for (Choice choice : ranked)
    {
        const Star star = star_at(ring, choice.place);
        if (!input.current.is_legal(star))
        {
            continue;
        }
        choice.spoils = spoils(input.mesh, star);
        if (!kept.empty() && choice.spoils < kept[0].spoils)
        {
            kept.clear();
        }
        if (kept.size() < count_max && (kept.empty() || choice.spoils == kept[0].spoils))
        {
            kept.push_back(choice);
        }
        if (kept.size() == count_max && kept[0].spoils == Spoils::nothing)
        {
            break;
        }
    }
    return kept;
}

/// Area-weighted squared distance of the sampled original surface to the new fan. Stops early, with
/// a value above the limit, once it exceeds the limit.
double measure(const CandidateInput& input, const Star& star, double limit,
               CandidateScratch& scratch)
{
    const StarSamples& sample = scratch.samples;
    scratch.nearest.assign(sample.points.size(), std::numeric_limits<double>::max());
    scratch.squared.resize(sample.points.size());
    const Vec3 parent = grid_point(input.mesh, star.parent);
    for (std::uint32_t i = 0; i < star.fan_size; ++i)
    {
        const DistanceTriangle face(parent, grid_point(input.mesh, star.rim[i]),
                                    grid_point(input.mesh, star.rim[i + 1]));
        face.squared_distances(sample.points, 0, scratch.squared.data());
        for (std::size_t p = 0; p < scratch.nearest.size(); ++p)
        {
            scratch.nearest[p] = std::min(scratch.nearest[p], scratch.squared[p]);
        }
    }
    double sum = 0;
    for (std::size_t p = 0; p < scratch.nearest.size() && sum <= limit; ++p)
    {
        sum += sample.areas[p] * scratch.nearest[p];
    }
    return sum;
}

Candidate take_least_measured(const CandidateInput& input, const VertexRing& ring,
                              const Choices& choices, CandidateScratch& scratch)
{
    input.samples.gather(std::span{ring.faces}.first(ring.face_count), scratch.samples);
    Candidate best{std::numeric_limits<double>::max(), ring.vertex, Candidate::kNone,
                   choices[0].spoils};
    for (const Choice& choice : choices)
    {
        const double known = kQuadricShare * choice.quadric + choice.upkeep;
        if (known >= best.cost)
        {
            continue;
        }
        const Star star = star_at(ring, choice.place);
        const double cost = known + measure(input, star, best.cost - known, scratch);
        if (cost < best.cost)
        {
            best.cost = cost;
            best.parent = star.parent;
        }
    }
    return best;
}

} // namespace

Candidate find_candidate(const CandidateInput& input, std::uint32_t vertex,
                         CandidateScratch& scratch)
{
    VertexRing ring;
    const Candidate none{0, vertex, Candidate::kNone, Spoils::nothing};
    if (!input.current.gather_ring(vertex, ring))
    {
        return none;
    }
    const bool measured = input.priority == Priority::measured;
    const Choices choices =
        keep_least_spoiling(input, ring, rank_neighbours(input, ring), measured ? kMeasuredMax : 1);
    if (choices.empty())
    {
        return none;
    }
    if (measured)
    {
        return take_least_measured(input, ring, choices, scratch);
    }
    return {choices[0].cost(), vertex, ring.parent_at(choices[0].place), choices[0].spoils};
}

namespace
{

/// Least cosine of the angle between a face's normals before and after a collapse; below it, the
/// collapse is a fold.
constexpr double kLeastTurnCosine = 0.2;
/// Limit of double area over the sum of squared sides, which is 0.289 for an equilateral triangle.
/// Below it a face is thin, about one in nine.
constexpr double kThin = 0.1;

struct Shape
{
    Vec3 normal; ///< Normal; its length is twice the area.
    double double_area;
    double roundness;
};

Shape shape_of(const Vec3& apex, const Vec3& left, const Vec3& right) noexcept
{
    const Vec3 to_left = left - apex;
    const Vec3 to_right = right - apex;
    const Vec3 normal = to_left.cross(to_right);
    const double double_area = normal.norm();
    const double sides =
        to_left.squaredNorm() + to_right.squaredNorm() + (right - left).squaredNorm();
    return {normal, double_area, sides > 0 ? double_area / sides : 0};
}

Spoils compare(const Shape& before, const Shape& after) noexcept
{
    if (before.double_area <= 0)
    {
        return Spoils::nothing;
    }
    const double turn = before.normal.dot(after.normal);
    if (after.double_area <= 0 || turn < 0)
    {
        return Spoils::face;
    }
    if (turn < kLeastTurnCosine * before.double_area * after.double_area)
    {
        return Spoils::fold;
    }
    const bool thin = after.roundness < kThin && 2 * after.roundness < before.roundness;
    return thin ? Spoils::thinness : Spoils::nothing;
}

} // namespace

Spoils spoils(const QuantisedMesh& mesh, const Star& star) noexcept
{
    const Vec3 from = grid_point(mesh, star.vertex);
    const Vec3 to = grid_point(mesh, star.parent);
    Spoils worst = Spoils::nothing;
    Vec3 left = grid_point(mesh, star.rim[0]);
    for (std::uint32_t i = 0; i < star.fan_size; ++i)
    {
        const Vec3 right = grid_point(mesh, star.rim[i + 1]);
        worst = std::max(worst, compare(shape_of(from, left, right), shape_of(to, left, right)));
        left = right;
    }
    return worst;
}

} // namespace tactus
