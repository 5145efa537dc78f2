// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/face_tree.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/trial_figures.hpp"
#include "tests/stability/hardships.hpp"
#include "tests/stability/tool_oracle.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace tactus::test
{

/// The same tools on the same object twice: streamed and refined around the tools under a hardship,
/// and refined fully. The object is 0.1 to 0.2 m large; each tool has its own PressMotion.
struct ForceTwinTrial
{
    const TestModel& model;
    const FaceTree& tree;
    Hardship hardship;
    std::uint64_t seed{0};
    std::uint32_t frames{0};
    std::uint32_t tools{1};
};

/// Change of force per frame that the level of detail may add: 0.05 N, below the other bound, 1 %
/// of a device's 8 N.
inline constexpr double kForceStep_n = 0.05;

/// Judge of one tool and its twin, frame by frame.
class ForceStepJudge
{
public:
    struct Step
    {
        /// Difference between the force's change since the last frame and the twin's, as vectors.
        double newtons{0.0};
        /// True if in both frames both were certified, and both have since coincided in place and
        /// force. A proxy that waited for data may have come to another side of an edge, and must
        /// catch up first.
        bool is_certified{false};
    };

    /// Step of a frame; empty unless both were in contact in this frame and the last one, and
    /// neither is halted or over-constrained. `is_answered`: both answers are exact or separated,
    /// and both proxies came to rest before the end of the certified range.
    [[nodiscard]] std::optional<Step> judge(const ToolOutput& ours, const ToolOutput& twins,
                                            bool is_answered);

private:
    Vec3 ours_n_{0.0, 0.0, 0.0};
    Vec3 twins_n_{0.0, 0.0, 0.0};
    bool were_touching_{false};
    bool were_certified_{false};
    bool are_apart_{false};
};

struct ForceTwinFigures
{
    /// Certified steps, in newtons.
    TrialFigures steps;
    double apart_n{0.0};         ///< Greatest difference of the forces in those frames.
    std::uint64_t refining{0};   ///< Those frames with splits.
    std::uint64_t coarsening{0}; ///< Those frames with merges.
    std::uint64_t adopting{0};   ///< Those frames with adopted pages.
    /// Other frames in contact: the proxy is data-limited or needs more than a frame's steps, or
    /// was so and came to another place.
    std::uint64_t data_limited{0};
    double data_limited_n{0.0}; ///< Greatest step in those.
    /// Frames in contact right after one in which the proxy waited for data: change of the force
    /// beyond that of the hand's motion, in newtons.
    TrialFigures after_waits;
    /// Frames in which the streamed proxy was halted or over-constrained; its force fades by
    /// design.
    std::uint64_t fading{0};

    /// Adds figures of the same claim from other trials.
    void add(const ForceTwinFigures& other)
    {
        steps.add(other.steps);
        apart_n = std::max(apart_n, other.apart_n);
        refining += other.refining;
        coarsening += other.coarsening;
        adopting += other.adopting;
        fading += other.fading;
        data_limited += other.data_limited;
        data_limited_n = std::max(data_limited_n, other.data_limited_n);
        after_waits.add(other.after_waits);
    }

    [[nodiscard]] bool hold() const { return steps.holds() && after_waits.holds(); }
};

/// Those of hardships() in which tools can be pressed: points or 0.04 diag large, with enough pages
/// for them.
[[nodiscard]] std::vector<Hardship> force_hardships(const TestModel& model);

[[nodiscard]] ForceTwinFigures run_force_twin_trial(const ForceTwinTrial& trial);

/// The same model twice: streamed and refined around a sliding tool as in use, and refined fully.
struct TwinTrial
{
    const TestModel& model;
    const FaceTree& tree;
    std::uint64_t seed{0};
    std::uint32_t frames{0};
};

struct TwinFigures
{
    /// Certified frames: kind, L, U, nearest face, point and feature, and the set of exact faces
    /// within the certified radius, bit for bit. The error is the number of differences.
    TrialFigures identity;
    /// Point, segment, box and hull in turn in those frames, at the centre of the sphere: contacts
    /// and, of exact answers, normal, side and nearest points, bit for bit.
    TrialFigures cores;
    /// Frames without an exact or separated answer, after the tool's descent, with K = 64 at 0.1
    /// diag/s. The error is their share.
    TrialFigures uncertified;
};

/// Share of frames that may be open.
inline constexpr double kUncertifiedShare = 0.05;

[[nodiscard]] TwinFigures run_twin_trial(const TwinTrial& trial);

} // namespace tactus::test
