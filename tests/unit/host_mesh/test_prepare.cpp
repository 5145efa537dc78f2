// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "tests/unit/host_mesh/support.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::test
{
namespace
{

PreparedMesh prepared(const TriangleMesh& mesh, const PrepareOptions& options = {})
{
    auto result = prepare_mesh(mesh, options);
    EXPECT_TRUE(result) << result.error().text;
    return result ? std::move(result).value() : PreparedMesh{};
}

void expect_refusal(const TriangleMesh& mesh, const PrepareOptions& options, std::string_view part)
{
    const auto sut = prepare_mesh(mesh, options);
    ASSERT_FALSE(sut) << part;
    EXPECT_NE(sut.error().text.find(part), std::string::npos) << sut.error().text;
    EXPECT_EQ(sut.error().text.find('\n'), std::string::npos);
}

TriangleMesh scaled(TriangleMesh mesh, double factor, double offset)
{
    for (auto& p : mesh.positions)
    {
        for (double& c : p)
        {
            c = c * factor + offset;
        }
    }
    return mesh;
}

TEST(PrepareMesh, knows_the_units)
{
    EXPECT_EQ(metres_per_unit("mm"), 0.001);
    EXPECT_EQ(metres_per_unit("cm"), 0.01);
    EXPECT_EQ(metres_per_unit("m"), 1.0);
    EXPECT_EQ(metres_per_unit("in"), 0.0254);
    EXPECT_EQ(metres_per_unit("inch"), 0.0254);
    EXPECT_EQ(metres_per_unit("MM"), 0.001);
    EXPECT_FALSE(metres_per_unit("mmm"));
    EXPECT_FALSE(metres_per_unit("ft"));
    EXPECT_FALSE(metres_per_unit(""));
}

TEST(PrepareMesh, puts_a_sound_mesh_on_the_grid_without_a_note)
{
    for (const unsigned bits : {16U, 20U, 24U})
    {
        const auto source = make_shape(Shape::sphere, 5000);
        ASSERT_TRUE(source);
        const auto& mesh = source.value();
        const auto sut = prepared(mesh, {.position_bits = bits});
        EXPECT_TRUE(sut.notes.empty()) << sut.notes.front();
        EXPECT_EQ(sut.mesh.faces, mesh.faces);
        ASSERT_EQ(sut.mesh.positions.size(), mesh.positions.size());
        double worst = 0.0;
        std::int32_t largest = 0;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        {
            double off = 0.0;
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const std::int32_t place = sut.mesh.positions[v][axis];
                ASSERT_GE(place, 0);
                largest = std::max(largest, place);
                off += std::pow(
                    mesh.positions[v][axis] - sut.origin_m[axis] - sut.quantum_m * place, 2);
            }
            worst = std::max(worst, std::sqrt(off));
        }
        int exponent = 0;
        EXPECT_EQ(std::frexp(sut.quantum_m, &exponent), 0.5) << "a power of two";
        // The extent fits, and with half the quantum it would not.
        EXPECT_LT(largest, 1 << bits);
        EXPECT_GT(0.1 / (0.5 * sut.quantum_m),
                  std::ldexp(1.0, static_cast<int>(bits)) - 1.0 - 1e-6);
        EXPECT_NEAR(sut.quantisation_m, worst, 1e-15);
        EXPECT_LE(sut.quantisation_m, std::sqrt(0.75) * sut.quantum_m * 1.0000001);
    }
}

TEST(PrepareMesh, uses_the_full_grid_when_the_extent_is_the_largest_that_fits)
{
    // The extent is exactly 65535 quanta of 2^-20 m, then slightly more.
    const double extent = 65535.0 * std::ldexp(1.0, -20);
    const TriangleMesh exact{{{0, 0, 0}, {extent, 0, 0}, {0, extent / 2, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(prepared(exact).quantum_m, std::ldexp(1.0, -20));
    EXPECT_EQ(prepared(exact).mesh.positions[1][0], 65535);
    EXPECT_EQ(prepared(exact).quantisation_m, 0.5 * std::ldexp(1.0, -20));
    EXPECT_EQ(prepared(scaled(exact, 1.0000001, 0.0)).quantum_m, std::ldexp(1.0, -19));
}

TEST(PrepareMesh, scales_by_unit_and_by_diagonal)
{
    const TriangleMesh mesh{{{0, 0, 0}, {3, 0, 0}, {3, 4, 0}}, {{0, 1, 2}}};
    EXPECT_DOUBLE_EQ(prepared(mesh, {.metres_per_unit = 0.001}).diagonal_m, 0.005);
    const auto sut = prepared(mesh, {.metres_per_unit = 0.001, .fit_diagonal_m = 0.25});
    EXPECT_DOUBLE_EQ(sut.diagonal_m, 0.25);
    EXPECT_DOUBLE_EQ(sut.metres_per_unit, 0.05);
    EXPECT_NEAR(sut.mesh.positions[2][1] * sut.quantum_m, 0.2, sut.quantum_m);
}

TEST(PrepareMesh, keeps_the_shape_far_from_the_origin)
{
    const auto source = make_shape(Shape::sphere, 2000);
    ASSERT_TRUE(source);
    const auto near = prepared(source.value());
    const auto far = prepared(scaled(source.value(), 1.0, 8e6));
    EXPECT_EQ(far.mesh.faces, near.mesh.faces);
    EXPECT_DOUBLE_EQ(far.quantum_m, near.quantum_m);
    for (std::size_t v = 0; v < near.mesh.positions.size(); ++v)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            // A double at 1e7 m has steps of 1.9e-9 m; the quantum is 2^-19 m, 1.9e-6.
            ASSERT_NEAR(far.mesh.positions[v][axis], near.mesh.positions[v][axis], 1);
        }
    }
    EXPECT_NEAR(far.origin_m[0], 8e6 - 0.05, 1e-3);
}

TEST(PrepareMesh, welds_equal_positions_to_the_first)
{
    const TriangleMesh mesh{
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, -0.0}, {1, 1, 0}, {-0.0, 1, 0}},
        {{0, 1, 2}, {3, 4, 5}}};
    const auto sut = prepared(mesh);
    EXPECT_EQ(sut.welded_vertices, 2U);
    EXPECT_EQ(sut.isolated_vertices, 0U);
    EXPECT_EQ(sut.mesh.faces, (std::vector<Face>{{0, 1, 2}, {1, 3, 2}}));
    EXPECT_EQ(sut.notes.size(), 1U);
}

