// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/face_tree.hpp"
#include "tests/shared/trial_figures.hpp"
#include "tests/stability/hardships.hpp"

#include <cstdint>

namespace tactus::test
{

/// Frames of a mesh tool and an object.
struct MeshTrial
{
    const TestModel& tool;
    const TestModel& object;
    const FaceTree& tree; ///< Tree of the object, for the motion.
    /// Hardship with pools for each model; its radius is the skin in diagonals of the tool.
    Hardship hardship;
    double scale{1.0};
    std::uint64_t seed{0};
    std::uint32_t frames{0};
};

struct MeshFigures
{
    /// L <= d <= U, meeting pairs, contacts and budgets; the error is the number of wrong frames.
    TrialFigures truth;
    /// Frames after kMeshSettling without an exact or separated answer or without a complete
    /// report; the error is their share.
    TrialFigures open;
    std::uint64_t exact{0};
    std::uint64_t meeting{0};   ///< Frames in which faces meet.
    std::uint64_t complete{0};  ///< Frames with a complete report.
    std::uint64_t truncated{0}; ///< Frames with too many pairs that meet.
};

/// Frames until both models are refined where the surfaces are near.
inline constexpr std::uint32_t kMeshSettling = 500;
/// Share of frames of a slow slide that may be open.
inline constexpr double kMeshOpenShare = 0.05;

/// Random motion under the trial's hardship.
[[nodiscard]] MeshFigures run_mesh_trial(const MeshTrial& trial);
/// Slow slide; `open` is bounded by kMeshOpenShare.
[[nodiscard]] MeshFigures run_mesh_slide(const MeshTrial& trial);

/// A tool with the object's own mesh in the object's pose.
[[nodiscard]] MeshFigures run_coincident_meshes(const MeshTrial& trial);

/// The same motion with both models streamed and with both refined fully. If both answers are exact
/// they are equal to the last bit, and so are complete reports. The error is the number of frames
/// that differ.
[[nodiscard]] TrialFigures run_mesh_twin(const MeshTrial& trial);

/// The same motion with all pairs requested, and with neither pairs nor contacts. If both answers
/// are exact they are equal to the last bit; whether faces meet is the same if both know it, and if
/// they meet the distance is known. The error is the number of frames that differ.
struct PairlessFigures
{
    TrialFigures same;
    std::uint64_t met{0}; ///< Frames in which more than one pair met.
};
[[nodiscard]] PairlessFigures run_mesh_without_pairs(const MeshTrial& trial);

} // namespace tactus::test
