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

/// Shapes of tools; lengths of those that slide over an object 0.1 m across.
enum class WorstTool : std::uint8_t
{
    ball,    ///< Of 10 mm: some 2,000 faces of a fine object are in its reach.
    capsule, ///< 40 mm long.
    box,     ///< 30 x 16 x 10 mm.
    hull,    ///< A spike, 30 mm long.
    mesh,    ///< A bumpy sphere of 980 faces, 0.15 diagonals of the object across.
};

/// What is done to the frame. Tools are felt, but where it says that they measure: then they go
/// where the hand is, and want contacts and all pairs of faces.
enum class WorstMotion : std::uint8_t
{
    sinks,     ///< Touches; then without a force, as after a stall, deep in, where it turns.
    waits,     ///< The same; no page comes while it touches, then all at once.
    turns,     ///< Measures, deep in from the first frame, turning at 5 rad/s.
    teleports, ///< Measures, each frame elsewhere on the surface.
    in_crowd,  ///< Sinks among 32 objects that meet one another.
    equals,    ///< A mesh in the very place of an object that is the same mesh.
    in_comb,   ///< A comb's teeth between those of another, then through them.
};

struct WorstCase
{
    const char* name;
    WorstTool tool;
    WorstMotion motion;
    bool measures{false};
    std::uint32_t tools{1}; ///< All alike, on one spot.
};

/// What one frame gets.
struct WorstMoment
{
    std::vector<ToolState> tools;
    std::vector<SceneChange> changes;
    bool is_delivered{true}; ///< The transport side works before the frame.
};

/// A scene and what becomes of it, frame by frame.
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
