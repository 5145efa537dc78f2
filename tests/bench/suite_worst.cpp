// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `worst`: greatest cost of a frame under motions made to be expensive, for every kind of
/// tool. With --instructions in instructions, which are the same on every machine.

#include "host_tools/shapes/shapes.hpp"
#include "rt_core/records/frame_input.hpp"
#include "tests/bench/bench_row.hpp"
#include "tests/bench/instruction_count.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/mesh_touch.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/bench/suites.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/random.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <variant>
#include <vector>

namespace tactus::bench
{
namespace
{

/// Shapes of tools; lengths of those that slide over an object of 0.1 m.
enum class WorstTool : std::uint8_t
{
    sphere,  ///< Radius 10 mm: about 2,000 faces of a fine object are in its reach.
    capsule, ///< 40 mm long.
    box,     ///< 30 x 16 x 10 mm.
    hull,    ///< Spike, 30 mm long.
    mesh,    ///< Bumpy sphere of 980 faces, 0.15 diagonals of the object across.
};

/// Stress on the frame. Tools render forces, unless they are query-only: then they follow the hand
/// and request contacts and all pairs of faces.
enum class WorstMotion : std::uint8_t
{
    sinks,     ///< Touches; then, without a force as after a stall, deep inside and rotating.
    waits,     ///< The same; no page arrives while it touches, then all at once.
    turns,     ///< Query-only tool, deep inside from the first frame, rotating at 5 rad/s.
    teleports, ///< Query-only tool, elsewhere on the surface in each frame.
    in_crowd,  ///< Sinks among 32 objects that overlap.
    equals,    ///< A mesh in the pose of an object with the same mesh.
    in_comb,   ///< Teeth of a comb between those of another, then through them.
};

struct WorstCase
{
    const char* name;
    WorstTool tool;
    WorstMotion motion;
    bool measures{false};
    std::uint32_t tools{1}; ///< Tools, all alike, at one place.
};

/// Inputs of one frame.
struct WorstMoment
{
    std::vector<ToolState> tools;
    std::vector<SceneChange> changes;
    bool is_delivered{true}; ///< The transport side works before the frame.
};

/// Scene and its development, frame by frame.
struct WorstRun
{
    std::vector<const test::TestModel*> models;
    test::RigOptions rig;
    std::vector<WorstMoment> moments;
};

inline constexpr std::uint32_t kWorstFrames = 60;

constexpr std::uint32_t kObjectFaces = 200'000;
constexpr std::uint32_t kEqualFaces = 20'000;
constexpr std::size_t kPoolBytes = 32 * kMiB;
/// Frame in which the force is lost while the hand is deep inside, or pages begin to arrive.
constexpr std::uint32_t kSunkFrom = 24;
constexpr double kPressed_m = 1e-3;
constexpr double kSlide_m_per_s = 0.1;
constexpr double kDeepTurn_rad_per_s = 5.0;

constexpr std::uint32_t kCrowd = 32;
constexpr double kCrowdScale = 0.2;
constexpr double kCrowdHalf_m = 0.012;

/// Teeth of one comb; the other has eight gaps for them, with 0.1 mm of clearance on each side.
constexpr std::uint32_t kTeeth = 7;
constexpr double kTooth_m = 2.4e-3;
constexpr double kPitch_m = 5e-3;
constexpr std::uint32_t kCells = 5;
constexpr std::uint32_t kFineCells = 40;
constexpr double kCombTurn_rad_per_s = 1.0;

/// Plates stacked around the origin.
TriangleMesh make_comb(std::uint32_t teeth, std::uint32_t cells)
{
    const TriangleMesh tooth = make_thin_plate(cells, kTooth_m).value();
    Vec3 middle_m(0.0, 0.0, 0.0);
    for (const auto& [x, y, z] : tooth.positions)
    {
        middle_m += Vec3(x, y, z) / static_cast<double>(tooth.positions.size());
    }
    TriangleMesh comb;
    for (std::uint32_t i = 0; i < teeth; ++i)
    {
        const auto first = static_cast<std::uint32_t>(comb.positions.size());
        const double up_m = kPitch_m * (i - 0.5 * (teeth - 1.0));
        for (const auto& [x, y, z] : tooth.positions)
        {
            comb.positions.push_back({x - middle_m.x(), y - middle_m.y(), z - middle_m.z() + up_m});
        }
        for (const auto& [a, b, c] : tooth.faces)
        {
            comb.faces.push_back({first + a, first + b, first + c});
        }
    }
    return comb;
}

const Scene& object_scene(const WorstCase& worst, SceneStore& scenes)
{
    switch (worst.motion)
    {
    case WorstMotion::equals:
        return scenes.get({"equal", make_shape(Shape::bumpy_sphere, kEqualFaces).value()});
    case WorstMotion::in_comb:
        return scenes.get({"comb", make_comb(kTeeth + 1, kFineCells)});
    default:
        return scenes.get({"bumpy", make_shape(Shape::bumpy_sphere, kObjectFaces).value()});
    }
}

const Scene& tool_scene(const WorstCase& worst, const Scene& object, SceneStore& scenes)
{
    switch (worst.motion)
    {
    case WorstMotion::equals:
        return object;
    case WorstMotion::in_comb:
        return scenes.get({"comb-tool", make_comb(kTeeth, kCells)});
    default:
        return scenes.get(make_tool_mesh(object, MeshProbe::large));
    }
}

ToolSpec tool_of(const WorstCase& worst, double diagonal_m)
{
    static const std::array<Vec3, 4> kSpike{Vec3(0.0, 0.0, -0.02), Vec3(0.006, 0.0, 0.01),
                                            Vec3(-0.004, 0.005, 0.01), Vec3(-0.004, -0.005, 0.01)};
    ToolSpec tool;
    switch (worst.tool)
    {
    case WorstTool::sphere:
        tool.radius_m = 0.01;
        break;
    case WorstTool::capsule:
        tool.core = Segment{{-0.02, 0.0, 0.0}, {0.02, 0.0, 0.0}};
        tool.radius_m = 0.004;
        break;
    case WorstTool::box:
        tool.core = Box{{0.015, 0.008, 0.005}};
        tool.radius_m = 5e-4;
        break;
    case WorstTool::hull:
        tool.core = Hull::create(kSpike).value();
        tool.radius_m = 5e-4;
        break;
    case WorstTool::mesh:
        tool.core = MeshCore{ModelId{1}};
        tool.radius_m = kMeshSkin_diag * diagonal_m;
        break;
    }
    tool.query_only = tool.wants_contacts = worst.measures;
    tool.wants_pairs = worst.measures && worst.tool == WorstTool::mesh;
    return tool;
}

/// Height of a touching tool's middle.
double height_m(const WorstCase& worst, const ToolSpec& tool, double diagonal_m)
{
    switch (worst.tool)
    {
    case WorstTool::capsule:
        return tool.radius_m;
    case WorstTool::box:
        return tool.radius_m + 0.005;
    case WorstTool::hull:
        return tool.radius_m + 0.01;
    case WorstTool::mesh:
        return tool.radius_m + 0.075 * diagonal_m;
    default:
        return tool.radius_m;
    }
}

/// Hand positions above or inside an object that is roughly a sphere.
class Hands
{
public:
    Hands(const WorstCase& worst, const WorstRun& run, const Scene& object)
        : worst_(worst)
        , object_(object)
        , period_s_(1e-9 * static_cast<double>(run.rig.period_ns))
        , height_m_(height_m(worst, run.rig.tools[0], object.model.diagonal_m))
        , middle_m_(0.5 * (object.tree->low_m() + object.tree->high_m()))
    {
    }

