// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Vertex removal by half-edge collapse. A removal's move is the smaller of two bounds. The first
/// is the length of the edge, since moving the vertex along it moves each point by no more. The
/// second holds if the star before and after is a graph over one plane: both are piecewise linear
/// with the same border, so their largest vertical gap is at the removed vertex or where an edge
/// before crosses one after.

#include "host_tools/edit/merge_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <unordered_map>

namespace tactus
{

namespace
{

/// Rounds over all vertices; a later round finds what earlier removals made possible.
constexpr int kMergeRounds = 6;
/// Height below which a triangle's normal is rounding alone, and share of the slack below which it
/// is of no use.
constexpr double kSliverHeight_quanta = 2.0;
constexpr double kSliverShare = 0.5;
/// Largest number of faces round a vertex that is examined.
constexpr std::size_t kMaxMergedFan = 24;
/// Removals whose moves differ by less are chosen by shape.
constexpr double kMoveStep_quanta = 0.5;
/// Share of the slack from which on the gap at an edge is remembered.
constexpr double kMarkShare = 0.25;
/// Least cosine between the normals of a face before and after.
constexpr double kLeastNormalCosine = 0.5;

class PieceMerger
{
public:
    PieceMerger(std::vector<SurfaceFace>& faces, std::span<const GridPoint> fixed, double slack)
        : faces_(faces)
        , slack_(slack)
        , sliver_(std::max(kSliverHeight_quanta, kSliverShare * slack))
        , is_alive_(faces.size(), true)
    {
        std::unordered_map<GridPoint, std::uint32_t, GridPointHash> found;
        for (std::uint32_t face = 0; face < faces.size(); ++face)
        {
            std::array<std::uint32_t, 3> corners{};
            for (std::size_t i = 0; i < 3; ++i)
            {
                const GridPoint& at = faces[face].corners[i];
                const auto [place, is_new] =
                    found.try_emplace(at, static_cast<std::uint32_t>(points_.size()));
                if (is_new)
                {
                    points_.push_back(to_vec3(at));
                    stars_.emplace_back();
                }
                corners[i] = place->second;
                stars_[place->second].push_back(face);
            }
            corners_.push_back(corners);
        }
        is_fixed_.assign(points_.size(), false);
        for (const GridPoint& point : fixed)
        {
            const auto place = found.find(point);
            if (place != found.end())
            {
                is_fixed_[place->second] = true;
            }
        }
    }

    void run()
    {
        std::vector<bool> is_open(points_.size(), true);
        for (int round = 0; round < kMergeRounds; ++round)
        {
            std::size_t removed = 0;
            for (std::uint32_t vertex = 0; vertex < points_.size(); ++vertex)
            {
                if (is_open[vertex] && !is_fixed_[vertex])
                {
                    is_open[vertex] = false;
                    if (remove(vertex))
                    {
                        ++removed;
                        for (const std::uint32_t neighbour : ring_)
                        {
                            is_open[neighbour] = true;
                        }
                    }
                }
            }
            if (removed == 0)
            {
                break;
            }
        }
        std::size_t face = 0;
        std::erase_if(faces_, [&](const SurfaceFace&) { return !is_alive_[face++]; });
    }

private:
    struct Removal
    {
        std::size_t place{0}; ///< Place of the neighbour in the ring.
        double move{0.0};
        double shape{0.0};      ///< Least height of a face that remains.
        Vec3 up{0.0, 0.0, 0.0}; ///< Normal of a plane over which both stars are graphs, or zero.
    };

    /// Removes the vertex to the neighbour that costs least; false if none is allowed. Fills ring_.
    bool remove(std::uint32_t vertex)
    {
        if (!find_ring(vertex))
        {
            return false;
        }
        candidates_.clear();
        for (std::size_t i = 0; i < ring_.size(); ++i)
        {
            if (auto removal = removal_to(vertex, i))
            {
                candidates_.push_back(*std::move(removal));
            }
        }
        const auto is_better = [](const Removal& a, const Removal& b)
        {
            const double a_step = std::floor(a.move / kMoveStep_quanta);
            const double b_step = std::floor(b.move / kMoveStep_quanta);
            return a_step < b_step || (a_step == b_step && a.shape > b.shape);
        };
        std::stable_sort(candidates_.begin(), candidates_.end(), is_better);
        collect_marks(vertex);
        for (const Removal& removal : candidates_)
        {
            if (assign_marks(vertex, removal))
            {
                apply(vertex, removal);
                return true;
            }
        }
        return false;
    }

