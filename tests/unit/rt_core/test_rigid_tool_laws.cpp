// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Common laws of sphere and rigid proxies: free flight, pressure, moving objects, and materials.
/// The oracles are the laws of statics, of a spring, a damper and Coulomb, and a texture's energy.

#include "rt_core/force/texture.hpp"
#include "tests/unit/rt_core/proxy_rig.hpp"
#include "tests/unit/rt_core/rigid_tool_rig.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

namespace tactus::test
{

namespace
{

/// Tool with its height at rest on a plane.
struct Kind
{
    ToolSpec spec;
    double rest_m;
};

struct SphereTool
{
    using Rig = ProxyRig;
    static constexpr double kRest_m = kRadius;
    static constexpr double kPlace_m = kRest * kRadius; ///< Allowed error of the proxy's place.
    /// Allowed error of the place on bumps.
    static constexpr double kBalance_m = 3.0 * kSlipShare * 5e-4;
    static constexpr double kRoom = 1e-5;      ///< Allowed penetration relative to the radius.
    static constexpr double kTurnOff_nm = 0.0; ///< Allowed remaining torque.
    static constexpr double kSlip_m = kSlipShare * kRadius; ///< Least displacement worth a step.
    static constexpr double kBumpDepth_m = 1.5e-3;
    static constexpr double kPressed_n = 1e-3; ///< Error of a normal force while the tool slides.
    static constexpr double kLag_n = 2e-3;     ///< Error of the drag on release.
    static constexpr double kSpring_n = 1e-9;  ///< Error of a spring's force at rest.
    static constexpr double kBump_n = 1e-4;    ///< Error of a texture's normal force.
    static constexpr double kAcross_n = 2e-4;  ///< Error of its tangential force.
    static constexpr int kLetGoFrames = 3;
    static constexpr bool kTurns = false;

    static std::vector<Kind> kinds() { return {{sphere_tool(), kRest_m}}; }
    /// Tool small compared with bumps, so that the proxy's remainder of a step is small too.
    static Kind on_bumps()
    {
        ToolSpec pin = sphere_tool();
        pin.radius_m = 5e-4;
        return {pin, pin.radius_m};
    }
    static Rig over(std::vector<Solid> solids, const ToolSpec& spec, const Vec3& start)
    {
        return Rig(std::move(solids), start, spec);
    }
    static void blind(Rig& rig, bool is_blind) { rig.certified = is_blind ? 0.0 : 0.05; }
    static Similarity place(const Rig& rig) { return rig.sut.place(); }
    static bool is_clear(const Rig& rig) { return rig.clearance() >= kRadius * (1.0 - kRoom); }
    static ToolOutput step_on(Rig& rig, const Vec3& goal, const Vec3& velocity)
    {
        return rig.step_on(goal, velocity);
    }
};

struct Block
{
    using Rig = test::Rig;
    static constexpr double kRest_m = 0.01 + kRigidRadius;
    static constexpr double kPlace_m = 1e-7;
    static constexpr double kBalance_m = 2e-6;
    static constexpr double kRoom = 0.02;
    static constexpr double kTurnOff_nm = 1e-5;
    static constexpr double kSlip_m = 0.0;
    static constexpr double kBumpDepth_m = 1e-3;
    static constexpr double kPressed_n = 0.02;
    static constexpr double kLag_n = 3e-3;
    static constexpr double kSpring_n = 1e-3;
    static constexpr double kBump_n = 1e-2;
    static constexpr double kAcross_n = 1e-3;
    static constexpr int kLetGoFrames = 100;
    static constexpr bool kTurns = true;

    static std::vector<Kind> kinds()
    {
        static const std::vector<Vec3> kWedge{{0.03, 0, 0.01},      {-0.03, 0.02, 0.01},
                                              {-0.03, -0.02, 0.01}, {-0.03, 0, -0.01},
                                              {0.03, -0.02, -0.01}, {0.03, 0.02, -0.01}};
        return {{tool_of(Box{kHalf}), kRest_m},
                {tool_of(Segment{{-0.03, 0, 0}, {0.03, 0, 0}}), kRigidRadius},
                {tool_of(Hull::create(kWedge).value()), kRest_m}};
    }
    static Kind on_bumps() { return kinds()[0]; }
    static Rig over(std::vector<Solid> solids, const ToolSpec& spec, const Vec3& start)
    {
        Rig rig(spec, std::move(solids));
        rig.step(start);
        return rig;
    }
    static void blind(Rig& rig, bool is_blind)
    {
        rig.kind = is_blind ? AnswerKind::bounded : AnswerKind::exact;
        rig.lower_share = is_blind ? 0.5 : 1.0;
    }
    static Similarity place(const Rig& rig) { return rig.sut.place(); }
    static bool is_clear(const Rig& rig) { return rig.distance() > 0.0; }
    static ToolOutput step_on(Rig& rig, const Vec3& goal, const Vec3& /*velocity*/)
    {
        rig.takes_steps = true;
        return rig.step(goal);
    }
};

template <typename Body>
class RigidToolLaws : public testing::Test
{
protected:
    using Rig = typename Body::Rig;