    [[nodiscard]] ToolState at(std::uint32_t frame)
    {
        ToolState hand;
        const double time_s = period_s_ * frame;
        const bool is_in = frame >= kSunkFrom;
        switch (worst_.motion)
        {
        case WorstMotion::equals:
        case WorstMotion::in_comb:
            hand.position_m = middle_m_;
            hand.rotation =
                turned(is_in ? kCombTurn_rad_per_s * (time_s - kSunkFrom * period_s_) : 0.0);
            return hand;
        case WorstMotion::in_crowd:
            hand.position_m = middle_m_;
            hand.rotation = turned(kDeepTurn_rad_per_s * time_s);
            return hand;
        case WorstMotion::teleports:
            hand.position_m = over(random_.in_cube(1.0).normalized(), 0.0);
            return hand;
        case WorstMotion::turns:
            hand.position_m = along(time_s, 0.0);
            hand.rotation = turned(kDeepTurn_rad_per_s * time_s);
            return hand;
        default:
            hand.position_m = along(time_s, is_in ? 0.0 : height_m_ - kPressed_m);
            hand.rotation = turned(is_in ? kDeepTurn_rad_per_s * time_s : 0.0);
            return hand;
        }
    }

private:
    [[nodiscard]] static Mat3 turned(double angle_rad)
    {
        return Eigen::AngleAxisd(angle_rad, Vec3(1.0, 2.0, 2.0) / 3.0).toRotationMatrix();
    }

