// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/host_simplify/forest_replay.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace tactus::test
{

namespace
{

constexpr std::uint32_t kNoFace = Collapse::kNoFace;

/// The corner that follows `vertex` in the face.
std::uint32_t after(const Corners& corners, std::uint32_t vertex)
{
    const auto at = std::ranges::find(corners, vertex);
    if (at == corners.end())
    {
        throw std::logic_error("a star face lacks the vertex it should have");
    }
    return corners[static_cast<std::size_t>(at - corners.begin() + 1) % 3];
}

} // namespace

ForestReplay::ForestReplay(const Simplification& forest, std::size_t face_count)
    : forest_(forest)
    , faces_(face_count)
    , changes_(face_count)
    , done_(face_count, 0)
    , split_(forest.collapses.size(), 0)
{
    for (std::uint32_t i = 0; i < forest.collapses.size(); ++i)
    {
        for (const std::uint32_t face : forest.collapses[i].star)
        {
            if (face != kNoFace)
            {
                changes_[face].push_back(i);
                ++done_[face];
            }
        }
    }
    for (std::size_t i = 0; i < forest.base_faces.size(); ++i)
    {
        faces_[forest.base_faces[i]] = {true, forest.base_corners[i], forest.base_error[i]};
    }
}

void ForestReplay::split_with_closure(std::uint32_t collapse)
{
    std::vector<std::uint32_t> stack{collapse};
    while (!stack.empty())
    {
        const std::uint32_t top = stack.back();
        bool ready = true;
        for (const std::uint32_t face : forest_.collapses[top].star)
        {
            const bool waits =
                split_[top] == 0 && face != kNoFace && changes_[face][done_[face] - 1] != top;
            if (waits)
            {
                stack.push_back(changes_[face][done_[face] - 1]);
                ready = false;
            }
        }
        if (ready)
        {
            stack.pop_back();
            if (split_[top] == 0)
            {
                split(top);
            }
        }
    }
}

void ForestReplay::split_randomly(std::size_t count, std::mt19937& random)
{
    std::uniform_int_distribution<std::uint32_t> draw(
        0, static_cast<std::uint32_t>(forest_.collapses.size() - 1));
    while (split_count_ < std::min(count, forest_.collapses.size()))
    {
        split_with_closure(draw(random));
    }
}

void ForestReplay::split(std::uint32_t index)
{
    const Collapse& c = forest_.collapses[index];
    std::uint32_t first_rim = 0;
    std::uint32_t last_rim = 0;
    for (std::uint32_t i = 0; i < c.fan_size; ++i)
    {
        Face& face = faces_[c.star[2 + i]];
        if (!face.active || (i > 0 && after(face.corners, c.parent) != last_rim))
        {
            throw std::logic_error("a fan is not a chain of active faces round the parent");
        }
        const std::uint32_t rim = after(face.corners, c.parent);
        first_rim = i == 0 ? rim : first_rim;
        last_rim = after(face.corners, rim);
        std::ranges::replace(face.corners, c.parent, c.vertex);
        face.error = c.error[2 + i];
    }
    const std::array<Corners, 2> appearing{Corners{c.vertex, c.parent, first_rim},
                                           Corners{c.vertex, last_rim, c.parent}};
    for (std::size_t side = 0; side < 2; ++side)
    {
        if (c.star[side] != kNoFace)
        {
            faces_[c.star[side]] = {true, appearing[side], c.error[side]};
        }
    }
    for (const std::uint32_t face : c.star)
    {
        if (face != kNoFace)
        {
            --done_[face];
        }
    }
    split_[index] = 1;
    ++split_count_;
}

std::uint32_t ForestReplay::last_change(std::uint32_t face) const
{
    return done_[face] < changes_[face].size() ? changes_[face][done_[face]] : kNoFace;
}

std::string manifold_fault(const std::vector<ForestReplay::Face>& faces)
{
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>> links;
    for (const auto& face : faces)
    {
        for (std::size_t i = 0; face.active && i < 3; ++i)
        {
            const std::uint32_t a = face.corners[i];
            const std::uint32_t b = face.corners[(i + 1) % 3];
            if (a == b || !edges.emplace(a, b).second)
            {
                return "edge " + std::to_string(a) + " -> " + std::to_string(b) + " comes twice";
            }
            links[a][b] = face.corners[(i + 2) % 3];
        }
    }
    // The link of a vertex must be one path or one cycle.
    for (const auto& [vertex, link] : links)
    {
        std::set<std::uint32_t> ends;
        for (const auto& [from, to] : link)
        {
            ends.insert(to);
        }
        std::uint32_t at = link.begin()->first;
        for (const auto& [from, to] : link)
        {
            at = ends.contains(from) ? at : from;
        }
        std::size_t seen = 0;
        for (; seen < link.size() && link.contains(at); ++seen)
        {
            at = link.at(at);
        }
        if (seen != link.size() || ends.size() != link.size())
        {
            return "vertex " + std::to_string(vertex) + " has more than one fan";
        }
    }
    return {};
}

Corners turned(const Corners& corners)
{
    Corners result = corners;
    std::rotate(result.begin(), std::ranges::min_element(result), result.end());
    return result;
}

std::vector<LongPoint> sample_surface(const QuantisedMesh& mesh, unsigned per_face,
                                      std::mt19937& random)
{
    std::vector<LongPoint> points;
    for (const auto& p : mesh.positions)
    {
        points.push_back({static_cast<long double>(p[0]), static_cast<long double>(p[1]),
                          static_cast<long double>(p[2])});
    }
    std::uniform_real_distribution<long double> draw(0, 1);
    for (const auto& face : mesh.faces)
    {
        for (unsigned i = 0; i < per_face; ++i)
        {
            long double s = draw(random);
            long double t = draw(random);
            if (s + t > 1)
            {
                s = 1 - s;
                t = 1 - t;
            }
            LongPoint point{};
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const long double a = points[face[0]][axis];
                point[axis] = a + s * (points[face[1]][axis] - a) + t * (points[face[2]][axis] - a);
            }
            points.push_back(point);
        }
    }
    return points;
}

