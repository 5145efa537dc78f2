// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/face_names.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/mesh_pair_oracle.hpp"
#include "tests/stability/mesh_motion.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace tactus::test
{

/// Compares the answers of a frame about a mesh tool and an object with all faces of both.
class MeshJudge
{
public:
    /// Judges a tool with a skin of `radius_m`. Both models must outlive the judge.
    MeshJudge(const TestModel& tool, const TestModel& object, double radius_m);

    /// Faults, one line each. `rig` has just run the frame; the object's model is its first, the
    /// tool's its second.
    [[nodiscard]] std::vector<std::string> judge(FrameRig& rig, const MeshMoment& moment,
                                                 const PairOutput& pair);

    /// True if any faces met in the last frame.
    [[nodiscard]] bool is_meeting() const { return !meeting_.empty(); }
    [[nodiscard]] double distance_m() const { return static_cast<double>(nearest_.distance_m); }

private:
    using NamedPairs = std::vector<FacePair>;

    void judge_bracket(const PairOutput& pair);
    void judge_nearest(const PairOutput& pair);
    void judge_meeting(const MeshReport& report);
    void judge_truncated(const MeshReport& report);
    void judge_intersection(const MeshReport& report);
    void judge_contacts(const ContactReport& report);
    void judge_complete_contacts(const NamedPairs& named);

    void flag(const std::string& what) { wrong_.push_back(what); }
    /// Name of a pair of active faces; a fault if they are not the source's.
    [[nodiscard]] FacePair named(FaceId tool_face, FaceId face);
    [[nodiscard]] NamedPairs sorted_names(const std::vector<FacePair>& pairs) const;

    MeshPairOracle oracle_;
    FaceNames tool_names_;
    FaceNames names_;
    double radius_m_;

    // Rig of the judged frame.
    FrameRig* rig_{nullptr};
    double doubt_m_{0.0}; ///< Possible error of distances in double.
    MeshPairOracle::Nearest nearest_;
    NamedPairs meeting_;
    std::vector<std::string> wrong_;
};

} // namespace tactus::test
