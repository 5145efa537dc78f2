// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/rigid_trial.hpp"

#include "host_tools/shapes/shapes.hpp"
#include "rt_core/limits.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/period.hpp"
#include "tests/shared/random.hpp"
#include "tests/stability/trial_terms.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace tactus::test
{

namespace
{

constexpr double kTorqueMax_nm = 0.5;
constexpr double kStepRounding = 1e-9;
constexpr double kRangeRounding = 1e-12;
/// Checked places of a frame's path.
constexpr int kPlacesOnWay = 4;

Vec3 middle_of(const TestModel& model)
{
    Vec3 low(1e9, 1e9, 1e9);
    Vec3 high = -low;
    for (const Face& face : model.faces)
    {
        for (const Vec3f& corner : face)
        {
            low = least_of(low, to_vec3(corner));
            high = greatest_of(high, to_vec3(corner));
        }
    }
    return 0.5 * (low + high);
}

/// Hand that approaches faces of the object and departs from it, by a share of the remaining
/// distance, while rotating.
class RigidToolOperator
{
public:
    RigidToolOperator(const TestModel& model, std::uint64_t seed)
        : model_(model), random_(Random::seeded(seed)), middle_(middle_of(model))
    {
        state_.position_m = away();
        aim_ = state_.position_m;
    }

    const ToolState& next()
    {
        if (random_.one_in(80))
        {
            const Face& face = model_.faces[random_.below(model_.faces.size())];
            aim_ = random_.one_in(10) ? away()
                   : random_.one_in(4)
                       ? Vec3(middle_ + random_.in_cube(0.3 * model_.diagonal_m))
                       : Vec3(to_vec3(face[0]) + random_.in_cube(0.02 * model_.diagonal_m));
            axis_ = random_.in_cube(1.0) + Vec3(0, 0, 1e-3);
            turn_rad_ = random_.between(0.0, 0.03);
            pace_ = random_.between(0.005, 0.06);
        }
        state_.position_m += pace_ * (aim_ - state_.position_m);
        state_.rotation =
            Eigen::AngleAxisd(turn_rad_, axis_.normalized()).toRotationMatrix() * state_.rotation;
        return state_;
    }

private:
    Vec3 away() { return middle_ + Vec3(1.0, 1.0, 1.0) * model_.diagonal_m; }

    const TestModel& model_;
    Random random_;
    Vec3 middle_;
    ToolState state_;
    Vec3 aim_;
    Vec3 axis_{0, 0, 1};
    double turn_rad_{0.01};
    double pace_{0.04};
};

constexpr double kFastestTurn_rad_per_s = 0.3;

/// Motion of the second object: mean distance and amplitude.
constexpr double kClosingMiddle_diag = 0.45;
constexpr double kClosingWay_diag = 0.45;

/// Poses of the objects in each frame.
class Stage
{
public:
    Stage(const RigidTrial& trial, Random random)
        : stage_(trial.stage)
        , middle_m_(middle_of(*trial.object))
        , size_m_(trial.object->diagonal_m)
    {
        axis_ = (random.in_cube(1.0) + Vec3(0, 0, 1e-3)).normalized();
        if (stage_ == RigidStage::closing)
        {
            // The second object comes from the side opposite to the hand's start.
            axis_ = -axis_.cwiseAbs();
        }
        if (stage_ == RigidStage::far)
        {
            rest_.rotation = Eigen::AngleAxisd(random.between(0.0, 3.0), axis_).toRotationMatrix();
            rest_.scale = random.between(0.5, 2.0);
            const double far_m = random.between(100.0, 1'000.0);
            rest_.translation_m = far_m * random.in_cube(1.0).normalized();
        }
        period_frames_ = random.between(500.0, 2'000.0);
        sway_m_ = stage_ == RigidStage::turning ? 2e-4 * random.in_cube(1.0) : Vec3(0, 0, 0);
    }

    /// Pose of the first object at the start; the hand's motion is relative to it.
    [[nodiscard]] const ObjectPose& at_rest() const { return rest_; }
    /// Number of objects; the last one may move.
    [[nodiscard]] std::size_t objects() const { return stage_ == RigidStage::closing ? 2 : 1; }
    [[nodiscard]] bool moves() const
    {
        return stage_ == RigidStage::turning || stage_ == RigidStage::closing;
    }
    [[nodiscard]] ObjectPose at(std::uint32_t frame) const
    {
        ObjectPose pose = rest_;
        const double phase = 2.0 * std::numbers::pi * frame / period_frames_;
        if (stage_ == RigidStage::closing)
        {
            pose.translation_m =
                (kClosingMiddle_diag + kClosingWay_diag * std::cos(phase)) * size_m_ * axis_;
            return pose;
        }
        const double most_rad =
            kFastestTurn_rad_per_s * kPeriod_s * period_frames_ / (2.0 * std::numbers::pi);
        pose.rotation = Eigen::AngleAxisd(most_rad * std::sin(phase), axis_).toRotationMatrix();
        pose.translation_m =
            middle_m_ - pose.rotation * middle_m_ + std::sin(3.0 * phase) * sway_m_;
        return pose;
    }

private:
    RigidStage stage_;
    Vec3 middle_m_;
    double size_m_;
    ObjectPose rest_;
    Vec3 axis_{0, 0, 1};
    Vec3 sway_m_{0, 0, 0};
    double period_frames_{1'000.0};
};

RigOptions options_of(const RigidTrial& trial)
{
    RigOptions options;
    options.pool_bytes = std::size_t{32} << 20U;
    ToolSpec spec;
    spec.radius_m = trial.tool.radius_m;
    spec.core = trial.tool.core;
    spec.stiffness_n_per_m = kWall_n_per_m;
    spec.force_max_n = kForceMax_n;
    spec.torque_max_nm = kTorqueMax_nm;
    options.tools = {spec};
    options.faults.loss = 0.1;
    options.faults.delay_polls_max = 10;
    options.faults.seed = trial.seed;
    return options;
}

class RigidRun
{
public:
    explicit RigidRun(const RigidTrial& trial)
        : trial_(trial)
        , hand_(*trial.object, trial.seed)
        , stage_(trial, Random::seeded(trial.seed + 1))
    {
        figures_.crossings = {"never through, " + name_of(trial), 0, 0.0, 0.0, "faces", 0, {}};
        figures_.steps.name = "steps without room, " + name_of(trial);
        figures_.steps.bound = 1.0 + kStepRounding;
        figures_.steps.unit = "of what the hand's way makes";
    }

    RigidFigures run()
    {
        std::vector<const TestModel*> models{trial_.object};
        if (trial_.tool.mesh != nullptr)
        {
            models.push_back(trial_.tool.mesh);
        }
        RigOptions options = options_of(trial_);
        options.objects.assign(stage_.objects(), {ModelId{0}, trial_.material});
        options.poses = {stage_.at_rest(), stage_.at(0)};
        options.poses.resize(stage_.objects());
        last_places_.resize(stage_.objects());
        FrameRig rig(models, options);
        center_ = rig.frame().tool(0).sphere().center; // The tool is in its own frame at the start.
        arm_m_ = rig.frame().tool(0).sphere().radius + rig.frame().tool(0).radius_m();
        for (std::uint32_t i = 0; i < trial_.frames; ++i)
        {
            ToolState state = hand_.next();
            state.position_m = stage_.at_rest().local_to_world(state.position_m);
            state.rotation = stage_.at_rest().rotation * state.rotation;
            if (stage_.moves())
            {
                rig.place_object(stage_.at(i), stage_.objects() - 1);
            }
            const FrameOutput output = rig.step(std::span(&state, 1), {});
            judge(i, output.tools[0], rig);
            judge_step(i, state, output.tools[0]);
        }
        return figures_;
    }

private:
    static std::string name_of(const RigidTrial& trial)
    {
        return trial.tool.name + " on " + trial.object->name + ", " + name_of(trial.stage);
    }
    static std::string name_of(RigidStage stage)
    {
        switch (stage)
        {
        case RigidStage::still:
            return "still";
        case RigidStage::turning:
            return "turning";
        case RigidStage::far:
            return "far away";
        case RigidStage::closing:
            return "closing in";
        }
        return "";
    }

    /// Judges a frame in each object's frame; the path begins at the last frame's place.
    void judge(std::uint32_t frame, const ToolOutput& output, const FrameRig& rig)
    {
        const bool is_in_range = output.force_n.norm() <= kForceMax_n * (1.0 + kRangeRounding) &&
                                 output.torque_nm.norm() <= kTorqueMax_nm * (1.0 + kRangeRounding);
        if (!is_in_range || (!output.in_contact && !output.force_n.isZero(0.0)))
        {
            figures_.crossings.flag(where(frame) + "a force that is none, too large or of nothing");
        }
        figures_.contacts += output.in_contact ? 1 : 0;
        figures_.halted += output.halted ? 1 : 0;
        figures_.over_constrained += output.over_constrained ? 1 : 0;
        int met = 0;
        for (std::size_t i = 0; i < last_places_.size(); ++i)
        {
            const Similarity now =
                in_frame(rig.pose(i), Similarity{output.proxy_rotation, output.proxy_m, 1.0});
            met += frame == 0 ? 0
                              : crossings_on_way(trial_.tool, last_places_[i], now, center_,
                                                 *trial_.object, kPlacesOnWay);
            last_places_[i] = now;
        }
        // A single object always leaves space.
        const bool may_be = trial_.stage == RigidStage::closing;
        is_run_over_ = met > 0 ? may_be && (is_run_over_ || output.over_constrained)
                               : is_run_over_ && (output.halted || !output.in_contact);
        figures_.run_over += met > 0 && is_run_over_ ? 1 : 0;
        figures_.crossings.trials += frame > 0 ? 1 : 0;
        figures_.crossings.observe(is_run_over_ ? 0 : met);
        if (met > 0 && !is_run_over_)
        {
            figures_.crossings.flag(where(frame) + std::to_string(met) + " faces are crossed");
        }
    }

    /// Judges the change of the wrench. The springs are a stiffness, and the stiffness times the
    /// square of the arm.
    void judge_step(std::uint32_t frame, const ToolState& hand, const ToolOutput& output)
    {
        const bool has_no_room = output.over_constrained || last_output_.over_constrained;
        if (frame > 0 && has_no_room && output.in_contact && !output.halted)
        {
            const Eigen::AngleAxisd turn(hand.rotation * last_hand_.rotation.transpose());
            const double way_m =
                (hand.position_m - last_hand_.position_m).norm() + arm_m_ * std::abs(turn.angle());
            const double by_device_n = kWall_n_per_m * way_m;
            const double most_n = by_device_n + kCatchUp_n_per_s * kPeriod_s;
            const double most_nm =
                arm_m_ * by_device_n + kCatchUpShare_per_s * kTorqueMax_nm * kPeriod_s;
            const double step =
                std::max((output.force_n - last_output_.force_n).norm() / most_n,
                         (output.torque_nm - last_output_.torque_nm).norm() / most_nm);
            ++figures_.steps.trials;
            figures_.steps.observe(step);
            if (step > figures_.steps.bound)
            {
                figures_.steps.flag(where(frame) + std::to_string(step) + " x");
            }
        }
        last_hand_ = hand;
        last_output_ = output;
    }

    [[nodiscard]] std::string where(std::uint32_t frame) const
    {
        return name_of(trial_) + ", TACTUS_SEED=" + std::to_string(trial_.seed) + ", frame " +
               std::to_string(frame) + ": ";
    }

    const RigidTrial& trial_;
    RigidToolOperator hand_;
    Stage stage_;
    RigidFigures figures_;
    bool is_run_over_{false}; ///< True until the tool has been clear again.
    Vec3 center_{0, 0, 0};
    double arm_m_{0.0};
    std::vector<Similarity> last_places_; ///< Last places of the tool relative to each object.
    ToolState last_hand_;
    ToolOutput last_output_;
};

} // namespace

void RigidFigures::add(const RigidFigures& other)
{
    crossings.add(other.crossings);
    steps.add(other.steps);
    run_over += other.run_over;
    over_constrained += other.over_constrained;
    contacts += other.contacts;
    halted += other.halted;
}

std::vector<RigidTrial> rigid_trials(RigidStage stage)
{
    const auto shape = [](const char* name, Shape made, std::uint32_t faces) -> const TestModel&
    { return test_model(name, make_shape(made, faces).value(), 200); };
    const TestModel& socket = shape("rigid-socket", Shape::socket, 2'000);
    const TestModel& plate = shape("rigid-flat", Shape::plate, 2'000);
    const TestModel& gear = shape("rigid-gear", Shape::gear, 2'000);
    const TestModel& peg = shape("rigid-peg", Shape::peg, 600);
    const TestModel& wheel = shape("rigid-wheel", Shape::gear, 300);
    const std::vector<SolidCore> tools{
        mesh_core("peg", peg, 1e-4), box_core("plate", Vec3(0.02, 0.015, 0.001), 5e-4),
        mesh_core("gear", wheel, 5e-4), segment_core("needle", {{0, 0, -0.03}, {0, 0, 0.03}}, 2e-4),
        segment_core("pin", {{0, 0, -0.02}, {0, 0, 0.02}}, 0.01)};
    Material rough;
    rough.static_friction = 0.5;
    rough.dynamic_friction = 0.4;
    std::vector<RigidTrial> trials;
    for (const SolidCore& tool : tools)
    {
        for (const TestModel* object : {&socket, &plate, &gear})
        {
            trials.push_back(
                {tool, object, trials.size() % 2 == 0 ? Material{} : rough, stage, 0, 0});
        }
    }
    return trials;
}

std::vector<RigidTrial> rigid_trials_on_small_models()
{
    const Vec3 half(0.012, 0.008, 0.004);
    const TestModel& mesh = test_model("rigid-tool", make_uv_sphere(12, 16).value(), 60);
    std::vector<RigidTrial> trials;
    for (const SolidCore& tool :
         {box_core("box", half, 0.001),
          segment_core("capsule", {{-0.01, 0, 0}, {0.02, 0, 0.003}}, 0.002), spike_core(0.001),
          box_core("box without a radius", 2.0 * half, 0.0), mesh_core("mesh", mesh, 0.0015)})
    {
        for (const TestModel* object : small_models())
        {
            trials.push_back({tool, object, Material{}, RigidStage::still, 0, 0});
        }
    }
    return trials;
}

RigidFigures run_rigid_trial(const RigidTrial& trial)
{
    return RigidRun(trial).run();
}

} // namespace tactus::test
