// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/worst_motions.hpp"

#include "host_tools/shapes/shapes.hpp"
#include "tests/bench/bench_row.hpp"
#include "tests/bench/mesh_touch.hpp"
#include "tests/shared/random.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace tactus::bench
{

namespace
{

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

} // namespace

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

} // namespace tactus::bench
