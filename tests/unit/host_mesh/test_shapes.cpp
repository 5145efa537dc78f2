// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/detail/surfaces.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "tests/unit/host_mesh/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tactus::test
{
namespace
{

TriangleMesh made(Result<TriangleMesh, Refusal> result)
{
    EXPECT_TRUE(result) << result.error().text;
    return result ? std::move(result).value() : TriangleMesh{};
}

void expect_sound(const TriangleMesh& mesh, std::int64_t euler, std::size_t borders)
{
    EXPECT_TRUE(is_manifold_with_borders(mesh.faces, mesh.positions.size()));
    EXPECT_EQ(euler_characteristic(mesh.faces, mesh.positions.size()), euler);
    EXPECT_EQ(border_edges(mesh.faces), borders);
}

void expect_volume(const TriangleMesh& mesh, double volume, double relative)
{
    EXPECT_NEAR(signed_volume(mesh), volume, relative * volume);
}

TEST(Shapes, are_named_both_ways)
{
    EXPECT_EQ(shape_names(),
              (std::vector<std::string_view>{"sphere", "bumpy-sphere", "torus", "terrain", "gear",
                                             "peg", "socket", "plate"}));
    for (const auto name : shape_names())
    {
        EXPECT_TRUE(parse_shape(name)) << name;
    }
    EXPECT_EQ(parse_shape("gear"), Shape::gear);
    EXPECT_FALSE(parse_shape("cube"));
    EXPECT_FALSE(parse_shape(""));
}

TEST(Shapes, have_about_the_faces_asked_for)
{
    for (const auto name : shape_names())
    {
        for (const std::uint32_t faces : {10'000U, 12'345U, 82'000U, 268'686U})
        {
            const auto shape = *parse_shape(name);
            const auto got = static_cast<double>(made(make_shape(shape, faces)).faces.size());
            const bool round = shape == Shape::sphere || shape == Shape::bumpy_sphere;
            EXPECT_NEAR(got, faces, faces * (round ? 0.05 : 0.02)) << name << ' ' << faces;
        }
    }
}

TEST(Shapes, take_the_subdivision_nearest_to_the_faces)
{
    for (const auto& [asked, got] : std::vector<std::pair<std::uint32_t, std::size_t>>{
             {100, 80}, {131, 180}, {130, 80}, {180, 180}, {500, 500}, {82'000, 81'920}})
    {
        EXPECT_EQ(made(make_shape(Shape::sphere, asked)).faces.size(), got) << asked;
    }
}

TEST(Shapes, refuse_face_counts_out_of_range)
{
    for (const auto name : shape_names())
    {
        for (const std::uint32_t faces : {0U, 99U, 16'000'001U, 0xFFFF'FFFFU})
        {
            const auto sut = make_shape(*parse_shape(name), faces);
            ASSERT_FALSE(sut);
            EXPECT_NE(sut.error().text.find("must be 100 .. 16000000"), std::string::npos);
        }
        EXPECT_TRUE(make_shape(*parse_shape(name), 100));
    }
}

TEST(Shapes, are_watertight_and_turned_outward_at_every_size)
{
    constexpr double kPi = std::numbers::pi;
    for (const std::uint32_t faces : {100U, 333U, 1000U, 7777U})
    {
        expect_sound(made(make_shape(Shape::sphere, faces)), 2, 0);
        expect_sound(made(make_shape(Shape::bumpy_sphere, faces)), 2, 0);
        expect_sound(made(make_shape(Shape::torus, faces)), 0, 0);
        expect_sound(made(make_shape(Shape::gear, faces)), 0, 0);
        expect_sound(made(make_shape(Shape::peg, faces)), 2, 0);
        expect_sound(made(make_shape(Shape::socket, faces)), 2, 0);
        expect_sound(made(make_shape(Shape::plate, faces)), 2, 0);
    }
    const double sphere = 4.0 / 3.0 * kPi * std::pow(0.05, 3);
    expect_volume(made(make_shape(Shape::sphere, 50'000)), sphere, 0.001);
    expect_volume(made(make_shape(Shape::bumpy_sphere, 50'000)), sphere, 0.005);
    expect_volume(made(make_shape(Shape::torus, 50'000)), 2.0 * kPi * kPi * 0.05 * 0.02 * 0.02,
                  0.001);
}

TEST(Shapes, a_peg_has_room_of_a_fifth_of_a_millimetre_in_its_socket)
{
    constexpr double kPi = std::numbers::pi;
    const auto cone = [](double r, double s, double h)
    { return kPi * h * (r * r + r * s + s * s) / 3.0; };
    const double pin = kPi * 0.01 * 0.01 * 0.058 + 2.0 * cone(0.01, 0.009, 0.001);
    const double hole = kPi * 0.0102 * 0.0102 * 0.039 + cone(0.0102, 0.0112, 0.001);
    expect_volume(made(make_shape(Shape::peg, 50'000)), pin, 0.001);
    expect_volume(made(make_shape(Shape::socket, 50'000)), kPi * 0.03 * 0.03 * 0.05 - hole, 0.001);
    expect_volume(made(make_shape(Shape::plate, 50'000)), 0.1 * 0.1 * 0.01, 1e-9);

    // Greatest radius of the peg, and least radius of the hole's walls.
    double thickest = 0.0;
    for (const auto& p : made(make_shape(Shape::peg, 20'000)).positions)
    {
        thickest = std::max(thickest, std::hypot(p[0], p[1]));
    }
    const auto socket = made(make_shape(Shape::socket, 20'000));
    double narrowest = 1.0;
    for (const auto& face : socket.faces)
    {
        const auto& a = socket.positions[face[0]];
        const auto& b = socket.positions[face[1]];
        const bool is_wall = std::max(a[2], b[2]) < 0.0189 && std::min(a[2], b[2]) > -0.0199;
        if (is_wall && std::hypot(a[0], a[1]) < 0.02)
        {
            narrowest = std::min(narrowest, std::hypot(0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])));
        }
    }
    EXPECT_NEAR(thickest, 0.01, 1e-12);
    EXPECT_GT(narrowest, 0.01 + 0.00017) << "less what facets take";
    EXPECT_LE(narrowest, 0.0102);
}

TEST(Shapes, gear_has_the_volume_of_its_outline_at_every_size)
{
    // Eight teeth of four triangles to the axis: 2 x area = sum of r r' sin(angle), times
    // thickness; the bore is a polygon with the outline's angles, so its area is nearly its
    // circle's.
    constexpr double kPitch = std::numbers::pi / 4.0;
    const double outline =
        8.0 * 0.5 *
        (0.04 * 0.04 * std::sin(0.4 * kPitch) + 0.05 * 0.05 * std::sin(0.4 * kPitch) +
         2.0 * 0.04 * 0.05 * std::sin(0.1 * kPitch));
    const double bore = std::numbers::pi * 0.015 * 0.015;
    for (const std::uint32_t faces : {1000U, 100'000U})
    {
        expect_volume(made(make_shape(Shape::gear, faces)), 0.02 * (outline - bore), 0.02);
    }
}

TEST(Shapes, sphere_vertices_lie_on_the_sphere_with_even_faces)
{
    const auto mesh = made(make_shape(Shape::sphere, 20'000));
    for (const auto& p : mesh.positions)
    {
        ASSERT_NEAR(std::hypot(p[0], p[1], p[2]), 0.05, 1e-15);
    }
}

TEST(Shapes, bumpy_sphere_vertices_lie_on_its_surface)
{
    const auto mesh = made(make_shape(Shape::bumpy_sphere, 20'000));
    for (const auto& p : mesh.positions)
    {
        const double r = std::hypot(p[0], p[1], p[2]);
        const double f = r - 0.05 * (1.0 + 0.02 * std::sin(8.0 * p[0] / r) *
                                               std::sin(8.0 * p[1] / r) * std::sin(8.0 * p[2] / r));
        ASSERT_NEAR(f, 0.0, 1e-14);
    }
}

TEST(Shapes, torus_vertices_lie_on_the_torus)
{
    const auto mesh = made(make_shape(Shape::torus, 5000));
    for (const auto& p : mesh.positions)
    {
        ASSERT_NEAR(std::hypot(std::hypot(p[0], p[1]) - 0.05, p[2]), 0.02, 1e-14);
    }
}

TEST(Shapes, terrain_is_an_open_height_field_with_upward_faces)
{
    const auto mesh = made(make_shape(Shape::terrain, 20'000));
    const auto border = border_edges(mesh.faces);
    EXPECT_NEAR(static_cast<double>(border), 400.0, 40.0);
    expect_sound(mesh, 1, border);
    double low = 1.0;
    double high = -1.0;
    for (const auto& p : mesh.positions)
    {
        low = std::min(low, p[2]);
        high = std::max(high, p[2]);
    }
    EXPECT_GE(low, 0.0);
    EXPECT_LE(high, 0.02);
    EXPECT_GT(high - low, 0.003);
    for (const auto& f : mesh.faces)
    {
        const auto& a = mesh.positions[f[0]];
        const auto& b = mesh.positions[f[1]];
        const auto& c = mesh.positions[f[2]];
        ASSERT_GT((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]), 0.0);
    }
}

TEST(Shapes, terrain_is_the_same_surface_at_every_resolution)
{
    const auto coarse = made(make_shape(Shape::terrain, 2 * 50 * 50));
    const auto fine = made(make_shape(Shape::terrain, 2 * 100 * 100));
    ASSERT_EQ(coarse.positions.size(), 51U * 51U);
    ASSERT_EQ(fine.positions.size(), 101U * 101U);
    for (std::size_t c = 0; c <= 50; ++c)
    {
        for (std::size_t r = 0; r <= 50; ++r)
        {
            ASSERT_NEAR(coarse.positions[c * 51 + r][2], fine.positions[2 * c * 101 + 2 * r][2],
                        1e-15);
        }
    }
}

TEST(Shapes, uv_sphere_has_poles_and_needles)
{
    const auto mesh = made(make_uv_sphere(20, 4000));
    EXPECT_EQ(mesh.faces.size(), 2U * 4000U * 19U);
    expect_sound(mesh, 2, 0);
    expect_sound(made(make_uv_sphere(2, 3)), 2, 0);
    expect_volume(made(make_uv_sphere(100, 200)), 4.0 / 3.0 * std::numbers::pi * std::pow(0.05, 3),
                  0.002);
    EXPECT_FALSE(make_uv_sphere(1, 10));
    EXPECT_FALSE(make_uv_sphere(10, 2));
    EXPECT_FALSE(make_uv_sphere(0xFFFF'FFFFU, 0xFFFF'FFFFU));
    EXPECT_FALSE(make_uv_sphere(0, 3));
}

TEST(Shapes, thin_plate_is_closed_and_has_its_volume)
{
    for (const std::uint32_t cells : {1U, 2U, 30U})
    {
        const auto mesh = made(make_thin_plate(cells, 1e-4));
        EXPECT_EQ(mesh.faces.size(), 4U * cells * cells + 8U * cells);
        expect_volume(mesh, 0.1 * 0.1 * 1e-4, 1e-9);
        if (cells > 1)
        {
            EXPECT_EQ(border_edges(mesh.faces), 0U);
        }
    }
    expect_sound(made(make_thin_plate(30, 1e-4)), 2, 0);
    EXPECT_FALSE(make_thin_plate(0, 1e-4));
    EXPECT_FALSE(make_thin_plate(1001, 1e-4));
    EXPECT_FALSE(make_thin_plate(10, 0.0));
    EXPECT_FALSE(make_thin_plate(10, std::nan("")));
}

TEST(Shapes, triangle_soup_depends_on_its_seed_alone)
{
    const auto mesh = made(make_triangle_soup(500, 7));
    EXPECT_EQ(mesh.faces.size(), 500U);
    expect_sound(mesh, 500, 1500);
    EXPECT_EQ(mesh.positions, made(make_triangle_soup(500, 7)).positions);
    EXPECT_NE(mesh.positions, made(make_triangle_soup(500, 8)).positions);
    for (const auto& p : mesh.positions)
    {
        EXPECT_TRUE(p[0] >= 0.0 && p[0] <= 0.1);
    }
    EXPECT_FALSE(make_triangle_soup(0, 1));
    EXPECT_FALSE(make_triangle_soup(16'000'001, 1));
}

TEST(PortableSine, agrees_with_the_library)
{
    for (int i = -100'000; i <= 100'000; ++i)
    {
        const double x = 0.00987654321 * i;
        ASSERT_NEAR(detail::portable_sin(x), std::sin(x), 1e-13) << x;
        ASSERT_NEAR(detail::portable_cos(x), std::cos(x), 3e-13) << x;
    }
}

} // namespace
} // namespace tactus::test
