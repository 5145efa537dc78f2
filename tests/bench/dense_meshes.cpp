// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Tools of a centimetre on dense meshes, with thousands of faces below each: how often a pressed
/// tool has a force, how often that is exact or within the tolerance, and with --instructions the
/// greatest cost of a frame. The operator descends, slides while pressing, and lifts off.

#include "host_tools/shapes/shapes.hpp"
#include "rt_core/limits.hpp"
#include "tests/bench/instruction_count.hpp"
#include "tests/bench/mesh_touch.hpp"
#include "tests/bench/sheet_tool_cases.hpp"
#include "tests/bench/stage_timer.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/surface_slide.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <variant>

namespace tactus::bench
{

namespace
{

constexpr std::size_t kDensePool_bytes = 16 * kMiB;
constexpr std::size_t kScarcePool_bytes = 2 * kMiB; ///< Default of hrtc.
constexpr double kDenseInstructions = 600'000;      ///< Goal.
constexpr double kDenseShare = 99.0;                ///< Goal of the shares, in per cent.

constexpr double kDenseSlide_m_per_s = 0.2;
/// Rate of the slide's heading: rounds of about 25 mm around the middle, each slightly beside the
/// last.
constexpr double kDenseTurn_rad_per_s = 8.0;
constexpr double kDenseUneven = 0.05; ///< Greatest reduction of that rate.
constexpr double kDenseRound_m = kDenseSlide_m_per_s / kDenseTurn_rad_per_s;
/// Heights of the tool's lowest point, above and below the surface: 1.5 N at 500 N/m.
constexpr double kDenseAbove_m = 5e-3;
constexpr double kDenseDepth_m = 3e-3;
/// A tool that is deeper must have a force.
constexpr double kDensePressed_m = 2e-4;
/// Frames of one cycle: down, slide, up.
constexpr std::uint32_t kDenseDown = 200;
constexpr std::uint32_t kDensePress = 600;
constexpr std::uint32_t kDenseUp = 200;
constexpr std::uint32_t kDenseCycle = kDenseDown + kDensePress + kDenseUp;
/// Frames with --instructions: a descent and most of a slide.
constexpr std::uint32_t kDenseCounted = 600;

struct DenseMesh
{
    const char* shape;
    std::uint32_t faces;
    bool is_quick;
};
constexpr std::array<DenseMesh, 6> kDenseMeshes{{{"plate", 80'000, true},
                                                 {"bumpy-sphere", 80'000, true},
                                                 {"plate", 320'000, false},
                                                 {"bumpy-sphere", 320'000, false},
                                                 {"plate", 1'300'000, false},
                                                 {"bumpy-sphere", 1'300'000, false}}};

struct DenseTool
{
    const char* name;
    ToolCore core;
    double radius_m;
    std::vector<Vec3> corners_m;
    std::uint32_t times{1}; ///< Factor of the usual frame budget.

    /// Extent of the tool along a direction, from its frame's origin.
    [[nodiscard]] double reach_m(const Vec3& direction) const
    {
        double most_m = 0.0;
        for (const Vec3& corner_m : corners_m)
        {
            most_m = std::max(most_m, direction.dot(corner_m));
        }
        return most_m + radius_m;
    }
};

DenseTool dense_box(const char* name, const Vec3& half_m)
{
    return {name, Box{half_m}, 5e-4, box_corners(half_m)};
}

DenseTool dense_capsule(const char* name, double radius_m, double length_m)
{
    const Vec3 end_m(0.0, 0.0, 0.5 * length_m);
    return {name, Segment{-end_m, end_m}, radius_m, {-end_m, end_m}};
}

/// Model of the mesh tools in all runs.
const Scene& dense_tool_scene(SceneStore& scenes)
{
    const TriangleMesh sphere = make_shape(Shape::bumpy_sphere, 1'000).value();
    return scenes.get(NamedMesh{"tool-20mm", scaled(sphere, 0.2)});
}

DenseTool dense_mesh_tool(const Scene& scene)
{
    DenseTool tool{"mesh of 20 mm", MeshCore{ModelId{1}}, 2e-4, {}, Budgets::kMeshWork};
    for (const Triangle& face : faces_in_source_frame(scene))
    {
        tool.corners_m.insert(tool.corners_m.end(), face.begin(), face.end());
    }
    return tool;
}

std::vector<DenseTool> dense_tools(SceneStore& scenes)
{
    return {dense_box("box of 8 mm", {4e-3, 4e-3, 4e-3}),
            dense_box("box of 20 mm", {1e-2, 1e-2, 2e-3}),
            dense_capsule("capsule of 20 mm", 1e-3, 0.02),
            dense_capsule("capsule of 12 mm", 1e-3, 0.012),
            {"ball of 2 mm", PointCore{}, 2e-3, {}},
            {"ball of 20 mm", PointCore{}, 0.02, {}},
            dense_mesh_tool(dense_tool_scene(scenes))};
}

/// Height of the tool's lowest point above the surface.
double dense_height_m(std::uint32_t frame)
{
    const std::uint32_t at = frame % kDenseCycle;
    const double left = at < kDenseDown ? 1.0 - static_cast<double>(at) / kDenseDown
                        : at < kDenseDown + kDensePress
                            ? 0.0
                            : static_cast<double>(at - kDenseDown - kDensePress) / kDenseUp;
    const double smooth = left * left * (3.0 - 2.0 * left);
    return smooth * (kDenseAbove_m + kDenseDepth_m) - kDenseDepth_m;
}

/// Device position in each frame: above or below the surface point nearest to a sphere that slides
/// on the surface.
std::vector<Vec3> dense_way(const Scene& scene, const DenseTool& tool, std::uint32_t frames)
{
    const test::FaceTree& tree = *scene.tree;
    const Vec3 middle_m = 0.5 * (tree.low_m() + tree.high_m());
    test::SlideManner manner;
    manner.diagonal_m = scene.model.diagonal_m;
    manner.step_m = kDenseSlide_m_per_s * kPeriod_s;
    manner.rotation_rad = kDenseTurn_rad_per_s * kPeriod_s;
    manner.rotation_rate = [](std::uint64_t turn)
    { return 1.0 - kDenseUneven * (0.5 + 0.5 * test::signed_unit(kSeed, turn)); };
    test::SurfaceSlide slide(
        tree, manner, {middle_m.x(), middle_m.y() - kDenseRound_m, tree.high_m().z() + 0.01});
    std::vector<Vec3> way;
    for (std::uint32_t frame = 0; frame < frames; ++frame)
    {
        const Vec3 above_m = slide.next();
        const Vec3 foot_m = tree.nearest(above_m).point_m;
        const Vec3 up = (above_m - foot_m).normalized();
        way.emplace_back(foot_m + (tool.reach_m(-up) + dense_height_m(frame)) * up);
    }
    return way;
}

struct DenseFigures
{
    std::uint64_t pressed{0};
    std::uint64_t forceless{0}; ///< Pressed frames without force.
    std::uint64_t longest{0};   ///< Longest sequence of frames without force.
    std::uint64_t waiting{0};   ///< Frames without force that are halted or data-limited.
    std::uint64_t contacts{0};
    std::uint64_t known{0}; ///< Frames with a force that is exact or within the tolerance.
    double force_step_n{0.0};
    std::uint64_t hash{0};
    std::uint64_t in_a_row{0};
    Vec3 last_n{0.0, 0.0, 0.0};

    void see(const FrameOutput& output, double height_m)
    {
        const ToolOutput& tool = output.tools[0];
        const bool is_pressed = height_m < -kDensePressed_m;
        const bool has_force = tool.force_n.norm() > 0.0;
        pressed += is_pressed ? 1U : 0U;
        forceless += is_pressed && !has_force ? 1U : 0U;
        waiting += is_pressed && !has_force && (tool.halted || tool.data_limited) ? 1U : 0U;
        in_a_row = is_pressed && !has_force ? in_a_row + 1 : 0;
        longest = std::max(longest, in_a_row);
        contacts += tool.in_contact ? 1U : 0U;
        known +=
            tool.in_contact && !output.pairs.empty() && is_known(output.pairs[0].kind) ? 1U : 0U;
        force_step_n = std::max(force_step_n, (tool.force_n - last_n).norm());
        last_n = tool.force_n;
        hash = 31 * hash + output.models[0].state_hash;
    }
};

double dense_percent(std::uint64_t part, std::uint64_t all)
{
    return all > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(all) : 0.0;
}

struct DenseRun
{
    const Scene& scene;
    const DenseTool& tool;
    std::size_t pool_bytes;
};

void run_dense(const CaseContext& context, const DenseRun& run,
               std::span<const StageCounts>& counted)
{
    const BenchOptions& options = context.options;
    const std::uint32_t frames = options.instructions || options.count
                                     ? kDenseCounted
                                     : options.frames_or(4 * kDenseCycle, kDenseCycle);
    const std::vector<Vec3> way = dense_way(run.scene, run.tool, frames);
    std::vector<const test::TestModel*> models{&run.scene.model};
    if (std::holds_alternative<MeshCore>(run.tool.core))
    {
        models.push_back(&dense_tool_scene(context.scenes).model);
    }
    ToolSpec tool;
    tool.core = run.tool.core;
    tool.radius_m = run.tool.radius_m;
    test::RigOptions rig_options;
    rig_options.tools = {tool};
    rig_options.pool_bytes = run.pool_bytes;
    rig_options.force_tolerance_n = kForceToleranceUsual_n;
    rig_options.static_when_it_fits = true;
    Budgets budgets;
    budgets.work = Budgets::work_of(rig_options.period_ns / 2, run.tool.times);
    test::FrameRig rig(models, rig_options);
    DenseFigures figures;
    StageTimer timer;
    for (std::uint32_t frame = 0; frame < frames; ++frame)
    {
        rig.deliver();
        timer.begin();
        figures.see(counted_step(rig, std::vector{way[frame]}, budgets, timer.mark()),
                    dense_height_m(frame));
    }
    Row common = context.common_row(run.scene.model.name, "Dense");
    common.test_case = run.tool.name;
    common.setting = fmt::format("{} MiB", run.pool_bytes / kMiB);
    common.frames = frames;
    common.hash = figures.hash;
    CaseRows rows(context.rows, common);
    rows.add("with a force, of frames pressed in",
             dense_percent(figures.pressed - figures.forceless, figures.pressed), "%", kDenseShare)
        .is_least = true;
    rows.add("of those without, waiting for data",
             dense_percent(figures.waiting, figures.forceless), "%");
    rows.add("longest without", static_cast<double>(figures.longest), "ms");
    rows.add("in contact", dense_percent(figures.contacts, frames), "%");
    rows.add("exact or within tolerance, of those", dense_percent(figures.known, figures.contacts),
             "%", kDenseShare)
        .is_least = true;
    rows.add("largest step of the force", figures.force_step_n, "N");
    if (!counted.empty())
    {
        const auto sum = [](const StageCounts& stages)
        { return std::accumulate(stages.begin(), stages.end(), std::uint64_t{0}); };
        const auto own = counted.first(frames);
        rows.add("most of a frame",
                 static_cast<double>(sum(*std::ranges::max_element(own, {}, sum))), "instructions",
                 kDenseInstructions);
        counted = counted.subspan(frames);
    }
}

} // namespace

void run_dense_meshes(const CaseContext& context)
{
    const std::vector<StageCounts> all_counted = count_stages(context);
    std::span<const StageCounts> counted(all_counted);
    const std::vector<DenseTool> tools = dense_tools(context.scenes);
    for (const DenseMesh& mesh : kDenseMeshes)
    {
        if (context.options.quick && !mesh.is_quick)
        {
            continue;
        }
        const Scene& scene = context.scenes.get(
            NamedMesh{fmt::format("{}-{}", mesh.shape, mesh.faces),
                      make_shape(parse_shape(mesh.shape).value(), mesh.faces).value()});
        for (const DenseTool& tool : tools)
        {
            run_dense(context, {scene, tool, kDensePool_bytes}, counted);
        }
        if (&mesh == &kDenseMeshes.back())
        {
            run_dense(context, {scene, tools[3], kScarcePool_bytes}, counted);
        }
    }
}

} // namespace tactus::bench
