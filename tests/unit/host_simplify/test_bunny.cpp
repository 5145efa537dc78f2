// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
// A scanned mesh with holes; only where TACTUS_MESHES names the folder that holds it.
#include "tests/unit/host_simplify/forest_replay.hpp"
#include "tests/unit/host_simplify/small_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace tactus::test
{

namespace
{

void drop_unused(QuantisedMesh& mesh, std::vector<std::array<double, 3>>& points)
{
    constexpr std::uint32_t kUnnamed = 0xFFFF'FFFFU;
    std::vector<std::uint32_t> names(points.size(), kUnnamed);
    std::vector<std::array<double, 3>> used;
    for (auto& face : mesh.faces)
    {
        for (auto& corner : face)
        {
            if (names[corner] == kUnnamed)
            {
                names[corner] = static_cast<std::uint32_t>(used.size());
                used.push_back(points[corner]);
            }
            corner = names[corner];
        }
    }
    points = used;
}

/// Used positions and the triangles of a plain OBJ file, on a grid of 16 bits.
QuantisedMesh read_plain_obj(const std::string& path)
{
    std::ifstream file(path);
    std::vector<std::array<double, 3>> points;
    QuantisedMesh mesh;
    for (std::string line; std::getline(file, line);)
    {
        std::istringstream words(line.substr(std::min<std::size_t>(line.size(), 2)));
        if (line.starts_with("v "))
        {
            std::array<double, 3> p{};
            words >> p[0] >> p[1] >> p[2];
            points.push_back(p);
        }
        else if (line.starts_with("f "))
        {
            std::array<std::uint32_t, 3> corners{};
            for (auto& corner : corners)
            {
                std::string word;
                words >> word;
                corner = static_cast<std::uint32_t>(std::stoul(word)) - 1;
            }
            mesh.faces.push_back(corners);
        }
    }
    drop_unused(mesh, points);
    std::array<double, 3> low{1e30, 1e30, 1e30};
    double extent = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const auto by_axis = [=](const auto& p) { return p[axis]; };
        low[axis] = std::ranges::min(points, {}, by_axis)[axis];
        extent = std::max(extent, std::ranges::max(points, {}, by_axis)[axis] - low[axis]);
    }
    for (const auto& p : points)
    {
        std::array<std::int32_t, 3> q{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            q[axis] =
                static_cast<std::int32_t>(std::lround((p[axis] - low[axis]) / extent * 65'535));
        }
        mesh.positions.push_back(q);
    }
    return mesh;
}

} // namespace

TEST(Bunny, is_certified_soundly_and_tightly_in_few_rounds)
{
    const char* folder = std::getenv("TACTUS_MESHES");
    if (folder == nullptr)
    {
        GTEST_SKIP() << "TACTUS_MESHES is not set";
    }
    const QuantisedMesh mesh = read_plain_obj(std::string(folder) + "/stanford-bunny.obj");
    const Simplification forest = simplified(mesh, 500);
    EXPECT_LE(forest.base_faces.size(), 500U);
    EXPECT_LE(forest.rounds, 45U);

    std::mt19937 random(51);
    auto points = sample_surface(mesh, 1, random);
    std::ranges::shuffle(points, random);
    points.resize(20'000);
    ForestReplay cut(forest, mesh.faces.size());
    EXPECT_LE(worst_violation(mesh, cut.faces(), points, 1.0), kOracleTolerance);
    EXPECT_GT(worst_violation(mesh, cut.faces(), points, 0.8), kOracleTolerance);
    cut.split_randomly(200, random);
    EXPECT_EQ(manifold_fault(cut.faces()), "");
    EXPECT_LE(worst_violation(mesh, cut.faces(), points, 1.0), kOracleTolerance);
    cut.split_randomly(forest.collapses.size(), random);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    {
        ASSERT_EQ(turned(cut.faces()[f].corners), turned(mesh.faces[f]));
    }
}

} // namespace tactus::test
