// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/golden/golden_model.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace tactus
{

namespace
{

using Point = std::array<std::int32_t, 3>;
using Corners = std::array<std::uint32_t, 3>;

std::int64_t integer_root(std::int64_t square)
{
    std::int64_t root = 0;
    for (std::int64_t bit = std::int64_t{1} << 20; bit > 0; bit /= 2)
    {
        root += (root + bit) * (root + bit) <= square ? bit : 0;
    }
    return root;
}

/// Moves a point to a radius that depends on its direction, so that no two regions are alike.
Point push_out(const Point& p)
{
    std::int64_t square = 0;
    for (const std::int32_t x : p)
    {
        square += std::int64_t{x} * x;
    }
    const std::int64_t length = integer_root(square);
    Point unit{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        unit[axis] = static_cast<std::int32_t>(std::int64_t{p[axis]} * 1000 / length);
    }
    const std::int64_t radius = 28'000 + (unit[0] * 7 + unit[1] * 13 + unit[2] * 29) % 1'500;
    Point out{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        out[axis] = static_cast<std::int32_t>(p[axis] * radius / length);
    }
    return out;
}

/// Splits every face into four.
QuantisedMesh subdivide(const QuantisedMesh& mesh)
{
    QuantisedMesh finer;
    finer.positions = mesh.positions;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle_of = [&](std::uint32_t a, std::uint32_t b)
    {
        const auto [at, is_new] = middles.try_emplace(
            std::minmax(a, b), static_cast<std::uint32_t>(finer.positions.size()));
        if (is_new)
        {
            Point middle{};
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                middle[axis] = (mesh.positions[a][axis] + mesh.positions[b][axis]) / 2;
            }
            finer.positions.push_back(push_out(middle));
        }
        return at->second;
    };
    for (const auto& [a, b, c] : mesh.faces)
    {
        const std::uint32_t ab = middle_of(a, b);
        const std::uint32_t bc = middle_of(b, c);
        const std::uint32_t ca = middle_of(c, a);
        finer.faces.insert(finer.faces.end(), {Corners{a, ab, ca}, Corners{ab, b, bc},
                                               Corners{ca, bc, c}, Corners{ab, bc, ca}});
    }
    return finer;
}

/// Mesh during its collapse; a removed face has three equal corners.
class PlainCollapser
{
public:
    PlainCollapser(const QuantisedMesh& mesh, std::size_t base_faces)
        : positions_(mesh.positions)
        , corners_(mesh.faces)
        , error_(mesh.faces.size(), 0.0)
        , faces_left_(mesh.faces.size())
        , goal_(base_faces)
    {
    }

    Simplification run()
    {
        for (bool any = true; any && faces_left_ > goal_;)
        {
            any = run_round();
        }
        for (std::uint32_t face = 0; face < corners_.size(); ++face)
        {
            if (is_left(face))
            {
                result_.base_faces.push_back(face);
                result_.base_corners.push_back(corners_[face]);
                result_.base_error.push_back(static_cast<float>(error_[face]));
            }
        }
        return std::move(result_);
    }

private:
    /// Map from each neighbour of a vertex to the next one counter-clockwise and the face between
    /// them.
    using Ring = std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>>;

    bool is_left(std::uint32_t face) const { return corners_[face][0] != corners_[face][1]; }

    std::map<std::uint32_t, Ring> find_rings() const
    {
        std::map<std::uint32_t, Ring> rings;
        for (std::uint32_t face = 0; face < corners_.size(); ++face)
        {
            for (std::size_t i = 0; is_left(face) && i < 3; ++i)
            {
                rings[corners_[face][i]][corners_[face][(i + 1) % 3]] = {
                    corners_[face][(i + 2) % 3], face};
            }
        }
        return rings;
    }

    bool run_round()
    {
        const std::size_t before = result_.collapses.size();
        const std::map<std::uint32_t, Ring> rings = find_rings();
        std::set<std::uint32_t> locked;
        for (const auto& [vertex, ring] : rings)
        {
            const bool is_free =
                locked.count(vertex) == 0 &&
                std::none_of(ring.begin(), ring.end(),
                             [&](const auto& entry) { return locked.count(entry.first) != 0; });
            if (faces_left_ > goal_ && is_free && ring.size() <= kMaxStarFaces)
            {
                try_neighbours(vertex, ring, rings, locked);
            }
        }
        result_.rounds += result_.collapses.size() > before ? 1U : 0U;
        return result_.collapses.size() > before;
    }

    void try_neighbours(std::uint32_t vertex, const Ring& ring,
                        const std::map<std::uint32_t, Ring>& rings, std::set<std::uint32_t>& locked)
    {
        for (const auto& [parent, next] : ring)
        {
            const Ring& other = rings.at(parent);
            const auto shared =
                std::count_if(ring.begin(), ring.end(),
                              [&](const auto& entry) { return other.count(entry.first) != 0; });
            if (shared == 2 && ring.size() >= 3 && other.size() + ring.size() <= 14)
            {
                collapse(vertex, parent, ring);
                locked.insert(vertex);
                for (const auto& [neighbour, unused] : ring)
                {
                    locked.insert(neighbour);
                }
                return;
            }
        }
    }

    void collapse(std::uint32_t vertex, std::uint32_t parent, const Ring& ring)
    {
        Collapse collapse;
        collapse.vertex = vertex;
        collapse.parent = parent;
        collapse.round = result_.rounds;
        collapse.star[0] = ring.at(parent).second;
        std::uint32_t at = ring.at(parent).first;
        for (; ring.at(at).first != parent; at = ring.at(at).first)
        {
            collapse.star[2 + collapse.fan_size++] = ring.at(at).second;
        }
        collapse.star[1] = ring.at(at).second;
        double bound = 0.0;
        for (std::size_t place = 0; place < 2 + collapse.fan_size; ++place)
        {
            const double error = error_[collapse.star[place]];
            collapse.error[place] = static_cast<float>(error);
            bound = std::max(bound, error);
        }
        bound += distance(positions_[vertex], positions_[parent]);
        corners_[collapse.star[0]] = corners_[collapse.star[1]] = {0, 0, 0};
        for (std::size_t i = 0; i < collapse.fan_size; ++i)
        {
            Corners& corners = corners_[collapse.star[2 + i]];
            std::replace(corners.begin(), corners.end(), vertex, parent);
            error_[collapse.star[2 + i]] = bound;
        }
        faces_left_ -= 2;
        result_.collapses.push_back(collapse);
    }

    static double distance(const Point& a, const Point& b)
    {
        double square = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const double d = a[axis] - b[axis];
            square += d * d;
        }
        return std::sqrt(square);
    }

    std::vector<Point> positions_;
    std::vector<Corners> corners_;
    std::vector<double> error_;
    std::size_t faces_left_;
    std::size_t goal_;
    Simplification result_;
};

} // namespace

PreparedMesh make_golden_mesh()
{
    constexpr std::int32_t kRadius = 28'000;
    QuantisedMesh mesh;
    mesh.positions = {{kRadius, 0, 0},  {0, kRadius, 0},  {0, 0, kRadius},
                      {-kRadius, 0, 0}, {0, -kRadius, 0}, {0, 0, -kRadius}};
    mesh.faces = {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2},
                  {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
    mesh = subdivide(subdivide(subdivide(mesh)));
    Point low = mesh.positions.front();
    for (const Point& position : mesh.positions)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            low[axis] = std::min(low[axis], position[axis]);
        }
    }
    for (Point& position : mesh.positions)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            position[axis] -= low[axis];
        }
    }
    PreparedMesh prepared;
    prepared.mesh = std::move(mesh);
    prepared.quantum_m = 0x1p-19;
    prepared.origin_m = {0.25, -0.5, 1.0};
    prepared.quantisation_m = 0x1p-20;
    prepared.diagonal_m = 0.185;
    return prepared;
}

Simplification collapse_plainly(const QuantisedMesh& mesh, std::size_t base_faces)
{
    return PlainCollapser(mesh, base_faces).run();
}

} // namespace tactus
