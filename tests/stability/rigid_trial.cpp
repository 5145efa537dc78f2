// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/rigid_trial.hpp"

#include "host_tools/shapes/shapes.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/random.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <string>

namespace tactus::test
{

namespace
{

constexpr double kTrialStiffness = 500.0;

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

/// Goes to faces of the object and away from it, by a share of what is left, turning as it goes.
class BodyHand
{
public:
    BodyHand(const TestModel& model, std::uint64_t seed)
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

RigOptions options_of(const RigidTrial& trial)
{
    RigOptions options;
    options.pool_bytes = std::size_t{32} << 20U;
    ToolSpec spec;
    spec.radius_m = trial.tool.radius_m;
    spec.core = trial.tool.core;
    spec.stiffness_n_per_m = kTrialStiffness;
    spec.force_max_n = 1e6;
    spec.torque_max_nm = 1e6;
    options.tools = {spec};
    options.objects = {{ModelId{0}, trial.material}};
    options.faults.loss = 0.05;
    options.faults.delay_polls_max = 10;
    options.faults.seed = trial.seed;
    return options;
}

class RigidRun
{
public:
    explicit RigidRun(const RigidTrial& trial) : trial_(trial), hand_(*trial.object, trial.seed)
    {
        const std::string name = trial.tool.name + " on " + trial.object->name;
        figures_.crossings = {"never through, " + name, 0, 0.0, 0.0, "faces", 0, {}};
    }

    RigidFigures run()
    {
        std::vector<const TestModel*> models{trial_.object};
        if (trial_.tool.mesh != nullptr)
        {
            models.push_back(trial_.tool.mesh);
        }
        FrameRig rig(models, options_of(trial_));
        center_ = rig.frame().tool(0).ball().center; // At its start the tool is in its own frame.
        for (std::uint32_t i = 0; i < trial_.frames; ++i)
        {
            const ToolState& state = hand_.next();
            const FrameOutput output = rig.step(std::span(&state, 1), {});
            judge(i, output.tools[0]);
        }
        return figures_;
    }

private:
    void judge(std::uint32_t frame, const ToolOutput& output)
    {
        const Similarity now{output.proxy_rotation, output.proxy_m, 1.0};
        figures_.contacts += output.in_contact ? 1 : 0;
        figures_.frozen += output.frozen ? 1 : 0;
        if (frame > 0)
        {
            ++figures_.crossings.trials;
            const int met =
                crossings_on_way(trial_.tool, last_place_, now, center_, *trial_.object, 2);
            figures_.crossings.observe(met);
            if (met > 0)
            {
                figures_.crossings.flag(where(frame) + std::to_string(met) + " faces are crossed");
            }
        }
        last_place_ = now;
    }

    [[nodiscard]] std::string where(std::uint32_t frame) const
    {
        return trial_.tool.name + " on " + trial_.object->name +
               ", TACTUS_SEED=" + std::to_string(trial_.seed) + ", frame " + std::to_string(frame) +
               ": ";
    }

    const RigidTrial& trial_;
    BodyHand hand_;
    RigidFigures figures_;
    Vec3 center_{0, 0, 0};
    Similarity last_place_;
};

} // namespace

void RigidFigures::add(const RigidFigures& other)
{
    crossings.add(other.crossings);
    contacts += other.contacts;
    frozen += other.frozen;
}

std::vector<RigidTrial> rigid_trials()
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
            trials.push_back({tool, object, trials.size() % 2 == 0 ? Material{} : rough, 0, 0});
        }
    }
    return trials;
}

RigidFigures run_rigid_trial(const RigidTrial& trial)
{
    return RigidRun(trial).run();
}

} // namespace tactus::test