    /// The removed points of the vertex's faces, and the vertex.
    void collect_marks(std::uint32_t vertex)
    {
        marks_.clear();
        for (const std::uint32_t face : stars_[vertex])
        {
            marks_.insert(marks_.end(), faces_[face].marks.begin(), faces_[face].marks.end());
        }
        marks_.push_back(points_[vertex]);
        star_marks_ = marks_.size();
    }

    /// Finds the nearest face of the new fan for each mark and each crossing of the removal; false
    /// if one is farther than the slack.
    [[nodiscard]] bool assign_marks(std::uint32_t vertex, const Removal& removal)
    {
        const std::size_t size = ring_.size();
        marks_.resize(star_marks_);
        if (removal.up.norm() > 0.0)
        {
            gap_to(points_[vertex], removal.place, removal.up, &marks_);
        }
        fan_.clear();
        for (std::size_t i = 1; i + 1 < size; ++i)
        {
            fan_.push_back({points_[ring_[removal.place]],
                            points_[ring_[(removal.place + i) % size]],
                            points_[ring_[(removal.place + i + 1) % size]]});
        }
        owners_.clear();
        for (const Vec3& mark : marks_)
        {
            const auto [owner, distance_sq] = nearest_of(fan_, mark);
            if (distance_sq > slack_ * slack_)
            {
                return false;
            }
            owners_.push_back(owner);
        }
        return true;
    }

    /// The neighbours round a vertex, counter-clockwise; false unless its faces form one closed
    /// fan.
    bool find_ring(std::uint32_t vertex)
    {
        ring_.clear();
        const std::vector<std::uint32_t>& star = stars_[vertex];
        if (star.size() < 3 || star.size() > kMaxMergedFan)
        {
            return false;
        }
        pairs_.clear();
        for (const std::uint32_t face : star)
        {
            const auto& corners = corners_[face];
            const std::size_t at = corners[0] == vertex ? 0 : (corners[1] == vertex ? 1 : 2);
            pairs_.push_back({corners[(at + 1) % 3], corners[(at + 2) % 3]});
        }
        std::uint32_t next = pairs_[0][0];
        for (std::size_t i = 0; i < pairs_.size(); ++i)
        {
            const auto pair = std::find_if(pairs_.begin(), pairs_.end(),
                                           [&](const auto& p) { return p[0] == next; });
            if (pair == pairs_.end() || std::find(ring_.begin(), ring_.end(), next) != ring_.end())
            {
                return false;
            }
            ring_.push_back(next);
            next = (*pair)[1];
        }
        return next == ring_[0];
    }

    /// True if the only common neighbours of the vertex and its neighbour are those of their two
    /// faces, so that no two faces become one.
    [[nodiscard]] bool is_linked_once(std::uint32_t neighbour) const
    {
        std::size_t common = 0;
        scratch_.clear();
        for (const std::uint32_t face : stars_[neighbour])
        {
            for (const std::uint32_t corner : corners_[face])
            {
                if (std::find(scratch_.begin(), scratch_.end(), corner) == scratch_.end())
                {
                    scratch_.push_back(corner);
                    common += corner != neighbour &&
                              std::find(ring_.begin(), ring_.end(), corner) != ring_.end();
                }
            }
        }
        return common == 2;
    }

    [[nodiscard]] static double height_of(const Vec3& a, const Vec3& b, const Vec3& c)
    {
        const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
        return longest == 0.0 ? 0.0 : (b - a).cross(c - a).norm() / longest;
    }

