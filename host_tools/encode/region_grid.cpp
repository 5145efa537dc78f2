// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/region_grid.hpp"

#include <algorithm>
#include <bit>

namespace tactus
{

namespace
{

/// Counts the boxes that cover each cell: a box adds +1 or -1 at its eight corners, and running
/// sums along the three axes give the counts.
class CoverCounter
{
public:
    explicit CoverCounter(const std::array<std::uint32_t, 3>& cells)
        : sizes_{cells[0] + 1, cells[1] + 1, cells[2] + 1}
        , counts_(std::size_t{sizes_[0]} * sizes_[1] * sizes_[2])
    {
    }

    void add(const std::array<std::uint32_t, 3>& low, const std::array<std::uint32_t, 3>& end)
    {
        for (std::uint32_t corner = 0; corner < 8; ++corner)
        {
            const bool x = (corner & 1U) != 0;
            const bool y = (corner & 2U) != 0;
            const bool z = (corner & 4U) != 0;
            at(x ? end[0] : low[0], y ? end[1] : low[1], z ? end[2] : low[2]) +=
                std::popcount(corner) % 2 == 0 ? 1 : -1;
        }
    }

    void sum_up()
    {
        const std::array<std::size_t, 3> strides{1, sizes_[0], std::size_t{sizes_[0]} * sizes_[1]};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            for (std::size_t i = strides[axis]; i < counts_.size(); ++i)
            {
                if (i / strides[axis] % sizes_[axis] != 0)
                {
                    counts_[i] += counts_[i - strides[axis]];
                }
            }
        }
    }

    [[nodiscard]] std::int32_t& at(std::uint32_t x, std::uint32_t y, std::uint32_t z)
    {
        return counts_[(std::size_t{z} * sizes_[1] + y) * sizes_[0] + x];
    }

private:
    std::array<std::uint32_t, 3> sizes_;
    std::vector<std::int32_t> counts_;
};

void count_faces(CoverCounter& counter, const RegionGrid& grid, const QuantisedMesh& mesh)
{
    const auto shift = static_cast<unsigned>(std::countr_zero(grid.cell_quanta));
    for (const auto& corners : mesh.faces)
    {
        std::array<std::uint32_t, 3> low{};
        std::array<std::uint32_t, 3> end{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const auto [least, most] =
                std::minmax({mesh.positions[corners[0]][axis], mesh.positions[corners[1]][axis],
                             mesh.positions[corners[2]][axis]});
            low[axis] = static_cast<std::uint32_t>(least) >> shift;
            end[axis] = (static_cast<std::uint32_t>(most) >> shift) + 1;
        }
        counter.add(low, end);
    }
}

} // namespace

std::uint32_t default_cell(const std::array<std::uint32_t, 3>& extent_quanta)
{
    const std::uint32_t longest = *std::max_element(extent_quanta.begin(), extent_quanta.end());
    return std::bit_ceil(longest / 16 + 1);
}

RegionGrid make_region_grid(const std::array<std::uint32_t, 3>& extent_quanta,
                            std::uint32_t cell_quanta)
{
    RegionGrid grid;
    grid.cell_quanta = cell_quanta;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        grid.cells[axis] = extent_quanta[axis] / cell_quanta + 1;
    }
    return grid;
}

void mark_occupied(RegionGrid& grid, const QuantisedMesh& mesh)
{
    CoverCounter counter(grid.cells);
    count_faces(counter, grid, mesh);
    counter.sum_up();
    grid.occupied.assign((grid.count() + 7) / 8, std::byte{0});
    std::size_t region = 0;
    for (std::uint32_t z = 0; z < grid.cells[2]; ++z)
    {
        for (std::uint32_t y = 0; y < grid.cells[1]; ++y)
        {
            for (std::uint32_t x = 0; x < grid.cells[0]; ++x, ++region)
            {
                if (counter.at(x, y, z) > 0)
                {
                    grid.occupied[region / 8] |= std::byte{1} << (region % 8);
                    ++grid.occupied_count;
                }
            }
        }
    }
}

} // namespace tactus
