// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/shapes/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <set>
#include <string>

namespace tactus::test
{
namespace
{

using Height = std::function<double(double, double)>;

double slanted(double x, double y)
{
    return 0.21 * x + 0.13 * y;
}

/// Ground of columns x rows squares between two corners.
TriangleMesh make_ground(unsigned columns, unsigned rows, std::array<double, 2> low,
                         std::array<double, 2> high, const Height& height)
{
    TriangleMesh mesh;
    for (unsigned row = 0; row <= rows; ++row)
    {
        for (unsigned column = 0; column <= columns; ++column)
        {
            const double x = low[0] + (high[0] - low[0]) * column / columns;
            const double y = low[1] + (high[1] - low[1]) * row / rows;
            mesh.positions.push_back({x, y, height(x, y)});
        }
    }
    for (unsigned row = 0; row < rows; ++row)
    {
        for (unsigned column = 0; column < columns; ++column)
        {
            const std::uint32_t a = row * (columns + 1) + column;
            const std::uint32_t b = a + columns + 1;
            mesh.faces.push_back({a, a + 1, b + 1});
            mesh.faces.push_back({a, b + 1, b});
        }
    }
    return mesh;
}

PreparedMesh on_its_grid(const TriangleMesh& mesh, const PrepareOptions& options)
{
    auto result = prepare_mesh(mesh, options);
    EXPECT_TRUE(result) << (result ? "" : result.error().text);
    return result ? std::move(result).value() : PreparedMesh{};
}

unsigned bits_chosen(const TriangleMesh& mesh)
{
    return on_its_grid(mesh, {.adds_bits = true}).position_bits;
}

/// Root mean square of the heights' errors, and of the heights.
std::array<double, 2> height_error(const TriangleMesh& mesh, const PreparedMesh& sut)
{
    double off = 0.0;
    double of = 0.0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    {
        const double z = mesh.positions[v][2];
        const double place = sut.origin_m[2] + sut.quantum_m * sut.mesh.positions[v][2];
        off += (place - z) * (place - z);
        of += z * z;
    }
    const auto count = static_cast<double>(mesh.positions.size());
    return {std::sqrt(off / count), std::sqrt(of / count)};
}

/// Dunes of two metres on 20 km.
TriangleMesh make_dunes()
{
    return make_ground(300, 300, {0, 0}, {20'000, 20'000},
                       [](double x, double y)
                       { return std::sin(0.00315 * x) * std::cos(0.00255 * y); });
}

/// Number printed with `digits` digits and read again.
double printed(double value, int digits)
{
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.*g", digits, value);
    return std::strtod(text.data(), nullptr);
}

} // namespace

TEST(Grid, takes_more_bits_for_relief_that_it_would_drown)
{
    const TriangleMesh dunes = make_dunes();
    const PreparedMesh usual = on_its_grid(dunes, {});
    EXPECT_EQ(usual.position_bits, 16U);
    const auto [usual_off, relief] = height_error(dunes, usual);
    EXPECT_GT(usual_off, relief / 8); // A few steps of height remain.
    const PreparedMesh sut = on_its_grid(dunes, {.adds_bits = true});
    const auto [off, same] = height_error(dunes, sut);
    EXPECT_LT(off, same / 20);
    EXPECT_LE(sut.position_bits, 21U);
    ASSERT_EQ(sut.notes.size(), 1U);
    EXPECT_EQ(sut.notes[0].find(std::to_string(sut.position_bits) +
                                " bits a coordinate instead of 16, steps of "),
              0U)
        << sut.notes[0];
    EXPECT_NE(sut.notes[0].find("for its fine relief"), std::string::npos) << sut.notes[0];
}

TEST(Grid, takes_more_bits_for_a_texture_the_larger_the_plate_it_lies_on)
{
    // Each eighth of a wave is a vertex; every second one has a height in whole decimals.
    const Height texture = [](double x, double y)
    { return 20e-6 * std::sin(1e3 * std::numbers::pi * x) * std::cos(1e3 * std::numbers::pi * y); };
    unsigned before = 16;
    for (const double length : {0.3, 1.2, 4.8})
    {
        TriangleMesh mesh = make_ground(240, 160, {0, 0}, {0.06, 0.04}, texture);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(),
                              {{0.07, 0, 0}, {length, 0, 0}, {length, 0.04, 0}, {0.07, 0.04, 0}});
        mesh.faces.push_back({first, first + 1, first + 2});
        mesh.faces.push_back({first, first + 2, first + 3});
        const PreparedMesh sut = on_its_grid(mesh, {.adds_bits = true});
        EXPECT_LT(sut.quantum_m, 10e-6) << length;
        EXPECT_GE(sut.position_bits, before) << length;
        before = sut.position_bits;
    }
    EXPECT_GE(before, 19U);
}

