// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Accuracy of rigid tools that lie, slide and rotate on a flat sheet without friction. The device
/// pose is 2 mm below the tool's rest pose, so the true wrench is known in each frame: 1 N along
/// the normal through the device position, no drag and no torque. Nothing is subtracted from the
/// rendered wrench.

#include "rt_core/limits.hpp"
#include "tests/bench/sheet_tool_cases.hpp"
#include "tests/bench/touch_motion.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/random.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace tactus::bench
{

namespace
{

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

} // namespace tactus::bench