    static Rig over(std::vector<Solid> solids)
    {
        return Body::over(std::move(solids), Body::kinds()[0].spec, Vec3(0, 0, 0.05));
    }
    /// Rig that just touches a plane, above the origin.
    static Rig on_plane(const Material& material, const Kind& kind = Body::kinds()[0])
    {
        Rig rig = Body::over({{plane(), {}, material}}, kind.spec, Vec3(0, 0, 0.05));
        static_cast<void>(hold(rig, Vec3(0, 0, kind.rest_m - 1e-5), 300));
        return rig;
    }
    static ToolOutput hold(Rig& rig, const ProxyGoal& hand, int frames = 300)
    {
        ToolOutput output;
        for (int i = 0; i < frames; ++i)
        {
            output = rig.step(hand);
        }
        return output;
    }
    static ToolOutput hold(Rig& rig, const Vec3& hand, int frames = 300)
    {
        return hold(rig, hand_at(hand), frames);
    }
    static Vec3 at(double x, double y, double depth) { return {x, y, Body::kRest_m - depth}; }
    static Vec3 place(const Rig& rig) { return Body::place(rig).translation_m; }
    static double drag_ratio(const ToolOutput& output)
    {
        return output.force_n.head<2>().norm() / output.force_n.z();
    }
    /// Displacement along the plane if the hand pulls like the weight on such a slope, and the
    /// final force.
    static std::pair<double, ToolOutput> pull(const Material& material, double slope_rad,
                                              double heading_rad)
    {
        Rig rig = on_plane(material);
        constexpr double kDepth = 0.004;
        const Vec3 along(std::cos(heading_rad), std::sin(heading_rad), 0.0);
        // The hand presses first, then moves along, no farther ahead than the weight's share.
        ToolOutput last = hold(rig, at(0, 0, kDepth), 50);
        const Vec3 start = place(rig);
        for (int i = 0; i < 400; ++i)
        {
            const double ahead_m = std::min(1.0, i / 100.0) * kDepth * std::tan(slope_rad);
            last = rig.step(at(place(rig).x(), place(rig).y(), kDepth) + ahead_m * along);
        }
        return {(place(rig) - start).norm(), last};
    }
};

using Bodies = testing::Types<SphereTool, Block>;
TYPED_TEST_SUITE(RigidToolLaws, Bodies);

Material rubbing(double static_friction, double dynamic_friction)
{
    Material material;
    material.static_friction = static_friction;
    material.dynamic_friction = dynamic_friction;
    return material;
}

TYPED_TEST(RigidToolLaws, in_free_flight_is_where_the_hand_is_without_a_force)
{
    for (const double step_m : {0.002, 1.0}) // The longer steps need space without objects.
    {
        auto rig = this->over(step_m < 0.1 ? std::vector<Solid>{{plane()}} : std::vector<Solid>{});
        Random random(1);
        Vec3 goal(0, 0, 0.05);
        Mat3 rotation = Mat3::Identity();
        for (int i = 0; i < 500; ++i)
        {
            goal += random.in_cube(step_m);
            goal.z() = std::max(goal.z(), 0.05);
            rotation = turn(random.in_cube(1.0), 0.05) * rotation;
            const ToolOutput output = rig.step(hand_at(goal, rotation));
            ASSERT_LE((output.proxy_m - goal).norm(), TypeParam::kTurns ? 0.0 : kRest * kRadius);
            ASSERT_TRUE(!TypeParam::kTurns || output.proxy_rotation == rotation) << i;
            ASSERT_EQ(output.force_n, Vec3(0, 0, 0)) << i;
            ASSERT_EQ(output.torque_nm, Vec3(0, 0, 0)) << i;
            ASSERT_FALSE(output.in_contact || output.halted) << i;
        }
    }
}

TYPED_TEST(RigidToolLaws, pressed_flat_stays_flat_pushes_by_its_depth_and_is_let_go_at_once)
{
    for (const auto& [spec, rest_m] : TypeParam::kinds())
    {
        for (const double depth : {0.0005, 0.002, 0.01, 0.015})
        {
            auto rig = TypeParam::over({{plane()}}, spec, Vec3(0.1, 0.2, 0.05));
            const ToolOutput output = this->hold(rig, Vec3(0.1, 0.2, rest_m - depth));
            EXPECT_TRUE(output.in_contact);
            EXPECT_FALSE(output.halted);
            expect_vector(output.proxy_m, Vec3(0.1, 0.2, rest_m), TypeParam::kPlace_m);
            expect_vector(output.force_n, Vec3(0, 0, kStiffness * depth),
                          kStiffness * TypeParam::kPlace_m + 1e-4);
            EXPECT_LE(output.torque_nm.norm(), TypeParam::kTurnOff_nm);
            EXPECT_LE((output.proxy_rotation - Mat3::Identity()).norm(), 1e-5);

            static_cast<void>(
                this->hold(rig, hand_at(Vec3(0.1, 0.2, rest_m - depth), turn({1, 0, 0}, 0.05))));
            const Vec3 away(0.1, 0.2, 0.05);
            const ToolOutput gone = this->hold(rig, away, TypeParam::kLetGoFrames);
            EXPECT_FALSE(gone.in_contact);
            EXPECT_EQ(gone.force_n, Vec3(0, 0, 0));
            EXPECT_EQ(gone.torque_nm, Vec3(0, 0, 0));
            EXPECT_LE((gone.proxy_m - away).norm(), TypeParam::kTurns ? 0.0 : kRest * kRadius);
        }
    }
}

TYPED_TEST(RigidToolLaws, frozen_in_contact_stays_with_its_force_says_so_never_pulls_and_comes_back)
{
    auto rig = this->over({{plane()}});
    const Vec3 goal = this->at(0, 0, 0.008);
    const ToolOutput held = this->hold(rig, goal);
    ASSERT_NEAR(held.force_n.z(), kStiffness * 0.008, 0.05);
    TypeParam::blind(rig, true);
    for (int i = 0; i < 60; ++i)
    {
        const ToolOutput output = rig.step(goal);
        ASSERT_TRUE(has_fault(faults_of(output), FrameFault::proxy_halted));
        ASSERT_EQ(output.proxy_m, held.proxy_m);
        ASSERT_NEAR(output.force_n.z(), held.force_n.z(), 1e-9) << i;
        ASSERT_TRUE(!TypeParam::kTurns || output.lag_m < 1e-6) << "what presses it is no way";
    }
    const ToolOutput pulled = rig.step(Vec3(0, 0, 0.5));
    EXPECT_TRUE(pulled.halted);
    EXPECT_NEAR(pulled.lag_m, 0.5 - held.proxy_m.z(), 1e-4);
    EXPECT_EQ(pulled.force_n, Vec3(0, 0, 0));
    EXPECT_EQ(pulled.proxy_m, held.proxy_m) << "what lies between is not known";

    static_cast<void>(this->hold(rig, goal, 100));
    TypeParam::blind(rig, false);
    for (int i = 0; i < 100; ++i)
    {
        const ToolOutput output = rig.step(goal);
        ASSERT_FALSE(output.halted);
        ASSERT_NEAR(output.force_n.z(), held.force_n.z(), 0.05) << i;
    }
    expect_vector(this->hold(rig, Vec3(0, 0, 0.1)).proxy_m, Vec3(0, 0, 0.1), kRest * kRadius);
}

TYPED_TEST(RigidToolLaws,
           an_object_that_moves_pushes_it_along_and_one_that_would_run_over_it_takes_it)
{
    for (const double speed : {0.1, 2.0, 50.0})
    {
        auto rig = this->over({{plane()}});
        const Vec3 hand = this->at(0, 0, speed > 10.0 ? -0.02 : 0.005);
        static_cast<void>(this->hold(rig, hand));
        for (int i = 0; i < 400; ++i)
        {
            double& height = rig.objects[0].pose.translation_m.z();
            height += (i < 200 ? speed : -speed) * kPeriod_s;
            const ToolOutput output = rig.step(hand);
            ASSERT_FALSE(output.over_constrained);
            ASSERT_TRUE(TypeParam::is_clear(rig)) << speed << " m/s, frame " << i;
            ASSERT_GT(output.proxy_m.z(), height);
        }
        rig.objects[0].pose.translation_m.z() = 0.0;
        const double rest_m = std::max(hand.z(), TypeParam::kRest_m);
        EXPECT_NEAR(this->hold(rig, hand).proxy_m.z(), rest_m, kRest * kRadius);
    }
}

TYPED_TEST(RigidToolLaws, squeezed_between_objects_says_so_and_stays)
{
    const double room_m = 2.0 * TypeParam::kRest_m;
    ObjectPose high;
    high.translation_m.z() = 0.2;
    auto rig = this->over({{plane()}, {plane(), high}});
    double& ceiling_m = rig.objects[1].pose.translation_m.z();
    const Vec3 hand(0, 0, TypeParam::kRest_m + 0.002);
    for (; ceiling_m > room_m + 0.006; ceiling_m -= 0.002)
    {
        ASSERT_FALSE(rig.step(hand).over_constrained);
    }
    ceiling_m = room_m + 0.006;
    int over_constrained = 0;
    for (int i = 0; i < 300; ++i)
    {
        ceiling_m -= i < 70 ? 1e-4 : 0.0; // Down to a millimetre below the needed space.
        const ToolOutput output = rig.step(hand);
        ASSERT_TRUE(output.proxy_m.allFinite() && output.force_n.allFinite());
        ASSERT_LE(output.force_n.norm(), TypeParam::kinds()[0].spec.force_max_n) << i;
        ASSERT_TRUE(!output.over_constrained || ceiling_m < room_m * (1.0 + TypeParam::kRoom)) << i;
        ASSERT_TRUE(output.over_constrained || ceiling_m > room_m * (1.0 - TypeParam::kRoom)) << i;
        ASSERT_EQ(output.over_constrained,
                  has_fault(faults_of(output), FrameFault::proxy_over_constrained));
        over_constrained += output.over_constrained ? 1 : 0;
    }
    EXPECT_GT(over_constrained, 200);
}

TYPED_TEST(RigidToolLaws, the_softer_of_tool_and_object_is_the_spring)
{
    for (const double stiffness : {50.0, 200.0, 3'500.0})
    {
        Material material;
        material.stiffness_n_per_m = stiffness;
        auto rig = this->on_plane(material);
        const Mat3 tilted = turn(Vec3(1, 0, 0), 0.05);
        const Vec3 goal = this->at(0, 0, 0.004);

        const ToolOutput output = this->hold(rig, hand_at(goal, tilted));

        const double softer = std::min(stiffness, kStiffness);
        EXPECT_NEAR(output.stiffness_n_per_m, softer, 1e-9 * softer);
        EXPECT_LE((output.force_n - softer * (output.proxy_m - goal)).norm(),
                  1e-3 * output.force_n.norm());
        EXPECT_GE(output.force_n.z(), 0.99 * softer * 0.004);
        if constexpr (TypeParam::kTurns)
        {
            const double arm = kHalf.norm() + kRigidRadius;
            const double held_rad = turned_between(tilted, output.proxy_rotation).norm();
            EXPECT_NEAR(output.torque_nm.norm(), softer * arm * arm * held_rad,
                        0.02 * output.torque_nm.norm());
        }
    }
}

TYPED_TEST(RigidToolLaws, damping_is_of_the_motion_across_the_surface_and_never_pulls)
{
    Material material;
    material.damping_n_s_per_m = 8.0;
    auto rig = this->on_plane(material);
    ProxyGoal hand = hand_at(this->at(0, 0, 0.004));
    const double still_n = this->hold(rig, hand).force_n.z();
    const auto pushed_n = [&](const Vec3& velocity_m_per_s)
    {
        hand.velocity_m_per_s = velocity_m_per_s;
        return rig.step(hand).force_n.z();
    };
    EXPECT_NEAR(pushed_n({0, 0, -0.05}), still_n + 8.0 * 0.05, 1e-6);
    EXPECT_NEAR(pushed_n({0.5, 0.2, 0}), still_n, 1e-6);
    EXPECT_NEAR(pushed_n({0.2, 0.1, 0.05}), still_n - 8.0 * 0.05, 1e-6);
    EXPECT_NEAR(pushed_n({0, 0, 10.0}), 0.0, 1e-9) << "a hand that tears itself away";
}

TYPED_TEST(RigidToolLaws, sticks_and_slides_at_the_angle_of_friction)
{
    for (const double friction : {0.1, 0.3, 0.6, 1.0})
    {
        for (const double heading : {0.0, 0.4, 0.785, 2.0, 4.0})
        {
            const double angle = std::atan(friction);
            const Material material = rubbing(friction, friction);
            const auto [stuck_m, below] = this->pull(material, 0.99 * angle, heading);
            const auto [slid_m, above] = this->pull(material, 1.01 * angle, heading);
            EXPECT_LT(stuck_m, 1e-5) << friction << ' ' << heading;
            EXPECT_NEAR(this->drag_ratio(below), std::tan(0.99 * angle), 1e-3 * friction);
            EXPECT_GT(slid_m, 1e-4) << friction << ' ' << heading;
            EXPECT_NEAR(this->drag_ratio(above), friction, 0.01 * friction);
        }
    }
}

TYPED_TEST(RigidToolLaws, sliding_meets_coulombs_force_against_the_motion_and_sticks_again)
{
    for (const double step_m : {1e-5, 1e-4, 5e-4})
    {
        auto rig = this->on_plane(rubbing(0.5, 0.3));
        Vec3 goal = this->at(0, 0, 0.004);
        ToolOutput output = this->hold(rig, goal);
        for (int i = 0; i < 1'500 && goal.x() < 0.3; ++i)
        {
            goal.x() += step_m;
            output = rig.step(goal);
        }
        EXPECT_NEAR(-output.force_n.x(), 0.3 * output.force_n.z(), 0.003 * output.force_n.z());
        EXPECT_NEAR(output.force_n.y(), 0.0, 1e-3);
        EXPECT_NEAR(output.force_n.z(), kStiffness * 0.004, 0.01);
        static_cast<void>(this->hold(rig, goal, 10));
        const Vec3 stuck = this->place(rig);
        EXPECT_NEAR((stuck - output.proxy_m).norm(), 0.0, 2e-4 * kRadius + step_m);
        EXPECT_EQ(rig.step(goal + Vec3(0.0005, 0, 0)).proxy_m, stuck) << "within the static cone";
    }
}

TYPED_TEST(RigidToolLaws, what_sticks_does_not_move_by_a_bit_for_a_minute)
{
    auto rig = this->on_plane(rubbing(0.5, 0.4));
    const Vec3 hand = this->at(0.0008, -0.0005, 0.004);
    static_cast<void>(this->hold(rig, hand_at(hand, turn(Vec3(0, 0, 1), 0.01)), 100));
    const Similarity rest = TypeParam::place(rig);
    Random random(7);
    for (int i = 0; i < 60'000; ++i)
    {
        const Mat3 turned = turn(Vec3(0.1, 0.1, 1), 0.01 + 0.002 * (i % 3));
        const ToolOutput output = rig.step(hand_at(hand + random.in_cube(1e-4), turned));
        ASSERT_EQ(this->place(rig), rest.translation_m) << i;
        ASSERT_TRUE(!TypeParam::kTurns || TypeParam::place(rig).rotation == rest.rotation) << i;
        ASSERT_LT(this->drag_ratio(output), 0.5) << i;
    }
}

TYPED_TEST(RigidToolLaws, friction_takes_it_along_with_an_object_that_slides)
{
    auto rig = this->on_plane(rubbing(0.5, 0.3));
    const Vec3 hand = this->at(0, 0, 0.004);
    static_cast<void>(this->hold(rig, hand, 100));
    const double start_m = this->place(rig).x();
    ToolOutput output;
    for (int i = 0; i < 115; ++i)
    {
        rig.objects[0].pose.translation_m.x() += 0.0001;
        output = rig.step(hand);
        if (i == 14)
        {
            EXPECT_NEAR(output.proxy_m.x() - start_m, 0.0015, 1e-9) << "a cone of 2 mm";
        }
    }
    EXPECT_NEAR(output.proxy_m.x(), 0.3 * 0.004, 1e-4 * kRadius + 1e-5);
    EXPECT_NEAR(output.force_n.x(), 0.3 * output.force_n.z(), 1e-2);
}

TYPED_TEST(RigidToolLaws, viscosity_drags_with_viscosity_times_speed_beside_friction_and_lets_go)
{
    for (const double viscosity : {0.5, 2.0, 10.0})
    {
        for (const double friction : {0.0, 0.3})
        {
            for (const double speed : {0.01, 0.05, 0.2})
            {
                Material material = rubbing(friction, friction);
                material.viscosity_n_s_per_m = viscosity;
                auto rig = this->on_plane(material);
                ToolOutput output;
                for (int i = 0; i <= 600; ++i)
                {
                    output = TypeParam::step_on(rig, this->at(speed * kPeriod_s * i, 0, 0.002),
                                                Vec3(speed, 0, 0));
                }
                const double drag_n = viscosity * speed + friction * kStiffness * 0.002;
                EXPECT_NEAR(output.force_n.x(), -drag_n, 0.01 * drag_n + 1e-3)
                    << viscosity << ' ' << friction << ' ' << speed;
                EXPECT_NEAR(output.force_n.z(), kStiffness * 0.002, TypeParam::kPressed_n);
                // The hand rests: the stored force is released, without a push beyond.
                for (int i = 0; i < 400; ++i)
                {
                    output = TypeParam::step_on(rig, this->at(speed * kPeriod_s * 600, 0, 0.002),
                                                Vec3(0, 0, 0));
                    EXPECT_LE(output.force_n.x(), 1e-3);
                }
                const double left_n = 2e-3 + viscosity * TypeParam::kSlip_m / kPeriod_s;
                EXPECT_LE(-output.force_n.x(), friction * output.force_n.z() + left_n);
            }
        }
    }
}

TYPED_TEST(RigidToolLaws, viscosity_lets_go_of_a_hand_at_rest_as_spring_and_damper_do)
{
    Material material;
    material.viscosity_n_s_per_m = 5.0;
    auto rig = this->on_plane(material);
    static_cast<void>(this->hold(rig, this->at(0, 0, 0.002), 20));
    double stretch_m = 0.001;
    // Backward Euler of v = K s / c, a damper in series with a spring.
    const double kept = 5.0 / (5.0 + kStiffness * kPeriod_s);
    for (int frame = 0; frame < 40; ++frame)
    {
        const ToolOutput output = rig.step(this->at(0.001, 0, 0.002));
        stretch_m *= kept;
        EXPECT_NEAR(output.force_n.x(), -kStiffness * stretch_m, TypeParam::kLag_n) << frame;
    }
    rig.objects[0].material.viscosity_n_s_per_m = kDampingMax_n_s_per_m;
    const ToolOutput held = this->hold(rig, this->at(-0.003, 0, 0.002), 50);
    EXPECT_NEAR(held.force_n.x(), kStiffness * (held.proxy_m.x() + 0.003), TypeParam::kSpring_n)
        << "never more than the spring";
}

TYPED_TEST(RigidToolLaws, viscosity_takes_a_resting_hand_along_with_a_surface_that_slides)
{
    Material material;
    material.viscosity_n_s_per_m = 4.0;
    auto rig = this->on_plane(material);
    ToolOutput output = this->hold(rig, this->at(0, 0, 0.002), 20);
    for (int i = 0; i < 300; ++i)
    {
        rig.objects[0].pose.translation_m.x() += 0.1 * kPeriod_s;
        output = rig.step(this->at(0, 0, 0.002));
    }
    EXPECT_NEAR(output.force_n.x(), 0.4, 0.01);
}

/// Energy e(d) h(p) divided by the stiffness.
double energy(const Material& material, const ObjectPose& pose, const Vec3& at_m, double depth_m)
{
    const Vec3 there_m = pose.rotation.inverse() * (at_m - pose.translation_m);
    double height_m = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double turns = there_m[axis] / material.texture_length_m;
        const double t = turns - std::floor(turns);
        height_m += material.texture_height_m * (16.0 * std::pow(t * (1.0 - t), 2) - 0.5);
    }
    const double most_m =
        std::pow(material.texture_length_m, 2) / (64.0 * material.texture_height_m);
    return most_m * std::pow(depth_m / (most_m + depth_m), 2) * height_m;
}

Material bumpy(double height_m, double length_m)
{
    Material material;
    material.texture_height_m = height_m;
    material.texture_length_m = length_m;
    return material;
}

ObjectPose random_pose(Random& random)
{
    ObjectPose pose;
    const Vec3 axis = random.in_cube(1.0);
    pose.rotation = turn(axis, random.between(0.0, 3.0));
    pose.translation_m = random.in_cube(0.1);
    return pose;
}

TYPED_TEST(RigidToolLaws, a_texture_is_felt_where_spring_and_bumps_are_in_balance)
{
    const Material material = bumpy(6e-5, 2.5e-3);
    const Kind kind = TypeParam::on_bumps();
    constexpr double kDepth = 1.5e-3;
    double most_n = 0.0;
    for (int i = 0; i < 40; ++i)
    {
        auto rig = this->on_plane(material, kind);
        const Vec3 hand(1.1e-4 * i, 0.0, kind.rest_m - kDepth);
        const ToolOutput output = this->hold(rig, hand, 200);
        const auto e_at = [&](double x, double depth_m)
        { return energy(material, {}, Vec3(x, 0.0, output.proxy_m.z()), depth_m); };
        double proxy_m = hand.x(); // Place of least energy, by bisection.
        for (int round = 0; round < 100; ++round)
        {
            const double slope =
                (e_at(proxy_m + 1e-9, kDepth) - e_at(proxy_m - 1e-9, kDepth)) / 2e-9;
            proxy_m += 0.5 * (hand.x() - slope - proxy_m);
        }
        EXPECT_NEAR(output.proxy_m.x(), proxy_m, TypeParam::kBalance_m) << i;
        EXPECT_NEAR(output.force_n.x(), kStiffness * (proxy_m - hand.x()), TypeParam::kAcross_n);
        const double rise =
            (e_at(output.proxy_m.x(), kDepth + 1e-9) - e_at(output.proxy_m.x(), kDepth - 1e-9)) /
            2e-9;
        EXPECT_NEAR(output.force_n.z(), kStiffness * (kDepth + rise), TypeParam::kBump_n);
        EXPECT_NEAR(output.stiffness_n_per_m, kStiffness * Texture::stiffening(material), 1e-9);
        most_n = std::max(most_n, std::abs(output.force_n.x()));
    }
    EXPECT_GT(most_n, 0.01) << "bumps that are felt";
    EXPECT_LT(most_n, kStiffness * material.texture_length_m * 0.05);
}

TYPED_TEST(RigidToolLaws, a_texture_makes_no_energy_on_closed_ways_and_turns)
{
    const Kind kind = TypeParam::on_bumps();
    for (std::uint64_t seed = 1; seed <= 4; ++seed)
    {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto work_over = [&](const Material& material, const ObjectPose& pose)
        {
            Random random(seed);
            // The path is between bumps: entry at a crest and exit at a trough would show a false
            // energy.
            const Vec3 wide_m{random.between(4e-4, 1e-3), random.between(4e-4, 1e-3), 0.0};
            const double dip_m = random.between(2e-4, 8e-4);
            const double phase = random.between(0.0, 6.0);
            const double tilt_rad = random.between(0.005, 0.02);
            constexpr int kRound = 8'000; // Steps so short that their energy is negligible.
            const auto hand_of = [&](int step)
            {
                const double angle = 2.0 * std::numbers::pi * step / kRound;
                const Mat3 turned = turn(Vec3(1, 0.4, 0), tilt_rad * std::sin(angle + 1.0)) *
                                    turn(Vec3(0, 0, 1), 0.05 * std::cos(angle));
                return hand_at(
                    pose.local_to_world(Vec3(
                        wide_m.x() * std::cos(angle), wide_m.y() * std::sin(angle),
                        kind.rest_m - TypeParam::kBumpDepth_m + dip_m * std::sin(angle + phase))),
                    pose.rotation * turned);
            };
            auto rig = TypeParam::over({{plane(), pose, material}}, kind.spec,
                                       pose.local_to_world(Vec3(0, 0, 0.05)));
            static_cast<void>(this->hold(rig, hand_of(0), 400));
            return work_of_rounds(rig, hand_of, kRound);
        };
        Random random(seed);
        Material material = bumpy(6e-5, random.between(2e-3, 3e-3));
        const ObjectPose pose = random_pose(random);
        const double smooth_j = work_over({}, pose);
        const double bumpy_j = work_over(material, pose);
        std::printf("work on the hand, twice round: %.3g J smooth, %.3g J with bumps\n", smooth_j,
                    bumpy_j);
        EXPECT_LT(std::abs(smooth_j), TypeParam::kTurns ? 1e-7 : 1e-12);
        EXPECT_LT(bumpy_j, TypeParam::kTurns ? 1e-7 : 1e-8) << "a false push makes some 100 nJ";
        EXPECT_GT(bumpy_j, TypeParam::kTurns ? -1e-3 : -1e-8);
        material.static_friction = 0.1;
        material.dynamic_friction = 0.08;
        EXPECT_LT(work_over(material, pose), 0.0);
    }
}

} // namespace

TEST(Texture, is_the_derivative_of_its_energy_and_keeps_within_its_bounds)
{
    Random random(2501);
    for (int i = 0; i < 2'000; ++i)
    {
        SCOPED_TRACE(i);
        const double length_m = random.between(2e-4, 0.01);
        const Material material =
            bumpy(random.between(0.01, 1.0) * kTextureSteepest * length_m, length_m);
        const ObjectPose pose = random_pose(random);
        const Vec3 at_m = random.in_cube(0.1);
        const double depth_m = random.between(1e-6, 0.02);
        const double small_m = 1e-4 * material.texture_length_m;
        const auto sut = Texture::at(material, pose, at_m, depth_m);
        const auto by_depth = [&](double step_m)
        { return energy(material, pose, at_m, depth_m + step_m); };
        const double step_m = std::min(small_m, 0.1 * depth_m);
        EXPECT_NEAR(sut.push_m, (by_depth(step_m) - by_depth(-step_m)) / (2.0 * step_m),
                    1e-5 * material.texture_height_m);
        EXPECT_GE(depth_m + sut.push_m, 0.0) << "a push stays a push";
        EXPECT_LE(1.0 + (Texture::at(material, pose, at_m, depth_m + step_m).push_m -
                         Texture::at(material, pose, at_m, depth_m - step_m).push_m) /
                            (2.0 * step_m),
                  Texture::stiffening(material) + 1e-6);
        for (int axis = 0; axis < 3; ++axis)
        {
            const Vec3 aside_m = small_m * Vec3::Unit(axis);
            const double slope = (energy(material, pose, at_m + aside_m, depth_m) -
                                  energy(material, pose, at_m - aside_m, depth_m)) /
                                 (2.0 * small_m);
            EXPECT_NEAR(sut.slope_m[axis], slope, 1e-4 * material.texture_height_m);
            const Vec3 bend = (Texture::at(material, pose, at_m + aside_m, depth_m).slope_m -
                               Texture::at(material, pose, at_m - aside_m, depth_m).slope_m) /
                              (2.0 * small_m);
            EXPECT_LE(bend.norm(), 0.5 + 1e-6) << "one place of rest for a hand";
        }
        EXPECT_LE(Texture::stiffening(material), 1.2);
    }
    EXPECT_EQ(Texture::stiffening(Material{}), 1.0);
    EXPECT_EQ(Texture::at(Material{}, {}, Vec3(1, 2, 3), 0.01).push_m, 0.0);
}

/// A material that fades out passes every height, including denormal ones; D is then infinite.
TEST(Texture, of_any_height_is_a_number_and_no_more_than_the_bumps)
{
    Random random(2502);
    for (const double length_m : {kTextureLengthMin_m, 1e-3, kTextureLengthMax_m})
    {
        const double highest_m = kTextureSteepest * length_m;
        for (double height_m = highest_m; height_m > 0.0; height_m *= random.between(0.0, 0.2))
        {
            const Material material = bumpy(height_m, length_m);
            ASSERT_TRUE(is_sound(material)) << height_m;
            for (const double depth_m : {0.0, 5e-324, 1e-300, 1e-9, 1e-3, 1.0, 1e4})
            {
                const ObjectPose pose = random_pose(random);
                const auto sut = Texture::at(material, pose, random.in_cube(0.1), depth_m);
                ASSERT_LE(std::abs(sut.push_m), 1.5 * height_m) << height_m << ' ' << depth_m;
                ASSERT_LE(sut.slope_m.cwiseAbs().maxCoeff(), 0.5 * length_m)
                    << height_m << ' ' << depth_m;
            }
            ASSERT_LE(Texture::stiffening(material), 1.2);
        }
    }
}

} // namespace tactus::test
