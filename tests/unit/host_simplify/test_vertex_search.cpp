// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/vertex_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <set>
#include <vector>

namespace tactus
{
namespace
{

std::vector<std::uint32_t> first_numbers(std::size_t count)
{
    std::vector<std::uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0U);
    return numbers;
}

TEST(VertexSearch, finds_the_nearest_first)
{
    QuantisedMesh mesh;
    for (std::int32_t i = 0; i < 100; ++i)
    {
        mesh.positions.push_back({i * i, 0, 0});
    }
    const auto vertices = first_numbers(mesh.positions.size());
    const VertexSearch sut(mesh, vertices);
    EXPECT_EQ(sut.place_count(), 100U);
    const auto found = sut.nearest(50);
    ASSERT_EQ(found.size(), 12U);
    EXPECT_EQ(found[0], 50U);
    EXPECT_EQ(found[1], 49U);
    EXPECT_EQ(found[2], 51U);
    EXPECT_EQ(found[11], 44U);
}

TEST(VertexSearch, has_one_place_for_all_vertices_at_one_position)
{
    QuantisedMesh mesh;
    for (std::int32_t i = 0; i < 8'000; ++i)
    {
        mesh.positions.push_back({0, 0, i % 2});
    }
    const auto vertices = first_numbers(mesh.positions.size());
    const VertexSearch sut(mesh, vertices);
    EXPECT_EQ(sut.place_count(), 2U);
    // Each vertex is found by some other one.
    std::set<std::uint32_t> all;
    for (const std::uint32_t vertex : vertices)
    {
        const auto found = sut.nearest(vertex);
        ASSERT_EQ(found.size(), 12U);
        for (std::size_t i = 0; i < found.size(); ++i)
        {
            EXPECT_EQ(found[i] % 2, vertex % 2) << "the other place is farther";
            all.insert(found[i]);
        }
        EXPECT_EQ(found[0], (vertex + 2) % 8'000);
    }
    EXPECT_EQ(all.size(), 8'000U);
}

TEST(VertexSearch, finds_fewer_where_there_are_fewer)
{
    QuantisedMesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 0}, {5, 0, 0}};
    const auto vertices = first_numbers(3);
    const VertexSearch sut(mesh, vertices);
    const auto found = sut.nearest(2);
    ASSERT_EQ(found.size(), 3U);
    EXPECT_EQ(found[0], 2U);
}

} // namespace
} // namespace tactus