TEST(Grid, takes_more_bits_for_edges_of_a_few_steps)
{
    // Board of 0.3 m with strips of copper, 35 um high.
    TriangleMesh board;
    const auto add_box = [&](std::array<double, 3> low, std::array<double, 3> high)
    {
        const auto first = static_cast<std::uint32_t>(board.positions.size());
        for (unsigned corner = 0; corner < 8; ++corner)
        {
            board.positions.push_back({corner & 1U ? high[0] : low[0],
                                       corner & 2U ? high[1] : low[1],
                                       corner & 4U ? high[2] : low[2]});
        }
        for (const auto& [a, b, c, d] : {std::array{0U, 2U, 3U, 1U},
                                         {4U, 5U, 7U, 6U},
                                         {0U, 1U, 5U, 4U},
                                         {2U, 6U, 7U, 3U},
                                         {0U, 4U, 6U, 2U},
                                         {1U, 3U, 7U, 5U}})
        {
            board.faces.push_back({first + a, first + b, first + c});
            board.faces.push_back({first + a, first + c, first + d});
        }
    };
    add_box({0, 0, 0}, {0.3, 0.2, 0.0016});
    for (unsigned i = 0; i < 200; ++i)
    {
        const double x = 0.005 + 0.014 * (i % 20);
        const double y = 0.005 + 0.018 * (i / 20);
        add_box({x, y, 0.0016}, {x + 0.004, y + 0.001, 0.0016 + 35e-6});
    }
    const PreparedMesh sut = on_its_grid(board, {.adds_bits = true});
    EXPECT_GT(sut.position_bits, 16U);
    EXPECT_LT(sut.quantum_m, 35e-6 / 15);
    EXPECT_NE(sut.notes[0].find("for its short edges"), std::string::npos) << sut.notes[0];
}

TEST(Grid, takes_no_bits_for_what_has_no_relief)
{
    TriangleMesh ground = make_ground(60, 60, {-0.2, -0.1}, {0, 0.1}, slanted);
    EXPECT_EQ(bits_chosen(ground), 16U);
    TriangleMesh floats = ground;
    TriangleMesh six_digits = ground;
    TriangleMesh six_decimals = ground;
    for (std::size_t v = 0; v < ground.positions.size(); ++v)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const double x = ground.positions[v][axis];
            floats.positions[v][axis] = static_cast<double>(static_cast<float>(x));
            six_digits.positions[v][axis] = printed(x, 6);
            six_decimals.positions[v][axis] = std::round(x * 1e6) / 1e6;
        }
    }
    // The source's rounding makes unintended slopes.
    EXPECT_EQ(bits_chosen(floats), 16U);
    EXPECT_EQ(bits_chosen(six_digits), 16U);
    EXPECT_EQ(bits_chosen(six_decimals), 16U);
}

