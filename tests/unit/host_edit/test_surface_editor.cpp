// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Edited surfaces against their definition: a point is in the solid after a carve if it was
/// before and is not in the swept tool. Winding numbers and distances are those of the test.

#include "host_tools/edit/surface_editor.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "tests/shared/random.hpp"
#include "tests/unit/host_edit/edited_surface.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <type_traits>
#include <vector>

namespace tactus
{
namespace
{

using test::EditedFaces;
using test::Random;
using test::Soup;

constexpr std::uint32_t kRoom = 20'000;

struct EditCase
{
    const char* name;
    TriangleMesh (*make)();
};

const EncodedModel& edit_model(const EditCase& mesh)
{
    static std::map<std::string, std::unique_ptr<EncodedModel>> made;
    auto& model = made[mesh.name];
    if (!model)
    {
        model = encode_source(std::string("edited-") + mesh.name, mesh.make(), 60);
    }
    return *model;
}

const EditCase kCube{"cube", [] { return test::make_cube(6); }};
const EditCase kSphere{"sphere", [] { return make_shape(Shape::sphere, 1'300).value(); }};
const EditCase kTorus{"torus", [] { return make_shape(Shape::torus, 1'500).value(); }};
const EditCase kPlate{"plate", [] { return test::make_noisy_plate(12, 3); }};
const EditCase kSheet{"sheet", [] { return make_shape(Shape::terrain, 1'500).value(); }};

/// An editor with the controller's faces beside it, which every change is applied to.
struct EditRig
{
    explicit EditRig(const EncodedModel& model, std::uint32_t room = kRoom)
        : header_(model.decoded->header())
        , sut(SurfaceEditor::create(*model.decoded, room).value())
        , controller_(*model.decoded, room)
    {
    }

    double take(const Result<SurfaceChange, Refusal>& change)
    {
        EXPECT_TRUE(change.has_value()) << (change ? "" : change.error().text);
        if (!change)
        {
            return 0.0;
        }
        for (const EditContent& edit : change.value().edits)
        {
            EXPECT_EQ(controller_.apply(edit), "");
        }
        return change.value().volume_m3;
    }

    void expect_same_faces() const
    {
        EXPECT_EQ(controller_.sorted(), test::sorted_faces(sut, header_.origin_m()));
    }
    [[nodiscard]] Soup soup() const { return test::soup_of(sut.surface()); }
    [[nodiscard]] double quantum_m() const { return static_cast<double>(header_.quantum_m()); }

private:
    ModelHeader header_;

public:
    SurfaceEditor sut;

private:
    EditedFaces controller_;
};

Sweep sphere_sweep(double radius_m, const Vec3& from_m, const Vec3& to_m)
{
    Sweep sweep;
    sweep.core_m = {Vec3(0.0, 0.0, 0.0)};
    sweep.radius_m = radius_m;
    sweep.from_m = from_m;
    sweep.to_m = to_m;
    return sweep;
}

Sweep box_sweep(const Vec3& half_m, const Vec3& from_m, const Vec3& to_m)
{
    Sweep sweep;
    for (const double x : {-1.0, 1.0})
    {
        for (const double y : {-1.0, 1.0})
        {
            for (const double z : {-1.0, 1.0})
            {
                sweep.core_m.emplace_back(x * half_m.x(), y * half_m.y(), z * half_m.z());
            }
        }
    }
    sweep.from_m = from_m;
    sweep.to_m = to_m;
    return sweep;
}

double distance_to_segment(const Vec3& point, const Vec3& a, const Vec3& b)
{
    const double length_sq = (b - a).squaredNorm();
    const double along =
        length_sq > 0.0 ? std::clamp((point - a).dot(b - a) / length_sq, 0.0, 1.0) : 0.0;
    return (a + along * (b - a) - point).norm();
}

/// Distance of a point from the swept ball's surface, negative inside.
double depth_in(const Sweep& ball, const Vec3& point)
{
    return distance_to_segment(point, ball.from_m, ball.to_m) - ball.radius_m;
}

/// True if an open sheet, whose faces look up, is above the point. By the sum of the faces that a
/// vertical ray leaves (1) and enters (-1).
bool is_below(const Soup& sheet, const Vec3& point)
{
    double sum = 0.0;
    for (const test::SoupFace& face : sheet)
    {
        // Areas of the point with the face's edges, seen from above.
        const auto area = [&](const Vec3& a, const Vec3& b) {
            return (a.x() - point.x()) * (b.y() - point.y()) -
                   (a.y() - point.y()) * (b.x() - point.x());
        };
        const double u = area(face[1], face[2]);
        const double v = area(face[2], face[0]);
        const double w = area(face[0], face[1]);
        const bool is_crossed = (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
        const double all = u + v + w;
        if (is_crossed && (u * face[0].z() + v * face[1].z() + w * face[2].z()) / all > point.z())
        {
            sum += all > 0.0 ? 1.0 : -1.0;
        }
    }
    return sum > 0.5;
}

/// True if the mesh extends farther than `margin_m` from the point in x and y.
bool is_over(const TriangleMesh& mesh, const Vec3& point, double margin_m)
{
    const auto reaches = [&](int axis, double sign)
    {
        return std::ranges::any_of(mesh.positions,
                                   [&](const std::array<double, 3>& at)
                                   {
                                       const auto i = static_cast<std::size_t>(axis);
                                       return sign * (at[i] - point[axis]) > margin_m;
                                   });
    };
    return reaches(0, 1.0) && reaches(0, -1.0) && reaches(1, 1.0) && reaches(1, -1.0);
}

/// Largest distance between a swept ball's surface and that of its region after merging.
double tolerance_of(const Sweep& ball, double quantum_m)
{
    return 3.0 * kSweptRoundness * ball.radius_m + 8.0 * quantum_m;
}

} // namespace

using SurfaceEditorTest = testing::TestWithParam<EditCase>;

TEST_P(SurfaceEditorTest, random_sequences_match_the_definition)
{
    Random random(11);
    const bool is_open = std::string(GetParam().name) == "sheet";
    std::size_t points = 0;
    std::size_t refused = 0;
    for (int sequence = 0; sequence < 40; ++sequence)
    {
        EditRig rig(edit_model(GetParam()));
        for (int step = 0; step < 5; ++step)
        {
            const Soup before = rig.soup();
            const TriangleMesh mesh = rig.sut.surface();
            const auto& near = mesh.positions[random.below(mesh.positions.size())];
            const double radius = random.between(0.002, 0.012);
            const Vec3 from = Vec3(near[0], near[1], near[2]) + random.in_cube(0.6 * radius);
            const Vec3 to = random.one_in(3) ? from : Vec3(from + random.in_cube(2.0 * radius));
            const Sweep sweep = sphere_sweep(radius, from, to);
            const std::uint32_t kind = random.below(5U);
            const bool fills = kind == 3;
            auto change = kind == 4
                              ? rig.sut.displace(from, 2.0 * radius, random.in_cube(0.3 * radius))
                              : (fills ? rig.sut.fill(sweep) : rig.sut.carve(sweep));
            const std::string place = std::string(GetParam().name) + ", sequence " +
                                      std::to_string(sequence) + ", step " + std::to_string(step);
            if (!change)
            {
                ++refused;
                ASSERT_NE(change.error().text.find("leave the model's box"), std::string::npos)
                    << place << ": " << change.error().text;
                continue;
            }
            const double volume = rig.take(change);
            const Soup after = rig.soup();
            if (!is_open)
            {
                ASSERT_EQ(test::open_edges(rig.sut.surface()), 0U) << place;
                const double lost = test::volume_of(before) - test::volume_of(after);
                ASSERT_NEAR(fills || kind == 4 ? -lost : lost, volume, 1e-12) << place;
            }
            const bool is_inner =
                !is_open || (is_over(mesh, from, 1.5 * radius) && is_over(mesh, to, 1.5 * radius));
            for (int i = 0; i < 40 && kind != 4 && is_inner; ++i)
            {
                const Vec3 point =
                    from + (to - from) * random.between(0.0, 1.0) + random.in_cube(1.3 * radius);
                const double depth = depth_in(sweep, point);
                const double margin = tolerance_of(sweep, rig.quantum_m());
                if (std::abs(depth) < margin || test::distance_to(before, point) < margin ||
                    test::distance_to(after, point) < 2.0 * rig.quantum_m())
                {
                    continue;
                }
                const double was = test::winding_number(before, point);
                const double is = test::winding_number(after, point);
                ++points;
                // Old and new surface have the same border, so their difference is closed.
                const bool was_inside = is_open ? is_below(before, point) : was > 0.5;
                const double gained = fills ? 1.0 : -1.0;
                ASSERT_NEAR(is - was, depth < 0.0 && was_inside != fills ? gained : 0.0, 1e-3)
                    << place << ", depth " << depth;
                ASSERT_TRUE(is_open || std::abs(is - std::round(is)) < 1e-3) << place;
            }
        }
        rig.expect_same_faces();
    }
    std::printf("%s: %zu points, %zu refused\n", GetParam().name, points, refused);
    EXPECT_GT(points, is_open ? 100U : 500U);
}

INSTANTIATE_TEST_SUITE_P(meshes, SurfaceEditorTest,
                         testing::Values(kCube, kSphere, kTorus, kPlate, kSheet),
                         [](const auto& mesh) { return std::string(mesh.param.name); });

TEST(surface_editor, volumes_are_those_of_spheres_capsules_and_boxes)
{
    const auto check = [](const Sweep& sweep, double truth, double error)
    {
        EditRig rig(edit_model(kCube));
        EXPECT_NEAR(rig.take(rig.sut.carve(sweep)), truth, error * truth);
        EXPECT_EQ(test::open_edges(rig.sut.surface()), 0U);
    };
    const double pi = std::numbers::pi;
    const double r = 0.01;
    const double ball = 4.0 / 3.0 * pi * r * r * r;
    const Vec3 top(0.003, -0.002, 0.05);
    check(sphere_sweep(r, top, top), ball / 2.0, 0.06);
    check(sphere_sweep(r, top, top + Vec3(0.02, 0.0, 0.0)), (ball + 0.02 * pi * r * r) / 2.0, 0.06);
    Sweep capsule = sphere_sweep(r, top, top);
    capsule.core_m = {Vec3(-0.01, 0.0, 0.0), Vec3(0.01, 0.0, 0.0)};
    check(capsule, (ball + 0.02 * pi * r * r) / 2.0, 0.06);
    check(sphere_sweep(r, Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.0)), ball, 0.06); // A void.
    check(box_sweep({0.01, 0.01, 0.01}, top, top), 0.02 * 0.02 * 0.01, 0.002);
    check(box_sweep({0.01, 0.01, 0.01}, top, top + Vec3(0.01, 0.01, 0.0)), 0.0008 * 0.01, 0.002);
}

TEST(surface_editor, a_filled_cavity_has_the_volume_of_before)
{
    EditRig rig(edit_model(kCube));
    const double before = test::volume_of(rig.soup());
    const Vec3 top(0.003, -0.002, 0.047);
    rig.take(rig.sut.carve(sphere_sweep(0.008, top, top)));
    const double carved = before - test::volume_of(rig.soup());
    rig.take(rig.sut.fill(
        box_sweep({0.01, 0.01, 0.01}, Vec3(0.003, -0.002, 0.0399), Vec3(0.003, -0.002, 0.0399))));
    EXPECT_LT(std::abs(before - test::volume_of(rig.soup())), 0.02 * carved);
    EXPECT_EQ(test::open_edges(rig.sut.surface()), 0U);
    rig.expect_same_faces();
}

TEST(surface_editor, a_sheet_stays_closed_but_for_its_border)
{
    EditRig rig(edit_model(kSheet));
    const std::size_t border = test::open_edges(rig.sut.surface());
    const TriangleMesh mesh = rig.sut.surface();
    Vec3 middle(0.0, 0.0, 0.0);
    for (const auto& at : mesh.positions)
    {
        middle += Vec3(at[0], at[1], at[2]) / static_cast<double>(mesh.positions.size());
    }
    rig.take(rig.sut.carve(sphere_sweep(0.005, middle, middle + Vec3(0.004, 0.0, 0.0))));
    EXPECT_EQ(test::open_edges(rig.sut.surface()), border);
    rig.expect_same_faces();
}

TEST(surface_editor, small_steps_keep_the_surface_small)
{
    for (const double step : {0.05, 0.0})
    {
        EditRig rig(edit_model(kCube));
        const double radius = 0.004;
        Vec3 at(-0.03, 0.001, 0.05);
        for (int i = 0; i < 300; ++i)
        {
            const Vec3 next = at + Vec3(step * radius, 0.0, 0.0);
            rig.take(rig.sut.carve(sphere_sweep(radius, at, next)));
            at = next;
        }
        std::printf("steps of %.2f radii: %u added faces\n", step, rig.sut.added_count());
        EXPECT_LT(rig.sut.added_count(), step > 0.0 ? 1'500U : 300U);
        EXPECT_EQ(test::open_edges(rig.sut.surface()), 0U);
    }
}

TEST(surface_editor, many_edits_stay_within_the_tolerance_of_one)
{
    EditRig rig(edit_model(kCube));
    const double radius = 0.004;
    std::vector<Sweep> sweeps;
    const auto place = [](int step)
    {
        const double angle = 0.04 * step;
        return Vec3(0.012 * std::sin(angle), 0.005 * std::sin(0.37 * angle), 0.0505);
    };
    for (int i = 0; i < 500; ++i)
    {
        sweeps.push_back(sphere_sweep(radius, place(i), place(i + 1)));
        rig.take(rig.sut.carve(sweeps.back()));
    }
    EXPECT_EQ(test::open_edges(rig.sut.surface()), 0U);
    rig.expect_same_faces();
    const Soup after = rig.soup();
    const double margin = tolerance_of(sweeps.front(), rig.quantum_m());
    Random random(7);
    std::size_t points = 0;
    for (int i = 0; i < 4'000; ++i)
    {
        const Vec3 point(random.between(-0.016, 0.016), random.between(-0.01, 0.01),
                         random.between(0.045, 0.052));
        double depth = std::numeric_limits<double>::max();
        for (const Sweep& sweep : sweeps)
        {
            depth = std::min(depth, depth_in(sweep, point));
        }
        if (std::abs(depth) < margin || std::abs(point.z() - 0.05) < 2.0 * rig.quantum_m())
        {
            continue;
        }
        ++points;
        const double truth = depth > 0.0 && point.z() < 0.05 ? 1.0 : 0.0;
        ASSERT_NEAR(test::winding_number(after, point), truth, 1e-3) << point << ", " << depth;
    }
    EXPECT_GT(points, 2'000U);
}

TEST(surface_editor, an_edit_has_only_faces_that_differ)
{
    EditRig rig(edit_model(kCube));
    for (int i = 0; i < 40; ++i)
    {
        const Vec3 from(-0.01 + 3e-4 * i, 0.002, 0.0505);
        const auto before = test::sorted_faces(rig.sut, Vec3(0.0, 0.0, 0.0));
        const auto change = rig.sut.carve(sphere_sweep(0.004, from, from + Vec3(3e-4, 0.0, 0.0)));
        rig.take(change);
        const auto after = test::sorted_faces(rig.sut, Vec3(0.0, 0.0, 0.0));
        std::size_t removed = 0;
        std::size_t added = 0;
        for (const EditContent& edit : change.value().edits)
        {
            removed += edit.removed.size();
            added += edit.added.size();
        }
        std::remove_cvref_t<decltype(before)> gone;
        std::remove_cvref_t<decltype(before)> come;
        std::ranges::set_difference(before, after, std::back_inserter(gone));
        std::ranges::set_difference(after, before, std::back_inserter(come));
        EXPECT_EQ(removed, gone.size()) << "step " << i;
        EXPECT_EQ(added, come.size()) << "step " << i;
    }
}

TEST(surface_editor, refuses_by_name_and_changes_nothing)
{
    EditRig rig(edit_model(kCube), 300);
    const auto faces = rig.soup();
    const auto expect = [&](const Result<SurfaceChange, Refusal>& change, const char* text)
    {
        ASSERT_FALSE(change.has_value()) << text;
        EXPECT_NE(change.error().text.find(text), std::string::npos) << change.error().text;
        EXPECT_EQ(rig.sut.revision(), 0U);
        EXPECT_EQ(rig.sut.added_count(), 0U);
        EXPECT_EQ(rig.soup(), faces);
    };
    const Vec3 top(0.0, 0.0, 0.05);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    expect(rig.sut.carve(sphere_sweep(nan, top, top)), "not finite");
    expect(rig.sut.carve(sphere_sweep(0.01, top, Vec3(nan, 0.0, 0.0))), "not finite");
    expect(rig.sut.carve(sphere_sweep(-0.01, top, top)), "radius");
    expect(rig.sut.carve(sphere_sweep(1e-9, top, top)), "thinner");
    expect(rig.sut.carve(sphere_sweep(0.01, top, Vec3(1e9, 0.0, 0.0))), "farther");
    Sweep many = sphere_sweep(0.01, top, top);
    many.core_m.resize(3, top);
    expect(rig.sut.carve(many), "points of core");
    many.core_m.resize(65, top);
    expect(rig.sut.carve(many), "points of core");
    Sweep skew = sphere_sweep(0.01, top, top);
    skew.rotation(0, 0) = 2.0;
    expect(rig.sut.carve(skew), "rotation");
    Sweep flat = box_sweep({0.01, 0.01, 0.0}, top, top);
    expect(rig.sut.carve(flat), "thinner");
    expect(rig.sut.fill(sphere_sweep(0.01, top, top)), "leave the model's box along z");
    expect(rig.sut.carve(sphere_sweep(0.5, top, top)), "whole surface");
    expect(rig.sut.displace(top, nan, top), "displacement");
    expect(rig.sut.displace(top, 0.01, Vec3(0.0, 0.0, 1e12)), "displacement");
    expect(rig.sut.displace(top, 0.03, Vec3(0.0, 0.0, 0.01)), "leave the model's box");
    EditRig small(edit_model(kCube), 10);
    const auto full = small.sut.carve(sphere_sweep(0.01, top, top));
    ASSERT_FALSE(full.has_value());
    EXPECT_NE(full.error().text.find("room for 10"), std::string::npos) << full.error().text;
    EXPECT_FALSE(SurfaceEditor::create(*edit_model(kCube).decoded, kMaxAddedFaces + 1).has_value());
    const auto missed = rig.sut.carve(sphere_sweep(0.01, Vec3(0.2, 0.0, 0.0), Vec3(0.2, 0.0, 0.0)));
    ASSERT_TRUE(missed.has_value());
    EXPECT_TRUE(missed.value().edits.empty());
    EXPECT_EQ(rig.sut.revision(), 0U);
}

TEST(surface_editor, splits_a_large_change_faces_that_come_first)
{
    const EditCase fine{"fine", [] { return make_shape(Shape::sphere, 12'000).value(); }};
    EditRig rig(edit_model(fine));
    const auto change =
        rig.sut.carve(sphere_sweep(0.03, Vec3(0.05, 0.0, 0.0), Vec3(0.05, 0.01, 0.0)));
    ASSERT_TRUE(change.has_value());
    const auto& edits = change.value().edits;
    ASSERT_GE(edits.size(), 2U);
    EXPECT_TRUE(edits.front().removed.empty());
    EXPECT_TRUE(edits.back().added.empty());
    for (const EditContent& edit : edits)
    {
        EXPECT_LE(std::max(edit.removed.size(), edit.added.size()), kMaxEditFaces);
    }
    rig.take(change);
    rig.expect_same_faces();
    EXPECT_EQ(test::open_edges(rig.sut.surface()), 0U);
}

} // namespace tactus
