// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/shared/frame_rig.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tactus::bench
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
[[nodiscard]] WorstRun make_worst_run(const WorstCase& worst, std::int64_t period_ns,
                                      SceneStore& scenes);

} // namespace tactus::bench
