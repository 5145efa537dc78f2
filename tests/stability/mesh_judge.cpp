// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/mesh_judge.hpp"

#include "tests/stability/trial_terms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

namespace tactus::test
{

namespace
{

constexpr ModelId kObject{0};
constexpr ModelId kTool{1};
constexpr FacePair kNoPair{0xFFFF'FFFFU, 0xFFFF'FFFFU};

std::string text_of(const FacePair& faces)
{
    return "faces " + std::to_string(faces.tool_face) + " of the tool and " +
           std::to_string(faces.face) + " of the object";
}

/// First pair that is in one list only.
FacePair first_difference(const std::vector<FacePair>& a, const std::vector<FacePair>& b)
{
    std::vector<FacePair> differing;
    std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(),
                                  std::back_inserter(differing));
    return differing.empty() ? kNoPair : differing[0];
}

} // namespace

MeshJudge::MeshJudge(const TestModel& tool, const TestModel& object, double radius_m)
    : oracle_(tool, object), tool_names_(tool.faces), names_(object.faces), radius_m_(radius_m)
{
}

std::vector<std::string> MeshJudge::judge(FrameRig& rig, const MeshMoment& moment,
                                          const PairOutput& pair)
{
    rig_ = &rig;
    wrong_.clear();
    if (pair.mesh == nullptr || pair.contacts == nullptr)
    {
        flag("there is no report");
        return wrong_;
    }
    oracle_.place(moment.pose, moment.tool);
    doubt_m_ = 1e-13 * (moment.tool.position_m.norm() + pair.point_m.norm() +
                        moment.pose.translation_m.norm() + moment.pose.scale);
    const std::vector<FacePair> meeting = oracle_.meeting();
    nearest_ = meeting.empty() ? oracle_.nearest() : MeshPairOracle::Nearest{0, meeting[0]};
    meeting_ = sorted_names(meeting);
    judge_bracket(pair);
    judge_nearest(pair);
    judge_meeting(*pair.mesh);
    judge_intersection(*pair.mesh);
    judge_contacts(*pair.contacts);
    return wrong_;
}

void MeshJudge::judge_bracket(const PairOutput& pair)
{
    if (is_between(pair.lower_m, nearest_.distance_m, pair.upper_m))
    {
        return;
    }
    const Quad judged = oracle_.distance<Quad>(nearest_.faces);
    if (!is_between(pair.lower_m, judged, pair.upper_m))
    {
        flag(text_of(nearest_.faces) + " are " + exactly(static_cast<double>(judged)) +
             " apart, not " + exactly(pair.lower_m) + " .. " + exactly(pair.upper_m) + ", answer " +
             std::to_string(static_cast<int>(pair.kind)));
    }
}

/// Checks that the pair of an exact answer is as near as it claims, and its points too.
void MeshJudge::judge_nearest(const PairOutput& pair)
{
    if (pair.kind != AnswerKind::exact)
    {
        return;
    }
    const FacePair faces = named(pair.mesh->nearest_tool_face, pair.nearest_face);
    if (faces == kNoPair)
    {
        return;
    }
    const auto distance_m = static_cast<double>(oracle_.distance(faces));
    const double points_m = (pair.point_m - pair.nearest_point_m).norm();
    if (!is_between(pair.lower_m - doubt_m_, distance_m, pair.upper_m + doubt_m_))
    {
        flag(text_of(faces) + " are said to be the nearest and are " + exactly(distance_m) +
             " apart, not " + exactly(pair.lower_m) + " .. " + exactly(pair.upper_m));
    }
    // Points on needles are less accurate than distances.
    if (std::abs(points_m - distance_m) > 1e5 * doubt_m_)
    {
        flag("the nearest points are " + exactly(points_m) + " apart, their faces " +
             exactly(distance_m));
    }
}

void MeshJudge::judge_meeting(const MeshReport& report)
{
    if (!std::is_sorted(report.meeting.begin(), report.meeting.end()) ||
        std::adjacent_find(report.meeting.begin(), report.meeting.end()) != report.meeting.end())
    {
        flag("meeting faces are not in ascending order");
    }
    NamedPairs reported;
    for (const MeetingFaces& faces : report.meeting)
    {
        reported.push_back(named(faces.tool_face, faces.face));
    }
    std::sort(reported.begin(), reported.end());
    if (!std::includes(meeting_.begin(), meeting_.end(), reported.begin(), reported.end()))
    {
        flag("said to meet, but do not: " + text_of(first_difference(reported, meeting_)));
    }
    if (report.is_complete && reported != meeting_)
    {
        flag(std::to_string(reported.size()) + " pairs are said to be all that meet, of " +
             std::to_string(meeting_.size()) + "; not so " +
             text_of(first_difference(reported, meeting_)));
    }
    if (report.is_truncated)
    {
        judge_truncated(report);
    }
}

