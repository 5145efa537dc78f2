// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/face_tree.hpp"
#include "tests/shared/trial_figures.hpp"
#include "tests/stability/hardships.hpp"

#include <cstdint>

namespace tactus::test
{

/// Frames of a tool that is a mesh, and an object.
struct MeshTrial
{
    const TestModel& tool;
    const TestModel& object;
    const FaceTree& tree; ///< Of the object, for the motion.
    /// Each model gets the pools that it gives to one; its radius is the skin's, in diagonals of
    /// the tool.
    Hardship hardship;
    double scale{1.0}; ///< Of the object.
    std::uint64_t seed{0};
    std::uint32_t frames{0};
};

struct MeshFigures
{
    /// L <= d <= U, pairs that meet, contacts, budgets: the error is the number of frames that are
    /// wrong.
    TrialFigures truth;
    /// Frames without an exact or decided answer or a complete report, of those after
    /// kMeshSettling; the error is their share.
    TrialFigures open;
    std::uint64_t exact{0};
    std::uint64_t meeting{0};   ///< Frames in which faces meet.
    std::uint64_t complete{0};  ///< Frames with a complete report.
    std::uint64_t truncated{0}; ///< Frames with too many pairs that meet.
};

/// Frames in which both fronts come to where the surfaces are near.
inline constexpr std::uint32_t kMeshSettling = 500;
/// What may be left open of a slow slide: a twentieth of the frames.
inline constexpr double kMeshOpenShare = 0.05;

/// A random motion, whatever runs out.
[[nodiscard]] MeshFigures run_mesh_trial(const MeshTrial& trial);
/// A slow slide; `open` is bounded by kMeshOpenShare.
[[nodiscard]] MeshFigures run_mesh_slide(const MeshTrial& trial);

/// The tool is the object's own mesh and where the object is.
[[nodiscard]] MeshFigures run_coincident_meshes(const MeshTrial& trial);

/// The same motion with both models streamed and with both refined fully: in frames in which both
/// answers are exact they are the same to the last bit, and so are complete reports. The error is
/// the number of frames that differ.
[[nodiscard]] TrialFigures run_mesh_twin(const MeshTrial& trial);

/// The same motion with all pairs wanted, and with neither pairs nor contacts: in frames in which
/// both answers are exact they are the same to the last bit, whether any faces meet is the same
/// where both know, and where some do the distance is known. The error is the number of frames that
/// differ.
struct PairlessFigures
{
    TrialFigures same;
    std::uint64_t met{0}; ///< Frames in which more than one pair met.
};
[[nodiscard]] PairlessFigures run_mesh_without_pairs(const MeshTrial& trial);

} // namespace tactus::test
