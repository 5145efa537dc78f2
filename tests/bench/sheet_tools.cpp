// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Accuracy of rigid tools that lie, slide and rotate on a flat sheet without friction. The device
/// pose is 2 mm below the tool's rest pose, so the true wrench is known in each frame: 1 N along
/// the normal through the device position, no drag and no torque. Nothing is subtracted from the
/// rendered wrench.
/// Tools of a centimetre on dense meshes, with thousands of faces below each: how often a pressed
/// tool has a force, how often that is exact or within the tolerance, and with --instructions the
/// greatest cost of a frame. The operator descends, slides while pressing, and lifts off.

#include "host_tools/shapes/shapes.hpp"
#include "rt_core/limits.hpp"
#include "tests/bench/force_rows.hpp"
#include "tests/bench/instruction_count.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/mesh_touch.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/surface_slide.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <variant>
#include <vector>

namespace tactus::bench
{
namespace
{

/// Corners of a box centred on the origin.
std::vector<Vec3> box_corners(const Vec3& half_m)
{
    std::vector<Vec3> corners_m;
    for (std::uint32_t i = 0; i < 8; ++i)
    {
        corners_m.emplace_back((i & 1U) != 0 ? half_m.x() : -half_m.x(),
                               (i & 2U) != 0 ? half_m.y() : -half_m.y(),
                               (i & 4U) != 0 ? half_m.z() : -half_m.z());
    }
    return corners_m;
}
constexpr double kSheet_m = 0.06;
/// Greatest displacement of corners of an uneven sheet, as a share of a cell.
constexpr double kSheetJitter = 0.3;
constexpr double kSheetForce_n = 1.0;
constexpr double kSheetStiffness_n_per_m = 500.0;
constexpr double kSheetDepth_m = kSheetForce_n / kSheetStiffness_n_per_m;
constexpr std::size_t kSheetPool_bytes = 16 * kMiB;

constexpr double kSheetSlide_m_per_s = 0.05;
constexpr double kSheetTurn_rad_per_s = 1.0;
constexpr double kSheetReach_m = 0.014; ///< Amplitude of a slide.
constexpr double kSheetAbove_m = 3e-3;  ///< Height of the start above the sheet.
constexpr std::uint32_t kSheetComes = 150;
/// Frames that are not counted after the descent.
constexpr std::uint32_t kSheetSettles = 200;

/// Goals, as shares of the force and of force x size.
constexpr double kSheetForceOff = 0.005;
constexpr double kSheetTorqueOff = 0.01;
constexpr double kSheetForceStep = 0.02;
constexpr double kSheetTorqueStep = 0.01;

struct SheetMesh
{
    std::uint32_t cells; ///< Cells along a side.
    bool is_uneven;
    bool is_quick;
};
constexpr std::array<SheetMesh, 8> kSheetMeshes{{{15, false, false},
                                                 {15, true, true},
                                                 {60, false, true},
                                                 {60, true, false},
                                                 {240, false, false},
                                                 {240, true, false},
                                                 {600, false, false},
                                                 {600, true, false}}};

struct SheetTool
{
    const char* name;
    ToolCore shape; ///< Shape of the core; a point means the hull of the corners.
    /// Corners of the core; the tool is their hull, enlarged by the radius.
    std::vector<Vec3> corners_m;
    double radius_m;
    double size_m;

