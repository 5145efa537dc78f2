// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// How a frame may differ from the one that ships, so that what it saves can be measured. The first
/// ten are shortcuts: without them exact answers are the same and cost more. For tools that are
/// no meshes. Recordings are of frames without any difference.
struct FrameVariant
{
    /// Only objects near a tool are looked at: see BroadPhase. Without, the nearest kMaxNear are.
    bool finds_neighbours{true};
    /// A tool at rest among objects and faces at rest keeps its last answers and its last force.
    bool lets_tools_rest{true};
    /// Where all tools rest and all models are here as a whole, all of the frame is the last one.
    bool lets_frames_rest{true};
    /// A pair that its last distance and the motion since prove out of reach is not looked at.
    bool lets_pairs_rest{true};
    bool starts_warm{true};        ///< A query starts where the last one ended.
    bool keeps_certificates{true}; ///< What is certified is not looked at until motion uses it up.
    bool refits_changed_only{true};
    /// Of a model whose boxes no ball meets nothing is asked for.
    bool asks_near_models_only{true};
    /// Index pages that were searched for balls a little wider are left alone for some frames.
    bool keeps_searches{true};
    bool asks_ahead{true}; ///< Chunks are asked for where a tool will be, not only where it is.
    /// Above 0 every coarse face within so many times the reach is split, whatever its error;
    /// answers are what the faces' errors prove all the same.
    double fixed_radius{0.0};
    /// Above 0 coarse faces count as the surface whose error is at most this, whatever
    /// FrameSetup::force_tolerance_n and the pools say. Model frame.
    double tolerance_m{0.0};
};

} // namespace tactus
