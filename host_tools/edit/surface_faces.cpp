// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/edit/surface_faces.hpp"

#include "rt_core/base/assert.hpp"

#include <bit>

namespace tactus
{

SurfaceFaces::SurfaceFaces(std::uint32_t ids, std::uint32_t typical_size,
                           std::uint32_t typical_count)
    : faces_(ids)
    , next_(ids, kAbsent)
    , lists_(std::bit_ceil(std::max(typical_count, 256U)), kEnd)
    , least_level_(static_cast<std::uint32_t>(std::bit_width(typical_size)))
{
}

SurfaceFaces::Cell SurfaceFaces::cell_of(const SurfaceFace& face) const noexcept
{
    const GridBox box = box_of(face.corners);
    std::int32_t size = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        size = std::max(size, box.high[axis] - box.low[axis]);
    }
    Cell cell;
    cell.level = std::max(
        least_level_, static_cast<std::uint32_t>(std::bit_width(static_cast<std::uint32_t>(size))));
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        cell.at[axis] = box.low[axis] >> cell.level;
    }
    return cell;
}

std::size_t SurfaceFaces::list_of(const Cell& cell) const noexcept
{
    std::uint64_t hash = cell.level;
    for (const std::int32_t at : cell.at)
    {
        hash = (hash ^ static_cast<std::uint32_t>(at)) * 0x9E37'79B9'7F4A'7C15ULL;
        hash ^= hash >> 32U;
    }
    return static_cast<std::size_t>(hash) & (lists_.size() - 1);
}

void SurfaceFaces::add(std::uint32_t id, const SurfaceFace& face)
{
    TACTUS_ASSERT(!has(id));
    faces_[id] = face;
    const Cell cell = cell_of(face);
    std::uint32_t& first = lists_[list_of(cell)];
    next_[id] = first;
    first = id;
    ++level_counts_[cell.level];
    ++count_;
}

void SurfaceFaces::remove(std::uint32_t id)
{
    TACTUS_ASSERT(has(id));
    const Cell cell = cell_of(faces_[id]);
    std::uint32_t* link = &lists_[list_of(cell)];
    while (*link != id)
    {
        link = &next_[*link];
    }
    *link = next_[id];
    next_[id] = kAbsent;
    faces_[id] = {};
    --level_counts_[cell.level];
    --count_;
}

std::vector<std::uint32_t> SurfaceFaces::in_box(const GridBox& box) const
{
    std::vector<std::uint32_t> found;
    const auto visit = [&](std::size_t list, const Cell* cell)
    {
        for (std::uint32_t id = lists_[list]; id != kEnd; id = next_[id])
        {
            if ((cell == nullptr || cell_of(faces_[id]) == *cell) &&
                box_of(faces_[id].corners).meets(box))
            {
                found.push_back(id);
            }
        }
    };
    std::array<std::array<std::int32_t, 2>, 3> range{};
    std::uint64_t cells = 0;
    const auto set_range = [&](std::uint32_t level)
    {
        std::uint64_t of_level = 1;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const std::int64_t least = std::int64_t{box.low[axis]} - (std::int64_t{1} << level);
            range[axis] = {static_cast<std::int32_t>(least >> level), box.high[axis] >> level};
            of_level *= static_cast<std::uint64_t>(range[axis][1] - range[axis][0] + 1);
        }
        return of_level;
    };
    for (std::uint32_t level = least_level_; level < level_counts_.size(); ++level)
    {
        cells += level_counts_[level] == 0 ? 0 : set_range(level);
    }
    if (cells > lists_.size() + count_)
    {
        for (std::size_t list = 0; list < lists_.size(); ++list)
        {
            visit(list, nullptr);
        }
    }
    for (std::uint32_t level = least_level_;
         level < level_counts_.size() && cells <= lists_.size() + count_; ++level)
    {
        if (level_counts_[level] == 0)
        {
            continue;
        }
        set_range(level);
        for (std::int32_t x = range[0][0]; x <= range[0][1]; ++x)
        {
            for (std::int32_t y = range[1][0]; y <= range[1][1]; ++y)
            {
                for (std::int32_t z = range[2][0]; z <= range[2][1]; ++z)
                {
                    const Cell cell{level, {x, y, z}};
                    visit(list_of(cell), &cell);
                }
            }
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

} // namespace tactus
