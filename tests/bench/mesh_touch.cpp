// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/mesh_touch.hpp"

#include "host_tools/shapes/shapes.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::bench
{

namespace
{

constexpr std::uint32_t kToolFaces = 1'000;
constexpr double kAcross_diag = 0.15;
constexpr double kTouch_diag_per_s = 0.1;
constexpr double kTurn_rad_per_s = 1.0;
constexpr double kLowest_diag = -0.0075;
constexpr double kHighest_diag = 0.005;
constexpr double kSwing_s = 1.0;
/// Budget without a limit.
constexpr std::uint32_t kUnlimited = std::numeric_limits<std::uint32_t>::max();

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
    std::vector<Vec3> way =
        is_small ? touch_motion(object, frames) : slide_motion(object, kTouch_diag_per_s, frames);
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
            Eigen::AngleAxisd(kTurn_rad_per_s * kPeriod_s * frame, axis).toRotationMatrix();
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
    WalkBudget budget{kUnlimited, kUnlimited};
    find_meeting_faces(question(), enough, budget, memory_, report_);
}

bool TactusPairQuery::do_meet()
{
    find_meeting(1);
    return report_.intersection == Intersection::proven;
}

const std::vector<test::FacePair>& TactusPairQuery::meeting()
{
    find_meeting(kUnlimited);
    return pairs_of_report();
}

const std::vector<test::FacePair>& TactusPairQuery::contacts()
{
    OtherSurface surface(object_.tree(), place_, {kUnlimited, kUnlimited});
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
    OtherSurface surface(object_.tree(), place_, {kUnlimited, kUnlimited});
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