    /// Core that refers to the corners.
    [[nodiscard]] ToolCore core() const
    {
        return is_hull() ? ToolCore(Hull::create(corners_m).value()) : shape;
    }
    [[nodiscard]] bool is_hull() const { return std::holds_alternative<PointCore>(shape); }
    /// Distance from the tool frame's origin down to the lowest point.
    [[nodiscard]] double lowest_m(const Mat3& rotation) const
    {
        double lowest_m = std::numeric_limits<double>::infinity();
        for (const Vec3& corner_m : corners_m)
        {
            lowest_m = std::min(lowest_m, (rotation * corner_m).z());
        }
        return lowest_m - radius_m;
    }
};

struct SheetMotion
{
    const char* name;
    Vec3 heading; ///< Direction of the slide; zero: the tool stays.
    double turn_rad_per_s;
};
const std::array<SheetMotion, 5>& sheet_motions()
{
    static const Vec3 kStays(0.0, 0.0, 0.0);
    static const Vec3 kStraight(1.0, 0.0, 0.0);
    static const Vec3 kDiagonal(std::numbers::sqrt2 / 2.0, std::numbers::sqrt2 / 2.0, 0.0);
    static const std::array<SheetMotion, 5> kMotions{
        {{"lies", kStays, 0.0},
         {"slides straight", kStraight, 0.0},
         {"slides diagonally", kDiagonal, 0.0},
         {"turns", kStays, kSheetTurn_rad_per_s},
         {"slides and turns", Vec3(0.8, 0.6, 0.0), kSheetTurn_rad_per_s}}};
    return kMotions;
}

/// Sheet of squares, each cut into two faces; an uneven sheet has displaced corners.
NamedMesh make_sheet(const SheetMesh& sheet)
{
    NamedMesh named;
    named.name = fmt::format("sheet-{:g}mm{}", 1e3 * kSheet_m / sheet.cells,
                             sheet.is_uneven ? "-uneven" : "");
    test::Random random = test::Random::seeded(kSeed);
    const std::uint32_t row = sheet.cells + 1;
    for (std::uint32_t y = 0; y < row; ++y)
    {
        for (std::uint32_t x = 0; x < row; ++x)
        {
            const bool is_inside = x > 0 && y > 0 && x < sheet.cells && y < sheet.cells;
            const double most = sheet.is_uneven && is_inside ? kSheetJitter : 0.0;
            const Vec3 off = random.in_cube(most);
            const double cell_m = kSheet_m / sheet.cells;
            named.mesh.positions.push_back({cell_m * (x + off.x()), cell_m * (y + off.y()), 0.0});
        }
    }
    for (std::uint32_t y = 0; y < sheet.cells; ++y)
    {
        for (std::uint32_t x = 0; x < sheet.cells; ++x)
        {
            const std::uint32_t low = y * row + x;
            const std::uint32_t high = low + row;
            const bool is_other = sheet.is_uneven && random.one_in(2);
            named.mesh.faces.push_back({low, low + 1, is_other ? high : high + 1});
            named.mesh.faces.push_back({is_other ? low + 1 : low, high + 1, high});
        }
    }
    return named;
}

SheetTool sheet_box(const char* name, const Vec3& half_m)
{
    return {name, Box{half_m}, box_corners(half_m), 5e-4, 2.0 * half_m.x()};
}

SheetTool sheet_capsule(const char* name, double length_m)
{
    const Vec3 end_m(0.5 * length_m, 0.0, 0.0);
    return {name, Segment{-end_m, end_m}, {-end_m, end_m}, 1e-3, length_m};
}

/// Hull with a flat base of ten corners and a wider top, rotated by half a corner.
SheetTool sheet_hull(const char* name)
{
    constexpr int kSheetCorners = 10;
    SheetTool body{name, PointCore{}, {}, 5e-4, 0.01};
    for (int i = 0; i < 2 * kSheetCorners; ++i)
    {
        const bool is_top = i >= kSheetCorners;
        const double angle = 2.0 * std::numbers::pi / kSheetCorners * (is_top ? i + 0.5 : i);
        const double across_m = is_top ? 5e-3 : 4e-3;
        body.corners_m.emplace_back(across_m * std::cos(angle), across_m * std::sin(angle),
                                    is_top ? 4e-3 : -4e-3);
    }
    return body;
}

std::vector<SheetTool> sheet_tools()
{
    return {sheet_box("box of 8 mm", {4e-3, 4e-3, 4e-3}),
            sheet_box("box of 20 mm", {1e-2, 1e-2, 2e-3}), sheet_capsule("capsule of 12 mm", 0.012),
            sheet_capsule("capsule of 20 mm", 0.02), sheet_hull("hull of 10 mm")};
}

/// Triangle wave about the middle, by path length.
double to_and_fro_m(double way_m)
{
    const double turn = std::fmod(way_m / (4.0 * kSheetReach_m) + 0.25, 1.0);
    return kSheetReach_m * (1.0 - 4.0 * std::abs(turn - 0.5));
}

/// Device pose; `frame` counts from the end of the descent and settling.
ToolState sheet_hand(const SheetMotion& motion, const Vec3& rest_m, std::int64_t frame)
{
    const double time_s = kPeriod_s * static_cast<double>(std::max<std::int64_t>(0, frame));
    const std::int64_t left = -frame - std::int64_t{kSheetSettles};
    const double share = std::max(0.0, static_cast<double>(left) / kSheetComes);
    const double above_m = -kSheetDepth_m + share * (kSheetAbove_m + kSheetDepth_m);
    ToolState hand;
    hand.position_m = rest_m + to_and_fro_m(kSheetSlide_m_per_s * time_s) * motion.heading +
                      above_m * Vec3::UnitZ();
    hand.rotation =
        Eigen::AngleAxisd(motion.turn_rad_per_s * time_s, Vec3::UnitZ()).toRotationMatrix();
    return hand;
}

/// Shares of the force and of force x size; the largest of all frames.
struct SheetFigures
{
    double normal{0.0};
    double drag{0.0};
    double torque{0.0};
    double force_step{0.0};
    double torque_step{0.0};
    double sunk_m{0.0};
    std::uint64_t impaired{0}; ///< Frames that are halted, over-constrained or without force.
    std::uint64_t capacity_exceeded{0}; ///< Frames in which the contact capacity is exceeded.

