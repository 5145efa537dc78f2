// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/shapes.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/rotation.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/period.hpp"
#include "tests/shared/safe_force.hpp"
#include "tests/shared/solid_cores.hpp"
#include "tests/stability/garbage_episodes.hpp"
#include "tests/stability/garbage_trial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace tactus::test
{

namespace
{

constexpr std::int64_t kGarbageFrame_ns = 1'000'000;
constexpr double kToolForceMax_n = 8.0;
constexpr double kToolTorqueMax_nm = 0.3;
constexpr double kGarbageRounding = 1e-12;
/// Greatest change per frame that ForceFader permits while fading and returning.
constexpr double kMostOfRange = kPeriod_s / kFadeTime_s + 2.0 * kPeriod_s / kRiseTime_s;
constexpr double kSecondTurn_rad =
    1.5; ///< Greater than kJumpRotation_rad_per_s permits in a frame.

Mat3 turned_about(const Vec3& axis, double angle_rad)
{
    return turned_by(axis.normalized() * angle_rad, Mat3::Identity());
}

void spoil_rotation(ToolState& sample, const ToolState& /*good*/, Random& random)
{
    const std::array<double, 4> factors{0.0, -1.0, 1.001, 1e200};
    sample.rotation *= factors[random.below(factors.size())];
}
/// Another rotation in each frame.
void spoil_turns(ToolState& sample, const ToolState& /*good*/, Random& random)
{
    const Vec3 axis = random.in_cube(1.0) + Vec3(0, 0, 1e-3);
    sample.rotation = turned_about(axis, random.between(kSecondTurn_rad, 3.0)) * sample.rotation;
}
void spoil_turned(ToolState& sample, const ToolState& /*good*/, Random& /*random*/)
{
    sample.rotation = turned_about(Vec3(1.0, 0.5, 0.2), kSecondTurn_rad) * sample.rotation;
}

/// Run of a box, 4 cm long, on a plate of 10 cm whose top is at the height of its highest corner.
class RigidGarbageRun
{
public:
    RigidGarbageRun(const Garbage& garbage, std::uint64_t seed)
        : model_(test_model("rigid-small-flat", make_shape(Shape::plate, 400).value(), 60))
        , box_(box_core("box", Vec3(0.02, 0.015, 0.004), 0.001))
        , rig_({&model_}, options())
        , safe_(rig_.frame().tool(0).spec(), kPeriod_s)
        , episodes_(garbage, seed, figures_)
    {
        figures_.name = "box on a plate, " + std::string(garbage.name);
        figures_.unit = "of the largest force or torque";
        figures_.bound = 1.0 + kGarbageRounding;
        center_ = rig_.frame().tool(0).sphere().center;
        for (const Face& face : model_.faces)
        {
            for (const Vec3f& corner : face)
            {
                low_ = least_of(low_, to_vec3(corner));
                high_ = greatest_of(high_, to_vec3(corner));
            }
        }
    }

    [[nodiscard]] TrialFigures run(std::uint32_t frames)
    {
        for (frame_ = 0; frame_ < frames; ++frame_)
        {
            const ToolState sample = episodes_.next(hand());
            check(rig_.step(std::span(&sample, 1), {}), sample.position_m);
        }
        return figures_;
    }

private:
    static RigOptions options()
    {
        RigOptions options;
        options.pool_bytes = std::size_t{32} << 20U;
        ToolSpec spec;
        spec.radius_m = 0.001;
        spec.core = Box{Vec3(0.02, 0.015, 0.004)};
        spec.force_max_n = kToolForceMax_n;
        spec.torque_max_nm = kToolTorqueMax_nm;
        options.tools = {spec};
        Material rough;
        rough.static_friction = 0.3;
        rough.dynamic_friction = 0.2;
        options.objects = {{ModelId{0}, rough}};
        return options;
    }

    /// Hand pose 2 mm too deep, on a circle, rotating about the plate's normal and rocking; from
    /// above at first.
    [[nodiscard]] ToolState hand() const
    {
        const double t = kPeriod_s * frame_;
        const double rest_m = high_.z() + 0.005;
        ToolState state;
        state.position_m = Vec3(0.5 * (low_.x() + high_.x()) + 0.01 * std::cos(3.0 * t),
                                0.5 * (low_.y() + high_.y()) + 0.01 * std::sin(3.0 * t),
                                rest_m + std::max(-0.002, 0.02 - 0.2 * t));
        state.rotation = turned_about(Vec3(1, 0, 0), 0.05 * std::sin(5.0 * t)) *
                         turned_about(Vec3(0, 0, 1), 0.8 * t);
        state.sample_time_ns = kGarbageFrame_ns * (frame_ + 1'000);
        return state;
    }

    void check(const FrameOutput& output, const Vec3& position_m)
    {
        ++figures_.trials;
        const ToolOutput& tool = output.tools[0];
        const ToolForce safe = safe_.both(tool, position_m);
        for (const auto& [norm, most] : {std::pair(tool.force_n.norm(), kToolForceMax_n),
                                         std::pair(tool.torque_nm.norm(), kToolTorqueMax_nm),
                                         std::pair(safe.push.force_n.norm(), kToolForceMax_n),
                                         std::pair(safe.torque.force_n.norm(), kToolTorqueMax_nm)})
        {
            figures_.observe(std::isfinite(norm) ? norm / most : kInfinity);
            expect(norm <= most * (1.0 + kGarbageRounding), std::to_string(norm) + " N or N m");
        }
        if (safe_.gain() < 1.0 && !tool.halted && !tool.over_constrained)
        {
            expect((safe.push.force_n - sent_.push.force_n).norm() <=
                       kMostOfRange * kToolForceMax_n + kGarbageRounding,
                   "the force jumps");
            expect((safe.torque.force_n - sent_.torque.force_n).norm() <=
                       kMostOfRange * kToolTorqueMax_nm + kGarbageRounding,
                   "the torque jumps");
        }
        sent_ = safe;
        const Similarity now{tool.proxy_rotation, tool.proxy_m, 1.0};
        expect(now.translation_m.allFinite() && now.rotation.allFinite(), "the proxy is nowhere");
        expect(frame_ == 0 || crossings_on_way(box_, place_, now, center_, model_, 2) == 0,
               "the box goes through");
        place_ = now;
        expect(!episodes_.is_recovered() || (tool.in_contact && sent_.push.force_n.norm() > 0.5),
               "nothing is felt again");
        episodes_.check(output,
                        sent_.push.force_n.norm() > 0.0 || sent_.torque.force_n.norm() > 0.0);
    }

    void expect(bool holds, const std::string& otherwise) { episodes_.expect(holds, otherwise); }

    const TestModel& model_;
    SolidCore box_;
    FrameRig rig_;
    SafeForce safe_;
    TrialFigures figures_;
    ToolForce sent_;
    Similarity place_;
    Vec3 center_{0, 0, 0};
    Vec3 low_{1e9, 1e9, 1e9};
    Vec3 high_{-1e9, -1e9, -1e9};
    std::uint32_t frame_{0};
    GarbageEpisodes episodes_;
};

} // namespace

std::span<const Garbage> rigid_garbage_kinds()
{
    using enum FrameFault;
    static const auto kinds = []
    {
        std::array<Garbage, kGarbageKinds + 3> all{};
        std::ranges::copy(garbage_kinds(), all.begin());
        all[kGarbageKinds] = {"no rotation", spoil_rotation, tool_invalid, tool_invalid, true};
        all[kGarbageKinds + 1] = {"turns of 1.5 to 3 rad", spoil_turns, tool_jumped, none, false};
        all[kGarbageKinds + 2] = {"a turn that stays", spoil_turned, tool_jumped, none, false};
        return all;
    }();
    return kinds;
}

TrialFigures run_rigid_garbage_trial(const Garbage& garbage, std::uint32_t frames,
                                     std::uint64_t seed)
{
    return RigidGarbageRun(garbage, seed).run(frames);
}

} // namespace tactus::test
