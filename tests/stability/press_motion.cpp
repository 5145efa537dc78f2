// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/press_motion.hpp"

#include "tests/shared/period.hpp"

#include <algorithm>
#include <array>

namespace tactus::test
{

namespace
{

/// Radius of the sphere that slides along the surface, for every tool.
constexpr double kFixture_diag = 0.01;
constexpr double kLeastDepth_m = 0.5e-3;
constexpr double kMostDepth_m = 1e-3;
constexpr double kLifted_m = -3e-3;
/// Speeds of the hand's descent and ascent.
constexpr double kSlowest_m_per_s = 0.02;
constexpr double kFastest_m_per_s = 0.3;
constexpr double kSlowestSlide_diag_per_s = 0.02;
constexpr double kFastestSlide_diag_per_s = 0.1;
constexpr double kHop_diag_per_s = 2.0;
constexpr std::uint32_t kHopFrames = 100;
constexpr std::uint32_t kTapFrames = 60;

} // namespace

PressMotion::PressMotion(const TestModel& model, const FaceTree& tree, double radius_m,
                         double scale, Random& random)
    : model_(model)
    , tree_(tree)
    , radius_m_(radius_m)
    , scale_(scale)
    , random_(random)
    , depth_m_(kLifted_m)
{
    const Vec3 middle = 0.5 * (tree.low_m() + tree.high_m());
    const double above = 2.0 * kFixture_diag * model.diagonal_m;
    slide_from(Vec3(middle.x(), middle.y(), tree.high_m().z() + above), kHop_diag_per_s);
    guide_m_ = slide_->next();
    begin();
}

void PressMotion::slide_from(const Vec3& place_m, double speed_diag_per_s)
{
    SlideManner manner;
    manner.diagonal_m = model_.diagonal_m;
    manner.radius_diag = kFixture_diag;
    manner.step_m = speed_diag_per_s * kPeriod_s * model_.diagonal_m;
    manner.rotation_rate = [rate = random_.between(-1.0, 1.0)](std::uint64_t) { return rate; };
    slide_.emplace(tree_, manner, place_m);
}

void PressMotion::begin()
{
    frame_ = 0;
    pressed_m_ = random_.between(kLeastDepth_m, kMostDepth_m);
    change_m_ = random_.between(kSlowest_m_per_s, kFastest_m_per_s) * kPeriod_s;
    const bool hops = activity_ == Activity::hop;
    frames_left_ = kHopFrames + random_.below(hops ? kHopFrames : 4 * kHopFrames);
    const double slow = random_.between(kSlowestSlide_diag_per_s, kFastestSlide_diag_per_s);
    slide_from(guide_m_, hops ? kHop_diag_per_s : slow);
}

Vec3 PressMotion::next()
{
    if (frames_left_ == 0)
    {
        activity_ = static_cast<Activity>(random_.below(4U));
        begin();
    }
    const bool is_up = depth_m_ <= 0.99 * kLifted_m;
    if (activity_ == Activity::slide || (activity_ == Activity::hop && is_up))
    {
        guide_m_ = slide_->next();
    }
    const Vec3 foot = tree_.nearest(guide_m_).point_m;
    normal_ = guide_m_ == foot ? normal_ : (guide_m_ - foot).normalized();
    depth_m_ += std::clamp(wanted_depth_m() - depth_m_, -change_m_, change_m_);
    ++frame_;
    --frames_left_;
    return foot + (radius_m_ - depth_m_) / scale_ * normal_;
}

/// A hop ends before its frames do, with the hand down again.
double PressMotion::wanted_depth_m()
{
    const bool taps_up = activity_ == Activity::tap && frame_ % kTapFrames >= kTapFrames / 2;
    const bool hops_up = activity_ == Activity::hop && frames_left_ > kHopFrames / 2;
    return taps_up || hops_up ? kLifted_m : pressed_m_;
}

const char* PressMotion::activity() const
{
    constexpr std::array<const char*, 4> kNames{"hop", "rest", "slide", "tap"};
    return kNames[static_cast<std::size_t>(activity_)];
}

} // namespace tactus::test
