// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/query/contact_report.hpp"
#include "rt_core/query/contact_set.hpp"
#include "rt_core/query/convex_contact.hpp"
#include "rt_core/query/core_query.hpp"
#include "rt_core/query/query_memory.hpp"
#include "rt_core/query/walk_budget.hpp"
#include "tests/shared/owned_surface.hpp"
#include "tests/shared/winding_number.hpp"
#include "tests/unit/rt_core/support.hpp"
#include "tests/unit/rt_core/tree_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace tactus::test
{

namespace
{

using Mesh = std::vector<std::array<Vec3f, 3>>;

/// Grid closed in both directions, so that every vertex has six faces.
Mesh torus(std::uint32_t around, std::uint32_t across)
{
    const auto vertex = [&](std::uint32_t i, std::uint32_t j)
    {
        const double a = 2.0 * std::numbers::pi * (i % around) / around;
        const double b = 2.0 * std::numbers::pi * (j % across) / across;
        const double r = 1.0 + 0.4 * std::cos(b);
        return to_float(Vec3(r * std::cos(a), r * std::sin(a), 0.4 * std::sin(b)));
    };
    Mesh faces;
    for (std::uint32_t i = 0; i < around; ++i)
    {
        for (std::uint32_t j = 0; j < across; ++j)
        {
            faces.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
            faces.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
        }
    }
    return faces;
}

/// Octahedron with corners moved along their axes: sharp, always star-shaped.
Mesh spiked(Random& random)
{
    std::array<Vec3f, 6> corners;
    for (std::size_t i = 0; i < 6; ++i)
    {
        corners[i] = {0.0F, 0.0F, 0.0F};
        corners[i][i / 2] =
            static_cast<float>((i % 2 == 0 ? 1.0 : -1.0) * random.between(0.05, 1.2));
    }
    Mesh faces;
    for (std::size_t octant = 0; octant < 8; ++octant)
    {
        const std::array<Vec3f, 3> face{corners[octant & 1U], corners[2 + (octant >> 1U & 1U)],
                                        corners[4 + (octant >> 2U & 1U)]};
        const bool is_even = ((octant & 1U) + (octant >> 1U & 1U) + (octant >> 2U & 1U)) % 2 == 0;
        faces.push_back(is_even ? face : std::array<Vec3f, 3>{face[0], face[2], face[1]});
    }
    return faces;
}

/// Step with concave edges, and a vertex whose faces bend both ways.
Mesh step()
{
    const std::array<std::array<float, 2>, 6> outline{
        {{0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 0.5F}, {0.5F, 0.5F}, {0.5F, 1.0F}, {0.0F, 1.0F}}};
    const auto at = [&](std::size_t i, float z) {
        return Vec3f{outline[i % 6][0], outline[i % 6][1], z};
    };
    Mesh faces;
    for (std::size_t i = 0; i < 6; ++i)
    {
        faces.push_back({at(i, 0), at(i + 1, 0), at(i + 1, 1)});
        faces.push_back({at(i, 0), at(i + 1, 1), at(i, 1)});
    }
    for (const auto& cap : {std::array<std::size_t, 3>{0, 1, 3}, {1, 2, 3}, {0, 3, 5}, {3, 4, 5}})
    {
        faces.push_back({at(cap[0], 1), at(cap[1], 1), at(cap[2], 1)});
        faces.push_back({at(cap[0], 0), at(cap[2], 0), at(cap[1], 0)});
    }
    return faces;
}

/// Mesh in a tree, all exact, in a random order.
struct Placed
{
    Placed(const Mesh& mesh, Random& random)
        : rig({static_cast<std::uint32_t>(mesh.size()), 1'024, 1'024})
    {
        std::vector<std::uint32_t> order(mesh.size());
        for (std::uint32_t i = 0; i < order.size(); ++i)
        {
            order[i] = i;
        }
        for (std::uint32_t i = 0; i < order.size(); ++i)
        {
            std::swap(order[i],
                      order[i + random.below(static_cast<std::uint32_t>(order.size()) - i)]);
            rig.put({PrimId{i}, FaceId{order[i]}, order[i] * 2'654'435'761U, 0, mesh[order[i]]});
        }
        rig.sut->refit();
    }

    ContactReport report(const PlacedCore& core, double radius, bool is_closed, double reach = 10.0)
    {
        WalkBudget budget{1'000'000, 1'000'000};
        QueryMemory memory;
        gather_surface(*rig.sut, core, reach, memory, budget, *surface);
        ContactReport result;
        report_contacts(core, radius, *rig.sut, *surface, is_closed, result);
        return result;
    }

    TreeRig rig;
    std::unique_ptr<OwnedSurface> surface{std::make_unique<OwnedSurface>()};
};

const std::array<Vec3, 5> kWedge{Vec3(0, 0, 0), Vec3(0.4, 0, 0), Vec3(0, 0.3, 0), Vec3(0, 0, 0.2),
                                 Vec3(0.2, 0.2, 0.2)};

PlacedCore point_at(const Vec3& at)
{
    return {PointCore{}, {Mat3::Identity(), at, 1.0}};
}

/// Point near a corner, an edge or anywhere.
Vec3 point_near(const Mesh& mesh, Random& random)
{
    const auto& face = mesh[random.below(static_cast<std::uint32_t>(mesh.size()))];
    const double share = random.one_in(2) ? 0.0 : random.between(0.0, 1.0);
    const Vec3 at = (1.0 - share) * to_vec3(face[0]) + share * to_vec3(face[1]);
    return random.one_in(4) ? random.in_cube(1.5)
                            : Vec3(at + random.in_cube(std::pow(10.0, random.between(-6.0, -0.5))));
}

} // namespace

TEST(ContactReport, sides_agree_with_the_winding_number)
{
    Random random(71);
    std::array<int, 3> features{};
    int inside = 0;
    for (int round = 0; round < 40; ++round)
    {
        const Mesh mesh = round % 3 == 0 ? torus(12, 8) : round % 3 == 1 ? step() : spiked(random);
        Placed sut(mesh, random);
        for (int query = 0; query < 200; ++query)
        {
            const Vec3 at = point_near(mesh, random);
            const long double winding = winding_number(mesh, at);

            const ContactReport report = sut.report(point_at(at), 0.0, true);

            const DistanceAnswer& answer = sut.surface->answer;
            if (!(answer.lower_m > 1e-12))
            {
                continue; // Neither can decide on the surface.
            }
            ASSERT_EQ(report.side, winding > 0.5L ? Side::inside : Side::outside)
                << "at " << at.transpose() << ", winding " << static_cast<double>(winding);
            ASSERT_NEAR(report.normal.norm(), 1.0, 1e-12);
            inside += report.side == Side::inside ? 1 : 0;
            const auto feature = static_cast<std::size_t>(answer.nearest_feature);
            ++features[feature < 3 ? 0 : feature < 6 ? 1 : 2];
        }
    }
    EXPECT_GT(inside, 500);
    EXPECT_GT(*std::min_element(features.begin(), features.end()), 500)
        << "corners, edges and insides of faces";
}

TEST(ContactReport, an_open_mesh_has_normals_and_no_sides)
{
    Random random(72);
    Mesh mesh = torus(12, 8);
    mesh.erase(mesh.begin() + 10, mesh.begin() + 14);
    Placed sut(mesh, random);
    for (int query = 0; query < 200; ++query)
    {
        const ContactReport report = sut.report(point_at(random.in_cube(1.5)), 0.0, false);
        ASSERT_EQ(report.side, Side::unsigned_distance);
        ASSERT_NEAR(report.normal.norm(), 1.0, 1e-12);
    }
}

TEST(ContactReport, where_faces_are_missing_there_is_no_side_even_if_the_mesh_is_called_closed)
{
    Random random(73);
    Mesh mesh = step();
    mesh.erase(mesh.begin()); // One of the first side's.
    Placed sut(mesh, random);
    // Nearest to the edge that the removed face left open, and to its corner.
    EXPECT_EQ(sut.report(point_at(Vec3(0.4, -0.01, -0.2)), 0.0, true).side,
              Side::unsigned_distance);
    EXPECT_EQ(sut.report(point_at(Vec3(1.01, -0.01, -0.01)), 0.0, true).side,
              Side::unsigned_distance);
}

TEST(ContactReport, beyond_what_is_certified_there_is_no_normal)
{
    Random random(74);
    Placed sut(step(), random);
    const ContactReport report = sut.report(point_at(Vec3(2, 2, 2)), 0.1, true, 0.2);
    EXPECT_EQ(report.normal, Vec3(0, 0, 0));
    EXPECT_EQ(report.side, Side::unsigned_distance);
    EXPECT_TRUE(report.is_complete) << "no contact is proven";
    EXPECT_EQ(report.contacts.size(), 0U);
}

/// Disc of `faces` faces around a vertex at the origin.
Mesh fan(std::uint32_t faces)
{
    const auto rim = [faces](std::uint32_t i)
    {
        const double angle = 2.0 * std::numbers::pi * (i % faces) / faces;
        return to_float(Vec3(std::cos(angle), std::sin(angle), 0.0));
    };
    Mesh mesh;
    for (std::uint32_t i = 0; i < faces; ++i)
    {
        mesh.push_back({Vec3f{0.0F, 0.0F, 0.0F}, rim(i), rim(i + 1)});
    }
    return mesh;
}

TEST(ContactReport, a_vertex_has_a_normal_with_as_many_faces_as_the_limit_and_none_with_more)
{
    Random random(83);
    for (const std::uint32_t faces : {kMaxIncidentFaces, kMaxIncidentFaces + 1})
    {
        Placed placed(fan(faces), random);
        const ContactReport report = placed.report(point_at(Vec3(0, 0, 0.5)), 0.6, false);
        EXPECT_EQ(report.contacts.size(), kMaxContacts);
        const Vec3 expected(0, 0, faces == kMaxIncidentFaces ? 1.0 : 0.0);
        EXPECT_NEAR((report.normal - expected).norm(), 0.0, 1e-12) << faces;
    }
}

TEST(ContactReport, touches_that_were_left_out_are_told)
{
    Random random(84);
    for (const std::uint32_t faces : {std::uint32_t{kMaxContacts}, std::uint32_t{kMaxContacts} + 1})
    {
        Placed placed(fan(faces), random);
        const PlacedCore core = point_at(Vec3(0, 0, 0.5));
        static_cast<void>(placed.report(core, 0.6, false));
        TouchReport touches;
        report_touches(core, 0.6, *placed.rig.sut, *placed.surface, touches);
        EXPECT_EQ(touches.nearest.size(), kMaxContacts);
        EXPECT_EQ(touches.is_truncated, faces > kMaxContacts);
    }
}

TEST(ContactReport, contacts_are_the_faces_within_the_radius_nearest_first)
{
    Random random(75);
    const Mesh mesh = torus(24, 16);
    Placed sut(mesh, random);
    std::size_t most = 0;
    for (int query = 0; query < 200; ++query)
    {
        SCOPED_TRACE("query " + std::to_string(query));
        const ToolCore core = query % 4 == 0   ? ToolCore(PointCore{})
                              : query % 4 == 3 ? ToolCore(Hull::create(kWedge).value())
                              : query % 4 == 1 ? ToolCore(Segment{{-0.3, 0, 0}, {0.3, 0.1, 0}})
                                               : ToolCore(Box{{0.2, 0.1, 0.05}});
        const PlacedCore placed(core, {Mat3::Identity(), random.in_cube(1.5), 1.0});
        const double radius = query % 8 == 3 ? 0.0 : random.between(0.0, 0.5);

        const ContactReport report = sut.report(placed, radius, true);

        std::vector<std::pair<double, std::uint32_t>> expected;
        for (std::uint32_t i = 0; i < mesh.size(); ++i)
        {
            const double distance = placed.closest(to_triangle(mesh[i])).distance;
            Vec3 direction(0, 0, 0);
            const bool meets = placed.is_convex_body() &&
                               contact_of(placed.body(), to_triangle(mesh[i]), direction).meet;
            if (distance <= radius || meets)
            {
                expected.emplace_back(distance, i);
            }
        }
        std::sort(expected.begin(), expected.end());
        most = std::max(most, expected.size());
        ASSERT_EQ(report.is_complete, expected.size() <= kMaxContacts);
        ASSERT_EQ(report.contacts.size(), std::min<std::size_t>(expected.size(), kMaxContacts));
        for (std::size_t i = 0; i < report.contacts.size(); ++i)
        {
            const Contact& contact = report.contacts[i];
            ASSERT_EQ(contact.distance_m, expected[i].first);
            ASSERT_EQ(contact.face.value, expected[i].second);
            ASSERT_NEAR(contact.normal.norm(), 1.0, 1e-12);
            ASSERT_NEAR(
                (contact.on_tool_m - contact.on_surface_m - contact.distance_m * contact.normal)
                    .norm(),
                0.0, contact.distance_m > 1e-9 ? 1e-11 : 1e-8);
        }
    }
    EXPECT_GT(most, kMaxContacts);
}

/// Directions of ContactEnds, of unit length.
std::vector<Vec3> end_directions()
{
    std::vector<Vec3> directions;
    for (int i = 0; i < 27; ++i)
    {
        const Vec3 way(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
        if (way.norm() > 0.0)
        {
            directions.emplace_back(way.normalized());
        }
    }
    return directions;
}

TEST(ContactReport, touches_are_what_measuring_every_face_finds)
{
    constexpr double kReach = 0.5;
    Random random(85);
    const Mesh mesh = torus(24, 16);
    Placed sut(mesh, random);
    const std::vector<Vec3> directions = end_directions();
    std::size_t most = 0;
    for (int query = 0; query < 300; ++query)
    {
        SCOPED_TRACE("query " + std::to_string(query));
        const ToolCore core = query % 3 == 0   ? ToolCore(Hull::create(kWedge).value())
                              : query % 3 == 1 ? ToolCore(Segment{{-0.3, 0, 0}, {0.3, 0.1, 0}})
                                               : ToolCore(Box{{0.2, 0.1, 0.05}});
        const PlacedCore placed(core, {Mat3::Identity(), random.in_cube(1.5), 1.0});
        static_cast<void>(sut.report(placed, 0.0, false, kReach));

        TouchReport touches;
        report_touches(placed, kReach, *sut.rig.sut, *sut.surface, touches);

        std::vector<std::pair<double, std::uint32_t>> expected;
        std::vector<double> reaches(directions.size(), -kInfinity);
        for (std::uint32_t i = 0; i < mesh.size(); ++i)
        {
            const ClosestPoints closest = placed.closest(to_triangle(mesh[i]));
            if (closest.distance > kReach)
            {
                continue;
            }
            expected.emplace_back(closest.distance, i);
            for (std::size_t k = 0; k < directions.size(); ++k)
            {
                reaches[k] = std::max(reaches[k], directions[k].dot(closest.on_triangle) -
                                                      kEndPerDistance * closest.distance);
            }
        }
        if (expected.size() > kEnoughMeetingFaces)
        {
            continue; // The query may have met so many that the rest was left out.
        }
        std::sort(expected.begin(), expected.end());
        most = std::max(most, expected.size());
        ASSERT_EQ(touches.is_truncated, expected.size() > kMaxContacts);
        ASSERT_EQ(touches.nearest.size(), std::min<std::size_t>(expected.size(), kMaxContacts));
        ASSERT_EQ(touches.ends.is_empty, expected.empty());
        double least_slab = kInfinity;
        for (const ContactSlab& slab : touches.slabs)
        {
            least_slab = std::min(least_slab, slab.distance_m);
        }
        for (std::size_t i = 0; i < touches.nearest.size(); ++i)
        {
            ASSERT_EQ(touches.nearest[i].distance_m, expected[i].first);
            ASSERT_EQ(touches.nearest[i].face.value, expected[i].second);
        }
        for (std::size_t k = 0; k < directions.size() && !expected.empty(); ++k)
        {
            ASSERT_NEAR(touches.ends.reaches_m[k], reaches[k], 1e-11);
        }
        if (!expected.empty())
        {
            ASSERT_NEAR(least_slab, expected[0].first, 1e-11);
        }
    }
    EXPECT_GT(most, 3 * kMaxContacts);
}

TEST(ContactReport, does_not_depend_on_the_order_of_the_tree)
{
    Random random(76);
    const Mesh mesh = torus(12, 8);
    Placed first(mesh, random);
    Placed second(mesh, random);
    for (int query = 0; query < 200; ++query)
    {
        SCOPED_TRACE("query " + std::to_string(query));
        const PlacedCore core = point_at(point_near(mesh, random));
        const ContactReport a = first.report(core, 0.2, true);
        const ContactReport b = second.report(core, 0.2, true);
        ASSERT_EQ(a.normal, b.normal);
        ASSERT_EQ(a.side, b.side);
        ASSERT_EQ(a.contacts.size(), b.contacts.size());
        for (std::size_t i = 0; i < a.contacts.size(); ++i)
        {
            ASSERT_EQ(a.contacts[i].face, b.contacts[i].face);
            ASSERT_EQ(a.contacts[i].normal, b.contacts[i].normal);
        }
    }
}

} // namespace tactus::test
