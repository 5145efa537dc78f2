// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "tests/bench/bench_row.hpp"
#include "tests/bench/cases.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/shared/brute_force.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tactus::bench
{

// Surface with known forces: the bumpy sphere of make_shape(),
//
//   f(x) = |x| - R (1 + a sin(m u) sin(m v) sin(m w)) = 0,   (u, v, w) = x / |x|,
//   R = 50 mm, a = 0.02, m = 8,
//
// in metres, with the sphere's centre at the origin. The functions are valid within 5 mm of the
// surface on either side; its radii of curvature are at least 20 mm.

[[nodiscard]] double bumpy_value_m(const Vec3& x);
[[nodiscard]] Vec3 bumpy_gradient(const Vec3& x);

/// Nearest point of the surface.
struct SurfaceFoot
{
    Vec3 point_m{0.0, 0.0, 0.0};
    Vec3 normal{0.0, 0.0, 0.0}; ///< Unit normal, outward.
    double distance_m{0.0};     ///< Signed distance, negative inside.
};
/// Nearest point to rounding: x is projected onto the tangent plane of f at the last estimate until
/// it no longer moves.
[[nodiscard]] SurfaceFoot bumpy_foot(const Vec3& x);

/// Larger magnitude of the principal curvatures at the foot of x, 1/m; accurate to six digits.
[[nodiscard]] double bumpy_curvature_per_m(const Vec3& x);

/// Sphere that rests on a surface without friction while a device pulls it.
struct Touch
{
    double radius_m{0.0};
    double depth_m{0.0}; ///< Depth of the device below the rest position of the sphere's centre.
    double stiffness_n_per_m{0.0};

    [[nodiscard]] double force_n() const { return stiffness_n_per_m * depth_m; }
};
/// True force on a device: stiffness times the depth below the surface offset by the sphere's
/// radius, along the surface normal; zero above it.
[[nodiscard]] Vec3 bumpy_force_n(const Vec3& device_m, double radius_m, double stiffness_n_per_m);

/// Difference between a mesh and the surface that it approximates.
struct Faceting
{
    double distance_m{0.0};      ///< Greatest distance of points of the faces.
    double normal_rad{0.0};      ///< Greatest angle between a face and the surface below it.
    double dihedral_rad{0.0};    ///< Greatest angle between faces across an edge.
    double curvature_per_m{0.0}; ///< Greatest curvature of the surface.

    /// Bound for the error of the force on the mesh against that on the surface, in newtons, if the
    /// sphere rests exactly where the mesh permits. h and t are the distance and angle above, k the
    /// curvature, r the sphere's radius and d the depth.
    ///
    /// The free space of the centre ends between the surface's offsets by r - h and r + h, so the
    /// spring's length is d within h. Each touched face pushes along a direction within t of the
    /// surface normal at the touched point; that normal turns by k for each metre along the
    /// surface. The touched points are within r t / (1 - k r) of the sphere's foot, the foot within
    /// d p / (1 - k r) of the device's, where p is the angle of the force. Together p <= t / (1 - k
    /// (r + d)), to first order in t, and the force error is at most stiffness x (h + d p).
    [[nodiscard]] double force_error_n(const Touch& touch) const;
    /// Bound p of the force's angle.
    [[nodiscard]] double force_rotation_rad(const Touch& touch) const;
};
/// Measures all faces at their corners, edge midpoints and centres, in the mesh frame, whose origin
/// lies at `origin_m` of the surface's. About 3 us a face.
[[nodiscard]] Faceting measure_faceting(const std::vector<test::Face>& faces,
                                        const std::array<double, 3>& origin_m);

/// Greatest angle between the normals of two faces with a common edge; edges are equal if both ends
/// are, bit for bit.
[[nodiscard]] double largest_dihedral_rad(const std::vector<test::Face>& faces);

/// Path of a device along a great circle of the surface, at a constant depth below the rest
/// position.
struct Sweep
{
    std::vector<Vec3> goals_m; ///< Positions of the device.
    std::vector<Vec3> rests_m; ///< Rest positions of the sphere's centre on the exact surface.
    std::size_t lead_in{0};    ///< Frames of the descent at the start.
};
/// Path with a lead-in and one frame for each of `steps_m`, a straight distance of the device,
/// repeatedly along a circle that is aligned neither with the icosahedron nor with the bumps.
[[nodiscard]] Sweep make_sweep(const Touch& touch, std::span<const double> steps_m);
/// Path of `frames` equal steps.
[[nodiscard]] Sweep make_sweep(const Touch& touch, double step_m, std::uint32_t frames);

/// Path of one device over a static model. The model is loaded and refined before the first frame,
/// so that only the force model determines the result.
struct ForceRun
{
    const Scene& scene;
    ToolSpec tool;
    std::vector<Vec3> goals_m; ///< Device positions in the model frame, one for each frame.
    std::size_t lead_in{0};    ///< Frames at the start that are not counted.
    Material material{};       ///< Material of the surface.
};

/// Results of the counted frames.
struct ForceTrace
{
    std::vector<ToolOutput> outputs;
    std::vector<double> planes; ///< Planes that the proxy evaluated (Budgets::planes).
    LeastTimes force_us;        ///< Time of the force stage.
    LeastTimes frame_us;        ///< Time of all stages.
    /// Most allocations of all frames in one replay; empty if they cannot be counted.
    std::optional<std::uint64_t> allocations;
    std::uint64_t hash{0}; ///< Hash of the bits of all forces and proxies.
};

/// Replays the path `passes` times, at least once, each time with a new controller. A failure if
/// the model cannot be refined fully, or if two replays differ in a bit of a force.
[[nodiscard]] ForceTrace replay_forces(const ForceRun& run, std::uint32_t passes);

/// Accuracy of the forces of one sweep, in newtons.
struct ForceFigures
{
    Spread error_n;             ///< Error of the force against the exact surface.
    double largest_step_n{0.0}; ///< Greatest change of the force between frames.
    /// Frames in which the sphere is stuck: halted, without contact, or farther than `lag_m` from
    /// its rest position.
    std::uint64_t stuck{0};
    std::uint64_t without_force{0};
};
/// Accuracy of a trace; `rests_m` of the counted frames, in the frame of the trace.
[[nodiscard]] ForceFigures measure_forces(const ForceTrace& trace, const std::vector<Vec3>& goals_m,
                                          const std::vector<Vec3>& rests_m, const Touch& touch,
                                          double lag_m);

/// Goals of one sweep; infinite: none.
struct ForceGoals
{
    double frame_p99_us;
    double error_p99_n;
    double error_max_n;
    double step_n;
    bool has_laws{true}; ///< Requires no allocation and no stuck frame.
    double force_p99_us{kNoGoal};
};
/// Time after which a proxy that lagged is on the device again, once that slows down.
inline constexpr double kReturn_ms = 50.0;

/// Adds the rows of a sweep. `coarser_p99_n` is the same sweep's error on the next coarser mesh, if
/// there is one; the error must be smaller.
void add_force_rows(CaseRows& rows, const ForceTrace& trace, const ForceFigures& figures,
                    const ForceGoals& goals, std::optional<double> coarser_p99_n);

/// Adds the rows of a sweep without a known true force: times, allocations and frames without a
/// force, which must not occur.
void add_felt_rows(CaseRows& rows, const ForceTrace& trace, const ForceFigures& figures,
                   const ForceGoals& goals);

/// Adds the lag of the proxy behind a fast device, and its cost. From the counted frame `slows_at`
/// on, each of 1 ms, the device is slow; kReturn_ms later the proxy must be on it again.
void add_lag_rows(CaseRows& rows, const ForceTrace& trace, std::size_t slows_at);

/// Adds recorded figures of CHAI3D 3.3's finger proxy, for the order of magnitude: measured
/// elsewhere, on a similar surface whose constants were not kept.
void add_recorded_peer(Rows& rows);

/// Rigid tools that lie, slide and rotate on flat sheets of any cell size, where force and torque
/// are known.
void run_sheet_tools(const CaseContext& context);

/// Tools of a centimetre on dense meshes: how often they have a force, and how accurate it is.
void run_dense_meshes(const CaseContext& context);

} // namespace tactus::bench