TEST(Grid, takes_no_bits_where_16_hold_the_shape)
{
    for (const Shape shape : {Shape::bumpy_sphere, Shape::torus, Shape::gear, Shape::plate})
    {
        EXPECT_EQ(bits_chosen(make_shape(shape, 20'000).value()), 16U) << static_cast<int>(shape);
    }
}

TEST(Grid, is_as_fine_as_its_neighbours_want_it)
{
    const TriangleMesh plate = make_shape(Shape::plate, 2'000).value();
    const PreparedMesh usual = on_its_grid(plate, {});
    const PreparedMesh sut = on_its_grid(plate, {.quantum_max_m = usual.quantum_m / 8});
    EXPECT_EQ(sut.quantum_m, usual.quantum_m / 8);
    EXPECT_EQ(sut.position_bits, 19U);
    const PreparedMesh finest = on_its_grid(plate, {.quantum_max_m = usual.quantum_m / 1e6});
    EXPECT_EQ(finest.position_bits, 24U);
    EXPECT_NE(finest.notes[0].find("; steps of "), std::string::npos) << finest.notes[0];
    const auto refused = prepare_mesh(plate, {.quantum_max_m = 0.0});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().text, "the largest step of the grid is 0 m; must be positive");
}

TEST(Grid, parts_no_vertex_from_the_edge_it_lies_on)
{
    // Fine squares to the left of x = 0, coarse ones to the right: three in four vertices of that
    // line are in the interior of a coarse edge.
    const TriangleMesh mesh = joined({make_ground(32, 32, {-0.25, -0.125}, {0, 0.125}, slanted),
                                      make_ground(8, 8, {0, -0.125}, {0.25, 0.125}, slanted)});
    // Sides along the line without an opposite face.
    const auto open_sides = [](const PreparedMesh& sut, double x_m)
    {
        std::set<std::array<std::uint32_t, 2>> sides;
        for (const auto& face : sut.mesh.faces)
        {
            for (std::size_t k = 0; k < 3; ++k)
            {
                sides.insert({face[k], face[(k + 1) % 3]});
            }
        }
        const auto is_on_line = [&](std::uint32_t v)
        {
            const double x = sut.origin_m[0] + sut.quantum_m * sut.mesh.positions[v][0];
            return std::abs(x - x_m) < 1e-4;
        };
        return std::ranges::count_if(sides,
                                     [&](const auto& side) {
                                         return is_on_line(side[0]) && is_on_line(side[1]) &&
                                                !sides.contains({side[1], side[0]});
                                     });
    };
    const PreparedMesh usual = on_its_grid(mesh, {});
    EXPECT_EQ(open_sides(usual, 0.0), 40);
    const PreparedMesh sut = on_its_grid(mesh, {.stitches = true});
    EXPECT_EQ(open_sides(sut, 0.0), 0);
    EXPECT_EQ(open_sides(sut, -0.25), 32);
    EXPECT_EQ(open_sides(sut, 0.25), 8);
    EXPECT_EQ(sut.stitched_faces, 24U);
    EXPECT_EQ(sut.mesh.faces.size(), usual.mesh.faces.size() + 24);
    EXPECT_NE(
        std::ranges::find(sut.notes, "24 faces added where a border vertex lies on another edge"),
        sut.notes.end());
}

/// Two grounds with the same border, one of them moved along y.
TriangleMesh make_seam(double off)
{
    TriangleMesh other = make_ground(8, 40, {0, -0.125}, {0.25, 0.125}, slanted);
    for (auto& position : other.positions)
    {
        position[1] += off;
    }
    return joined({make_ground(8, 40, {-0.25, -0.125}, {0, 0.125}, slanted), other});
}

TEST(Grid, closes_a_seam_that_the_source_has_rounded_apart)
{
    const PreparedMesh whole = on_its_grid(make_seam(0.0), {.stitches = true});
    EXPECT_EQ(whole.joined_vertices, 0U);
    EXPECT_EQ(whole.mesh.positions.size(), 17U * 41U);
    for (const double off : {1e-12, 0.3 * whole.quantum_m, -0.49 * whole.quantum_m})
    {
        const TriangleMesh mesh = make_seam(off);
        const PreparedMesh apart = on_its_grid(mesh, {});
        EXPECT_EQ(apart.mesh.positions.size(), 18U * 41U) << off;
        const PreparedMesh sut = on_its_grid(mesh, {.stitches = true});
        EXPECT_EQ(sut.joined_vertices, 41U) << off;
        EXPECT_EQ(sut.welded_vertices, 0U) << off;
        EXPECT_EQ(sut.mesh.positions.size(), 17U * 41U) << off;
        EXPECT_EQ(sut.mesh.faces, whole.mesh.faces) << off;
        EXPECT_NEAR(sut.quantisation_m, apart.quantisation_m + std::abs(off), 1e-15) << off;
        EXPECT_NE(std::ranges::find(
                      sut.notes,
                      "41 vertices of borders joined to others less than half a grid step away"),
                  sut.notes.end());
    }
    EXPECT_EQ(on_its_grid(make_seam(0.51 * whole.quantum_m), {.stitches = true}).joined_vertices,
              0U);
}

TEST(Grid, keeps_the_corners_of_a_face_apart)
{
    const TriangleMesh needle{{{0, 0, 0}, {0.1, 0, 0}, {0.1, 1e-9, 0}}, {{0, 1, 2}}};
    const PreparedMesh sut = on_its_grid(needle, {.stitches = true});
    EXPECT_EQ(sut.joined_vertices, 0U);
    EXPECT_EQ(sut.flat_faces, 1U);
}

TEST(Grid, tells_how_far_vertices_were_moved_before)
{
    const TriangleMesh tile = make_seam(0.0);
    const double rounding_m = on_its_grid(tile, {}).quantisation_m;
    EXPECT_EQ(on_its_grid(tile, {.moved_m = rounding_m / 2}).quantisation_m, rounding_m);
    EXPECT_EQ(on_its_grid(tile, {.moved_m = 0.01}).quantisation_m, 0.01);
}

TEST(Grid, parts_no_border_from_the_vertices_of_a_mesh_beside_it)
{
    const TriangleMesh fine = make_ground(32, 32, {-0.25, -0.125}, {0, 0.125}, slanted);
    const TriangleMesh coarse = make_ground(8, 8, {0, -0.125}, {0.25, 0.125}, slanted);
    const std::array<double, 3> place{0.25, 0.5, -0.125};
    const PreparedMesh alone = on_its_grid(coarse, {.stitches = true, .grid_place_m = place});
    const PreparedMesh sut =
        on_its_grid(coarse, {.stitches = true, .grid_place_m = place, .beside_m = fine.positions});
    EXPECT_EQ(alone.stitched_faces, 0U);
    EXPECT_EQ(sut.stitched_faces, 24U);
    EXPECT_EQ(sut.mesh.positions.size(), alone.mesh.positions.size() + 24);
    EXPECT_EQ(sut.isolated_vertices, 0U);
    const PreparedMesh other = on_its_grid(fine, {.grid_place_m = place});
    ASSERT_EQ(sut.quantum_m, other.quantum_m);
    const auto border_of = [](const PreparedMesh& mesh)
    {
        std::set<std::array<double, 3>> places;
        for (const auto& at : mesh.mesh.positions)
        {
            const std::array<double, 3> place_m{mesh.origin_m[0] + mesh.quantum_m * at[0],
                                                mesh.origin_m[1] + mesh.quantum_m * at[1],
                                                mesh.origin_m[2] + mesh.quantum_m * at[2]};
            if (std::abs(place_m[0]) < 1e-4)
            {
                places.insert(place_m);
            }
        }
        return places;
    };
    EXPECT_EQ(border_of(sut).size(), 33U);
    EXPECT_EQ(border_of(sut), border_of(other));
}

TEST(Grid, leaves_a_border_that_only_comes_near)
{
    const Height flat = [](double, double) { return 0.0; };
    const TriangleMesh mesh = joined({make_ground(30, 30, {-0.2, -0.1}, {0, 0.1}, flat),
                                      make_ground(10, 10, {20e-6, -0.1}, {0.2, 0.1}, flat)});
    EXPECT_EQ(on_its_grid(mesh, {.stitches = true}).stitched_faces, 0U);
}

TEST(Grid, rounds_equal_positions_of_two_tiles_alike)
{
    const TriangleMesh left = make_ground(40, 40, {-0.2, -0.1}, {0, 0.1}, slanted);
    const TriangleMesh right = make_ground(26, 40, {0, -0.1}, {0.13, 0.1}, slanted);
    const auto border = [](const TriangleMesh& mesh, const PreparedMesh& on_grid)
    {
        std::set<std::array<double, 3>> places;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        {
            if (mesh.positions[v][0] == 0.0)
            {
                auto& at = on_grid.mesh.positions[v];
                places.insert({on_grid.origin_m[0] + on_grid.quantum_m * at[0],
                               on_grid.origin_m[1] + on_grid.quantum_m * at[1],
                               on_grid.origin_m[2] + on_grid.quantum_m * at[2]});
            }
        }
        return places;
    };
    const PrepareOptions by_itself{};
    EXPECT_NE(border(left, on_its_grid(left, by_itself)),
              border(right, on_its_grid(right, by_itself)));
    for (const std::array<double, 3>& place : {std::array{0.0, 0.0, 0.0}, {0.3, -7.1, 2.0}})
    {
        const PrepareOptions on_one{.grid_place_m = place};
        const PreparedMesh first = on_its_grid(left, on_one);
        const PreparedMesh second = on_its_grid(right, on_one);
        ASSERT_EQ(first.quantum_m, second.quantum_m);
        EXPECT_EQ(border(left, first).size(), 41U);
        EXPECT_EQ(border(left, first), border(right, second));
        // No coordinate is negative or beyond the bits, and no displacement exceeds the reported
        // one.
        for (const PreparedMesh* sut : {&first, &second})
        {
            for (const auto& at : sut->mesh.positions)
            {
                for (const std::int32_t steps : at)
                {
                    EXPECT_TRUE(steps >= 0 && steps < 1 << sut->position_bits);
                }
            }
            EXPECT_LE(sut->quantisation_m, 0.87 * sut->quantum_m);
        }
    }
}

/// A mesh as long as all steps that begins between two of them needs one more.
TEST(Grid, has_room_for_every_coordinate_wherever_its_place_is)
{
    const double step_m = 0x1p-20;
    const double length_m = 65'535.0 * step_m;
    const TriangleMesh triangle{{{0, 0, 0}, {length_m, 0, 0}, {0, length_m, 0}}, {{0, 1, 2}}};
    for (const double off : {0.0, 0.25, 0.5, 0.75})
    {
        const double place_m = off * step_m;
        const PreparedMesh sut =
            on_its_grid(triangle, {.grid_place_m = std::array{place_m, -place_m, 0.0}});
        EXPECT_EQ(sut.position_bits, 16U);
        for (const auto& position : sut.mesh.positions)
        {
            EXPECT_GE(*std::ranges::min_element(position), 0) << off;
            EXPECT_LE(*std::ranges::max_element(position), 65'535) << off;
        }
        for (std::size_t axis = 0; axis < 3; ++axis) // The box is the mesh's own.
        {
            EXPECT_EQ(std::ranges::min(sut.mesh.positions, {},
                                       [axis](const auto& position)
                                       { return position[axis]; })[axis],
                      0)
                << off;
        }
    }
}

TEST(Grid, moves_along_with_a_mesh_that_is_centred)
{
    const TriangleMesh tile = make_ground(26, 40, {0, -0.1}, {0.13, 0.1}, slanted);
    const std::array<double, 3> place{0.3, -7.1, 2.0};
    const PreparedMesh there = on_its_grid(tile, {.grid_place_m = place});
    const PreparedMesh sut = on_its_grid(tile, {.grid_place_m = place, .is_centered = true});
    EXPECT_EQ(sut.quantum_m, there.quantum_m);
    EXPECT_EQ(sut.mesh.positions, there.mesh.positions);
    const std::array<double, 3> middle_m{0.065, 0.0, 0.21 * 0.065};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        EXPECT_NEAR(there.origin_m[axis] - sut.origin_m[axis], middle_m[axis], 1e-12);
    }
}

TEST(Grid, is_refused_where_no_step_from_its_place_is_a_number)
{
    const auto at_height = [](double z) {
        return TriangleMesh{{{0.0, 0.0, z}, {1.0, 0.0, z}, {0.0, 1.0, z}}, {{0, 1, 2}}};
    };
    const PrepareOptions centred{.grid_place_m = std::array{0.0, 0.0, 0.0}, .is_centered = true};
    const PreparedMesh sut = on_its_grid(at_height(1e12), centred);
    EXPECT_EQ(sut.origin_m[2] + sut.quantum_m * sut.mesh.positions[0][2], 0.0);
    const auto refused = prepare_mesh(at_height(1e300), centred);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().text, "coordinates are no longer finite after scaling by 1");
}

} // namespace tactus::test
