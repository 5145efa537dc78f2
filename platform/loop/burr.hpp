// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/cut_tap.hpp"
#include "platform/machine/time.hpp"
#include "rt_core/base/model_id.hpp"
#include "rt_core/geometry/tool_core.hpp"
#include "rt_core/math/vec3.hpp"

#include <cstdint>
#include <optional>
#include <vector>

// Any thread except the haptic one: calls allocate.
namespace tactus::hrtc
{

/// Shape of a tool that cuts: all points within the radius of the hull of the points.
struct BurrShape
{
    std::vector<Vec3> core_m; ///< In the tool's frame; one point for a sphere, two for a capsule.
    double radius_m{0.0};
};

/// Shape of a tool; none if it can't cut: a point, a mesh, a hull with a radius.
[[nodiscard]] std::optional<BurrShape> burr_shape(const ToolCore& core, double radius_m);

/// Volume that 1 N removes in a metre of path of the tool's surface over the material
/// (Preston's law), 1,000 mm^3.
inline constexpr double kBurrVolume_m3_per_nm = 1e-6;
/// Speed of a burr's surface by its own rotation, to which that of the hand is added.
inline constexpr double kBurrSpeed_m_per_s = 0.05;
/// Range of the greatest volume in a second of a burr, in mm^3/s.
inline constexpr double kBurrRateMin_mm3_per_s = 0.01;
inline constexpr double kBurrRateMax_mm3_per_s = 10'000.0;

/// A cut that a burr asks for: the tool moves along a straight line without rotation, in the frame
/// of the object's model.
struct BurrCut
{
    std::uint32_t object{0};
    ModelId model{};
    Mat3 rotation{Mat3::Identity()}; ///< Tool's frame to model's frame.
    Vec3 from_m{0.0, 0.0, 0.0};      ///< Tool's origin at the start.
    Vec3 to_m{0.0, 0.0, 0.0};        ///< Tool's origin at the end.
    double scale{1.0};               ///< Scale of the object, by which the tool is to be divided.
    double volume_m3{0.0};           ///< Greatest volume that it removes, in the world.
};

/// Law of a burr: which part of the material a tool removes that presses on it.
///
///     volume in a second = k x force x speed, at most `rate`
///
/// k is kBurrVolume_m3_per_nm. The speed is that of the proxy over the surface plus
/// kBurrSpeed_m_per_s. The volume of successive frames is summed up, and asked for by a sweep from
/// the last to the present proxy, pushed in along the hand's force by a depth:
///
///              device                    push by d
///                |                      ------------
///         o--------------o  proxy  ->   |          |   new volume <= d x (area of the shadow of
///        from           to              o----------o   the swept tool along the push)
///
/// At both places the tool is outside of the material, so the depth
///
///     d = volume / shadow - roundness x radius
///
/// removes at most the volume, also in a groove that fits the tool. On a flat surface the shadow is
/// larger than what is cut, so less is removed until the tool has made its groove. The second term
/// is the tolerance of the server's polyhedron (kBurrRoundness). Cuts have at least the depth
/// kBurrDepthMin x radius, so that each is deeper than that tolerance; until the volume suffices,
/// the sweep grows with the path. Volume beyond the depth kBurrDepthMax x radius is lost.
class BurrLaw
{
public:
    /// Shortest time between two cuts.
    static constexpr Duration kPeriod = milliseconds(33);
    /// Longest wait for the answer to the last cut. Without the answer, the proxy is still on the
    /// old surface, and a cut would remove what is removed already.
    static constexpr Duration kAnswer = milliseconds(100);
    /// Longest time between two frames of one contact.
    static constexpr Duration kContact = milliseconds(20);

    BurrLaw(BurrShape shape, double rate_m3_per_s);

    /// Adds a frame, and returns the cut that is now due, if any. Samples must be of one tool, in
    /// order of time.
    [[nodiscard]] std::optional<BurrCut> add(const CutSample& sample);
    /// Notes that the surface has changed since the last cut.
    void note_answer() noexcept { is_answered_ = true; }

    [[nodiscard]] const BurrShape& shape() const noexcept { return shape_; }

private:
    [[nodiscard]] bool is_straight(const Vec3& to_m, double scale) const;
    [[nodiscard]] double shadow_m2(const Mat3& rotation, const Vec3& way_m, const Vec3& push) const;

    BurrShape shape_;
    double rate_m3_per_s_;
    double size_m_; ///< Radius of the tool, or half the least width of a hull.
    std::optional<CutSample> last_;
    Vec3 from_m_{0.0, 0.0, 0.0};
    std::vector<Vec3> path_m_; ///< Proxies since `from_m_`.
    double volume_m3_{0.0};
    bool is_answered_{true};
    std::int64_t cut_ns_{0}; ///< Time of the last cut.
};

/// Share of a round tool's radius by which the polyhedron of a server may lie outside of the tool
/// (kSweptRoundness of host_tools/edit).
inline constexpr double kBurrRoundness = 1.0 / 64.0;
/// Least and greatest depth of a cut, as shares of the tool's radius.
inline constexpr double kBurrDepthMin = 3.0 / 64.0;
inline constexpr double kBurrDepthMax = 1.0 / 4.0;
/// Greatest length of a sweep, in radii.
inline constexpr double kBurrLengthMax = 4.0;
/// Greatest distance of a path from the straight line of its sweep, in radii.
inline constexpr double kBurrBend = 1.0 / 16.0;

} // namespace tactus::hrtc
