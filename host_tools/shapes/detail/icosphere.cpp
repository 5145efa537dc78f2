// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/detail/surfaces.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace tactus::detail
{

namespace
{

using Point = std::array<double, 3>;

/// Point a x wa + b x wb + c x wc, projected onto the unit sphere.
Point blend(const Point& a, double wa, const Point& b, double wb, const Point& c, double wc)
{
    Point p{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        p[axis] = a[axis] * wa + b[axis] * wb + c[axis] * wc;
    }
    const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    return {p[0] / length, p[1] / length, p[2] / length};
}

double determinant(const Point& a, const Point& b, const Point& c)
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

class Icosphere
{
public:
    explicit Icosphere(std::uint32_t n) : n_(n) {}

    TriangleMesh make()
    {
        mesh_.positions.reserve(std::size_t{10} * n_ * n_ + 2);
        mesh_.faces.reserve(std::size_t{20} * n_ * n_);
        add_corners();
        add_edges();
        for (std::uint32_t a = 0; a < 12; ++a)
        {
            for (std::uint32_t b = a + 1; b < 12; ++b)
            {
                for (std::uint32_t c = b + 1; c < 12; ++c)
                {
                    if (is_edge(a, b) && is_edge(b, c) && is_edge(c, a))
                    {
                        add_side(a, b, c);
                    }
                }
            }
        }
        return std::move(mesh_);
    }

private:
    /// Adds the cyclic permutations of (0, +-1, +-golden ratio).
    void add_corners()
    {
        const double golden = 0.5 * (1.0 + std::sqrt(5.0));
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            for (const double one : {-1.0, 1.0})
            {
                for (const double g : {-golden, golden})
                {
                    Point p{};
                    p[(axis + 1) % 3] = one;
                    p[(axis + 2) % 3] = g;
                    mesh_.positions.push_back(blend(p, 1.0, p, 0.0, p, 0.0));
                }
            }
        }
    }

    /// True for neighbours, which are 63 degrees apart; all others are 116 or more.
    [[nodiscard]] bool is_edge(std::uint32_t a, std::uint32_t b) const
    {
        const Point& p = mesh_.positions[a];
        const Point& q = mesh_.positions[b];
        return a != b && p[0] * q[0] + p[1] * q[1] + p[2] * q[2] > 0.0;
    }

    void add_edges()
    {
        for (std::uint32_t a = 0; a < 12; ++a)
        {
            for (std::uint32_t b = a + 1; b < 12; ++b)
            {
                if (!is_edge(a, b))
                {
                    continue;
                }
                edge_start_[a][b] = static_cast<std::uint32_t>(mesh_.positions.size());
                for (std::uint32_t i = 1; i < n_; ++i)
                {
                    add_blend(a, b, a, i, 0);
                }
            }
        }
    }

    void add_blend(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t i,
                   std::uint32_t j)
    {
        const auto& p = mesh_.positions;
        mesh_.positions.push_back(blend(p[a], static_cast<double>(n_ - i - j), p[b],
                                        static_cast<double>(i), p[c], static_cast<double>(j)));
    }

    /// Vertex `i` steps from a towards b.
    [[nodiscard]] std::uint32_t on_edge(std::uint32_t a, std::uint32_t b, std::uint32_t i) const
    {
        if (i == 0 || i == n_)
        {
            return i == 0 ? a : b;
        }
        return a < b ? edge_start_[a][b] + i - 1 : edge_start_[b][a] + (n_ - i) - 1;
    }

    /// Adds one side; its vertex (i, j) lies i steps towards b and j steps towards c.
    void add_side(std::uint32_t a, std::uint32_t b, std::uint32_t c)
    {
        if (determinant(mesh_.positions[a], mesh_.positions[b], mesh_.positions[c]) < 0.0)
        {
            std::swap(b, c);
        }
        const auto inside = static_cast<std::uint32_t>(mesh_.positions.size());
        for (std::uint32_t j = 1; j + 1 < n_; ++j)
        {
            for (std::uint32_t i = 1; i + j < n_; ++i)
            {
                add_blend(a, b, c, i, j);
            }
        }
        const auto vertex = [&](std::uint32_t i, std::uint32_t j)
        {
            if (j == 0 || i == 0)
            {
                return j == 0 ? on_edge(a, b, i) : on_edge(a, c, j);
            }
            // Row j inside has n - 1 - j vertices.
            return i + j == n_ ? on_edge(b, c, j)
                               : inside + (j - 1) * (n_ - 1) - (j - 1) * j / 2 + i - 1;
        };
        for (std::uint32_t j = 0; j < n_; ++j)
        {
            for (std::uint32_t i = 0; i + j < n_; ++i)
            {
                mesh_.faces.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
                if (i + j + 1 < n_)
                {
                    mesh_.faces.push_back(
                        {vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
                }
            }
        }
    }

    std::uint32_t n_;
    TriangleMesh mesh_;
    std::array<std::array<std::uint32_t, 12>, 12> edge_start_{};
};

} // namespace

TriangleMesh make_icosphere(std::uint32_t n)
{
    return Icosphere(n).make();
}

} // namespace tactus::detail