/// If both models are refined fully, every true id is known and the lowest are kept.
void MeshJudge::judge_truncated(const MeshReport& report)
{
    if (report.is_complete || report.meeting.size() != kMaxMeetingFaces)
    {
        flag("a truncated report of " + std::to_string(report.meeting.size()) + " pairs");
    }
    if (rig_->model(kObject).residence != Residence::complete ||
        rig_->model(kTool).residence != Residence::complete)
    {
        return;
    }
    const auto ids_by_name = [](const FaceNames& names, const Model& model)
    {
        std::map<std::uint32_t, std::vector<FaceId>> ids;
        for (std::uint32_t i = 0; i < model.header.counts().face_ids(); ++i)
        {
            if (const auto name = names.of(model, FaceId{i}))
            {
                ids[*name].push_back(FaceId{i});
            }
        }
        return ids;
    };
    const auto tool_ids = ids_by_name(tool_names_, rig_->model(kTool));
    const auto ids = ids_by_name(names_, rig_->model(kObject));
    NamedPairs pairs = meeting_;
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    std::vector<MeetingFaces> all;
    for (const FacePair& pair : pairs)
    {
        for (const FaceId tool_face : tool_ids.at(pair.tool_face))
        {
            for (const FaceId face : ids.at(pair.face))
            {
                all.push_back({tool_face, face});
            }
        }
    }
    std::sort(all.begin(), all.end());
    if (all.size() <= kMaxMeetingFaces ||
        !std::equal(report.meeting.begin(), report.meeting.end(), all.begin()))
    {
        flag("the pairs that are kept of " + std::to_string(all.size()) + " are not the lowest");
    }
}

void MeshJudge::judge_intersection(const MeshReport& report)
{
    if (report.intersection == Intersection::none && !meeting_.empty())
    {
        flag("said to be apart, but " + std::to_string(meeting_.size()) + " pairs meet, as " +
             text_of(meeting_[0]));
    }
    if (report.intersection == Intersection::proven && meeting_.empty())
    {
        flag("said to meet, but are apart by " + exactly(static_cast<double>(nearest_.distance_m)));
    }
    if (report.is_complete && report.intersection == Intersection::open)
    {
        flag("all pairs are known, but not whether any meet");
    }
}

void MeshJudge::judge_contacts(const ContactReport& report)
{
    NamedPairs reported;
    double last_m = 0.0;
    for (const Contact& contact : report.contacts)
    {
        const FacePair faces = named(contact.tool_face, contact.face);
        if (faces == kNoPair)
        {
            return;
        }
        reported.push_back(faces);
        const auto distance_m = static_cast<double>(oracle_.distance(faces));
        if (std::abs(contact.distance_m - distance_m) > doubt_m_ ||
            contact.distance_m > radius_m_ + doubt_m_)
        {
            flag("a contact at " + exactly(contact.distance_m) + " of " + text_of(faces) +
                 ", which are " + exactly(distance_m) + " apart; the skin is " +
                 exactly(radius_m_));
        }
        if (contact.distance_m < last_m)
        {
            flag("contacts are not in order");
        }
        last_m = contact.distance_m;
    }
    if (report.is_complete)
    {
        std::sort(reported.begin(), reported.end());
        judge_complete_contacts(reported);
    }
}

/// Expects all pairs that are clearly within the skin, and none that is clearly outside.
void MeshJudge::judge_complete_contacts(const NamedPairs& named_pairs)
{
    constexpr std::size_t kEnough = kMaxContacts + 1;
    NamedPairs clear =
        radius_m_ > 0.0 ? sorted_names(oracle_.within(radius_m_ - doubt_m_, kEnough)) : meeting_;
    if (!std::includes(named_pairs.begin(), named_pairs.end(), clear.begin(), clear.end()))
    {
        std::vector<FacePair> missing;
        std::set_difference(clear.begin(), clear.end(), named_pairs.begin(), named_pairs.end(),
                            std::back_inserter(missing));
        flag(std::to_string(named_pairs.size()) + " contacts are said to be all; missing " +
             text_of(missing[0]) + ", " +
             exactly(static_cast<double>(oracle_.distance(missing[0]))) + " apart");
    }
}

FacePair MeshJudge::named(FaceId tool_face, FaceId face)
{
    const auto tool_name = tool_names_.of(rig_->model(kTool), tool_face);
    const auto name = names_.of(rig_->model(kObject), face);
    if (!tool_name || !name)
    {
        flag("face " + std::to_string(tool_face.value) + " of the tool or " +
             std::to_string(face.value) + " of the object is no exact face");
        return kNoPair;
    }
    return {*tool_name, *name};
}

MeshJudge::NamedPairs MeshJudge::sorted_names(const std::vector<FacePair>& pairs) const
{
    NamedPairs result;
    for (const FacePair& pair : pairs)
    {
        result.push_back({tool_names_.of(pair.tool_face), names_.of(pair.face)});
    }
    std::sort(result.begin(), result.end());
    return result;
}

} // namespace tactus::test