    void see(const SheetTool& body, const ToolOutput& output, double plane_m)
    {
        const Vec3& force_n = output.force_n;
        normal = std::max(normal, std::abs(force_n.z() / kSheetForce_n - 1.0));
        drag = std::max(drag, force_n.head<2>().norm() / kSheetForce_n);
        torque = std::max(torque, output.torque_nm.norm() / (kSheetForce_n * body.size_m));
        sunk_m =
            std::max(sunk_m, plane_m - output.proxy_m.z() - body.lowest_m(output.proxy_rotation));
        const bool is_well =
            output.in_contact && !output.halted && !output.over_constrained && force_n.z() > 0.0;
        capacity_exceeded += output.capacity_exceeded ? 1U : 0U;
        impaired += is_well ? 0U : 1U;
    }
    void see_step(const SheetTool& body, const ToolOutput& before, const ToolOutput& now)
    {
        const double step_n = (now.force_n - before.force_n).norm();
        const double step_nm = (now.torque_nm - before.torque_nm).norm();
        force_step = std::max(force_step, step_n / kSheetForce_n);
        torque_step = std::max(torque_step, step_nm / (kSheetForce_n * body.size_m));
    }
};

void run_sheet(const CaseContext& context, const Scene& scene, const SheetTool& body)
{
    ToolSpec tool;
    tool.core = body.core();
    tool.radius_m = body.radius_m;
    tool.stiffness_n_per_m = kSheetStiffness_n_per_m;
    test::RigOptions options;
    options.tools = {tool};
    options.pool_bytes = kSheetPool_bytes;
    options.force_tolerance_n = kForceToleranceUsual_n;
    options.static_when_it_fits = true;
    Budgets budgets;
    budgets.work =
        Budgets::work_of(options.period_ns / 2, body.is_hull() ? Budgets::kHullWork : 1U);
    const double plane_m = scene.tree->high_m().z();
    Vec3 rest_m = 0.5 * (scene.tree->low_m() + scene.tree->high_m());
    rest_m.z() = plane_m - body.lowest_m(Mat3::Identity());
    const std::uint32_t frames = context.options.frames_or(1'200, 200);
    for (const SheetMotion& motion : sheet_motions())
    {
        test::FrameRig rig(scene.model, options);
        SheetFigures figures;
        ToolOutput before;
        const std::int64_t first = -std::int64_t{kSheetComes} - std::int64_t{kSheetSettles};
        for (std::int64_t frame = first; frame < frames; ++frame)
        {
            const std::array<ToolState, 1> hand{sheet_hand(motion, rest_m, frame)};
            const FrameOutput output = rig.step(hand, budgets);
            if (frame >= 0)
            {
                figures.see(body, output.tools[0], plane_m);
                figures.see_step(body, before, output.tools[0]);
            }
            before = output.tools[0];
        }
        Row common = context.common_row(scene.model.name, "Sheets");
        common.test_case = body.name;
        common.setting = motion.name;
        common.frames = frames;
        CaseRows rows(context.rows, common);
        rows.add("normal force is off by", 100.0 * figures.normal, "%", 100.0 * kSheetForceOff);
        rows.add("drag", 100.0 * figures.drag, "%", 100.0 * kSheetForceOff);
        rows.add("torque", 100.0 * figures.torque, "%", 100.0 * kSheetTorqueOff);
        rows.add("largest step of the force", 100.0 * figures.force_step, "%",
                 100.0 * kSheetForceStep);
        rows.add("largest step of the torque", 100.0 * figures.torque_step, "%",
                 100.0 * kSheetTorqueStep);
        rows.add("sunk in", 1e6 * figures.sunk_m, "um", 1e6 * kSheetForceOff * kSheetDepth_m);
        rows.add("frames impaired", static_cast<double>(figures.impaired), "", 0.0);
        rows.add("frames over capacity", static_cast<double>(figures.capacity_exceeded), "");
    }
}

} // namespace

void run_sheet_tools(const CaseContext& context)
{
    for (const SheetMesh& sheet : kSheetMeshes)
    {
        if (context.options.quick && !sheet.is_quick)
        {
            continue;
        }
        const Scene& scene = context.scenes.get(make_sheet(sheet));
        for (const SheetTool& body : sheet_tools())
        {
            run_sheet(context, scene, body);
        }
    }
}

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
