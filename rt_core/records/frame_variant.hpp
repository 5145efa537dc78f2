// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// Switches of a frame that measure the saving of each shortcut; the default is the shipped frame.
/// Without one of the first ten, exact answers are the same and cost more. Mesh tools and
/// recordings need the default.
struct FrameVariant
{
    /// Only objects near a tool are checked (BroadPhase). False: the nearest kMaxNear objects.
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
    /// Nothing is requested of a model if no region's sphere meets one of its boxes.
    bool asks_near_models_only{true};
    /// After a search with slightly wider spheres, index pages are skipped for some frames.
    bool keeps_searches{true};
    /// Chunks are requested where a tool will be, not only where it is.
    bool asks_ahead{true};
    /// Above 0: every coarse face within this many times the reach is split, even with a small
    /// error. Answers still follow from the faces' errors.
    double fixed_radius{0.0};
    /// Above 0: coarse faces with at most this error count as the surface, in metres of the model's
    /// frame. Replaces the tolerance that follows from FrameSetup::force_tolerance_n and the pools.
    double tolerance_m{0.0};
};

} // namespace tactus