    [[nodiscard]] std::optional<Removal> removal_to(std::uint32_t vertex, std::size_t target)
    {
        const std::size_t size = ring_.size();
        const Vec3& apex = points_[vertex];
        const Vec3& to = points_[ring_[target]];
        Removal removal{target, (to - apex).norm(), std::numeric_limits<double>::max()};
        Vec3 up(0.0, 0.0, 0.0);
        double old_height = std::numeric_limits<double>::max();
        for (std::size_t i = 0; i < size; ++i)
        {
            const Vec3& a = points_[ring_[i]];
            const Vec3& b = points_[ring_[(i + 1) % size]];
            up += (a - apex).cross(b - apex);
            old_height = std::min(old_height, height_of(apex, a, b));
        }
        if (up.norm() == 0.0)
        {
            return std::nullopt;
        }
        up.normalize();
        bool is_graph = true;
        for (std::size_t i = 0; i < size; ++i)
        {
            const Vec3& a = points_[ring_[i]];
            const Vec3& b = points_[ring_[(i + 1) % size]];
            const Vec3 before = (a - apex).cross(b - apex);
            const bool was_sliver = height_of(apex, a, b) < sliver_;
            is_graph &= was_sliver || before.dot(up) > 0.0;
            if (i == target || (i + 1) % size == target)
            {
                continue;
            }
            const Vec3 after = (a - to).cross(b - to);
            const double height = height_of(to, a, b);
            removal.shape = std::min(removal.shape, height);
            is_graph &= after.dot(up) > 0.0;
            if (!was_sliver &&
                !(after.dot(before) > kLeastNormalCosine * after.norm() * before.norm()))
            {
                return std::nullopt;
            }
        }
        if (removal.shape < std::min(sliver_, old_height))
        {
            return std::nullopt;
        }
        if (is_graph)
        {
            removal.up = up;
            removal.move = std::min(removal.move, gap_to(apex, target, up, nullptr));
        }
        if (removal.move > slack_ || !is_linked_once(ring_[target]))
        {
            return std::nullopt;
        }
        return removal;
    }

    /// Largest gap along `up` between the star of the apex and the fan from ring_[target]. Adds
    /// the points of the star's edges where it is wide to `wide`.
    double gap_to(const Vec3& apex, std::size_t target, const Vec3& up, std::vector<Vec3>* wide)
    {
        const std::size_t size = ring_.size();
        const Vec3 x = up.unitOrthogonal();
        const Vec3 y = up.cross(x);
        flat_.clear();
        for (const std::uint32_t vertex : ring_)
        {
            const Vec3 from_apex = points_[vertex] - apex;
            flat_.push_back({from_apex.dot(x), from_apex.dot(y), from_apex.dot(up)});
        }
        const std::array<double, 3>& t = flat_[target];
        double gap = 0.0;
        // Each edge of the new fan against each old spoke from the apex, which is the origin.
        for (std::size_t i = 2; i + 1 < size; ++i)
        {
            const std::array<double, 3>& e = flat_[(target + i) % size];
            for (const std::array<double, 3>& spoke : flat_)
            {
                const double dx = e[0] - t[0];
                const double dy = e[1] - t[1];
                const double turn = spoke[0] * dy - spoke[1] * dx;
                if (turn == 0.0)
                {
                    continue;
                }
                const double along_spoke = (t[0] * dy - t[1] * dx) / turn;
                const double along_edge = (t[0] * spoke[1] - t[1] * spoke[0]) / turn;
                if (along_spoke >= 0.0 && along_spoke <= 1.0 && along_edge >= 0.0 &&
                    along_edge <= 1.0)
                {
                    const double here =
                        std::abs(t[2] + along_edge * (e[2] - t[2]) - along_spoke * spoke[2]);
                    gap = std::max(gap, here);
                    if (wide != nullptr && here > kMarkShare * slack_)
                    {
                        wide->push_back(apex + along_spoke *
                                                   (spoke[0] * x + spoke[1] * y + spoke[2] * up));
                    }
                }
            }
        }
        // The apex against the new face below it.
        for (std::size_t i = 1; i + 1 < size; ++i)
        {
            const std::array<double, 3>& a = flat_[(target + i) % size];
            const std::array<double, 3>& b = flat_[(target + i + 1) % size];
            const double at = a[0] * b[1] - a[1] * b[0];
            const double aa = b[0] * t[1] - b[1] * t[0];
            const double ab = t[0] * a[1] - t[1] * a[0];
            const double sum = at + aa + ab;
            if (sum > 0.0 && at >= 0.0 && aa >= 0.0 && ab >= 0.0)
            {
                gap = std::max(gap, std::abs(at * t[2] + aa * a[2] + ab * b[2]) / sum);
            }
        }
        return gap;
    }