    /// Position on a path around the object.
    [[nodiscard]] Vec3 along(double time_s, double above_m) const
    {
        const double angle_rad = kSlide_m_per_s * time_s / 0.05;
        return over({std::sin(angle_rad), 0.0, std::cos(angle_rad)}, above_m);
    }

    [[nodiscard]] Vec3 over(const Vec3& direction, double above_m) const
    {
        const Vec3 outside_m = middle_m_ + 0.06 * direction;
        return object_.tree->nearest(outside_m).point_m + above_m * direction;
    }

    const WorstCase& worst_;
    const Scene& object_;
    double period_s_;
    double height_m_;
    Vec3 middle_m_;
    test::Random random_{test::Random::seeded(kSeed)};
};

void add_crowd(test::RigOptions& rig, const Vec3& middle_m)
{
    test::Random random = test::Random::seeded(kSeed);
    for (std::uint32_t i = 0; i < kCrowd; ++i)
    {
        rig.objects.push_back({ModelId{0}});
        ObjectPose& pose = rig.poses.emplace_back();
        pose.scale = kCrowdScale;
        pose.translation_m = middle_m + random.in_cube(kCrowdHalf_m) - kCrowdScale * middle_m;
    }
}

/// Removes the tools and adds them at the hands.
std::vector<SceneChange> stall(std::uint32_t tools)
{
    std::vector<SceneChange> changes;
    for (std::uint32_t i = 0; i < tools; ++i)
    {
        for (const SceneChangeKind kind : {SceneChangeKind::tool_goes, SceneChangeKind::tool_comes})
        {
            changes.emplace_back().kind = kind;
            changes.back().number = i;
        }
    }
    return changes;
}

WorstRun make_worst_run(const WorstCase& worst, std::int64_t period_ns, SceneStore& scenes)
{
    const Scene& object = object_scene(worst, scenes);
    WorstRun run;
    run.models = {&object.model};
    if (worst.tool == WorstTool::mesh)
    {
        run.models.push_back(&tool_scene(worst, object, scenes).model);
    }
    run.rig.pool_bytes = kPoolBytes;
    run.rig.period_ns = period_ns;
    run.rig.tools.assign(worst.tools, tool_of(worst, object.model.diagonal_m));
    const Vec3 middle_m = 0.5 * (object.tree->low_m() + object.tree->high_m());
    if (worst.motion == WorstMotion::in_crowd)
    {
        add_crowd(run.rig, middle_m);
    }
    Hands hands(worst, run, object);
    const bool waits = worst.motion == WorstMotion::waits;
    run.rig.chunk_loader_steps_per_frame = waits ? 64 : 4;
    for (std::uint32_t frame = 0; frame < kWorstFrames; ++frame)
    {
        WorstMoment& moment = run.moments.emplace_back();
        moment.tools.assign(worst.tools, hands.at(frame));
        moment.is_delivered = !waits || frame >= kSunkFrom;
        if (frame == kSunkFrom)
        {
            moment.changes = stall(worst.tools);
        }
    }
    return run;
}

struct Rate
{
    const char* name;
    std::int64_t period_ns;
    double instructions; ///< Goal in instructions.
};
constexpr std::array<Rate, 2> kRates{{{"1 kHz", 1'000'000, 600'000}, {"4 kHz", 250'000, 150'000}}};

/// Greatest amounts in a frame.
struct MostWork
{
    std::uint32_t splits{0};
    std::uint32_t nodes{0};
    std::uint32_t triangles{0};
    std::uint32_t planes{0};
    std::uint32_t work{0}; ///< WorkBudget::used().

    void see(const WorkCounters& work_done)
    {
        splits = std::max(splits, work_done.splits);
        nodes = std::max(nodes, work_done.nodes_visited);
        triangles = std::max(triangles, work_done.triangles_tested);
        planes = std::max(planes, work_done.planes_looked_at);
        work = std::max(work, work_done.budget.used());
    }
};

class WorstReplay
{
public:
    /// Replays with half of the period for each frame, like hrtc.
    WorstReplay(const WorstRun& run, std::int64_t period_ns)
        : run_(run), frame_us_(run.moments.size())
    {
        const auto times_of = [](const ToolSpec& tool)
        {
            return is_mesh(tool)                             ? Budgets::kMeshWork
                   : std::holds_alternative<Hull>(tool.core) ? Budgets::kHullWork
                                                             : 1U;
        };
        const std::uint32_t times =
            times_of(*std::ranges::max_element(run.rig.tools, {}, times_of));
        budgets_.work = Budgets::work_of(period_ns / 2, times);
    }

    /// A failure if the frames differ from those of an earlier pass.
    void run(std::uint32_t passes)
    {
        for (std::uint32_t pass = 0; pass < passes; ++pass)
        {
            const std::uint64_t hash = run_once();
            if (pass > 0 && hash != hash_)
            {
                throw Failure("a replay of the same motion ended otherwise");
            }
            hash_ = hash;
        }
    }

    [[nodiscard]] const std::vector<double>& frame_us() const { return frame_us_.least(); }
    [[nodiscard]] const MostWork& most() const { return most_; }
    [[nodiscard]] std::uint64_t hash() const { return hash_; }

private:
    [[nodiscard]] std::uint64_t run_once()
    {
        test::FrameRig rig(run_.models, run_.rig);
        StageTimer timer;
        std::uint64_t hash = 0;
        for (std::size_t i = 0; i < run_.moments.size(); ++i)
        {
            const WorstMoment& moment = run_.moments[i];
            for (const SceneChange& change : moment.changes)
            {
                rig.change(change);
            }
            if (moment.is_delivered)
            {
                rig.deliver();
            }
            timer.begin();
            const FrameOutput output = counted_step(rig, moment.tools, budgets_, timer.mark());
            frame_us_.keep(i, timer.sum_us());
            most_.see(output.work);
            for (const ModelOutput& model : output.models)
            {
                hash = 31 * hash + model.state_hash;
            }
        }
        return hash;
    }

    const WorstRun& run_;
    Budgets budgets_;
    LeastTimes frame_us_;
    MostWork most_;
    std::uint64_t hash_{0};
};

void add_instructions(CaseRows& rows, std::span<const StageCounts> frames, double goal)
{
    const auto sum = [](const StageCounts& stages)
    { return std::accumulate(stages.begin(), stages.end(), std::uint64_t{0}); };
    const StageCounts& most = *std::ranges::max_element(frames, {}, sum);
    rows.add("most of a frame", static_cast<double>(sum(most)), "instructions", goal);
    for (std::size_t stage = 0; stage < kStages; ++stage)
    {
        rows.add(fmt::format("of them {}", kStageNames[stage]), static_cast<double>(most[stage]),
                 "instructions");
    }
}

struct ToolCases
{
    const char* name;
    std::vector<WorstCase> cases;
};

void run_tool_cases(const CaseContext& context, const ToolCases& tool)
{
    const PinnedCore pinned(context.options.core);
    const std::vector<StageCounts> counted = count_stages(context);
    std::span<const StageCounts> left(counted);
    for (const WorstCase& worst : tool.cases)
    {
        for (const Rate& rate : kRates)
        {
            const WorstRun run = make_worst_run(worst, rate.period_ns, context.scenes);
            WorstReplay replay(run, rate.period_ns);
            replay.run(context.options.passes_or(3, 1));
            Row common = context.common_row(run.models[0]->name);
            common.setting = fmt::format("{}, {}", worst.name, rate.name);
            common.frames = run.moments.size();
            common.hash = replay.hash();
            CaseRows rows(context.rows, common);
            if (!left.empty())
            {
                add_instructions(rows, left.first(common.frames), rate.instructions);
                left = left.subspan(common.frames);
            }
            rows.add("longest frame", spread_of(replay.frame_us()).max, "us");
            rows.add("splits, most of a frame", replay.most().splits, "");
            rows.add("nodes, most of a frame", replay.most().nodes, "");
            rows.add("triangles, most of a frame", replay.most().triangles, "");
            rows.add("planes, most of a frame", replay.most().planes, "");
            rows.add("work, most of a frame", replay.most().work, "instructions");
        }
    }
}

const std::vector<ToolCases>& all_tools()
{
    using Motion = WorstMotion;
    using Tool = WorstTool;
    static const std::vector<ToolCases> kTools{
        {"ball",
         {{"sunk by a stall", Tool::sphere, Motion::sinks},
          {"everything late", Tool::sphere, Motion::waits},
          {"teleports", Tool::sphere, Motion::teleports, true},
          {"among 32 objects", Tool::sphere, Motion::in_crowd}}},
        {"capsule", {{"sunk by a stall", Tool::capsule, Motion::sinks}}},
        {"box",
         {{"sunk by a stall", Tool::box, Motion::sinks},
          {"measures, turns deep in", Tool::box, Motion::turns, true},
          {"teleports", Tool::box, Motion::teleports, true}}},
        {"hull",
         {{"sunk by a stall", Tool::hull, Motion::sinks},
          {"measures, turns deep in", Tool::hull, Motion::turns, true}}},
        {"mesh",
         {{"sunk by a stall", Tool::mesh, Motion::sinks},
          {"everything late", Tool::mesh, Motion::waits},
          {"measures, turns deep in", Tool::mesh, Motion::turns, true},
          {"teleports", Tool::mesh, Motion::teleports, true},
          {"among 32 objects", Tool::mesh, Motion::in_crowd},
          {"in its equal", Tool::mesh, Motion::equals},
          {"measures, in its equal", Tool::mesh, Motion::equals, true},
          {"a comb in a comb", Tool::mesh, Motion::in_comb},
          {"measures, a comb in a comb", Tool::mesh, Motion::in_comb, true}}},
        {"16 on one spot",
         {{"spheres", Tool::sphere, Motion::sinks, false, 16},
          {"boxes", Tool::box, Motion::sinks, false, 16},
          {"meshes", Tool::mesh, Motion::sinks, false, 16}}},
    };
    return kTools;
}

std::vector<Case> worst_cases()
{
    std::vector<Case> cases;
    for (const ToolCases& tool : all_tools())
    {
        cases.push_back(make_case(tool.name, When::always, run_tool_cases, tool));
    }
    return cases;
}

} // namespace

Suite worst_suite()
{
    return {"worst", worst_cases};
}

} // namespace tactus::bench
