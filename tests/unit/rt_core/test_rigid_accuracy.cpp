// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Force and torque of rigid tools at rest, compared with statics of the ideal shapes: within
/// (facet angle) x force, and for a torque times its lever. The triangles are exact, so there is no
/// quantum.

#include "tests/unit/rt_core/rigid_tool_rig.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tactus::test
{

namespace
{

constexpr double kPi = std::numbers::pi;

/// Wall of a cylinder around the z axis, with `facets` facets whose middles are at the radius, each
/// in `rings` pieces.
TriangleList tube(double radius_m, double half_m, int facets, int rings = 1)
{
    TriangleList list;
    const double corner_m = radius_m / std::cos(kPi / facets);
    for (int i = 0; i < facets; ++i)
    {
        const auto at = [&](int k, double z)
        {
            const double angle = 2.0 * kPi * k / facets;
            return Vec3(corner_m * std::cos(angle), corner_m * std::sin(angle), z);
        };
        for (int ring = 0; ring < rings; ++ring)
        {
            const double from = half_m * (2.0 * ring / rings - 1.0);
            const double to = half_m * (2.0 * (ring + 1) / rings - 1.0);
            add_square(list, at(i, from), at(i + 1, from), at(i + 1, to), at(i, to));
        }
    }
    return list;
}

} // namespace

TEST(RigidAccuracy, a_box_on_an_edge_is_pushed_along_the_edges_normal_through_where_it_touches)
{
    // Ridge along y, steep on both sides; the box's bottom lies across it, off its middle.
    TriangleList ridge;
    add_square(ridge, {0, -0.1, 0}, {0.1, -0.1, -0.2}, {0.1, 0.1, -0.2}, {0, 0.1, 0});
    add_square(ridge, {0, -0.1, 0}, {-0.1, -0.1, -0.2}, {-0.1, 0.1, -0.2}, {0, 0.1, 0});
    ToolSpec spec = tool_of(Box{kHalf});
    Rig rig(spec, {{ridge, {}}});
    constexpr double kOff = 0.012;
    rig.settle(Vec3(kOff, 0, 0.05));
    const Vec3 hand(kOff, 0, 0.006);

    const ToolOutput output = rig.settle(hand, Mat3::Identity(), 3'000);

    // The box rotates until torque and force are those of one line along its normal.
    const Vec3 normal = output.proxy_rotation.col(2);
    EXPECT_LE((output.force_n.normalized() - normal).norm(), 2e-3);
    const Vec3 lever = Vec3(0, 0, 0) - output.proxy_m;
    EXPECT_LE((output.torque_nm - lever.cross(output.force_n)).norm(),
              2e-3 * output.force_n.norm() * kOff);
    const double arm = kHalf.norm() + kRigidRadius;
    EXPECT_LE((output.torque_nm - kRigidStiffness * arm * arm *
                                      turned_between(Mat3::Identity(), output.proxy_rotation))
                  .norm(),
              0.01 * output.torque_nm.norm());
    EXPECT_LE((output.force_n - kRigidStiffness * (output.proxy_m - hand)).norm(),
              0.01 * output.force_n.norm());
}

TEST(RigidAccuracy, a_peg_with_a_fifth_of_a_millimetre_of_room_is_centred_by_its_socket)
{
    constexpr int kFacets = 96;
    constexpr double kPeg = 0.01;
    constexpr double kRoom = 0.0002;
    // Axis and radius of the capsule are the peg's.
    Rig rig(tool_of(Segment{{0, 0, -0.02}, {0, 0, 0.02}}, kPeg),
            {{tube(kPeg + kRoom, 0.06, kFacets), {}}});
    rig.settle(Vec3(0, 0, 0), Mat3::Identity(), 20);
    for (const double heading : {0.0, 0.3, 1.1, 2.5})
    {
        const Vec3 aside = 0.003 * Vec3(std::cos(heading), std::sin(heading), 0.0);
        const ToolOutput output = rig.settle(aside, Mat3::Identity(), 600);

        // The peg is one clearance off the axis: the hand is 3 mm away, the peg 0.2 mm.
        const double force_n = kRigidStiffness * (0.003 - kRoom);
        const double facet = 2.0 * kPi / kFacets;
        EXPECT_LE((output.force_n + force_n * aside.normalized()).norm(), facet * force_n)
            << heading;
        EXPECT_LE(output.torque_nm.norm(), facet * force_n * 0.02);
        EXPECT_NEAR(output.force_n.norm(), force_n, facet * force_n);
    }
    // A tilted peg touches on both sides: clearance and length limit the rotation.
    const Mat3 tilted = turn(Vec3(0, 1, 0), 0.1);
    const ToolOutput output = rig.settle(Vec3(0, 0, 0), tilted, 600);
    const double most_rad = kRoom / 0.02;
    const double arm = 0.02 + kPeg;
    const double torque_nm = kRigidStiffness * arm * arm * (0.1 - most_rad);
    EXPECT_NEAR(output.torque_nm.norm(), torque_nm, 0.02 * torque_nm);
    EXPECT_LE(output.force_n.norm(), 0.02 * torque_nm / 0.02);
    EXPECT_LT(output.torque_nm.y(), 0.0) << "back towards the axis";
}

TEST(RigidAccuracy, a_cylinder_across_a_cylinder_is_pushed_from_axis_to_axis)
{
    constexpr int kFacets = 256;
    const double facet = 2.0 * kPi / kFacets;
    for (const double off : {0.0, 0.004, -0.009})
    {
        Rig rig(tool_of(Segment{{0, -0.03, 0}, {0, 0.03, 0}}, 0.01),
                {{tube(0.02, 0.1, kFacets), {}}});
        rig.objects[0].pose.rotation =
            turn(Vec3(0, 1, 0), kPi / 2.0); // The cylinder's axis is the world's x.
        rig.settle(Vec3(0, off, 0.06), Mat3::Identity(), 50);

        const ToolOutput output = rig.settle(Vec3(0, off, 0.025), Mat3::Identity(), 2'000);

        // The tool is along y on a cylinder along x: it touches at the point of its line nearest to
        // the axis, straight above it, tilted by the lever of the force.
        const Vec3 axis = output.proxy_rotation.col(1);
        const Vec3 up = Vec3(1, 0, 0).cross(axis).normalized();
        EXPECT_LE((output.force_n.normalized() - (up.z() > 0 ? up : Vec3(-up))).norm(), facet)
            << off;
        const double gap = std::abs(output.proxy_m.dot(up));
        EXPECT_NEAR(gap, 0.03, facet * facet * 0.03) << "both radii";
        const double along = -output.proxy_m.dot(axis);
        const Vec3 at = output.proxy_m + along * axis - 0.01 * up;
        EXPECT_LE((output.torque_nm - (at - output.proxy_m).cross(output.force_n)).norm(),
                  facet * output.force_n.norm() * 0.03)
            << off;
    }
}

TEST(RigidAccuracy, force_and_torque_change_by_no_more_than_the_stiffness_times_the_motion)
{
    // The box moves over a cylinder of facets, pressed and rotated by a hand that never stops.
    constexpr int kFacets = 48;
    ToolSpec spec = tool_of(Box{kHalf});
    Rig rig(spec, {{tube(0.05, 0.06, kFacets, 12), {}}});
    rig.takes_steps = true;
    rig.objects[0].pose.rotation = turn(Vec3(0, 1, 0), kPi / 2.0);
    rig.settle(Vec3(0, 0, 0.09), Mat3::Identity(), 50);
    const double arm = kHalf.norm() + kRigidRadius;
    const double facet = 2.0 * kPi / kFacets;
    ToolOutput last;
    Vec3 last_hand(0, 0, 0);
    Mat3 last_turn = Mat3::Identity();
    Similarity last_place;
    int contacts = 0;
    for (int i = 0; i < 1'500; ++i)
    {
        const double t = 2e-3 * i;
        const Vec3 hand(0.02 * std::sin(t), 0.02 * std::sin(1.7 * t), 0.058);
        const Mat3 turned = turn(Vec3(1, 0.3, 0.2), 0.2 * std::sin(2.3 * t));
        const ToolOutput output = rig.step(hand, turned);
        const Similarity place = rig.sut.place();
        if (i > 200 && last.in_contact && output.in_contact)
        {
            const auto length = [arm](const Vec3& way, const Mat3& from, const Mat3& to)
            { return way.norm() + arm * Eigen::AngleAxisd(to * from.transpose()).angle(); };
            const double moved = length(hand - last_hand, last_turn, turned) +
                                 length(place.translation_m - last_place.translation_m,
                                        last_place.rotation, place.rotation);
            // Between facets: its angle, and the lever that changes by its width.
            const double facet_n = facet * output.force_n.norm();
            ASSERT_LE((output.force_n - last.force_n).norm(), kRigidStiffness * moved + facet_n)
                << i;
            ASSERT_LE((output.torque_nm - last.torque_nm).norm(),
                      arm * (kRigidStiffness * moved + facet_n) + 0.05 * facet_n)
                << i;
            ++contacts;
        }
        last = output;
        last_hand = hand;
        last_turn = turned;
        last_place = place;
    }
    EXPECT_GT(contacts, 1'000);
}

} // namespace tactus::test
