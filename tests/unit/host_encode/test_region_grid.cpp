// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/region_grid.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"

#include <gtest/gtest.h>

#include <bit>

namespace tactus
{

namespace
{

bool is_marked(const RegionGrid& grid, std::size_t region)
{
    return (static_cast<unsigned>(grid.occupied[region / 8]) >> (region % 8) & 1U) != 0;
}

/// True if the box of any face reaches into the cell, by trying every face.
bool is_touched(const RegionGrid& grid, const QuantisedMesh& mesh,
                const std::array<std::uint32_t, 3>& cell)
{
    for (const auto& face : mesh.faces)
    {
        bool touches = true;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const std::int64_t start = std::int64_t{cell[axis]} * grid.cell_quanta;
            const auto [low, high] =
                std::minmax({mesh.positions[face[0]][axis], mesh.positions[face[1]][axis],
                             mesh.positions[face[2]][axis]});
            touches = touches && high >= start && low < start + grid.cell_quanta;
        }
        if (touches)
        {
            return true;
        }
    }
    return false;
}

TEST(RegionGrid, marks_exactly_the_cells_that_the_box_of_a_face_touches)
{
    for (const auto& model : sample_models())
    {
        RegionGrid sut = make_region_grid(model->fields.extent_quanta,
                                          default_cell(model->fields.extent_quanta) * 2);
        mark_occupied(sut, model->prepared.mesh);
        std::uint32_t occupied = 0;
        std::size_t region = 0;
        for (std::uint32_t z = 0; z < sut.cells[2]; ++z)
        {
            for (std::uint32_t y = 0; y < sut.cells[1]; ++y)
            {
                for (std::uint32_t x = 0; x < sut.cells[0]; ++x, ++region)
                {
                    const bool touched = is_touched(sut, model->prepared.mesh, {x, y, z});
                    EXPECT_EQ(is_marked(sut, region), touched)
                        << model->name << ", cell " << x << " " << y << " " << z;
                    occupied += touched ? 1U : 0U;
                }
            }
        }
        EXPECT_EQ(sut.occupied_count, occupied) << model->name;
    }
}

TEST(RegionGrid, the_file_says_that_every_vertex_is_in_an_occupied_region)
{
    for (const auto& model : sample_models())
    {
        const ModelHeader& header = model->store->header();
        for (std::uint32_t vertex = 0; vertex < header.counts().vertices(); ++vertex)
        {
            const Vec3f& p = model->decoded->position_m({vertex});
            const RegionId region = header.region_at(
                {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
            EXPECT_TRUE(header.is_occupied(region)) << model->name << ", vertex " << vertex;
        }
    }
}

TEST(RegionGrid, cuts_the_longest_axis_into_9_to_16_cells)
{
    for (const std::uint32_t longest : {15U, 16U, 17U, 255U, 256U, 65'535U, 16'777'215U})
    {
        const std::uint32_t cell = default_cell({3, longest, 0});
        EXPECT_TRUE(std::has_single_bit(cell)) << longest;
        const std::uint32_t cells = make_region_grid({3, longest, 0}, cell).cells[1];
        EXPECT_LE(cells, 16U) << longest;
        EXPECT_GE(cells, 9U) << longest;
    }
}

} // namespace

} // namespace tactus