    void apply(std::uint32_t vertex, const Removal& removal)
    {
        const std::uint32_t target = ring_[removal.place];
        const std::size_t size = ring_.size();
        std::vector<std::uint32_t> star;
        star.swap(stars_[vertex]);
        std::vector<std::uint32_t> fan(size - 2);
        for (const std::uint32_t face : star)
        {
            auto& corners = corners_[face];
            const auto at = std::find(corners.begin(), corners.end(), vertex) - corners.begin();
            const auto place = static_cast<std::size_t>(at);
            const std::uint32_t next = corners[(place + 1) % 3];
            if (std::find(corners.begin(), corners.end(), target) != corners.end())
            {
                is_alive_[face] = false;
                for (const std::uint32_t corner : corners)
                {
                    std::erase(stars_[corner], face);
                }
                continue;
            }
            const auto in_ring = static_cast<std::size_t>(
                std::find(ring_.begin(), ring_.end(), next) - ring_.begin());
            fan[(in_ring + size - removal.place) % size - 1] = face;
            corners[place] = target;
            stars_[target].push_back(face);
            const Vec3& to = points_[target];
            faces_[face].corners[place] = {static_cast<std::int32_t>(to.x()),
                                           static_cast<std::int32_t>(to.y()),
                                           static_cast<std::int32_t>(to.z())};
            faces_[face].marks.clear();
        }
        for (std::size_t i = 0; i < marks_.size(); ++i)
        {
            faces_[fan[owners_[i]]].marks.push_back(marks_[i]);
        }
        for (const std::uint32_t face : fan)
        {
            thin_out(faces_[face]);
        }
    }

    /// Keeps the marks farthest from the face on each side, and of the others those farthest from
    /// each other.
    void thin_out(SurfaceFace& face)
    {
        std::vector<Vec3>& marks = face.marks;
        if (marks.size() <= kMaxMarks)
        {
            return;
        }
        const Vec3 base = to_vec3(face.corners[0]);
        const Vec3 normal =
            (to_vec3(face.corners[1]) - base).cross(to_vec3(face.corners[2]) - base);
        const auto height = [&](const Vec3& mark) { return normal.dot(mark - base); };
        const auto is_lower = [&](const Vec3& a, const Vec3& b) { return height(a) < height(b); };
        std::iter_swap(marks.begin(), std::min_element(marks.begin(), marks.end(), is_lower));
        std::iter_swap(marks.begin() + 1,
                       std::max_element(marks.begin() + 1, marks.end(), is_lower));
        gaps_.assign(marks.size(), std::numeric_limits<double>::max());
        for (std::size_t kept = 1; kept < kMaxMarks; ++kept)
        {
            std::size_t farthest = kept;
            for (std::size_t i = kept; i < marks.size(); ++i)
            {
                gaps_[i] = std::min(gaps_[i], (marks[i] - marks[kept - 1]).squaredNorm());
                farthest = gaps_[i] > gaps_[farthest] ? i : farthest;
            }
            if (kept > 1)
            {
                std::swap(marks[kept], marks[farthest]);
                std::swap(gaps_[kept], gaps_[farthest]);
            }
        }
        marks.resize(kMaxMarks);
    }

    std::vector<SurfaceFace>& faces_;
    double slack_;
    double sliver_; ///< Height of a triangle whose normal does not count.
    std::vector<Vec3> points_;
    std::vector<std::array<std::uint32_t, 3>> corners_; ///< Corners by face, as indices of points_.
    std::vector<std::vector<std::uint32_t>> stars_;     ///< Faces by point.
    std::vector<bool> is_alive_;                        ///< One entry a face.
    std::vector<bool> is_fixed_;                        ///< One entry a point.

    // Scratch.
    std::vector<std::uint32_t> ring_;
    std::vector<std::array<std::uint32_t, 2>> pairs_;
    std::vector<std::array<double, 3>> flat_;
    mutable std::vector<std::uint32_t> scratch_;
    std::vector<Removal> candidates_;
    std::vector<Vec3> marks_;
    std::size_t star_marks_{0};       ///< Marks of marks_ that don't depend on the removal.
    std::vector<std::size_t> owners_; ///< Face of the fan by mark.
    std::vector<Triangle> fan_;
    std::vector<double> gaps_;
};

} // namespace

std::pair<std::size_t, double> nearest_of(std::span<const Triangle> faces, const Vec3& point)
{
    std::pair<std::size_t, double> best{0, std::numeric_limits<double>::max()};
    for (std::size_t i = 0; i < faces.size(); ++i)
    {
        const double distance_sq = closest_point_on_triangle(point, faces[i]).distance_sq;
        best = distance_sq < best.second ? std::pair(i, distance_sq) : best;
    }
    return best;
}

void merge_pieces(std::vector<SurfaceFace>& faces, std::span<const GridPoint> fixed,
                  double slack_quanta)
{
    PieceMerger(faces, fixed, slack_quanta).run();
}

} // namespace tactus
