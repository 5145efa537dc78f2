// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// The suite `frame`: the stages of one frame while a tool slides over the bunny.
///
/// The goals come from one first pass, in which the tool follows the surface that it feels. They
/// are then replayed several times from the start; each frame keeps its least time, which takes out
/// what the machine's scheduler adds and leaves what the algorithm does; the quantiles go over
/// frames.

#include "host_tools/mesh/prepare.hpp"
#include "host_tools/mesh/read_mesh.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "tests/bench/bench_row.hpp"
#include "tests/shared/frame_rig.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>

namespace tactus::bench
{

namespace
{

using test::FrameRig;
using test::TestModel;

struct FrameCase
{
    const char* name;
    double speed_diag_per_s;
    std::uint32_t splits;
};

constexpr std::array<FrameCase, 2> kCases{FrameCase{"slide-0.1-K64", 0.1, 64},
                                          FrameCase{"slide-2-K64", 2.0, 64}};
constexpr double kPeriod_s = 1e-3;

/// Nanoseconds of each stage, and of the frame as a whole, for each frame.
struct FrameTimes
{
    std::array<std::vector<double>, kStages> stage_ns;
    std::vector<double> frame_ns;
};

class StageTimer
{
public:
    void begin()
    {
        start_ = Clock::now();
        last_ = start_;
    }
    [[nodiscard]] StageMark mark()
    {
        return {[](void* context, Stage stage) noexcept
                { static_cast<StageTimer*>(context)->end(stage); },
                this};
    }
    std::array<double, kStages> stage_ns{};

    [[nodiscard]] double frame_ns() const { return nanoseconds(start_, last_); }

private:
    using Clock = std::chrono::steady_clock;

    static double nanoseconds(Clock::time_point from, Clock::time_point to)
    {
        return static_cast<double>(
            std::chrono::duration_cast<std::chrono::nanoseconds>(to - from).count());
    }
    void end(Stage stage) noexcept
    {
        const Clock::time_point now = Clock::now();
        stage_ns[static_cast<std::size_t>(stage)] = nanoseconds(last_, now);
        last_ = now;
    }