TEST(PrepareMesh, does_not_weld_what_only_meets_on_the_grid)
{
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1e-9, 0}},
                            {{0, 1, 2}, {3, 2, 1}}};
    const auto sut = prepared(mesh);
    EXPECT_EQ(sut.mesh.positions.size(), 4U);
    EXPECT_EQ(sut.mesh.positions[0], sut.mesh.positions[3]);
}

TEST(PrepareMesh, drops_isolated_vertices_and_keeps_them_out_of_the_box)
{
    const TriangleMesh mesh{{{9e9, 0, 0}, {0, 0, 0}, {1, 0, 0}, {5, 5, 5}, {0, 1, 0}}, {{1, 2, 4}}};
    const auto sut = prepared(mesh);
    EXPECT_EQ(sut.isolated_vertices, 2U);
    EXPECT_DOUBLE_EQ(sut.diagonal_m, std::sqrt(2.0));
    EXPECT_EQ(sut.mesh.faces, (std::vector<Face>{{0, 1, 2}}));
}

TEST(PrepareMesh, drops_degenerate_and_duplicate_faces)
{
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}},
                            {{0, 0, 1}, {0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 3, 1}, {3, 1, 2}}};
    const auto sut = prepared(mesh);
    EXPECT_EQ(sut.degenerate_faces, 2U);
    EXPECT_EQ(sut.duplicate_faces, 3U);
    EXPECT_EQ(sut.mesh.faces, (std::vector<Face>{{0, 1, 2}}));
}

TEST(PrepareMesh, keeps_and_counts_faces_that_are_flat_on_the_grid)
{
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-9, 0}}, {{0, 1, 2}}};
    const auto sut = prepared(mesh);
    EXPECT_EQ(sut.flat_faces, 1U);
    EXPECT_EQ(sut.mesh.faces.size(), 1U);
    EXPECT_EQ(prepared(tetrahedron()).flat_faces, 0U);
}

TEST(PrepareMesh, gives_the_same_result_twice)
{
    const auto soup = make_triangle_soup(2000, 3);
    ASSERT_TRUE(soup);
    const auto first = prepared(soup.value());
    const auto second = prepared(soup.value());
    EXPECT_EQ(first.mesh.positions, second.mesh.positions);
    EXPECT_EQ(first.mesh.faces, second.mesh.faces);
}

TEST(PrepareMesh, refuses_options_out_of_range_by_name)
{
    const auto mesh = tetrahedron();
    for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL})
    {
        expect_refusal(mesh, {.metres_per_unit = bad}, "metres per unit");
        expect_refusal(mesh, {.fit_diagonal_m = bad}, "fit diagonal");
    }
    expect_refusal(mesh, {.fit_diagonal_m = 0.99e-6}, "must be 1e-06 .. 1000000 m");
    expect_refusal(mesh, {.fit_diagonal_m = 1.001e6}, "must be 1e-06 .. 1000000 m");
    expect_refusal(mesh, {.position_bits = 15}, "position bits is 15; must be 16 .. 24");
    expect_refusal(mesh, {.position_bits = 25}, "position bits");
    prepared(mesh, {.fit_diagonal_m = 1e-6, .position_bits = 24});
    prepared(mesh, {.fit_diagonal_m = 1e6});
}

TEST(PrepareMesh, refuses_sources_that_make_no_model)
{
    expect_refusal({}, {}, "no face");
    expect_refusal({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}}, {}, "no face is left");
    expect_refusal({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}}, {}, "names vertex 3");
    expect_refusal({{{0, 0, 0}, {1, 0, 0}, {0, std::nan(""), 0}}, {{0, 1, 2}}}, {}, "finite");
    expect_refusal(scaled(tetrahedron(), 1e-7, 0.0), {}, "diagonal");
    expect_refusal(scaled(tetrahedron(), 1e6, 0.0), {}, "diagonal");
    expect_refusal(scaled(tetrahedron(), 1e306, 0.0), {.metres_per_unit = 1e5}, "finite");
    expect_refusal({{{-1.7e308, 0, 0}, {1.7e308, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}},
                   {.fit_diagonal_m = 1.0}, "finite");
    expect_refusal({{{0, 0, 0}, {5e-324, 0, 0}, {0, 5e-324, 0}}, {{0, 1, 2}}},
                   {.fit_diagonal_m = 1.0}, "finite");
}

TEST(PrepareMesh, fits_models_whose_squares_would_under_or_overflow)
{
    for (const double size : {1e-200, 1e200})
    {
        const auto sut = prepared(scaled(tetrahedron(), size, 0.0), {.fit_diagonal_m = 1.0});
        EXPECT_TRUE(is_manifold_with_borders(sut.mesh));
        EXPECT_EQ(sut.quantum_m, prepared(tetrahedron(), {.fit_diagonal_m = 1.0}).quantum_m);
    }
}

} // namespace
} // namespace tactus::test
