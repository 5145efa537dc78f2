// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "tests/shared/face_tree.hpp"
#include "tests/shared/test_model.hpp"
#include "tests/shared/trial_figures.hpp"
#include "tests/stability/hardships.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace tactus::test
{

/// Straight path that shares a point with a face, in the model frame.
struct Crossing
{
    Vec3 from_m{0.0, 0.0, 0.0};
    Vec3 to_m{0.0, 0.0, 0.0};
    std::uint32_t face{0};

    [[nodiscard]] std::string text() const;
};

/// A face of the full mesh that the straight path between two places meets, by exact arithmetic:
/// faces include their borders, paths their ends. Nothing slips through an edge or a corner, and a
/// path that only touches counts too. A face without an area is a segment and can be met.
[[nodiscard]] std::optional<Crossing> find_crossing(const TestModel& model, const FaceTree& tree,
                                                    const Vec3& from_m, const Vec3& to_m);

/// Path of one proxy relative to one object, from frame to frame: from the last place under the
/// object's old pose, to the same under the new pose, and on along the frame's path. Shares no code
/// with the proxy.
class ProxyTrail
{
public:
    /// Starts without a place. Both arguments must outlive the trail.
    ProxyTrail(const TestModel& model, const FaceTree& tree) : model_(&model), tree_(&tree) {}

    struct Crossings
    {
        std::optional<Crossing> carried; ///< Crossing by the object's motion.
        std::optional<Crossing> moved;   ///< Crossing by the proxy's own steps.
    };

    /// Crossings of the next frame, with the path in the world.
    [[nodiscard]] Crossings follow(std::span<const Vec3> path_m, const ObjectPose& pose);

private:
    const TestModel* model_;
    const FaceTree* tree_;
    std::optional<Vec3> last_m_; ///< Last place in the model frame.
};

/// Frames of one model under one hardship: the object is 0.1 to 0.2 m large and moves, the hand
/// taps it at up to kFastestTap_m_per_s.
struct PopThroughTrial
{
    const TestModel& model;
    const FaceTree& tree;
    Hardship hardship;
    std::uint64_t seed{0};
    std::uint32_t frames{0};
    bool is_smooth{false}; ///< True if the tool has force shading, of any permitted width.
};

inline constexpr double kFastestTap_m_per_s = 2.0;

struct PopThroughFigures
{
    /// Frames in which the path of the proxy's centre relative to the object met a face of the full
    /// mesh: none, except where the object ran over it and the frame reports it as
    /// over-constrained. Also frames with a force beyond its limit or not finite.
    TrialFigures crossings;
    /// Frames in which an object ran over the proxy; a violation unless the frame reports it.
    TrialFigures run_over;
    std::uint64_t in_contact{0};
    std::uint64_t halted{0};
    std::uint64_t over_constrained{0};
    std::uint64_t faded{0};       ///< Frames after kFadeTime_s of an over-constrained proxy.
    std::uint64_t let_go{0};      ///< Rounds after which the tool was no longer over-constrained.
    std::uint64_t felt_shaded{0}; ///< Frames in which force shading stiffened the wall.

    /// Adds figures of the same claims from other trials.
    void add(const PopThroughFigures& other)
    {
        crossings.add(other.crossings);
        run_over.add(other.run_over);
        in_contact += other.in_contact;
        halted += other.halted;
        over_constrained += other.over_constrained;
        faded += other.faded;
        felt_shaded += other.felt_shaded;
    }
};

[[nodiscard]] PopThroughFigures run_pop_through_trial(const PopThroughTrial& trial);

/// Two objects of one model close in on a tool from both sides, at up to 1 m/s each, until it is
/// over-constrained; they stay a while and retreat.
struct ClosingTrial
{
    const TestModel& model;
    const FaceTree& tree;
    std::uint64_t seed{0};
    std::uint32_t rounds{0};
    bool is_smooth{false}; ///< True if the tool has force shading.
};

/// Checks the claims of PopThroughFigures, and that no force is left after kFadeTime_s of
/// over-constraint, which ends when the objects are gone. A tool may slip out to a side, and end
/// behind one of them.
[[nodiscard]] PopThroughFigures run_closing_trial(const ClosingTrial& trial);

} // namespace tactus::test
