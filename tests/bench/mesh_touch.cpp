// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/bench/mesh_touch.hpp"

#include "host_tools/shapes/shapes.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/shared/mesh_pair_oracle.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

namespace tactus::bench
{
namespace
{

std::vector<std::uint32_t> names_of(const Scene& scene)
{
    const test::FaceNames names(scene.model.faces);
    std::vector<std::uint32_t> all(scene.model.faces.size());
    for (std::uint32_t face = 0; face < all.size(); ++face)
    {
        all[face] = names.of(face);
    }
    return all;
}

/// Names of the pairs, ascending and unique.
std::vector<test::FacePair> named(const std::vector<test::FacePair>& pairs, const PairTruth& truth)
{
    std::vector<test::FacePair> names;
    for (const test::FacePair& pair : pairs)
    {
        names.push_back({truth.tool_names[pair.tool_face], truth.object_names[pair.face]});
    }
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

std::uint64_t missing_from(const std::vector<test::FacePair>& those,
                           const std::vector<test::FacePair>& wanted)
{
    std::vector<test::FacePair> missing;
    std::ranges::set_difference(wanted, those, std::back_inserter(missing));
    return missing.size();
}

/// Asks one question; keeps the answer and returns its hash.
std::uint64_t answer(PairQuery& query, PairQuestion question, std::size_t frame,
                     PairAnswers& answers)
{
    const BenchClock::time_point start = BenchClock::now();
    switch (question)
    {
    case PairQuestion::any:
    {
        const bool do_meet = query.do_meet();
        answers.us.keep(frame, microseconds(start, BenchClock::now()));
        answers.do_meet[frame] = do_meet;
        return do_meet ? 1 : 0;
    }
    case PairQuestion::all_pairs:
    case PairQuestion::contacts:
    {
        const std::vector<test::FacePair>& pairs =
            question == PairQuestion::contacts ? query.contacts() : query.meeting();
        answers.us.keep(frame, microseconds(start, BenchClock::now()));
        answers.meeting[frame].clear();
        std::uint64_t sum = pairs.size();
        for (const test::FacePair& pair : pairs)
        {
            answers.meeting[frame].push_back(query.in_source(pair));
            sum += (std::uint64_t{pair.tool_face} << 32U) + pair.face; // Independent of the order.
        }
        return sum;
    }
    case PairQuestion::distance:
        break;
    }
    const double distance_m = query.distance_m();
    answers.us.keep(frame, microseconds(start, BenchClock::now()));
    answers.distances_m[frame] = distance_m;
    return std::bit_cast<std::uint64_t>(distance_m);
}

bool asks_for_pairs(PairQuestion question)
{
    return question == PairQuestion::all_pairs || question == PairQuestion::contacts;
}

PairAnswers room_for(PairQuestion question, std::size_t frames)
{
    PairAnswers answers{LeastTimes(frames), {}, {}, {}};
    answers.do_meet.resize(question == PairQuestion::any ? frames : 0);
    answers.meeting.resize(asks_for_pairs(question) ? frames : 0);
    answers.distances_m.resize(question == PairQuestion::distance ? frames : 0);
    return answers;
}

} // namespace

const char* question_name(PairQuestion question)
{
    return question == PairQuestion::any         ? "any"
           : question == PairQuestion::all_pairs ? "all pairs"
           : question == PairQuestion::contacts  ? "contacts"
                                                 : "distance";
}

PairTruth find_pair_truth(const Scene& tool, const Scene& object,
                          std::span<const Similarity> places)
{
    PairTruth truth;
    truth.tool_names = names_of(tool);
    truth.object_names = names_of(object);
    test::MeshPairOracle oracle(tool.model, object.model);
    for (const Similarity& place : places)
    {
        ToolState state;
        state.position_m = place.translation_m;
        state.rotation = place.rotation;
        oracle.place(ObjectPose{}, state);
        truth.meeting.push_back(named(oracle.meeting(), truth));
        const bool do_meet = !truth.meeting.back().empty();
        truth.distances_m.push_back(do_meet ? 0.0
                                            : static_cast<double>(oracle.nearest().distance_m));
    }
    return truth;
}

PairAnswers replay_pairs(PairQuery& query, std::span<const Similarity> places,
                         PairQuestion question, std::uint32_t passes)
{
    PairAnswers answers = room_for(question, places.size());
    for (std::uint32_t pass = 0; pass < passes; ++pass)
    {
        std::uint64_t hash = 0;
        query.forget();
        if (!places.empty())
        {
            query.place(places[0]);
            PairAnswers not_kept = room_for(question, 1);
            static_cast<void>(answer(query, question, 0, not_kept));
        }
        for (std::size_t i = 0; i < places.size(); ++i)
        {
            query.place(places[i]);
            hash += answer(query, question, i, answers) * (2 * i + 1);
        }
        if (pass > 0 && hash != answers.hash)
        {
            throw Failure(query.name() + ": passes over the same places gave other answers");
        }
        answers.hash = hash;
    }
    return answers;
}

PairErrors judge_pairs(const PairAnswers& answers, const PairTruth& truth, PairQuestion question)
{
    PairErrors errors;
    for (std::size_t i = 0; i < truth.meeting.size(); ++i)
    {
        const bool do_meet = !truth.meeting[i].empty();
        if (question == PairQuestion::any)
        {
            errors.missed += do_meet && !answers.do_meet[i] ? 1U : 0U;
            errors.invented += !do_meet && answers.do_meet[i] ? 1U : 0U;
        }
        else if (asks_for_pairs(question))
        {
            const std::vector<test::FacePair> told = named(answers.meeting[i], truth);
            errors.missed += missing_from(told, truth.meeting[i]);
            errors.invented += missing_from(truth.meeting[i], told);
        }
        else
        {
            const double error_m = std::abs(answers.distances_m[i] - truth.distances_m[i]);
            errors.largest_m = std::isnan(error_m) ? std::numeric_limits<double>::infinity()
                                                   : std::max(errors.largest_m, error_m);
        }
    }
    return errors;
}

namespace
{

constexpr std::uint32_t kToolFaces = 1'000;
constexpr double kAcross_diag = 0.15;
constexpr double kMeshTouch_diag_per_s = 0.1;
constexpr double kMeshTurn_rad_per_s = 1.0;
constexpr double kLowest_diag = -0.0075;
constexpr double kHighest_diag = 0.005;
constexpr double kSwing_s = 1.0;
/// Budget without a limit.
constexpr std::uint32_t kNoLimit = std::numeric_limits<std::uint32_t>::max();

Vec3 vec3_of(const std::array<double, 3>& coordinates)
{
    return {coordinates[0], coordinates[1], coordinates[2]};
}

/// Height of the lowest corner above the surface; highest in frame 0.
double height_diag(std::uint32_t frame)
{
    const double phase = 2.0 * std::numbers::pi * frame * kPeriod_s / kSwing_s;
    return 0.5 * (kHighest_diag + kLowest_diag) +
           0.5 * (kHighest_diag - kLowest_diag) * std::cos(phase);
}

/// Extent of a tool along a direction, from its frame's origin.
double extent_along(const Vec3& direction, const std::vector<Triangle>& tool)
{
    double most = -std::numeric_limits<double>::infinity();
    for (const Triangle& triangle : tool)
    {
        for (const Vec3& corner : triangle)
        {
            most = std::max(most, direction.dot(corner));
        }
    }
    return most;
}

std::vector<Triangle> moved(const std::vector<test::Face>& faces, const Vec3& offset_m)
{
    std::vector<Triangle> triangles;
    triangles.reserve(faces.size());
    for (const test::Face& face : faces)
    {
        triangles.push_back(to_triangle(face));
        for (Vec3& corner : triangles.back())
        {
            corner += offset_m;
        }
    }
    return triangles;
}

} // namespace

NamedMesh make_tool_mesh(const Scene& object, MeshProbe probe)
{
    TriangleMesh mesh = make_shape(Shape::bumpy_sphere, kToolFaces).value();
    Vec3 low = vec3_of(mesh.positions[0]);
    Vec3 high = low;
    for (const auto& position : mesh.positions)
    {
        low = low.cwiseMin(vec3_of(position));
        high = high.cwiseMax(vec3_of(position));
    }
    const bool is_small = probe == MeshProbe::small;
    const double own = is_small ? (high - low).norm() : (high - low).maxCoeff();
    return {(is_small ? "small-tool-for-" : "tool-for-") + object.model.name,
            scaled(std::move(mesh), kAcross_diag * object.model.diagonal_m / own)};
}

std::vector<Triangle> faces_in_source_frame(const Scene& scene)
{
    return moved(scene.model.faces, vec3_of(scene.model.origin_m));
}

std::vector<Triangle> faces_in_model_frame(const Scene& scene)
{
    return moved(scene.model.faces, Vec3(0.0, 0.0, 0.0));
}

std::vector<Similarity> mesh_touch_motion(const TouchScene& object,
                                          const std::vector<Triangle>& tool, MeshProbe probe,
                                          std::uint32_t frames)
{
    const bool is_small = probe == MeshProbe::small;
    std::vector<Vec3> way = is_small ? touch_motion(object, frames)
                                     : slide_motion(object, kMeshTouch_diag_per_s, frames);
    way.erase(way.begin(), way.end() - frames);
    const Vec3 axis = Vec3(1.0, 2.0, 2.0) / 3.0;
    std::vector<Similarity> places;
    for (std::uint32_t frame = 0; frame < frames; ++frame)
    {
        const Vec3& above_m = way[frame];
        const Vec3 below_m = object.tree.nearest(above_m).point_m;
        const double over_m = (above_m - below_m).norm();
        const Vec3 up = (above_m - below_m) / over_m;
        const Mat3 rotation =
            Eigen::AngleAxisd(kMeshTurn_rad_per_s * kPeriod_s * frame, axis).toRotationMatrix();
        const double lowest_m = extent_along(-(rotation.transpose() * up), tool);
        const double height_m = is_small ? over_m - kRadius_diag * object.diagonal_m
                                         : height_diag(frame) * object.diagonal_m;
        places.push_back({rotation, below_m + (lowest_m + height_m) * up, 1.0});
    }
    return places;
}

TactusPairQuery::TactusPairQuery(const Scene& tool, const Scene& object)
    : tool_(tool)
    , object_(object)
    , tool_names_(tool.model.faces)
    , object_names_(object.model.faces)
    , place_{{}, vec3_of(tool.model.origin_m)}
    , skin_m_(kMeshSkin_diag * object.model.diagonal_m)
{
    pairs_.reserve(kMaxMeetingFaces);
}

void TactusPairQuery::place(const Similarity& tool)
{
    place_.place = tool;
}

void TactusPairQuery::forget()
{
    memory_ = {};
    front_.count = 0;
}

MeshQuestion TactusPairQuery::question()
{
    MeshQuestion question{tool_.tree(), object_.tree(), place_};
    question.front = &front_;
    return question;
}

void TactusPairQuery::find_meeting(std::uint32_t enough)
{
    WalkBudget budget{kNoLimit, kNoLimit};
    find_meeting_faces(question(), enough, budget, memory_, report_);
}

bool TactusPairQuery::do_meet()
{
    find_meeting(1);
    return report_.intersection == Intersection::proven;
}

const std::vector<test::FacePair>& TactusPairQuery::meeting()
{
    find_meeting(kNoLimit);
    return pairs_of_report();
}

const std::vector<test::FacePair>& TactusPairQuery::contacts()
{
    OtherSurface surface(object_.tree(), place_, {kNoLimit, kNoLimit});
    ends_.is_empty = true;
    MeshQuestion asked = question();
    asked.reach_m = skin_m_;
    asked.contact_m = skin_m_;
    asked.ends = &ends_;
    query_meshes(asked, surface, memory_, answer_, report_, contacts_);
    return pairs_of_report();
}

const std::vector<test::FacePair>& TactusPairQuery::pairs_of_report()
{
    pairs_.clear();
    for (const MeetingFaces& faces : report_.meeting)
    {
        pairs_.push_back({faces.tool_face.value, faces.face.value});
    }
    return pairs_;
}

double TactusPairQuery::distance_m()
{
    OtherSurface surface(object_.tree(), place_, {kNoLimit, kNoLimit});
    find_nearest_faces(question(), surface, memory_, answer_, report_);
    return answer_.kind == AnswerKind::exact ? answer_.upper_m
                                             : std::numeric_limits<double>::quiet_NaN();
}

test::FacePair TactusPairQuery::in_source(const test::FacePair& own) const
{
    return {tool_names_.of(tool_.model(), FaceId{own.tool_face}).value(),
            object_names_.of(object_.model(), FaceId{own.face}).value()};
}

} // namespace tactus::bench