    Clock::time_point start_;
    Clock::time_point last_;
};

/// The bunny where it is at hand, a generated stand-in of its size elsewhere.
const TestModel& bench_model()
{
    const char* folder = std::getenv("TACTUS_MESHES");
    if (folder != nullptr)
    {
        const auto mesh = read_mesh(std::filesystem::path(folder) / "stanford-bunny.obj");
        if (mesh)
        {
            return test::test_model("bunny", mesh.value(), 500);
        }
    }
    return test::test_model("bumpy-sphere", make_shape(Shape::bumpy_sphere, 69'000).value(), 500);
}

/// Slides by what it feels: across the force with a turning heading, pressed in by a set depth.
std::vector<Vec3> slide_over(const TestModel& model, const test::RigOptions& options,
                             const FrameCase& slide, const Budgets& budgets, std::size_t frames)
{
    FrameRig rig(model, options);
    const double depth_m = 0.005 * model.diagonal_m;
    const double step_m = slide.speed_diag_per_s * model.diagonal_m * kPeriod_s;
    // From above the highest corner down onto it, then on.
    Vec3 top = to_vec3(model.faces.front()[0]);
    for (const test::Face& face : model.faces)
    {
        for (const Vec3f& corner : face)
        {
            top = corner[2] > static_cast<float>(top.z()) ? to_vec3(corner) : top;
        }
    }
    std::vector<Vec3> goals;
    Vec3 goal = top + Vec3(0.0, 0.0, 0.05 * model.diagonal_m);
    Vec3 normal(0.0, 0.0, 1.0);
    Vec3 heading(1.0, 0.0, 0.0);
    for (std::size_t i = 0; i < frames; ++i)
    {
        goals.push_back(goal);
        const FrameOutput output = rig.step(goal, budgets);
        const ToolOutput& tool = output.tools[0];
        if (tool.in_contact && tool.force_n.norm() > 0.0)
        {
            normal = tool.force_n.normalized();
        }
        const double turn = 3.0 * kPeriod_s * (i / 700 % 2 == 0 ? 1.0 : -1.0);
        heading =
            (heading - heading.dot(normal) * normal + turn * normal.cross(heading)).normalized();
        const Vec3 pressed = tool.in_contact ? Vec3(tool.proxy_m - depth_m * normal)
                                             : Vec3(tool.proxy_m - 4.0 * step_m * normal);
        goal = pressed + step_m * heading;
    }
    return goals;
}

void keep_least(std::vector<double>& kept, std::size_t frame, double value)
{
    if (frame == kept.size())
    {
        kept.push_back(value);
    }
    kept[frame] = std::min(kept[frame], value);
}

double quantile(std::vector<double> values, double q)
{
    std::sort(values.begin(), values.end());
    const double place = std::ceil(q * static_cast<double>(values.size())) - 1.0;
    return values[static_cast<std::size_t>(std::max(place, 0.0))];
}

struct Replayed
{
    FrameTimes times;
    std::uint64_t hash{0};
    std::uint64_t answered{0};
    std::uint64_t splits{0};
    std::uint64_t nodes{0};
    double raw_max_ns{0.0};
    bool hashes_agree{true};
};

void replay_once(const TestModel& model, const test::RigOptions& options,
                 const std::vector<Vec3>& goals, const Budgets& budgets, int pass, Replayed& result)
{
    FrameRig rig(model, options);
    StageTimer timer;
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < goals.size(); ++i)
    {
        rig.deliver();
        rig.frame().rehearse();
        timer.begin();
        const FrameOutput output = rig.step_without_delivery({goals[i]}, budgets, timer.mark());
        for (std::size_t stage = 0; stage < kStages; ++stage)
        {
            keep_least(result.times.stage_ns[stage], i, timer.stage_ns[stage]);
        }
        keep_least(result.times.frame_ns, i, timer.frame_ns());
        result.raw_max_ns = std::max(result.raw_max_ns, timer.frame_ns());
        hash += output.models[0].state_hash * (2 * i + 1);
        if (pass == 0)
        {
            const AnswerKind kind = output.pairs[0].kind;
            result.answered += kind == AnswerKind::exact || kind == AnswerKind::decided ? 1 : 0;
            result.splits += output.work.splits;
            result.nodes += output.work.nodes_visited;
        }
    }
    result.hashes_agree = result.hashes_agree && (pass == 0 || hash == result.hash);
    result.hash = hash;
}

void add_rows(const TestModel& model, const FrameCase& slide, const Replayed& replayed, Rows& rows)
{
    const std::size_t frames = replayed.times.frame_ns.size();
    const auto add = [&](const std::string& metric, double value, const char* unit)
    {
        rows.push_back({"frame", slide.name, metric, value, unit, model.name, 0, frames,
                        replayed.hash, std::nullopt, 0.0});
    };
    constexpr std::array<const char*, kStages> kNames{"load", "refine", "refit", "query", "force"};
    const auto add_times = [&](const std::string& name, const std::vector<double>& times)
    {
        add(name + ".p50", quantile(times, 0.5) * 1e-3, "us");
        add(name + ".p99", quantile(times, 0.99) * 1e-3, "us");
        add(name + ".max", quantile(times, 1.0) * 1e-3, "us");
    };
    for (std::size_t stage = 0; stage < kStages; ++stage)
    {
        add_times(kNames[stage], replayed.times.stage_ns[stage]);
    }
    add_times("frame", replayed.times.frame_ns);
    add("frame.raw_max", replayed.raw_max_ns * 1e-3, "us");
    const auto count = static_cast<double>(frames);
    add("answered", 100.0 * static_cast<double>(replayed.answered) / count, "%");
    add("splits", static_cast<double>(replayed.splits) / count, "/frame");
    add("nodes", static_cast<double>(replayed.nodes) / count, "/frame");
}

} // namespace

std::optional<std::string> run_frame_suite(const BenchOptions& options, Rows& rows)
{
    const TestModel& model = bench_model();
    const std::size_t frames = options.quick ? 1'500 : 6'000;
    const int passes = options.quick ? 3 : 5;
    test::RigOptions rig_options;
    rig_options.pool_bytes = std::size_t{2} << 20U;
    for (const FrameCase& slide : kCases)
    {
        Budgets budgets;
        budgets.splits = slide.splits;
        budgets.merges = slide.splits;
        const std::vector<Vec3> goals = slide_over(model, rig_options, slide, budgets, frames);
        Replayed replayed;
        for (int pass = 0; pass < passes; ++pass)
        {
            replay_once(model, rig_options, goals, budgets, pass, replayed);
        }
        if (!replayed.hashes_agree)
        {
            return fmt::format("frame {}: replays of the same goals gave different state hashes",
                               slide.name);
        }
        add_rows(model, slide, replayed, rows);
    }
    return std::nullopt;
}

} // namespace tactus::bench
