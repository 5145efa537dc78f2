// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// No input ends the process: tools without free space, hands at rest and exactly along walls.

#include "rt_core/base/assert.hpp"
#include "rt_core/geometry/tool_core.hpp"
#include "rt_core/math/rotation.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/period.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/solid_cores.hpp"
#include "tests/shared/trial_figures.hpp"
#include "tests/shared/trial_length.hpp"
#include "tests/stability/trial_terms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace tactus::test
{
namespace
{

/// Kind of tool with too little free space.
struct CrampedTool
{
    const char* name;
    ToolCore core;
    double radius_m{0.0};
    double shading_m{0.0};                    ///< See ToolSpec.
    bool query_only{false};                   ///< True for a query-only tool without force.
    double angular_stiffness_nm_per_rad{0.0}; ///< See ToolSpec.
};

constexpr std::uint32_t kCrampedFrames = 200;
constexpr std::int64_t kCrampedFrame_ns = 1'000'000;
constexpr double kCrampedTorqueMax_nm = 0.3;
constexpr double kCrampedRounding = 1e-12;
constexpr std::uint32_t kCrampedObjects = 3;
constexpr double kCrampedSize_m = 0.002; ///< Approximate size of a tool.

/// Trial that a failed assertion belongs to. Only one runs at a time.
struct RunningEpisode
{
    const char* tool{""};
    bool has_friction{false};
    std::uint64_t seed{0};
    std::uint32_t episode{0};
    std::uint32_t frame{0};
};
RunningEpisode
    running_episode; // NOLINT(cppcoreguidelines-avoid-non-const-global-variables): for the handler.

void tell_which(const char* condition, const char* file, int line) noexcept
{
    std::fprintf(stderr, "%s, friction %d: seed %llu, episode %u, frame %u: %s (%s:%d)\n",
                 running_episode.tool, running_episode.has_friction ? 1 : 0,
                 static_cast<unsigned long long>(running_episode.seed), running_episode.episode,
                 running_episode.frame, condition, file, line);
}

/// Reports the running trial on a failed assertion before the program ends, for its lifetime.
class TellsAssertions
{
public:
    TellsAssertions() : before_(set_assert_handler(tell_which)) {}
    TellsAssertions(const TellsAssertions&) = delete;
    TellsAssertions& operator=(const TellsAssertions&) = delete;
    ~TellsAssertions() { set_assert_handler(before_); }

private:
    AssertHandler before_;
};

/// Closed box around the origin, of 12 faces.
TriangleMesh make_closed_box(const Vec3& half)
{
    TriangleMesh box;
    for (std::uint32_t corner = 0; corner < 8; ++corner)
    {
        box.positions.push_back({(corner & 1U) != 0 ? half.x() : -half.x(),
                                 (corner & 2U) != 0 ? half.y() : -half.y(),
                                 (corner & 4U) != 0 ? half.z() : -half.z()});
    }
    box.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return box;
}

/// Models of the objects: a plate of 0.1 mm, the same with many faces, and a cube.
const std::array<const TestModel*, 3>& cramping_models()
{
    static const std::array<const TestModel*, 3> models{
        &test_model("no-room-plate", make_closed_box(Vec3(0.04, 0.04, 5e-5))), &small_model(4),
        &test_model("no-room-cube", make_closed_box(Vec3(0.01, 0.01, 0.01)))};
    return models;
}

const TestModel& cramped_tool_model()
{
    return test_model("no-room-tool", make_closed_box(Vec3(0.003, 0.002, 0.0015)));
}

/// Centre and half extents of a model, in its frame.
struct ModelExtent
{
    Vec3 middle{0.0, 0.0, 0.0};
    Vec3 half{0.0, 0.0, 0.0};
};

ModelExtent extent_in_model(const TestModel& model)
{
    Vec3 low = to_vec3(model.faces[0][0]);
    Vec3 high = low;
    for (const Face& face : model.faces)
    {
        for (const Vec3f& corner : face)
        {
            low = least_of(low, to_vec3(corner));
            high = greatest_of(high, to_vec3(corner));
        }
    }
    return {0.5 * (low + high), 0.5 * (high - low)};
}

Mat3 cramped_turn(const Vec3& axis, double angle_rad)
{
    return turned_by(axis * angle_rad, Mat3::Identity());
}

/// One scene with one hand in it.
class CrampedEpisode
{
public:
    CrampedEpisode(const CrampedTool& tool, bool has_friction, std::uint64_t seed)
        : random_(Random::seeded(seed))
        , tool_(tool)
        , has_friction_(has_friction)
        , room_(static_cast<Room>(random_.below(kRooms)))
        , rig_(make_rig())
    {
        load_everything(rig_);
        next_leg();
    }

    void run(TrialFigures& figures)
    {
        for (std::uint32_t frame = 0; frame < kCrampedFrames; ++frame)
        {
            running_episode.frame = frame;
            change_scene(frame);
            move();
            ToolState hand;
            hand.position_m = place_m_;
            hand.rotation = rotation_;
            hand.sample_time_ns = has_clock_ ? kCrampedFrame_ns * (frame + 1'000) : 0;
            hand.elapsed_periods = random_.one_in(50) ? random_.below(6U) : 1;
            spoil(hand);
            check(rig_.step(std::span(&hand, 1), budgets_), frame, figures);
        }
    }

private:
    enum class Room : std::uint8_t
    {
        plate,
        gap,
        wedge,
        corner,
        closing,
        coming,
    };
    static constexpr std::uint32_t kRooms = 6;

    struct Object
    {
        ModelId model{};
        ModelExtent extent;
        Vec3 place_m{0.0, 0.0, 0.0};
        Mat3 rotation{Mat3::Identity()};
        double scale{1.0};
        std::uint32_t generation{0};
        bool is_resident{true};

        [[nodiscard]] ObjectPose pose() const
        {
            ObjectPose pose;
            pose.rotation = rotation;
            pose.scale = scale;
            pose.translation_m = place_m - scale * (rotation * extent.middle);
            return pose;
        }
    };

    FrameRig make_rig()
    {
        std::vector<const TestModel*> models{cramping_models()[0], &cramped_tool_model(),
                                             cramping_models()[1], cramping_models()[2]};
        budgets_.planes = random_.one_in(8) ? random_.below(60U) : budgets_.planes;
        budgets_.nodes = random_.one_in(12) ? random_.below(20U) : budgets_.nodes;
        budgets_.triangles = random_.one_in(12) ? random_.below(20U) : budgets_.triangles;
        budgets_.splits = random_.one_in(12) ? random_.below(3U) : budgets_.splits;
        budgets_.merges = random_.one_in(12) ? random_.below(3U) : budgets_.merges;
        has_clock_ = !random_.one_in(4);
        turns_scene_ = random_.one_in(3);
        scene_rotation_ = turns_scene_ ? cramped_turn(random_.in_cube(1.0), 1.0) : Mat3::Identity();
        lay_out();
        RigOptions options = with_room_for_all();
        ToolSpec spec;
        spec.core = tool_.core;
        spec.radius_m = tool_.radius_m;
        spec.shading_m = tool_.shading_m;
        spec.angular_stiffness_nm_per_rad = tool_.angular_stiffness_nm_per_rad;
        spec.query_only = tool_.query_only;
        spec.wants_contacts = tool_.query_only || random_.one_in(4);
        spec.wants_distance = tool_.query_only;
        spec.force_max_n = kForceMax_n;
        spec.torque_max_nm = kCrampedTorqueMax_nm;
        spec.stiffness_n_per_m = random_.one_in(10) ? 0.0 : kWall_n_per_m;
        options.tools = {spec};
        for (const Object& object : objects_)
        {
            options.objects.push_back({object.model, feel()});
            options.poses.push_back(object.pose());
        }
        options.capacities.objects = kCrampedObjects;
        return {models, options};
    }

    /// Material as a server may send it, occasionally an implausible one.
    Material feel()
    {
        Material material;
        if (random_.one_in(10))
        {
            material.stiffness_n_per_m = random_.one_in(2) ? 1e-200 : 1e6;
        }
        if (!has_friction_)
        {
            return material;
        }
        constexpr std::array<double, 4> kStatic{0.3, 0.3, 1e-12, kFrictionMax};
        material.static_friction = kStatic[random_.below(kStatic.size())];
        material.dynamic_friction =
            random_.one_in(2) ? material.static_friction : random_.between(0.0, 0.2) * 1e-12;
        if (random_.one_in(3))
        {
            material.viscosity_n_s_per_m = random_.one_in(2) ? 5.0 : kDampingMax_n_s_per_m;
            material.damping_n_s_per_m = random_.one_in(2) ? 5.0 : kDampingMax_n_s_per_m;
        }
        if (random_.one_in(3))
        {
            material.texture_length_m = random_.one_in(2) ? kTextureLengthMin_m : 2e-3;
            material.texture_height_m = kTextureSteepest * material.texture_length_m;
        }
        return material;
    }

    void add(std::uint32_t shown, const Vec3& place_m, const Mat3& rotation)
    {
        Object object;
        object.model = ModelId{shown == 0 ? 0U : shown + 1};
        object.extent = extent_in_model(*cramping_models()[shown]);
        constexpr std::array<double, 4> kObjectScales{0.5, 3.0, kPoseScaleMin, kPoseScaleMax};
        object.scale =
            random_.one_in(12) ? kObjectScales[random_.below(kObjectScales.size())] : 1.0;
        object.place_m = scene_rotation_ * place_m;
        object.rotation = scene_rotation_ * rotation;
        objects_.push_back(object);
    }
    /// Distance between the centres of two objects of this model with `room_m` between their sides.
    [[nodiscard]] static double apart_m(std::uint32_t shown, double room_m)
    {
        return room_m + 2.0 * extent_in_model(*cramping_models()[shown]).half.z();
    }

    void lay_out()
    {
        const std::uint32_t shown = random_.below(3U);
        constexpr std::array<double, 6> kRoom{0.0, 0.3, 1.0, 1.9, 2.0, 2.2};
        gap_m_ = kCrampedSize_m * kRoom[random_.below(kRoom.size())];
        const double half_m = 0.5 * apart_m(shown, gap_m_);
        const Mat3 upright = Mat3::Identity();
        switch (room_)
        {
        case Room::plate:
            add(shown, Vec3(0, 0, 0), upright);
            break;
        case Room::gap:
            add(shown, Vec3(0, 0, half_m), upright);
            add(shown, Vec3(0, 0, -half_m), upright);
            break;
        case Room::wedge:
        {
            constexpr std::array<double, 4> kLean{1e-9, 1e-4, 0.1, 0.8};
            const double lean = kLean[random_.below(kLean.size())];
            add(shown, Vec3(0, 0, half_m), cramped_turn(Vec3(1, 0, 0), lean));
            add(shown, Vec3(0, 0, -half_m), cramped_turn(Vec3(1, 0, 0), -lean));
            break;
        }
        case Room::corner:
            add(shown, Vec3(0, 0, -half_m), upright);
            add(shown, Vec3(0, -half_m, 0), cramped_turn(Vec3(1, 0, 0), 2.0));
            add(shown, Vec3(-half_m, 0, 0), cramped_turn(Vec3(0, 1, 0), 2.0));
            break;
        case Room::closing:
            add(shown, Vec3(0, 0, apart_m(shown, 8.0 * kCrampedSize_m) / 2.0), upright);
            add(shown, Vec3(0, 0, -apart_m(shown, 8.0 * kCrampedSize_m) / 2.0), upright);
            add(random_.below(3U), Vec3(0.5, 0, 0), upright);
            break;
        case Room::coming:
            add(shown, Vec3(0, 0, 0), upright);
            add(random_.below(3U), Vec3(0, 0, 0.004), upright);
            add(random_.below(3U), Vec3(3.0, 0, 0), upright);
            break;
        }
    }

    void change_scene(std::uint32_t frame)
    {
        if (room_ == Room::closing)
        {
            close_in(frame);
        }
        if (room_ == Room::coming && random_.one_in(6))
        {
            come_or_go(random_.below(static_cast<std::uint32_t>(objects_.size())));
        }
        if (random_.one_in(60))
        {
            SceneChange change;
            change.kind = SceneChangeKind::object_feels;
            change.number = random_.below(static_cast<std::uint32_t>(objects_.size()));
            change.generation = objects_[change.number].generation;
            change.object.material = feel();
            rig_.change(change);
        }
    }

    /// Closes until the objects overlap, then opens; occasionally in one jump.
    void close_in(std::uint32_t frame)
    {
        const double step_m = random_.one_in(40) ? 0.004 : 1e-4;
        const bool is_closing = frame % 120 < 70;
        for (std::uint32_t i = 0; i < 2; ++i)
        {
            const double side = (i == 0) == is_closing ? -1.0 : 1.0;
            objects_[i].place_m += scene_rotation_ * Vec3(0, 0, side * step_m);
            rig_.place_object(objects_[i].pose(), i);
        }
    }

    void come_or_go(std::uint32_t number)
    {
        Object& object = objects_[number];
        SceneChange change;
        change.number = number;
        if (object.is_resident && random_.one_in(2))
        {
            object.place_m = spot();
            rig_.place_object(object.pose(), number);
            return;
        }
        object.is_resident = !object.is_resident;
        if (object.is_resident)
        {
            ++object.generation;
            object.place_m = random_.one_in(2) ? place_m_ : spot();
            change.object = {object.model, feel()};
            change.pose = object.pose();
            change.kind = SceneChangeKind::object_comes;
        }
        else
        {
            change.kind = SceneChangeKind::object_goes;
        }
        change.generation = object.generation;
        rig_.change(change);
    }

    /// Hand position at an exact place of an object.
    Vec3 spot()
    {
        const Object& object = objects_[random_.below(objects_.size())];
        const Vec3 half = object.scale * object.extent.half;
        const double reach_m = tool_.radius_m > 0.0 ? tool_.radius_m : 1e-6;
        Vec3 at(0.0, 0.0, 0.0);
        const auto axis = static_cast<Eigen::Index>(random_.below(3U));
        const double side = random_.one_in(2) ? 1.0 : -1.0;
        switch (random_.below(10U))
        {
        case 0:
        case 1:
            break;
        case 2:
            at[2] = side * half[2];
            break;
        case 3:
            at[axis] = side * half[axis];
            break;
        case 4:
            at[axis] = side * (half[axis] + reach_m);
            break;
        case 5:
            at = Vec3(half.x(), half.y(), side * half.z());
            break;
        case 6:
            return Vec3(0.0, 0.0, 0.0);
        case 7:
            return random_.in_cube(0.02);
        case 8:
        {
            constexpr std::array<double, 4> kFar_m{6.0, 6.0, 0.9 * kPoseReachMax_m,
                                                   0.9 * kGoalRange_m};
            return Vec3(side * kFar_m[random_.below(kFar_m.size())], 0.0, 0.0);
        }
        default:
            at = Vec3(0.5 * half.x(), 0.25 * half.y(), side * (half.z() + 2.0 * reach_m));
            break;
        }
        return object.place_m + object.rotation * at;
    }

    /// Begins the next activity of the hand.
    void next_leg()
    {
        const Object& object = objects_[random_.below(objects_.size())];
        frames_left_ = 1 + random_.below(60U);
        if (random_.one_in(2))
        {
            place_m_ = spot();
        }
        constexpr std::array<double, 6> kSpeeds{0.0, 1e-12, 1e-6, 1e-5, 1e-4, 2e-3};
        const double step_m = kSpeeds[random_.below(kSpeeds.size())];
        Vec3 way(0.0, 0.0, 0.0);
        way[static_cast<Eigen::Index>(random_.below(3U))] = random_.one_in(2) ? 1.0 : -1.0;
        step_m_ = step_m * (object.rotation * way);
        if (random_.one_in(5))
        {
            step_m_ = step_m * random_.in_cube(1.0);
        }
        if (random_.one_in(4))
        {
            rotation_ =
                random_.one_in(2) ? object.rotation : cramped_turn(random_.in_cube(2.0), 1.0);
        }
        turn_ = random_.one_in(3) ? Vec3(random_.in_cube(0.01)) : Vec3(0.0, 0.0, 0.0);
    }

    void move()
    {
        if (frames_left_ == 0)
        {
            next_leg();
        }
        --frames_left_;
        place_m_ += step_m_;
        rotation_ = turned_by(turn_, rotation_);
    }

    /// Drops or corrupts the device's sample occasionally, or pauses for long.
    void spoil(ToolState& hand)
    {
        switch (random_.below(1'000U))
        {
        case 0:
            hand.valid = false;
            break;
        case 1:
            hand.position_m[0] = std::numeric_limits<double>::quiet_NaN();
            break;
        case 2:
            hand.rotation *= 0.0;
            break;
        case 3:
            hand.elapsed_periods = 0xFFFF'FFFFU;
            break;
        default:
            break;
        }
    }

    void check(const FrameOutput& output, std::uint32_t frame, TrialFigures& figures)
    {
        ++figures.trials;
        const ToolOutput& tool = output.tools[0];
        const double share = std::max(tool.force_n.norm() / kForceMax_n,
                                      tool.torque_nm.norm() / kCrampedTorqueMax_nm);
        figures.observe(share);
        const bool is_sound = std::isfinite(share) && share <= figures.bound &&
                              tool.proxy_m.allFinite() && tool.proxy_rotation.allFinite() &&
                              std::isfinite(tool.stiffness_n_per_m) && std::isfinite(tool.lag_m);
        if (!is_sound)
        {
            figures.flag("episode " + std::to_string(running_episode.episode) + ", frame " +
                         std::to_string(frame) + ": force " + exactly(tool.force_n) + ", torque " +
                         exactly(tool.torque_nm) + ", proxy " + exactly(tool.proxy_m) +
                         ", stiffness " + exactly(tool.stiffness_n_per_m) + ", lag " +
                         exactly(tool.lag_m));
        }
    }

    Random random_;
    const CrampedTool& tool_;
    bool has_friction_;
    Room room_;
    double gap_m_{0.0};
    Budgets budgets_;
    bool has_clock_{true};
    bool turns_scene_{false};
    Mat3 scene_rotation_{Mat3::Identity()};
    std::vector<Object> objects_;
    FrameRig rig_;
    Vec3 place_m_{0.0, 0.0, 0.02};
    Mat3 rotation_{Mat3::Identity()};
    Vec3 step_m_{0.0, 0.0, 0.0};
    Vec3 turn_{0.0, 0.0, 0.0};
    std::uint32_t frames_left_{0};
};

/// Tools of every kind, with and without a radius, and cores that degenerate to a point, a line or
/// a plane. A mesh is model 1.
std::span<const CrampedTool> cramped_tools()
{
    static const Segment axis{Vec3(0, 0, -0.004), Vec3(0, 0, 0.004)};
    static const Box box{Vec3(0.003, 0.002, 0.0015)};
    static const ToolCore spike = spike_core(0.0).core;
    static const std::array point{Vec3(0.001, 0, 0)};
    static const std::array line{Vec3(0, 0, 0), Vec3(0, 0, 0.003)};
    static const std::vector<CrampedTool> tools{
        {"point", PointCore{}},
        {"sphere", PointCore{}, kCrampedSize_m},
        {"sphere with force shading", PointCore{}, kCrampedSize_m, 0.004},
        {"capsule", axis, kCrampedSize_m},
        {"capsule without a radius", axis},
        {"box", box, 0.0005},
        {"box without a radius", box},
        {"hull", spike, 0.0005},
        {"hull without a radius", spike},
        {"mesh", MeshCore{ModelId{1}}, 0.0005},
        {"mesh without a radius", MeshCore{ModelId{1}}},
        {"point that measures", PointCore{}, 0.0, 0.0, true},
        {"mesh that measures", MeshCore{ModelId{1}}, 0.0, 0.0, true},
        {"capsule without a length", Segment{}, kCrampedSize_m},
        {"capsule without any size", Segment{}},
        {"box without any size", Box{}},
        {"plane", Box{Vec3(0.003, 0.002, 0.0)}},
        {"hull of a point", Hull::create(point).value()},
        {"hull of a line", Hull::create(line).value()},
        {"box that hardly turns", box, 0.0005, 0.0, false, 1e6},
        {"box that turns at nothing", box, 0.0005, 0.0, false, 1e-200},
    };
    return tools;
}

/// Episodes of 200 frames among objects that leave a tool little or no space: a plate thinner than
/// the tool's skin, gaps and wedges narrower than the tool, a corner, objects that close in, and
/// objects that are added and removed. The hand rests on faces, in them, in their middle and at the
/// tool's width from them, moves exactly along them, presses, and jumps. In each frame force and
/// torque are finite and within the device's range, and the proxy is finite; a failed assertion
/// ends the program with the seed of the episode. The error is the greatest force divided by the
/// allowed one.
TrialFigures run_no_room_trial(const CrampedTool& tool, bool has_friction, std::uint32_t frames,
                               std::uint64_t seed)
{
    const TellsAssertions tells;
    TrialFigures figures;
    figures.name = std::string(tool.name) + (has_friction ? " with" : " without") + " friction";
    figures.unit = "of the largest force or torque";
    figures.bound = 1.0 + kCrampedRounding;
    for (std::uint32_t episode = 0; episode * kCrampedFrames < frames; ++episode)
    {
        running_episode = {tool.name, has_friction, seed, episode, 0};
        CrampedEpisode(tool, has_friction, mixed(seed, episode)).run(figures);
    }
    return figures;
}

class NoRoom : public testing::TestWithParam<std::size_t>
{
};

TEST_P(NoRoom, ends_no_process_and_leaves_every_force_finite_and_in_range)
{
    const std::uint32_t frames = has_full_trials() ? 25'000 : 1'000;
    for (const bool has_friction : {false, true})
    {
        const TrialFigures sut = run_no_room_trial(cramped_tools()[GetParam()], has_friction,
                                                   frames, seed_of(20'261'600));
        std::printf("%s\n", sut.summary().c_str());
        EXPECT_TRUE(sut.holds());
    }
}

INSTANTIATE_TEST_SUITE_P(tools, NoRoom, testing::Range<std::size_t>(0, cramped_tools().size()));

} // namespace

} // namespace tactus::test
