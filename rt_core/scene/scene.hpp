// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/local_surface.hpp"

#include <cstdint>
#include <span>

namespace tactus
{

/// One pair of tool and object and what is known of its distance from frame to frame. The distance
/// from a tool to a surface changes by no more than the tool moves, so a proven L stays of use:
/// while L minus the motion is beyond what the tool asks for, nothing has to be looked at.
struct ScenePair
{
    std::uint32_t tool{0};
    std::uint32_t object{0};
    PlacedCore core;             ///< The tool's, at its proxy now; in the model's frame, as all.
    CoreCover cover;             ///< Of the core.
    double reach_m{0.0};         ///< From the core, what the tool asks for now.
    Vec3 ahead_m{0.0, 0.0, 0.0}; ///< How far the tool comes before a contact can be refined.
    bool is_asleep{false};       ///< Proven out of reach; no stage needs to look.

    PlacedCore known_core; ///< Where `known` was taken.
    DistanceAnswer known;
    bool has_known{false};

    [[nodiscard]] double motion_m() const noexcept { return core.motion_since(known_core); }
};

/// Tools, objects, and the pairs they make. Haptic thread.
class Scene
{
public:
    /// At most kMaxTools and kMaxObjects.
    Scene(std::span<const ToolSpec> tools, std::span<const ObjectSpec> objects) noexcept;

    /// Records are merged when they are this much farther than the reach: between the two, nothing
    /// changes when a tool goes back and forth.
    static constexpr double kKeepFactor = 1.25;

    /// Tells the tools whose mesh is the core's model the rest of it.
    void describe_meshes(const MeshCore& core) noexcept;

    /// Places a pair's tool for this frame: where its frame lies in the world, how far it asks from
    /// there, and how far it looks ahead (both in the world).
    void place(ScenePair& pair, const ObjectPose& pose, const Mat3& rotation,
               const Vec3& position_m, double reach_m,
               const Vec3& ahead_m) const noexcept TACTUS_NONBLOCKING;
    /// Keeps what a query found at the pair's present place.
    static void remember(ScenePair& pair, const DistanceAnswer& answer) noexcept TACTUS_NONBLOCKING;
    /// What `remember`ed knowledge says of the present place, without looking: a valid bracket.
    [[nodiscard]] static DistanceAnswer
    from_motion(const ScenePair& pair) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] std::span<const ToolSpec> tools() const noexcept { return tools_.view(); }
    [[nodiscard]] std::span<const ObjectSpec> objects() const noexcept { return objects_.view(); }
    [[nodiscard]] std::span<ScenePair> pairs() noexcept { return {pairs_.begin(), pairs_.size()}; }

private:
    StaticVector<ToolSpec, kMaxTools> tools_;
    StaticVector<ObjectSpec, kMaxObjects> objects_;
    StaticVector<ScenePair, kMaxPairs> pairs_;
};

} // namespace tactus
