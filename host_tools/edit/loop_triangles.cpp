// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Ear clipping. Each ear that is cut off leaves a loop whose edges, with those of the triangle,
/// sum to the edges of the loop before; so the triangles' edges always sum to the loops, and a
/// wrong choice costs only shape. Holes are joined to the loop around them by a pair of opposite
/// edges, which cancel.

#include "host_tools/edit/exact_shapes.hpp"
#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace tactus
{

namespace
{

/// Twice the area of a triangle; exact, since differences have at most 31 bits.
std::int64_t turn_of(const LoopCorner& a, const LoopCorner& b, const LoopCorner& c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

int sign_of(std::int64_t value)
{
    return (value > 0 ? 1 : 0) - (value < 0 ? 1 : 0);
}

double distance_sq(const LoopCorner& a, const LoopCorner& b)
{
    const auto x = static_cast<double>(a.x - b.x);
    const auto y = static_cast<double>(a.y - b.y);
    return x * x + y * y;
}

double area_of(const CornerLoop& loop)
{
    double twice = 0.0;
    for (std::size_t i = 1; i + 1 < loop.size(); ++i)
    {
        twice += static_cast<double>(turn_of(loop[0], loop[i], loop[i + 1]));
    }
    return twice / 2.0;
}

/// True if the open segments cross, or one touches the other's inner part.
bool cross(const LoopCorner& a, const LoopCorner& b, const LoopCorner& c, const LoopCorner& d)
{
    if (a.name == c.name || a.name == d.name || b.name == c.name || b.name == d.name)
    {
        return false;
    }
    return sign_of(turn_of(a, b, c)) * sign_of(turn_of(a, b, d)) <= 0 &&
           sign_of(turn_of(c, d, a)) * sign_of(turn_of(c, d, b)) <= 0;
}

bool contains(const CornerLoop& loop, const LoopCorner& point)
{
    bool is_inside = false;
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
        const LoopCorner& a = loop[i];
        const LoopCorner& b = loop[(i + 1) % loop.size()];
        if ((a.y > point.y) != (b.y > point.y))
        {
            const std::int64_t turn = turn_of(a, b, point);
            is_inside ^= b.y > a.y ? turn > 0 : turn < 0;
        }
    }
    return is_inside;
}

/// Drops corners that repeat the one before.
void drop_repeated(CornerLoop& loop)
{
    const auto same = [](const LoopCorner& a, const LoopCorner& b) { return a.name == b.name; };
    loop.erase(std::unique(loop.begin(), loop.end(), same), loop.end());
    while (loop.size() > 1 && same(loop.front(), loop.back()))
    {
        loop.pop_back();
    }
}

/// Joins a hole to a loop by the shortest edge that crosses neither.
void join(CornerLoop& outer, const CornerLoop& hole)
{
    const auto right = std::max_element(hole.begin(), hole.end(),
                                        [](const auto& a, const auto& b) { return a.x < b.x; });
    std::vector<std::size_t> order(outer.size());
    for (std::size_t i = 0; i < order.size(); ++i)
    {
        order[i] = i;
    }
    std::sort(order.begin(), order.end(),
              [&](std::size_t i, std::size_t k)
              { return distance_sq(outer[i], *right) < distance_sq(outer[k], *right); });
    const auto is_free = [&](std::size_t at)
    {
        const auto misses = [&](const CornerLoop& loop)
        {
            for (std::size_t i = 0; i < loop.size(); ++i)
            {
                if (cross(outer[at], *right, loop[i], loop[(i + 1) % loop.size()]))
                {
                    return false;
                }
            }
            return true;
        };
        return misses(outer) && misses(hole);
    };
    const auto free = std::find_if(order.begin(), order.end(), is_free);
    const std::size_t at = free == order.end() ? order.front() : *free;
    CornerLoop joined(outer.begin(), outer.begin() + static_cast<std::ptrdiff_t>(at) + 1);
    joined.insert(joined.end(), right, hole.end());
    joined.insert(joined.end(), hole.begin(), right + 1);
    joined.insert(joined.end(), outer.begin() + static_cast<std::ptrdiff_t>(at), outer.end());
    outer = std::move(joined);
}

/// A loop whose ears are cut off, the one of the best shape first.
class EarClipper
{
public:
    EarClipper(const CornerLoop& loop, std::vector<std::array<std::uint32_t, 3>>& triangles)
        : corners_(loop), triangles_(triangles)
    {
        for (std::size_t i = 0; i < corners_.size(); ++i)
        {
            costs_.push_back(cost_of(i));
        }
    }

    void clip_all()
    {
        while (corners_.size() > 3)
        {
            const auto best = std::min_element(costs_.begin(), costs_.end());
            clip(static_cast<std::size_t>(best - costs_.begin()));
        }
        if (corners_.size() == 3)
        {
            emit(corners_[0], corners_[1], corners_[2]);
        }
    }

private:
    static constexpr double kNoEar = std::numeric_limits<double>::max();

    [[nodiscard]] std::size_t before(std::size_t i) const
    {
        return i == 0 ? corners_.size() - 1 : i - 1;
    }
    [[nodiscard]] std::size_t after(std::size_t i) const
    {
        return i + 1 == corners_.size() ? 0 : i + 1;
    }

    /// Largest squared edge over area, so slim ears come last; a corner that is no ear after all
    /// ears, the one with the smallest area first.
    [[nodiscard]] double cost_of(std::size_t i) const
    {
        const LoopCorner& a = corners_[before(i)];
        const LoopCorner& b = corners_[i];
        const LoopCorner& c = corners_[after(i)];
        if (a.name == c.name)
        {
            return -1.0; // An edge there and back, which vanishes.
        }
        const std::int64_t turn = turn_of(a, b, c);
        const double size = std::abs(static_cast<double>(turn));
        if (turn <= 0 || !is_empty(a, b, c))
        {
            return kNoEar * 0.25 * (1.0 + size / (1.0 + size));
        }
        return std::max({distance_sq(a, b), distance_sq(b, c), distance_sq(c, a)}) / size;
    }

    [[nodiscard]] bool is_empty(const LoopCorner& a, const LoopCorner& b, const LoopCorner& c) const
    {
        return std::none_of(corners_.begin(), corners_.end(),
                            [&](const LoopCorner& p)
                            {
                                return p.name != a.name && p.name != b.name && p.name != c.name &&
                                       turn_of(a, b, p) >= 0 && turn_of(b, c, p) >= 0 &&
                                       turn_of(c, a, p) >= 0;
                            });
    }

    void clip(std::size_t i)
    {
        emit(corners_[before(i)], corners_[i], corners_[after(i)]);
        corners_.erase(corners_.begin() + static_cast<std::ptrdiff_t>(i));
        costs_.erase(costs_.begin() + static_cast<std::ptrdiff_t>(i));
        const std::size_t next = i == corners_.size() ? 0 : i;
        costs_[next] = cost_of(next);
        costs_[before(next)] = cost_of(before(next));
    }

    void emit(const LoopCorner& a, const LoopCorner& b, const LoopCorner& c)
    {
        if (a.name != b.name && b.name != c.name && c.name != a.name)
        {
            triangles_.push_back({a.name, b.name, c.name});
        }
    }

    CornerLoop corners_;
    std::vector<double> costs_;
    std::vector<std::array<std::uint32_t, 3>>& triangles_;
};

} // namespace

std::vector<std::array<std::uint32_t, 3>> triangles_of_loops(std::vector<CornerLoop> loops)
{
    std::vector<CornerLoop> outers;
    std::vector<CornerLoop> holes;
    for (CornerLoop& loop : loops)
    {
        drop_repeated(loop);
        if (loop.size() >= 3)
        {
            (area_of(loop) >= 0.0 ? outers : holes).push_back(std::move(loop));
        }
    }
    const auto rightmost = [](const CornerLoop& loop)
    {
        return std::max_element(loop.begin(), loop.end(),
                                [](const auto& a, const auto& b) { return a.x < b.x; })
            ->x;
    };
    std::stable_sort(holes.begin(), holes.end(),
                     [&](const CornerLoop& a, const CornerLoop& b)
                     { return rightmost(a) > rightmost(b); });
    std::stable_sort(outers.begin(), outers.end(),
                     [](const CornerLoop& a, const CornerLoop& b)
                     { return area_of(a) < area_of(b); });
    for (CornerLoop& hole : holes)
    {
        const auto around =
            std::find_if(outers.begin(), outers.end(),
                         [&](const CornerLoop& outer) { return contains(outer, hole.front()); });
        if (around != outers.end())
        {
            join(*around, hole);
        }
        else
        {
            outers.push_back(std::move(hole));
        }
    }
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const CornerLoop& outer : outers)
    {
        EarClipper(outer, triangles).clip_all();
    }
    return triangles;
}

} // namespace tactus
