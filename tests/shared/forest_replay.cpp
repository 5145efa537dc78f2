// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/forest_replay.hpp"

#include <algorithm>
#include <stdexcept>

namespace tactus::test
{

namespace
{

constexpr std::uint32_t kNoFace = Collapse::kNoFace;

/// Corner after `vertex` in the face.
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

std::vector<Corners> ForestReplay::active_corners() const
{
    std::vector<Corners> corners;
    for (const Face& face : faces_)
    {
        if (face.active)
        {
            corners.push_back(face.corners);
        }
    }
    return corners;
}

} // namespace tactus::test