long double worst_violation(const QuantisedMesh& mesh, const std::vector<ForestReplay::Face>& faces,
                            const std::vector<LongPoint>& points, double factor)
{
    struct Convex
    {
        std::array<LongPoint, 3> corners;
        long double bound;
        LongPoint low;
        LongPoint high;
    };
    std::vector<Convex> convex;
    for (const auto& face : faces)
    {
        if (!face.active)
        {
            continue;
        }
        Convex c{};
        c.bound = static_cast<long double>(factor * static_cast<double>(face.error));
        for (std::size_t i = 0; i < 3; ++i)
        {
            const auto& p = mesh.positions[face.corners[i]];
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const auto value = static_cast<long double>(p[axis]);
                c.corners[i][axis] = value;
                c.low[axis] = i == 0 ? value : std::min(c.low[axis], value);
                c.high[axis] = i == 0 ? value : std::max(c.high[axis], value);
            }
        }
        convex.push_back(c);
    }
    long double worst = -1e30L;
    for (const LongPoint& point : points)
    {
        long double least = 1e30L;
        for (const Convex& c : convex)
        {
            long double off_box = 0;
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                off_box =
                    std::max({off_box, c.low[axis] - point[axis], point[axis] - c.high[axis]});
            }
            if (off_box - c.bound < least)
            {
                least = std::min(least, oracle_distance(point, c.corners) - c.bound);
            }
            if (least <= 0)
            {
                break;
            }
        }
        worst = std::max(worst, least);
        if (worst > kOracleTolerance)
        {
            return worst;
        }
    }
    return worst;
}

} // namespace tactus::test
