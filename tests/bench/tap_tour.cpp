// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/tap_tour.hpp"

#include "tests/bench/bench_row.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/surface_slide.hpp"

#include <cmath>

namespace tactus::bench
{

namespace
{

constexpr double kTapTurn_rad_per_s = 3.0;
/// Height of the flights above the surface, of the tool's own surface.
constexpr double kTapFlight_diag = 0.03;
constexpr std::uint32_t kFlightSteps = 250;
constexpr std::uint32_t kSlideSteps = 500;

class Tour
{
public:
    Tour(const TouchScene& scene, const TourManner& manner)
        : scene_(scene)
        , manner_(manner)
        , step_m_(manner.speed_diag_per_s * scene.diagonal_m * kPeriod_s)
    {
        const Vec3 middle = 0.5 * (scene.tree.low_m() + scene.tree.high_m());
        goals_m_.emplace_back(middle.x(), middle.y(),
                              scene.tree.high_m().z() + kTapFlight_diag * scene.diagonal_m);
    }

    TapTour make()
    {
        for (std::uint32_t tap = 0; tap < manner_.taps; ++tap)
        {
            blend(kRadius_diag + kTapFlight_diag, 0, kFlightSteps);
            blend(kRadius_diag, kDeepest, kSlideSteps);
        }
        TapTour tour;
        tour.goals_m = std::move(goals_m_);
        tour.touches = first_touches(tour.goals_m);
        tremble(tour.goals_m);
        return tour;
    }

private:
    /// Frame of the greatest depth of a slide: half a swing.
    static constexpr std::uint32_t kDeepest = test::SurfaceSlide::kSwingFrames / 2;

    /// Moves straight to the start of the slide, then along the surface.
    void blend(double radius_diag, std::uint32_t first_frame, std::uint32_t steps)
    {
        go_to_distance(test::SurfaceSlide::wanted_distance_diag(radius_diag, first_frame));
        test::SlideManner slide;
        slide.diagonal_m = scene_.diagonal_m;
        slide.radius_diag = radius_diag;
        slide.step_m = step_m_;
        slide.rotation_rad = kTapTurn_rad_per_s * kPeriod_s;
        slide.first_frame = first_frame;
        slide.rotation_rate = [seed = kSeed + goals_m_.size()](std::uint64_t turn)
        { return test::signed_unit(seed, turn); };
        test::SurfaceSlide along(scene_.tree, slide, goals_m_.back());
        for (std::uint32_t i = 0; i < steps; ++i)
        {
            goals_m_.push_back(along.next());
        }
    }

    /// Moves straight to or from the nearest point of the surface.
    void go_to_distance(double distance_diag)
    {
        const Vec3 from = goals_m_.back();
        const test::FaceTree::Nearest nearest = scene_.tree.nearest(from);
        const Vec3 normal = (from - nearest.point_m).normalized();
        const Vec3 to = nearest.point_m + distance_diag * scene_.diagonal_m * normal;
        const auto frames = static_cast<std::uint32_t>(std::ceil((to - from).norm() / step_m_)) + 1;
        for (std::uint32_t i = 1; i <= frames; ++i)
        {
            goals_m_.emplace_back(from + (to - from) * (static_cast<double>(i) / frames));
        }
    }

    [[nodiscard]] std::vector<std::size_t> first_touches(const std::vector<Vec3>& goals_m) const
    {
        std::vector<std::size_t> touches;
        bool was_near = false;
        const double reach_m = kRadius_diag * scene_.diagonal_m;
        for (std::size_t i = 0; i < goals_m.size(); ++i)
        {
            const double distance_m = scene_.tree.nearest(goals_m[i]).distance_m;
            if (!was_near && distance_m <= reach_m)
            {
                touches.push_back(i);
                was_near = true;
            }
            was_near =
                was_near && distance_m <= reach_m + 0.5 * kTapFlight_diag * scene_.diagonal_m;
        }
        return touches;
    }

    void tremble(std::vector<Vec3>& goals_m) const
    {
        for (std::size_t i = 0; manner_.tremor_m > 0.0 && i < goals_m.size(); ++i)
        {
            goals_m[i] += manner_.tremor_m * Vec3(test::signed_unit(kSeed + 2, 3 * i),
                                                  test::signed_unit(kSeed + 2, 3 * i + 1),
                                                  test::signed_unit(kSeed + 2, 3 * i + 2));
        }
    }

    const TouchScene& scene_;
    TourManner manner_;
    double step_m_;
    std::vector<Vec3> goals_m_;
};

} // namespace

TapTour tap_tour(const TouchScene& scene, const TourManner& manner)
{
    return Tour(scene, manner).make();
}

} // namespace tactus::bench
