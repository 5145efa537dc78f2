// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Differences from the shipped frame, so that the saving of each shortcut can be measured. The
/// first ten are shortcuts: without them exact answers are the same and cost more. Not for tools
/// that are meshes. Recordings are of frames without any difference.
struct FrameVariant
{
    /// Checks only objects near a tool: see BroadPhase. Off: the nearest kMaxNear.
    bool finds_neighbours{true};
    /// A tool at rest among objects and faces at rest keeps its last answers and its last force.
    bool lets_tools_rest{true};
    /// If all tools rest and all models are resident as a whole, the whole frame repeats the last
    /// one.
    bool lets_frames_rest{true};
    /// A pair proven out of reach by its last distance and the motion since is not queried.
    bool lets_pairs_rest{true};
    bool starts_warm{true}; ///< A query starts where the last one ended.
    /// A certified region is not checked until motion uses up its certificate.
    bool keeps_certificates{true};
    bool refits_changed_only{true};
    /// Requests nothing of a model whose boxes no sphere meets.
    bool asks_near_models_only{true};
    /// Skips index pages for some frames after a search for slightly wider spheres.
    bool keeps_searches{true};
    /// Requests chunks where a tool will be, not only where it is.
    bool asks_ahead{true};
    /// Above 0, every coarse face within this many times the reach is split, even if its error is
    /// small; answers still follow from the faces' errors.
    double fixed_radius{0.0};
    /// Above 0, coarse faces count as the surface if their error is at most this; replaces the
    /// tolerance that FrameSetup::force_tolerance_n and the pools give. Model frame.
    double tolerance_m{0.0};
};

} // namespace tactus
