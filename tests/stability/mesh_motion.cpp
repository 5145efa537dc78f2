// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/mesh_motion.hpp"

#include <algorithm>
#include <array>

namespace tactus::test
{

namespace
{

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

} // namespace

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

} // namespace tactus::test
