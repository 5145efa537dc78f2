// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I1 undoing the collapses gives the mesh, I3 cuts are manifold and stars keep their limit, I10
/// the finest corner: the vertex forest of a simplification, replayed from the collapses alone.

#include "tests/shared/forest_replay.hpp"
#include "tests/unit/host_simplify/small_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace tactus::test
{
namespace
{

constexpr std::uint32_t kNoStarFace = Collapse::kNoFace;

void expect_original(const QuantisedMesh& mesh, const ForestReplay& sut)
{
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    {
        ASSERT_TRUE(sut.faces()[f].active) << "face " << f;
        ASSERT_EQ(turned(sut.faces()[f].corners), turned(mesh.faces[f])) << "face " << f;
        ASSERT_EQ(sut.faces()[f].error, 0) << "face " << f;
    }
}

} // namespace

TEST(Forest, undoing_the_collapses_backwards_gives_the_mesh)
{
    for (const auto& [name, mesh] : all_small_meshes())
    {
        SCOPED_TRACE(name);
        const Simplification forest = simplified(mesh);
        ForestReplay sut(forest, mesh.faces.size());
        for (auto i = static_cast<std::uint32_t>(forest.collapses.size()); i-- > 0;)
        {
            const std::size_t before = sut.split_count();
            sut.split_with_closure(i);
            ASSERT_EQ(sut.split_count(), before + 1);
        }
        expect_original(mesh, sut);
    }
}

TEST(Forest, undoing_the_collapses_in_any_closed_order_gives_the_mesh)
{
    std::mt19937 random(11);
    for (const auto& [name, mesh] : all_small_meshes())
    {
        SCOPED_TRACE(name);
        const Simplification forest = simplified(mesh);
        for (int run = 0; run < 5; ++run)
        {
            ForestReplay sut(forest, mesh.faces.size());
            sut.split_randomly(forest.collapses.size(), random);
            expect_original(mesh, sut);
        }
    }
}

TEST(Forest, every_closed_cut_is_a_manifold_with_borders)
{
    std::mt19937 random(12);
    for (const auto& [name, mesh] : all_small_meshes())
    {
        SCOPED_TRACE(name);
        const Simplification forest = simplified(mesh);
        for (std::size_t run = 0; run < 12; ++run)
        {
            ForestReplay sut(forest, mesh.faces.size());
            sut.split_randomly(forest.collapses.size() * run / 12, random);
            // A crumb that moves into another component shares one of its edges.
            const std::string fault = manifold_fault(sut.active_corners());
            ASSERT_TRUE(fault.empty() || (run > 0 && name.starts_with("crumb"))) << fault;
        }
    }
}

TEST(Forest, the_last_change_of_a_face_is_by_the_finest_of_its_corners)
{
    std::mt19937 random(13);
    for (const auto& [name, mesh] : all_small_meshes())
    {
        SCOPED_TRACE(name);
        const Simplification forest = simplified(mesh);
        std::vector<std::uint32_t> removed_by(mesh.positions.size(), kNoStarFace);
        for (std::uint32_t i = 0; i < forest.collapses.size(); ++i)
        {
            removed_by[forest.collapses[i].vertex] = i;
        }
        for (std::size_t run = 1; run <= 4; ++run)
        {
            ForestReplay sut(forest, mesh.faces.size());
            sut.split_randomly(forest.collapses.size() * run / 4, random);
            for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
            {
                const auto& face = sut.faces()[f];
                if (face.active)
                {
                    const std::uint32_t finest =
                        std::min({removed_by[face.corners[0]], removed_by[face.corners[1]],
                                  removed_by[face.corners[2]]});
                    const bool changed = sut.last_change(f) != kNoStarFace;
                    ASSERT_TRUE(!changed || sut.last_change(f) == finest) << "face " << f;
                }
            }
        }
    }
}

TEST(Forest, stars_keep_their_caps_and_order)
{
    for (const auto& [name, mesh] : all_small_meshes())
    {
        SCOPED_TRACE(name);
        for (const Collapse& c : simplified(mesh).collapses)
        {
            ASSERT_GE(c.fan_size, 1U);
            ASSERT_LE(c.fan_size, kMaxFanFaces);
            for (std::uint32_t place = 2; place < kMaxStarFaces; ++place)
            {
                ASSERT_EQ(c.star[place] != kNoStarFace, place < 2 + c.fan_size);
            }
        }
    }
}

TEST(Forest, a_star_in_the_mesh_before_its_collapse_is_a_counter_clockwise_fan)
{
    for (const auto& [name, mesh] : all_small_meshes())
    {
        SCOPED_TRACE(name);
        const Simplification forest = simplified(mesh);
        std::vector<Corners> corners = mesh.faces;
        std::vector<char> present(mesh.faces.size(), 1);
        for (const Collapse& c : forest.collapses)
        {
            // Around v every face's third corner is the next face's second; A starts and B ends at
            // u.
            std::vector<Corners> round;
            for (std::uint32_t i = 0; i < c.fan_size + 2; ++i)
            {
                // The order is A, the fan, B.
                const std::uint32_t place = i == 0 ? 0 : (i == c.fan_size + 1 ? 1 : i + 1);
                if (c.star[place] != kNoStarFace)
                {
                    ASSERT_TRUE(present[c.star[place]]);
                    Corners turn = corners[c.star[place]];
                    const auto at = std::ranges::find(turn, c.vertex);
                    ASSERT_NE(at, turn.end());
                    std::rotate(turn.begin(), at, turn.end());
                    ASSERT_TRUE(round.empty() || round.back()[2] == turn[1]);
                    round.push_back(turn);
                }
            }
            ASSERT_TRUE(c.star[0] == kNoStarFace || round.front()[1] == c.parent);
            ASSERT_TRUE(c.star[1] == kNoStarFace || round.back()[2] == c.parent);
            const auto degree =
                std::ranges::count_if(corners, [&](const Corners& face)
                                      { return std::ranges::count(face, c.vertex) > 0; });
            ASSERT_EQ(static_cast<std::size_t>(degree), round.size());
            for (std::uint32_t place = 0; place < 2 + c.fan_size; ++place)
            {
                if (c.star[place] != kNoStarFace && place < 2)
                {
                    present[c.star[place]] = 0;
                    corners[c.star[place]].fill(kNoStarFace);
                }
                else if (place >= 2)
                {
                    std::ranges::replace(corners[c.star[place]], c.vertex, c.parent);
                }
            }
        }
        for (std::size_t i = 0; i < forest.base_faces.size(); ++i)
        {
            ASSERT_EQ(corners[forest.base_faces[i]], forest.base_corners[i]);
            present[forest.base_faces[i]] = 0;
        }
        ASSERT_EQ(std::ranges::count(present, 1), 0);
    }
}

TEST(Forest, no_vertex_grows_beyond_the_degree_cap)
{
    for (const auto& [name, mesh] : all_small_meshes())
    {
        SCOPED_TRACE(name);
        std::vector<std::uint32_t> allowed(mesh.positions.size(), 0);
        for (const auto& face : mesh.faces)
        {
            for (const std::uint32_t vertex : face)
            {
                ++allowed[vertex];
            }
        }
        for (auto& degree : allowed)
        {
            degree = std::max(degree, 10U);
        }
        const Simplification forest = simplified(mesh, 12);
        std::vector<std::uint32_t> degree(mesh.positions.size(), 0);
        for (const auto& corners : forest.base_corners)
        {
            for (const std::uint32_t vertex : corners)
            {
                ASSERT_LE(++degree[vertex], allowed[vertex]);
            }
        }
    }
}

TEST(Forest, stars_of_one_round_are_disjoint_and_rounds_ascend)
{
    for (const auto& [name, mesh] : all_small_meshes())
    {
        SCOPED_TRACE(name);
        const Simplification forest = simplified(mesh);
        std::uint32_t round = 0;
        std::set<std::uint32_t> touched;
        for (const Collapse& c : forest.collapses)
        {
            ASSERT_TRUE(c.round == round || c.round == round + 1);
            if (c.round != round)
            {
                touched.clear();
                round = c.round;
            }
            for (const std::uint32_t face : c.star)
            {
                ASSERT_TRUE(face == kNoStarFace || touched.insert(face).second);
            }
        }
        ASSERT_EQ(forest.rounds, round + 1);
    }
}

} // namespace tactus::test
