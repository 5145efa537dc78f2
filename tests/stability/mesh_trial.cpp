// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/stability/mesh_trial.hpp"

#include "tests/shared/frame_rig.hpp"
#include "tests/shared/frame_verdict.hpp"
#include "tests/shared/mesh_pair_oracle.hpp"
#include "tests/stability/random_motion.hpp"
#include "tests/stability/trial_terms.hpp"
#include "tests/stability/whole_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace tactus::test
{
namespace
{

/// State of a mesh tool and of the object in one frame.
struct MeshMoment
{
    ToolState tool;
    ObjectPose pose;
};

/// Smallest sphere around the centre of a tool's box, in the tool frame.
struct ToolSphere
{
    Vec3 middle_m{0.0, 0.0, 0.0};
    double radius_m{0.0};
};

/// Motion of a mesh tool around an object.
class MeshMotion
{
public:
    MeshMotion() = default;
    MeshMotion(const MeshMotion&) = delete;
    MeshMotion& operator=(const MeshMotion&) = delete;
    MeshMotion(MeshMotion&&) = delete;
    MeshMotion& operator=(MeshMotion&&) = delete;
    virtual ~MeshMotion() = default;

    [[nodiscard]] virtual MeshMoment next() = 0;
    /// Receives the distance of the surfaces in the last frame, for motions that depend on it.
    virtual void feel(double distance_m) { static_cast<void>(distance_m); }
    /// Name of the present activity, for a report.
    [[nodiscard]] virtual const char* activity() const = 0;
};

/// Motion of RandomMotion, applied to some place in or near the tool that changes from time to
/// time. The tool rotates not at all, slowly, fast, or to any orientation at once.
class RandomMeshMotion final : public MeshMotion
{
public:
    /// Starts with an object of this scale. All arguments must outlive the motion.
    RandomMeshMotion(const TestModel& tool, const TestModel& object, const FaceTree& tree,
                     double scale, Random& random);

    [[nodiscard]] MeshMoment next() override;
    [[nodiscard]] const char* activity() const override { return hand_.activity(); }

private:
    void change_grip();

    ToolSphere sphere_;
    Random& random_;
    RandomMotion hand_;
    Eigen::Quaterniond rotation_{Eigen::Quaterniond::Identity()};
    Vec3 grip_m_{0.0, 0.0, 0.0}; ///< Grip in the tool frame.
    Vec3 axis_{0.0, 0.0, 1.0};
    double rate_rad_{0.0};
    std::uint32_t frames_left_{0};
};

/// A tool with the object's own mesh in the object's pose: first exactly, as far as doubles permit,
/// then increasingly displaced to one side after the other.
class CoincidentMotion final : public MeshMotion
{
public:
    CoincidentMotion(const TestModel& tool, const TestModel& object);

    [[nodiscard]] MeshMoment next() override;
    [[nodiscard]] const char* activity() const override { return "coincident"; }

private:
    Vec3 place_m_; ///< Place of the tool frame.
    double diagonal_m_;
    std::uint32_t frame_{0};
};

/// Slide along the surface at 0.1 diag/s with rotation at 0.5 rad/s: descends to the surface, and
/// rises a little when faces meet.
class MeshSlide final : public MeshMotion
{
public:
    /// Starts with an object of this scale at the origin. All arguments must outlive the motion.
    MeshSlide(const TestModel& tool, const TestModel& object, const FaceTree& tree, double scale,
              Random& random);

    [[nodiscard]] MeshMoment next() override;
    void feel(double distance_m) override;
    [[nodiscard]] const char* activity() const override { return "slow slide"; }

private:
    ToolSphere sphere_;
    const FaceTree& tree_;
    double step_m_; ///< Step of a frame, in the world.
    ObjectPose pose_;
    /// Depth below the place where the sphere around the tool touches, in the world.
    double sunk_m_{0.0};
    Vec3 axis_;
    SurfaceSlide slide_;
    std::uint32_t frame_{0};
};

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

constexpr std::uint32_t kLongestGrip = 60;
constexpr std::array<double, 4> kTurns_rad{0.0, 5e-4, 5e-3, 0.05}; ///< Rotation in a frame of 1 ms.
constexpr double kSlideStep_diag = 0.1e-3;
constexpr double kSlideTurn_rad = 0.5e-3;
/// Speeds of descent and ascent, in steps of the slide.
constexpr double kSinking = 10.0;
constexpr double kPressing = 1.0;
constexpr double kRising = 1.0;

/// State of the tool with `grip_m` of its frame at `place_m` of the world.
ToolState held(const Vec3& grip_m, const Vec3& place_m, const Mat3& rotation)
{
    ToolState state;
    state.rotation = rotation;
    state.position_m = place_m - rotation * grip_m;
    return state;
}

SlideManner slide_manner(const TestModel& object, double radius_m, Random& random)
{
    SlideManner manner;
    manner.diagonal_m = object.diagonal_m;
    manner.radius_diag = radius_m / object.diagonal_m;
    manner.step_m = kSlideStep_diag * object.diagonal_m;
    manner.rotation_rate = [seed = random.bits()](std::uint64_t turn)
    { return Random::seeded(seed + turn).between(-1.0, 1.0); };
    return manner;
}

ObjectPose pose_of_scale(double scale)
{
    ObjectPose pose;
    pose.scale = scale;
    return pose;
}

ToolSphere sphere_round(const TestModel& tool)
{
    Vec3 low = to_vec3(tool.faces[0][0]);
    Vec3 high = low;
    for (const Face& face : tool.faces)
    {
        for (const Vec3f& corner : face)
        {
            low = low.cwiseMin(to_vec3(corner));
            high = high.cwiseMax(to_vec3(corner));
        }
    }
    const Vec3 middle = 0.5 * (low + high);
    double radius = 0.0;
    for (const Face& face : tool.faces)
    {
        for (const Vec3f& corner : face)
        {
            radius = std::max(radius, (to_vec3(corner) - middle).norm());
        }
    }
    return {middle + Vec3(tool.origin_m[0], tool.origin_m[1], tool.origin_m[2]), radius};
}

RandomMeshMotion::RandomMeshMotion(const TestModel& tool, const TestModel& object,
                                   const FaceTree& tree, double scale, Random& random)
    : sphere_(sphere_round(tool))
    , random_(random)
    , hand_(object, tree, sphere_.radius_m / scale, scale, random)
{
}

MeshMoment RandomMeshMotion::next()
{
    if (frames_left_ == 0)
    {
        change_grip();
    }
    --frames_left_;
    rotation_ = (Eigen::Quaterniond(Eigen::AngleAxisd(rate_rad_, axis_)) * rotation_).normalized();
    const Moment moment = hand_.next();
    return {held(grip_m_, moment.goal_m, rotation_.toRotationMatrix()), moment.pose};
}

/// Chooses a grip from half inside the tool to outside of it.
void RandomMeshMotion::change_grip()
{
    frames_left_ = 5 + random_.below(kLongestGrip);
    const Vec3 direction = random_.in_cube(1.0).normalized();
    grip_m_ = sphere_.middle_m + random_.between(0.3, 1.1) * sphere_.radius_m * direction;
    axis_ = random_.in_cube(1.0).normalized();
    rate_rad_ = kTurns_rad[random_.below(kTurns_rad.size())];
    if (random_.one_in(4))
    {
        rotation_ = Eigen::Quaterniond{random_.between(0.1, 1.0), random_.between(-1.0, 1.0),
                                       random_.between(-1.0, 1.0), random_.between(-1.0, 1.0)}
                        .normalized();
    }
}

CoincidentMotion::CoincidentMotion(const TestModel& tool, const TestModel& object)
    : place_m_(-tool.origin_m[0], -tool.origin_m[1], -tool.origin_m[2])
    , diagonal_m_(object.diagonal_m)
{
}

MeshMoment CoincidentMotion::next()
{
    constexpr std::array<double, 6> kOff_diag{0.0, 1e-17, 1e-16, 1e-12, 1e-6, 1e-3};
    const double off_m = kOff_diag[frame_ / 3 % kOff_diag.size()] * diagonal_m_;
    MeshMoment moment;
    moment.tool.position_m = place_m_;
    moment.tool.position_m[frame_ % 3] += off_m;
    ++frame_;
    return moment;
}

MeshSlide::MeshSlide(const TestModel& tool, const TestModel& object, const FaceTree& tree,
                     double scale, Random& random)
    : sphere_(sphere_round(tool))
    , tree_(tree)
    , step_m_(kSlideStep_diag * object.diagonal_m * scale)
    , pose_(pose_of_scale(scale))
    , axis_(random.in_cube(1.0).normalized())
    , slide_(tree, slide_manner(object, sphere_.radius_m / scale, random),
             Vec3(0.0, 0.0, tree.high_m().z()) + 0.5 * (tree.low_m() + tree.high_m()))
{
}

MeshMoment MeshSlide::next()
{
    ++frame_;
    const Mat3 rotation =
        Eigen::Quaterniond(Eigen::AngleAxisd(kSlideTurn_rad * frame_, axis_)).toRotationMatrix();
    const Vec3 place_m = slide_.next();
    const Vec3 up = (place_m - tree_.nearest(place_m).point_m).normalized();
    return {held(sphere_.middle_m, to_world(pose_, place_m) - sunk_m_ * up, rotation), pose_};
}

void MeshSlide::feel(double distance_m)
{
    const double sinking_m = std::min(0.5 * distance_m, kSinking * step_m_) + kPressing * step_m_;
    sunk_m_ += distance_m > 0.0 ? sinking_m : -kRising * step_m_;
}

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

double skin_m(const MeshTrial& trial)
{
    return trial.hardship.radius_diag * trial.tool.diagonal_m;
}

RigOptions rig_options(const MeshTrial& trial)
{
    RigOptions options = trial.hardship.rig;
    options.pool_bytes *= 2;
    options.faults.seed = trial.seed + 1;
    ToolSpec tool;
    tool.radius_m = skin_m(trial);
    tool.core = MeshCore{ModelId{1}};
    tool.wants_contacts = true;
    tool.wants_pairs = true;
    tool.query_only = true; // A tool with a proxy would never meet the object.
    options.tools = {tool};
    return options;
}

FrameOutput step(FrameRig& rig, const MeshMoment& moment, const Budgets& budgets)
{
    rig.place_object(moment.pose);
    return rig.step(std::span(&moment.tool, 1), budgets);
}

std::string name_of(const MeshTrial& trial)
{
    return trial.tool.name + " on " + trial.object.name + ", " + trial.hardship.name;
}

std::string where(const MeshTrial& trial, std::uint32_t frame, const char* activity)
{
    return name_of(trial) + ", TACTUS_SEED=" + std::to_string(trial.seed) + ", frame " +
           std::to_string(frame) + " (" + activity + "): ";
}

bool is_answered(const PairOutput& pair)
{
    return pair.kind == AnswerKind::exact || pair.kind == AnswerKind::separated;
}

/// Frames of one trial and their evaluation.
class MeshRun
{
public:
    MeshRun(const MeshTrial& trial, MeshMotion& motion)
        : trial_(trial)
        , motion_(motion)
        , rig_({&trial.object, &trial.tool}, rig_options(trial))
        , judge_(trial.tool, trial.object, skin_m(trial))
    {
        figures_.truth = {name_of(trial), 0, 0.0, 0.0, "frames", 0, {}};
        figures_.open = {name_of(trial) + ", open", 0, 0.0, kMeshOpenShare, "of the frames", 0, {}};
    }

    [[nodiscard]] MeshFigures run()
    {
        for (frame_ = 0; frame_ < trial_.frames; ++frame_)
        {
            const MeshMoment moment = motion_.next();
            const FrameOutput output = step(rig_, moment, trial_.hardship.budgets);
            count(output.pairs[0]);
            check(output, moment);
        }
        if (figures_.open.trials > 0)
        {
            figures_.open.observe(static_cast<double>(open_) /
                                  static_cast<double>(figures_.open.trials));
        }
        return figures_;
    }

private:
    void count(const PairOutput& pair)
    {
        const bool is_complete = pair.mesh != nullptr && pair.mesh->is_complete;
        figures_.exact += pair.kind == AnswerKind::exact ? 1U : 0U;
        figures_.complete += is_complete ? 1U : 0U;
        figures_.truncated += pair.mesh != nullptr && pair.mesh->is_truncated ? 1U : 0U;
        if (frame_ >= kMeshSettling)
        {
            ++figures_.open.trials;
            open_ += is_answered(pair) && is_complete ? 0U : 1U;
        }
    }

    void check(const FrameOutput& output, const MeshMoment& moment)
    {
        ++figures_.truth.trials;
        std::vector<std::string> wrong = judge_.judge(rig_, moment, output.pairs[0]);
        motion_.feel(judge_.distance_m());
        figures_.meeting += judge_.is_meeting() ? 1U : 0U;
        for (const Verdict& verdict :
             {broken_budget(output, trial_.hardship.budgets), unexplained(output)})
        {
            if (verdict)
            {
                wrong.push_back(*verdict);
            }
        }
        for (const std::string& what : wrong)
        {
            figures_.truth.flag(where(trial_, frame_, motion_.activity()) + what);
        }
        wrong_frames_ += wrong.empty() ? 0 : 1;
        figures_.truth.observe(wrong_frames_);
    }

    const MeshTrial& trial_;
    MeshMotion& motion_;
    FrameRig rig_;
    MeshJudge judge_;
    MeshFigures figures_;
    std::uint32_t frame_{0};
    std::uint64_t open_{0};
    int wrong_frames_{0};
};

/// Difference between two exact answers; empty if there is none.
std::string difference(const PairOutput& a, const PairOutput& b)
{
    if (!same_bits(a.lower_m, b.lower_m) || !same_bits(a.upper_m, b.upper_m))
    {
        return "the distances differ: " + std::to_string(a.lower_m) + ", whole " +
               std::to_string(b.lower_m);
    }
    if (a.mesh->is_complete && b.mesh->is_complete &&
        !std::equal(a.mesh->meeting.begin(), a.mesh->meeting.end(), b.mesh->meeting.begin(),
                    b.mesh->meeting.end()))
    {
        return "the faces that meet differ";
    }
    if (a.contacts->is_complete && b.contacts->is_complete &&
        !same_bits(a.contacts->contacts, b.contacts->contacts))
    {
        return "the contacts differ";
    }
    // Any of several meeting faces is nearest, and the known ones may differ.
    const bool is_known = a.upper_m > 0.0 || (a.mesh->is_complete && b.mesh->is_complete);
    if (is_known &&
        (a.nearest_face != b.nearest_face ||
         a.mesh->nearest_tool_face != b.mesh->nearest_tool_face ||
         !same_bits(a.point_m, b.point_m) || !same_bits(a.nearest_point_m, b.nearest_point_m)))
    {
        return "the nearest faces or points differ";
    }
    return "";
}

/// Rig with both models refined fully.
std::unique_ptr<FrameRig> whole_models(const MeshTrial& trial)
{
    RigOptions options = whole_options(trial.object.faces.size() + trial.tool.faces.size());
    options.pool_bytes *= 2;
    options.tools = rig_options(trial).tools;
    auto rig = std::make_unique<FrameRig>(std::vector{&trial.object, &trial.tool}, options);
    refine_fully(name_of(trial),
                 [&](const Budgets& budgets) { return step(*rig, MeshMoment{}, budgets); });
    return rig;
}

/// Rig of a tool that requests no contacts, and all pairs or none.
std::unique_ptr<FrameRig> rig_without_contacts(const MeshTrial& trial, bool wants_pairs)
{
    RigOptions options = rig_options(trial);
    options.tools[0].wants_contacts = false;
    options.tools[0].wants_pairs = wants_pairs;
    return std::make_unique<FrameRig>(std::vector{&trial.object, &trial.tool}, options);
}

/// Difference between answers with and without pairs; empty if there is none.
std::string difference_without_pairs(const PairOutput& all, const PairOutput& first)
{
    // Bounds beyond the reach depend on the pair's memory.
    const bool are_exact = all.kind == AnswerKind::exact && first.kind == AnswerKind::exact;
    if (are_exact &&
        (!same_bits(all.lower_m, first.lower_m) || !same_bits(all.upper_m, first.upper_m)))
    {
        return "the distances differ: " + std::to_string(first.lower_m) + ", with pairs " +
               std::to_string(all.lower_m);
    }
    const bool are_known = all.mesh->intersection != Intersection::open &&
                           first.mesh->intersection != Intersection::open;
    if (are_known && all.mesh->intersection != first.mesh->intersection)
    {
        return "whether they meet differs";
    }
    if (first.mesh->intersection == Intersection::proven && first.kind != AnswerKind::exact)
    {
        return "they meet, and the distance is not known";
    }
    if (first.mesh->meeting.size() > 1)
    {
        return "pairs that nobody wants: " + std::to_string(first.mesh->meeting.size());
    }
    return "";
}

} // namespace

MeshFigures run_mesh_trial(const MeshTrial& trial)
{
    Random random = Random::seeded(trial.seed);
    RandomMeshMotion motion(trial.tool, trial.object, trial.tree, trial.scale, random);
    return MeshRun(trial, motion).run();
}

MeshFigures run_mesh_slide(const MeshTrial& trial)
{
    Random random = Random::seeded(trial.seed);
    MeshSlide motion(trial.tool, trial.object, trial.tree, trial.scale, random);
    return MeshRun(trial, motion).run();
}

MeshFigures run_coincident_meshes(const MeshTrial& trial)
{
    CoincidentMotion motion(trial.tool, trial.object);
    return MeshRun(trial, motion).run();
}

TrialFigures run_mesh_twin(const MeshTrial& trial)
{
    Random random = Random::seeded(trial.seed);
    RandomMeshMotion motion(trial.tool, trial.object, trial.tree, trial.scale, random);
    const std::unique_ptr<FrameRig> whole = whole_models(trial);
    FrameRig rig({&trial.object, &trial.tool}, rig_options(trial));
    TrialFigures figures{name_of(trial) + ", identical", 0, 0.0, 0.0, "frames", 0, {}};
    for (std::uint32_t frame = 0; frame < trial.frames; ++frame)
    {
        const MeshMoment moment = motion.next();
        const PairOutput ours = step(rig, moment, trial.hardship.budgets).pairs[0];
        const PairOutput full = step(*whole, moment, trial.hardship.budgets).pairs[0];
        if (ours.kind != AnswerKind::exact || full.kind != AnswerKind::exact)
        {
            continue;
        }
        ++figures.trials;
        if (const std::string text = difference(ours, full); !text.empty())
        {
            figures.flag(where(trial, frame, motion.activity()) + text);
            figures.observe(static_cast<double>(figures.violations));
        }
    }
    return figures;
}

PairlessFigures run_mesh_without_pairs(const MeshTrial& trial)
{
    Random random = Random::seeded(trial.seed);
    RandomMeshMotion motion(trial.tool, trial.object, trial.tree, trial.scale, random);
    const auto with = rig_without_contacts(trial, true);
    const auto without = rig_without_contacts(trial, false);
    PairlessFigures figures{{name_of(trial) + ", without pairs", 0, 0.0, 0.0, "frames", 0, {}}};
    for (std::uint32_t frame = 0; frame < trial.frames; ++frame)
    {
        const MeshMoment moment = motion.next();
        const PairOutput all = step(*with, moment, trial.hardship.budgets).pairs[0];
        const PairOutput first = step(*without, moment, trial.hardship.budgets).pairs[0];
        ++figures.same.trials;
        figures.met += all.mesh->meeting.size() > 1 ? 1U : 0U;
        if (const std::string text = difference_without_pairs(all, first); !text.empty())
        {
            figures.same.flag(where(trial, frame, motion.activity()) + text);
            figures.same.observe(static_cast<double>(figures.same.violations));
        }
    }
    return figures;
}

} // namespace tactus::test
